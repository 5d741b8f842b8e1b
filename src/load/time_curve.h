#pragma once
// Piecewise linear functions of time in double precision, constant outside their points:
//   value f(t), and the exact integral of f over [a, b].
#include <algorithm>
#include <span>

namespace fabrica {

// Value at t; x ascending, x and y of equal length >= 1.
inline double curve_value(std::span<const double> x, std::span<const double> y, double t) {
  if (t <= x.front()) return y.front();
  if (t >= x.back()) return y.back();
  const auto i = std::size_t(std::upper_bound(x.begin(), x.end(), t) - x.begin());
  return y[i - 1] + (y[i] - y[i - 1]) / (x[i] - x[i - 1]) * (t - x[i - 1]);
}

// Integral over [a, b], a <= b.
inline double curve_integral(std::span<const double> x, std::span<const double> y, double a,
                             double b) {
  auto i = std::size_t(std::upper_bound(x.begin(), x.end(), a) - x.begin());
  double sum = 0, from = a, value = curve_value(x, y, a);
  for (; i < x.size() && x[i] < b; ++i) {
    sum += 0.5 * (value + y[i]) * (x[i] - from);
    from = x[i], value = y[i];
  }
  return sum + 0.5 * (value + curve_value(x, y, b)) * (b - from);
}

// Whether something is alive in the step [t, t + dt]; times that differ by rounding count as equal.
inline bool alive(double birth, double death, double t, double dt) {
  const double slack = 1e-6 * dt;
  return t >= birth - slack && t < death - slack;
}

}  // namespace fabrica
