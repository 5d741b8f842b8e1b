#include "base/team.h"

#include <algorithm>
#include <chrono>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace fabrica {
namespace {

constexpr std::chrono::microseconds spin_time{30};

void relax() {
#if defined(__x86_64__)
  _mm_pause();
#endif
}

// waits for done() without giving the core away; false when that has taken too long
template <class Done>
bool spin(Done done) {
  const auto give_up = std::chrono::steady_clock::now() + spin_time;
  do {
    for (int i = 0; i < 32; ++i) {
      if (done()) return true;
      relax();
    }
  } while (std::chrono::steady_clock::now() < give_up);
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

void Team::start(int chunks, Function function, void* data) {
  function_ = function, data_ = data, chunks_ = chunks;
  done_.store(0, std::memory_order_relaxed);
  for (int t = 0; t < size_; ++t) {
    const std::uint64_t first = std::uint64_t(chunks) * t / size_,
                        end = std::uint64_t(chunks) * (t + 1) / size_;
    shares_[t].ticket.store((end << 32) + first, std::memory_order_release);
  }
  loop_.fetch_add(1, std::memory_order_release);
  loop_.notify_all();
  work(0);
  if (spin([&] { return done_.load(std::memory_order_acquire) == chunks; })) return;
  for (int done; (done = done_.load(std::memory_order_acquire)) != chunks;)
    done_.wait(done, std::memory_order_acquire);
}

void Team::work(int thread) {
  // first the own share, then those of the others
  for (int k = 0; k < size_; ++k) {
    std::atomic<std::uint64_t>& ticket = shares_[(thread + k) % size_].ticket;
    for (;;) {
      const std::uint64_t taken = ticket.fetch_add(1, std::memory_order_acq_rel);
      const int end = int(taken >> 32), chunk = int(taken & 0xffffffffu);
      if (chunk >= end) break;
      // those who wait are told by the last chunk alone; the number is of the loop that it is of
      const int chunks = chunks_;
      function_(data_, chunk, thread);
      if (done_.fetch_add(1, std::memory_order_acq_rel) + 1 == chunks) done_.notify_one();
    }
  }
}

void Team::worker(int thread) {
  int seen = 0;
  for (;;) {
    if (!spin([&] { return loop_.load(std::memory_order_acquire) != seen; }))
      loop_.wait(seen, std::memory_order_acquire);
    seen = loop_.load(std::memory_order_acquire);
    if (stop_.load()) return;
    work(thread);
  }
}

}  // namespace fabrica
