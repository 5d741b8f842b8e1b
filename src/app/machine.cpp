#include "app/machine.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <vector>

#include "base/pack.h"
#include "base/team.h"

namespace fabrica {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point t) {
  return std::chrono::duration<double>(Clock::now() - t).count();
}

double triad(int threads) {
  const std::size_t n = 8'000'000;  // 192 MB in all: beyond the caches
  std::vector<double> a(n, 1), b(n, 2), c(n, 3);
  Team team(threads);
  double best = 0;
  for (int pass = 0; pass < 6; ++pass) {
    const auto start = Clock::now();
    team.for_each(threads, [&](int share, int) {
      const std::size_t first = n * share / threads, end = n * (share + 1) / threads;
      for (std::size_t i = first; i < end; ++i) a[i] = b[i] + 2.0 * c[i];
      asm volatile("" : : "r"(a.data()) : "memory");
    });
    best = std::max(best, 24.0 * double(n) / seconds_since(start) / 1e9);
  }
  return best;
}

double peak() {
  RealPack x[12];
  for (int i = 0; i < 12; ++i) x[i] = RealPack(1.0 + 0.001 * i);
  const RealPack m(0.999), d(0.0005);
  double best = 0;
  for (int pass = 0; pass < 5; ++pass) {
    const auto start = Clock::now();
    const int n = 2'000'000;
    for (int k = 0; k < n; ++k)
      for (int i = 0; i < 12; ++i) x[i] = fma(x[i], m, d);
    for (int i = 0; i < 12; ++i) asm volatile("" : "+v"(x[i].v));
    best = std::max(best, 2.0 * 12 * native_width * double(n) / seconds_since(start) / 1e9);
  }
  return best;
}

}  // namespace

Machine measure_machine(const std::vector<int>& threads) {
  Machine m;
  std::ifstream cpu("/proc/cpuinfo");
  for (std::string line; std::getline(cpu, line);)
    if (line.rfind("model name", 0) == 0) {
      m.name = line.substr(line.find(':') + 2);
      break;
    }
#if defined(__AVX512F__)
  m.instruction_set = "AVX-512";
#else
  m.instruction_set = "AVX2";
#endif
  for (const int t : threads) m.triad[t] = triad(t);
  m.peak = peak();
  return m;
}

}  // namespace fabrica
