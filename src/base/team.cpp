#include "base/team.h"

#include <algorithm>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace fabrica {
namespace {

void relax() {
#if defined(__x86_64__)
  _mm_pause();
#endif
}

// spins for a while, then lets other processes run
template <class Done>
void wait_until(Done done) {
  for (int spins = 0; !done(); ++spins) {
    if (spins < 4000)
      relax();
    else
      std::this_thread::yield();
  }
}

}  // namespace

Team::Team(int threads) : size_(std::max(1, threads)) {
  for (int i = 1; i < size_; ++i) threads_.emplace_back([this, i] { worker(i); });
}

Team::~Team() {
  stop_.store(true);
  epoch_.fetch_add(1);
  epoch_.notify_all();
  for (auto& t : threads_) t.join();
}

void Team::start(int chunks, Function function, void* data) {
  chunks_ = chunks, function_ = function, data_ = data;
  next_.store(0, std::memory_order_relaxed);
  busy_.store(size_ - 1, std::memory_order_relaxed);
  epoch_.fetch_add(1, std::memory_order_release);
  epoch_.notify_all();
  work(0);
  wait_until([&] { return busy_.load(std::memory_order_acquire) == 0; });
}

void Team::work(int thread) {
  for (;;) {
    const int chunk = next_.fetch_add(1, std::memory_order_relaxed);
    if (chunk >= chunks_) return;
    function_(data_, chunk, thread);
  }
}

void Team::worker(int thread) {
  unsigned seen = 0;
  for (;;) {
    // spin first: the next loop usually starts within microseconds; sleep when it does not
    for (int spins = 0; epoch_.load(std::memory_order_acquire) == seen && spins < 20000; ++spins)
      relax();
    epoch_.wait(seen, std::memory_order_acquire);
    seen = epoch_.load(std::memory_order_acquire);
    if (stop_.load()) return;
    work(thread);
    busy_.fetch_sub(1, std::memory_order_release);
  }
}

}  // namespace fabrica
