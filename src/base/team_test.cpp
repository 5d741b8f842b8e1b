#include "base/team.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <thread>

using namespace fabrica;

// Every chunk of every loop runs once, for loops shorter and longer than the team, back to back and
// after pauses in which the threads have gone to sleep.
TEST_CASE("team: every chunk runs exactly once") {
  for (const int threads : {1, 2, 3, 8}) {
    Team team(threads);
    CHECK(team.size() == threads);
    std::vector<int> runs;
    for (int loop = 0; loop < 2000; ++loop) {
      const int chunks = loop % 37;
      runs.assign(std::size_t(chunks), 0);
      team.for_each(chunks, [&](int chunk, int thread) {
        if (thread >= 0 && thread < threads) ++runs[std::size_t(chunk)];
      });
      for (const int r : runs) REQUIRE(r == 1);
      team.for_each_own(chunks, [&](int chunk, int thread) {
        if (thread >= 0 && thread < threads) ++runs[std::size_t(chunk)];
      });
      for (const int r : runs) REQUIRE(r == 2);
      if (loop % 200 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
}

// A loop waits for the chunks that others have taken: the last one to finish is a slow one.
TEST_CASE("team: a loop ends when its slowest chunk has ended") {
  Team team(2);
  for (int loop = 0; loop < 20; ++loop) {
    std::vector<int> done(8, 0);
    team.for_each(8, [&](int chunk, int) {
      if (chunk == loop % 8) std::this_thread::sleep_for(std::chrono::milliseconds(2));
      done[std::size_t(chunk)] = 1;
    });
    for (const int d : done) REQUIRE(d == 1);
  }
}

// Thread t of T begins with chunk [C t / T], whichever thread comes first: nobody goes on before
// all have begun.
TEST_CASE("team: every thread begins with its own share") {
  const int threads = 3, chunks = 11;
  Team team(threads);
  for (int loop = 0; loop < 50; ++loop) {
    std::vector<int> begun(threads, -1), runs(chunks, 0);
    std::atomic<int> present{0};
    team.for_each(chunks, [&](int chunk, int thread) {
      ++runs[std::size_t(chunk)];
      if (begun[std::size_t(thread)] >= 0) return;
      begun[std::size_t(thread)] = chunk;
      ++present;
      while (present < threads) std::this_thread::yield();
    });
    for (int t = 0; t < threads; ++t) REQUIRE(begun[std::size_t(t)] == chunks * t / threads);
    for (const int r : runs) REQUIRE(r == 1);
  }
}

// Chunks of their own: the caller leaves them to the others until they are late, and they leave the
// caller's to it.
TEST_CASE("team: loops of own chunks") {
  const int chunks = 40, half = chunks / 2;
  Team team(2);
  for (int loop = 0; loop < 20; ++loop) {
    std::vector<int> by(chunks, -1);
    std::atomic<int> done{0};
    std::atomic<bool> begun{false};
    // the second thread holds its first chunk until all others are done
    team.for_each_own(chunks, [&](int chunk, int thread) {
      by[std::size_t(chunk)] = thread;
      if (chunk == 0)
        while (!begun) std::this_thread::yield();
      if (chunk == half) {
        begun = true;
        while (done < chunks - 1) std::this_thread::yield();
      }
      ++done;
    });
    for (int c = 0; c < chunks; ++c) REQUIRE(by[std::size_t(c)] == (c == half ? 1 : 0));
    // the caller holds its first chunk until the second thread has done its share
    done = 0;
    team.for_each_own(chunks, [&](int chunk, int thread) {
      by[std::size_t(chunk)] = thread;
      if (chunk == 0)
        while (done < chunks - half) std::this_thread::yield();
      ++done;
    });
    for (int c = 0; c < chunks; ++c) REQUIRE(by[std::size_t(c)] == (c < half ? 0 : 1));
  }
}

// Every index once, within its chunk.
TEST_CASE("team: ranges") {
  Team team(3);
  std::vector<int> seen(75, 0);
  team.for_ranges(seen.size(), 10, [&](int chunk, int first, int last) {
    for (int i = first; i < last; ++i) seen[std::size_t(i)] += i / 10 == chunk;
  });
  for (const int n : seen) CHECK(n == 1);
  CHECK(Team::ranges(75, 10) == 8);
  CHECK(Team::ranges(0, 10) == 0);
}
