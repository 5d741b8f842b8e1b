#pragma once
// Curve of Catmull and Rom through values at equal steps: between value i and the next, with t from
// 0 to 1 and m(i) half the difference of the neighbours of i,
//   p = (2t^3 - 3t^2 + 1) p(i) + (t^3 - 2t^2 + t) m(i) + (3t^2 - 2t^3) p(i+1) + (t^3 - t^2) m(i+1).
// Beyond the ends the curve goes straight on. E. Catmull, R. Rom: A class of local interpolating
// splines, 1974.
namespace fabrica::body {

// value(k) for k from 0 to count - 1; count is at least 2
template <class F>
double catmull_rom(int count, int i, double t, F&& value) {
  const double b = value(i), c = value(i + 1);
  const double a = i > 0 ? value(i - 1) : 2 * b - c, d = i + 2 < count ? value(i + 2) : 2 * c - b;
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

}  // namespace fabrica::body
