#pragma once
// A team of threads that stays alive between loops. Work is a range of fixed chunks; which thread
// takes which chunk never changes a result, because chunks write to their own places and sums are
// made in chunk order. Every thread begins with its own share, the same one in every loop of that
// many chunks, so that what it wrote last time lies in its own caches; who is done takes from the
// shares of others, in one kind of loop at once, in the other only when they are late.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>
#include <type_traits>
#include <vector>

namespace fabrica {

class Team {
 public:
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  int size() const { return size_; }

  // calls fn(chunk, thread) for every chunk in [0, chunks); returns when all are done
  template <class Fn>
  void for_each(int chunks, Fn&& fn) {
    run(chunks, fn, false);
  }
  // The same for light work on data of the chunks' own, such as nodes: to bring them to another
  // thread's caches costs more than the work, so that the calling thread helps others only once
  // they take twice as long as itself, and they do not help at all.
  template <class Fn>
  void for_each_own(int chunks, Fn&& fn) {
    run(chunks, fn, true);
  }
  // Chunks of their own that are ranges of at most `size` of 0 .. n: calls fn(chunk, first, last).
  template <class Fn>
  void for_ranges(std::size_t n, int size, Fn&& fn) {
    for_each_own(ranges(n, size), range_of(n, size, fn));
  }
  static int ranges(std::size_t n, int size) {
    return int((n + std::size_t(size) - 1) / std::size_t(size));
  }
  // first chunk of a thread's own share
  static int share_first(int chunks, int thread, int threads) {
    return int(std::int64_t(chunks) * thread / threads);
  }

 private:
  using Function = void (*)(void*, int, int);
  template <class Fn>
  static auto range_of(std::size_t n, int size, Fn& fn) {
    return [n, size, &fn](int chunk, int) {
      fn(chunk, chunk * size, int(std::min(n, std::size_t(chunk + 1) * std::size_t(size))));
    };
  }
  template <class Fn>
  void run(int chunks, Fn&& fn, bool own) {
    if (size_ == 1 || chunks <= 1) {
      for (int i = 0; i < chunks; ++i) fn(i, 0);
      return;
    }
    using Body = std::remove_reference_t<Fn>;
    struct Call {
      static void run(void* f, int chunk, int thread) { (*static_cast<Body*>(f))(chunk, thread); }
    };
    start(chunks, &Call::run, const_cast<void*>(static_cast<const void*>(&fn)), own);
  }
  void start(int chunks, Function function, void* data, bool own);
  void work(int thread, int loop, bool help);
  void worker(int thread);

  int size_;
  std::vector<std::thread> threads_;
  // A thread's share of one loop: chunks up to its end are taken one by one.
  struct alignas(64) Share {
    std::atomic<std::uint64_t> ticket{0};
  };
  std::vector<Share> shares_;
  alignas(64) std::atomic<int> done_{0};  // chunks of this loop that are finished
  alignas(64) std::atomic<int> loop_{0};  // counts loops; workers sleep on it
  std::atomic<bool> stop_{false};
  std::atomic<bool> own_{false};  // whether this loop is one of for_each_own
  // written before the tickets, read only by who holds a chunk
  Function function_ = nullptr;
  void* data_ = nullptr;
  int chunks_ = 0;
};

}  // namespace fabrica
