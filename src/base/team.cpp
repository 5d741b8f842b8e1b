#include "base/team.h"

#include <algorithm>
#include <chrono>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace fabrica {
namespace {

using Clock = std::chrono::steady_clock;

// about what it takes to wake a thread that has given its core away
constexpr std::chrono::microseconds spin_time{100};

void relax() {
#if defined(__x86_64__)
  _mm_pause();
#endif
}

// A ticket: the number of its loop (16 bits), the end of the share (24), the next chunk to take
// (24).
constexpr int chunk_bits = 24;
constexpr std::uint64_t chunk_mask = (std::uint64_t(1) << chunk_bits) - 1;
std::uint64_t ticket_of(int loop, std::uint64_t first, std::uint64_t end) {
  return std::uint64_t(std::uint16_t(loop)) << 2 * chunk_bits | end << chunk_bits | first;
}
bool open_in(int loop, std::uint64_t ticket) {
  return std::uint16_t(ticket >> 2 * chunk_bits) == std::uint16_t(loop) &&
         (ticket & chunk_mask) < (ticket >> chunk_bits & chunk_mask);
}

// waits for done() without giving the core away; false when that has taken too long
template <class Done>
bool spin(Done done, Clock::duration longest = spin_time) {
  const auto give_up = Clock::now() + longest;
  do {
    for (int i = 0; i < 32; ++i) {
      if (done()) return true;
      relax();
    }
  } while (Clock::now() < give_up);
  return done();
}

}  // namespace

Team::Team(int threads) : size_(std::max(1, threads)), shares_(size_) {
  for (int i = 1; i < size_; ++i) threads_.emplace_back([this, i] { worker(i); });
}

Team::~Team() {
  stop_.store(true);
  loop_.fetch_add(1);
  loop_.notify_all();
  for (auto& t : threads_) t.join();
}

void Team::start(int chunks, Function function, void* data, bool own) {
  function_ = function, data_ = data, chunks_ = chunks;
  own_.store(own, std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  const int loop = loop_.load(std::memory_order_relaxed) + 1;
  for (int t = 0; t < size_; ++t)
    shares_[t].ticket.store(ticket_of(loop, std::uint64_t(share_first(chunks, t, size_)),
                                      std::uint64_t(share_first(chunks, t + 1, size_))),
                            std::memory_order_release);
  loop_.fetch_add(1, std::memory_order_release);
  loop_.notify_all();
  const auto done = [&] { return done_.load(std::memory_order_acquire) == chunks; };
  if (own) {
    const auto begin = Clock::now();
    work(0, loop, false);
    if (spin(done, std::min<Clock::duration>(Clock::now() - begin, spin_time))) return;
  }
  work(0, loop, true);
  if (spin(done)) return;
  for (int n; (n = done_.load(std::memory_order_acquire)) != chunks;)
    done_.wait(n, std::memory_order_acquire);
}

// First the own share, then those of the others. Who still looks for chunks of this loop when the
// next has begun takes none of that.
void Team::work(int thread, int loop, bool help) {
  for (int k = 0; k < (help ? size_ : 1); ++k) {
    std::atomic<std::uint64_t>& ticket = shares_[(thread + k) % size_].ticket;
    // counted here and told once: the count of all goes from cache to cache
    int finished = 0;
    for (std::uint64_t t = ticket.load(std::memory_order_acquire); open_in(loop, t);) {
      if (!ticket.compare_exchange_weak(t, t + 1, std::memory_order_acq_rel,
                                        std::memory_order_acquire))
        continue;
      function_(data_, int(t & chunk_mask), thread);
      ++finished;
      t = ticket.load(std::memory_order_acquire);
    }
    if (finished == 0) continue;
    // those who wait are told by the last chunk alone; the number is of the loop that it is of
    const int chunks = chunks_;
    if (done_.fetch_add(finished, std::memory_order_acq_rel) + finished == chunks)
      done_.notify_one();
  }
}

void Team::worker(int thread) {
  int seen = 0;
  for (;;) {
    if (!spin([&] { return loop_.load(std::memory_order_acquire) != seen; }))
      loop_.wait(seen, std::memory_order_acquire);
    seen = loop_.load(std::memory_order_acquire);
    if (stop_.load()) return;
    work(thread, seen, !own_.load(std::memory_order_relaxed));
  }
}

}  // namespace fabrica
