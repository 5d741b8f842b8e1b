#include "injury/head.h"

#include <algorithm>
#include <cmath>

#include "signal/units.h"

namespace fabrica {
namespace {

using Vector = std::array<double, 3>;

Vector along(const Vector& a, double s, const Vector& b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

// d'' = alpha - K (d + tau d'), tau = C/K
Vector acceleration(const Vector& alpha, const Vector& d, const Vector& v) {
  constexpr double xx = 32142, yy = 23493, zz = 16935, xy = 0, yz = 0, xz = 1636.3;  // [N/m]
  constexpr double tau = 5.9148e-3;                                                  // [s]
  const Vector e = along(d, tau, v);
  return {alpha[0] - ((xx + xy + xz) * e[0] - xy * e[1] - xz * e[2]),
          alpha[1] - (-xy * e[0] + (xy + yy + yz) * e[1] - yz * e[2]),
          alpha[2] - (-xz * e[0] - yz * e[1] + (xz + yz + zz) * e[2])};
}

// one step of the classical Runge-Kutta method; alpha goes linearly from a to b
void step(Vector& d, Vector& v, const Vector& a, const Vector& b, double h) {
  const Vector middle = along(along({0, 0, 0}, 0.5, a), 0.5, b);
  const Vector k1 = acceleration(a, d, v), v2 = along(v, h / 2, k1);
  const Vector k2 = acceleration(middle, along(d, h / 2, v), v2), v3 = along(v, h / 2, k2);
  const Vector k3 = acceleration(middle, along(d, h / 2, v2), v3), v4 = along(v, h, k3);
  const Vector k4 = acceleration(b, along(d, h, v3), v4);
  for (int i = 0; i < 3; ++i) {
    d[i] += h / 6 * (v[i] + 2 * v2[i] + 2 * v3[i] + v4[i]);
    v[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
}

}  // namespace

Hic hic(const Signal& given, double window) {
  const Signal s = in_x_unit(in_unit(given, "g"), "s");
  const double interval = sample_interval(s);
  std::vector<double> integral(s.size(), 0.0);
  for (std::size_t i = 1; i < s.size(); ++i)
    integral[i] = integral[i - 1] + 0.5 * interval * (s.y[i] + s.y[i - 1]);
  const std::size_t most =
      std::max<std::size_t>(1, std::size_t(window / interval * (1 + 1e-9) + 1e-6));
  Hic best;
  for (std::size_t i = 0; i < s.size(); ++i)
    for (std::size_t j = i + 1; j < s.size() && j <= i + most; ++j) {
      const double duration = double(j - i) * interval,
                   mean = (integral[j] - integral[i]) / duration;
      const double value = mean > 0 ? duration * mean * mean * std::sqrt(mean) : 0;
      if (value > best.value) best = {value, s.x[i], s.x[j]};
    }
  return best;
}

namespace {

// where a straight line from a to b, one of them below `level`, passes it: the part of the step
// that is not below
double part_above(double a, double b, double level) {
  return std::abs(std::max(a, b) - level) / std::abs(b - a);
}

// Time in steps for which the polygon through y is at or above `level`: the longest stay, or all.
double time_above(const std::vector<double>& y, double level, bool cumulative) {
  double longest = 0, now = 0, all = 0;
  for (std::size_t i = 1; i < y.size(); ++i) {
    const bool was = y[i - 1] >= level, is = y[i] >= level;
    const double part = was && is ? 1 : was || is ? part_above(y[i - 1], y[i], level) : 0;
    now = was ? now + part : part;
    all += part;
    longest = std::max(longest, now);
  }
  return cumulative ? all : longest;
}

}  // namespace

double clip(const Signal& given, double duration, Clip kind) {
  const Signal s = in_x_unit(given, "s");
  const double steps = duration / sample_interval(s) * (1 - 1e-9);
  if (steps > double(s.size() - 1))
    throw SignalError("record-too-short",
                      "'" + s.name + "' is shorter than the duration of the clip",
                      "Give the whole record");
  // the time falls as the level rises: halve what is left until nothing is
  const auto [least, largest] = std::minmax_element(s.y.begin(), s.y.end());
  double low = *least, high = *largest;
  for (int i = 0; i < 60 && high > low; ++i) {
    const double middle = low + 0.5 * (high - low);
    (time_above(s.y, middle, kind == Clip::cumulative) >= steps ? low : high) = middle;
  }
  return time_above(s.y, high, kind == Clip::cumulative) >= steps ? high : low;
}

double bric(const std::array<Signal, 3>& angular_velocity) {
  constexpr Vector critical{66.25, 56.45, 42.87};  // [rad/s]
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const Signal w = in_unit(angular_velocity[i], "rad/s");
    double largest = 0;
    for (const double y : w.y) largest = std::max(largest, std::abs(y));
    sum += largest / critical[i] * largest / critical[i];
  }
  return std::sqrt(sum);
}

double damage(const std::array<Signal, 3>& angular_acceleration) {
  constexpr double factor = 2.9903;         // [1/m]
  constexpr double longest_step = 0.25e-3;  // [s], a hundredth of the shortest period of the system
  std::array<Signal, 3> a;
  for (int i = 0; i < 3; ++i) a[i] = in_x_unit(in_unit(angular_acceleration[i], "rad/s2"), "s");
  if (!same_base(a[0], a[1]) || !same_base(a[0], a[2]))
    throw SignalError("different-time-base",
                      "the angular accelerations are not sampled at the same times",
                      "Resample them to one step");
  const double interval = sample_interval(a[0]);
  const int parts = std::max(1, int(std::ceil(interval / longest_step)));
  Vector d{}, v{};
  double largest = 0;
  for (std::size_t i = 0; i + 1 < a[0].size(); ++i) {
    const Vector start{a[0].y[i], a[1].y[i], a[2].y[i]};
    const Vector rise{a[0].y[i + 1] - start[0], a[1].y[i + 1] - start[1], a[2].y[i + 1] - start[2]};
    for (int k = 0; k < parts; ++k) {
      step(d, v, along(start, double(k) / parts, rise), along(start, double(k + 1) / parts, rise),
           interval / parts);
      largest = std::max(largest, std::hypot(d[0], d[1], d[2]));
    }
  }
  return factor * largest;
}

}  // namespace fabrica
