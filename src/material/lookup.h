#pragma once
// Curves and tables for constitutive laws: values and slopes for a whole lane without a branch on
// the data.
#include "base/curve.h"
#include "base/lane_math.h"

namespace fabrica {

// Value of a piecewise linear curve at a and, in slope, dy/dx there; the end segments are continued
// unless the curve says otherwise. Short curves are scanned by all lanes together, which beats a
// search per lane.
template <class L>
FABRICA_FN L lookup(const CurveView& curve, const L& a, L& slope) {
  if (curve.n > 64) return curve(a, slope);
  if (curve.n == 1) return slope = L(0.0), L(curve.y[0]);
  auto rise = [&](int i) { return (curve.y[i + 1] - curve.y[i]) / (curve.x[i + 1] - curve.x[i]); };
  L x0 = L(curve.x[0]), y0 = L(curve.y[0]);
  slope = L(rise(0));
  for (int i = 1; i < curve.n - 1; ++i) {
    const auto beyond = a >= L(curve.x[i]);
    x0 = select(beyond, L(curve.x[i]), x0);
    y0 = select(beyond, L(curve.y[i]), y0);
    slope = select(beyond, L(rise(i)), slope);
  }
  L y = fma(slope, a - x0, y0);
  if (!curve.extrapolate) {
    const L first = L(curve.x[0]), last = L(curve.x[curve.n - 1]);
    y = select(a < first, L(curve.y[0]), select(a > last, L(curve.y[curve.n - 1]), y));
    slope = select((a < first) | (a > last), L(0.0), slope);
  }
  return y;
}

// Value of a curve at a >= 0, the slope there and, in area, the integral from 0; the first point
// stands at 0 (a curve that starts later is read as if it began with its first segment). All lanes
// scan together.
template <class L>
FABRICA_FN L lookup_with_area(const CurveView& curve, const L& a, L& slope, L& area) {
  if (curve.n == 1) return slope = L(0.0), area = L(curve.y[0]) * a, L(curve.y[0]);
  auto rise = [&](int i) { return (curve.y[i + 1] - curve.y[i]) / (curve.x[i + 1] - curve.x[i]); };
  L x0 = L(curve.x[0]), y0 = L(curve.y[0]), below = L(0.0);
  slope = L(rise(0));
  Real sum = 0;
  for (int i = 1; i < curve.n - 1; ++i) {
    sum += Real(0.5) * (curve.y[i] + curve.y[i - 1]) * (curve.x[i] - curve.x[i - 1]);
    const auto beyond = a >= L(curve.x[i]);
    x0 = select(beyond, L(curve.x[i]), x0);
    y0 = select(beyond, L(curve.y[i]), y0);
    slope = select(beyond, L(rise(i)), slope);
    below = select(beyond, L(sum), below);
  }
  const L run = a - x0, y = fma(slope, run, y0);
  area = fma(L(0.5) * run, y + y0, below);
  return y;
}

// Value of a table at abscissa a and rate r: linear in the rate (or its logarithm), constant
// outside.
template <class L>
FABRICA_FN L lookup(const TableView& table, const L& a, const L& rate, L& slope) {
  const L r = table.log_rate ? log(max(rate, L(1e-30))) : rate;
  L y = lookup(table.curves[0], a, slope);
  for (int i = 1; i < table.n; ++i) {
    const L r0 = L(table.rate[i - 1]), r1 = L(table.rate[i]);
    const L w = clamp((r - r0) / (r1 - r0), L(0.0), L(1.0));
    L next_slope = L(0.0);
    const L next = lookup(table.curves[i], a, next_slope);
    // below r0 the weight is 0 and the value stays
    y = fma(w, next - y, y);
    slope = fma(w, next_slope - slope, slope);
  }
  return y;
}

}  // namespace fabrica
