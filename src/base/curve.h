#pragma once
// Piecewise linear curves, as kernels see them.
#include <cstddef>

#include "base/lane.h"

namespace fabrica {

// A view of n points (x ascending, n >= 1). Outside the points the curve is continued by its end
// segments (constitutive curves) or by its end values (time curves).
struct CurveView {
  const Real* x = nullptr;
  const Real* y = nullptr;
  int n = 0;
  bool extrapolate = true;

  FABRICA_FN explicit operator bool() const { return n > 0; }

  // value at a and, in slope, dy/dx there
  FABRICA_FN Real at(Real a, Real& slope) const {
    if (n == 1) return slope = 0, y[0];
    int lo = 0, hi = n - 1;
    while (hi - lo > 1) {
      const int mid = (lo + hi) / 2;
      if (x[mid] <= a)
        lo = mid;
      else
        hi = mid;
    }
    slope = (y[lo + 1] - y[lo]) / (x[lo + 1] - x[lo]);
    if (!extrapolate && (a < x[0] || a > x[n - 1])) return slope = 0, a < x[0] ? y[0] : y[n - 1];
    return y[lo] + slope * (a - x[lo]);
  }

  template <class L>
  FABRICA_FN L operator()(L a, L& slope) const {
    L r = L(0.0);
    for (int i = 0; i < LaneTraits<L>::width; ++i) {
      Real s = 0;
      const Real v = at(Real(get(a, i)), s);
      set(r, i, ScalarOf<L>(v));
      set(slope, i, ScalarOf<L>(s));
    }
    return r;
  }
  template <class L>
  FABRICA_FN L operator()(L a) const {
    L slope = L(0.0);
    return (*this)(a, slope);
  }
};

// A family of curves y(x; r) with r ascending; linear in r between neighbours, constant outside.
// If log_rate is set the r values are natural logarithms of rates.
struct TableView {
  const Real* rate = nullptr;
  const CurveView* curves = nullptr;
  int n = 0;
  bool log_rate = false;
  FABRICA_FN explicit operator bool() const { return n > 0; }
};

}  // namespace fabrica
