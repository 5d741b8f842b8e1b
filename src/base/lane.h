#pragma once
// A lane is the number type `L` that every kernel is written over: float or double (one element, as
// on a GPU thread) or Pack<Real, W> (W elements on a CPU core). This header gives the scalar lanes
// the same vocabulary that pack.h gives to packs: select, min, max, abs, fma, sqrt, any, all,
// clamp.
#include <cmath>
#include <cstdint>

#include "base/real.h"

namespace fabrica {

// Scalar type, mask type and integer type of a lane.
template <class L>
struct LaneTraits;

template <>
struct LaneTraits<float> {
  using Scalar = float;
  using Mask = bool;
  using Int = std::int32_t;
  static constexpr int width = 1;
};
template <>
struct LaneTraits<double> {
  using Scalar = double;
  using Mask = bool;
  using Int = std::int64_t;
  static constexpr int width = 1;
};

template <class L>
using ScalarOf = typename LaneTraits<L>::Scalar;
template <class L>
using MaskOf = typename LaneTraits<L>::Mask;

FABRICA_FN float select(bool m, float a, float b) { return m ? a : b; }
FABRICA_FN double select(bool m, double a, double b) { return m ? a : b; }
// min and max return the second argument when the comparison is false, as the x86 instructions do
FABRICA_FN float min(float a, float b) { return a < b ? a : b; }
FABRICA_FN double min(double a, double b) { return a < b ? a : b; }
FABRICA_FN float max(float a, float b) { return a > b ? a : b; }
FABRICA_FN double max(double a, double b) { return a > b ? a : b; }
FABRICA_FN float abs(float a) { return fabsf(a); }
FABRICA_FN double abs(double a) { return ::fabs(a); }
FABRICA_FN float fma(float a, float b, float c) { return fmaf(a, b, c); }
FABRICA_FN double fma(double a, double b, double c) { return ::fma(a, b, c); }
FABRICA_FN float sqrt(float a) { return sqrtf(a); }
FABRICA_FN double sqrt(double a) { return ::sqrt(a); }
FABRICA_FN bool any(bool m) { return m; }
FABRICA_FN bool all(bool m) { return m; }
FABRICA_FN float get(float a, int) { return a; }
FABRICA_FN double get(double a, int) { return a; }
FABRICA_FN void set(float& a, int, float v) { a = v; }
FABRICA_FN void set(double& a, int, double v) { a = v; }

template <class L>
FABRICA_FN L clamp(L x, L lo, L hi) {
  return min(max(x, lo), hi);
}

}  // namespace fabrica
