// Time curves in double: piecewise linear between the points, constant outside.
#include <algorithm>

#include "model/model.h"

namespace fabrica {

double Curve::at(double t) const {
  if (x.empty()) return 0;
  if (t <= x.front()) return y.front();
  if (t >= x.back()) return y.back();
  const auto i = std::size_t(std::upper_bound(x.begin(), x.end(), t) - x.begin());
  const double s = (t - x[i - 1]) / (x[i] - x[i - 1]);
  return y[i - 1] + s * (y[i] - y[i - 1]);
}

double Curve::slope_integral(double a, double b) const {
  if (x.empty() || a == b) return 0;
  if (b < a) return -slope_integral(b, a);

  // trapezia between a, the points inside (a, b), and b
  auto i = std::size_t(std::upper_bound(x.begin(), x.end(), a) - x.begin());
  double sum = 0, t = a, value = at(a);
  for (; i < x.size() && x[i] < b; ++i) {
    sum += 0.5 * (x[i] - t) * (value + y[i]);
    t = x[i], value = y[i];
  }
  return sum + 0.5 * (b - t) * (value + at(b));
}

}  // namespace fabrica
