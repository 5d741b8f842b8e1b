#pragma once
// Sums that do not depend on order: contributions are rounded to 64-bit integers and added with
// integer atomics.
//   F_int = llrint(F * 2^s)
// s is chosen once from a force scale so that the range is about 4e6 times that scale and the
// resolution 1e-12 of it.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/tensor.h"

namespace fabrica {

struct FixedScale {
  double to_int = 1, to_real = 1;
  // scale: a typical large value (force or moment) of the model
  static FixedScale of(double scale) {
    int e = 0;
    std::frexp(scale > 0 && std::isfinite(scale) ? scale : 1.0, &e);
    return {std::ldexp(1.0, 40 - e), std::ldexp(1.0, e - 40)};
  }
};

// One vector sum per entry; add() may be called from any thread. Runs of entries that nothing was
// added to are known, so that who takes all sums passes them over.
class FixedVectors {
 public:
  static constexpr std::size_t run = 64;  // entries
  void resize(std::size_t n, FixedScale scale) {
    scale_ = scale;
    data_.assign(3 * n, 0);
    touched_.assign((n + run - 1) / run, 0);
  }
  std::size_t size() const { return data_.size() / 3; }
  void add(std::size_t i, const Vec3d& f) {
    const std::atomic_ref<std::uint8_t> touched(touched_[i / run]);
    if (!touched.load(std::memory_order_relaxed)) touched.store(1, std::memory_order_relaxed);
    for (int k = 0; k < 3; ++k) {
      const std::int64_t q = std::llrint(f[k] * scale_.to_int);
      if (q != 0)
        std::atomic_ref<std::int64_t>(data_[3 * i + k]).fetch_add(q, std::memory_order_relaxed);
    }
  }
  Vec3d get(std::size_t i) const {
    return {double(data_[3 * i]) * scale_.to_real, double(data_[3 * i + 1]) * scale_.to_real,
            double(data_[3 * i + 2]) * scale_.to_real};
  }
  // returns the sum and sets it to zero
  Vec3d take(std::size_t i) {
    const Vec3d f = get(i);
    data_[3 * i] = data_[3 * i + 1] = data_[3 * i + 2] = 0;
    return f;
  }
  // Hands out every sum of [first, last) that may not be zero, and sets them to zero; first is a
  // multiple of `run`.
  template <class Fn>
  void take_all(std::size_t first, std::size_t last, Fn fn) {
    for (std::size_t i = first; i < last; i += run) {
      if (!touched_[i / run]) continue;
      touched_[i / run] = 0;
      for (std::size_t k = i; k < std::min(last, i + run); ++k) fn(k, take(k));
    }
  }
  void clear() {
    std::fill(data_.begin(), data_.end(), 0);
    std::fill(touched_.begin(), touched_.end(), 0);
  }
  FixedScale scale() const { return scale_; }

 private:
  FixedScale scale_;
  std::vector<std::int64_t> data_;
  std::vector<std::uint8_t> touched_;  // of each run
};

// One scalar sum (an energy, a resultant); add() may be called from any thread.
class FixedSum {
 public:
  explicit FixedSum(FixedScale s = {}) : scale_(s) {}
  void add(double x) {
    value_.fetch_add(std::llrint(x * scale_.to_int), std::memory_order_relaxed);
  }
  double take() { return double(value_.exchange(0)) * scale_.to_real; }

 private:
  FixedScale scale_;
  std::atomic<std::int64_t> value_{0};
};

}  // namespace fabrica
