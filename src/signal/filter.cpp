// Coefficients after SAE J211-1:
//   w_d = 2 pi 2.0775 CFC,  w_a = tan(w_d T / 2)
//   a0 = w_a^2 / q,  a1 = 2 a0,  a2 = a0,  q = 1 + sqrt(2) w_a + w_a^2
//   b1 = -2 (w_a^2 - 1) / q,  b2 = (-1 + sqrt(2) w_a - w_a^2) / q
#include "signal/filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "signal/units.h"

namespace fabrica {
namespace {

using std::numbers::pi;
constexpr std::array<double, 4> classes{60, 180, 600, 1000};
constexpr double samples_per_class = 10;  // SAE J211-1: at least 10 CFC samples a second

// one pass over the record, in place; starts as if the first value had always been there
void pass(std::vector<double>& y, const FilterCoefficients& c) {
  double x1 = y[0], x2 = y[0], y1 = y[0], y2 = y[0];
  for (double& v : y) {
    const double x = v;
    v = c.a0 * x + c.a1 * x1 + c.a2 * x2 + c.b1 * y1 + c.b2 * y2;
    x2 = x1, x1 = x, y2 = y1, y1 = v;
  }
}

// The record continued at both ends by its point mirror image: value and slope go on without a
// jump.
std::vector<double> padded(const std::vector<double>& y, std::size_t count) {
  std::vector<double> out(y.size() + 2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    out[count - 1 - i] = 2 * y.front() - y[i + 1];
    out[count + y.size() + i] = 2 * y.back() - y[y.size() - 2 - i];
  }
  std::copy(y.begin(), y.end(), out.begin() + std::ptrdiff_t(count));
  return out;
}

}  // namespace

FilterCoefficients cfc_coefficients(double cfc, double interval) {
  if (std::find(classes.begin(), classes.end(), cfc) == classes.end())
    throw SignalError("unknown-filter-class", fmt::format("channel frequency class {}", cfc),
                      "Use 60, 180, 600 or 1000");
  if (!(interval > 0) || interval * samples_per_class * cfc > 1 + 1e-6)
    throw SignalError("sampling-too-slow",
                      fmt::format("CFC {} needs {:.0f} samples a second, the signal has {:.6g}",
                                  cfc, samples_per_class * cfc, 1 / interval),
                      "Sample faster, or take a lower class");
  const double w_a = std::tan(2 * pi * 2.0775 * cfc * interval / 2), root = std::sqrt(2.0) * w_a;
  const double q = 1 + root + w_a * w_a, a0 = w_a * w_a / q;
  return {a0, 2 * a0, a0, -2 * (w_a * w_a - 1) / q, (-1 + root - w_a * w_a) / q};
}

double cfc_gain(const FilterCoefficients& c, double frequency, double interval) {
  const std::complex<double> z =
      std::polar(1.0, -2 * pi * frequency * interval);  // one sample's delay
  return std::norm((c.a0 + c.a1 * z + c.a2 * z * z) / (1.0 - c.b1 * z - c.b2 * z * z));
}

Signal cfc_filtered(const Signal& signal, double cfc) {
  const double interval = sample_interval(signal) * unit_factor(signal.x_unit, "s");
  const FilterCoefficients c = cfc_coefficients(cfc, interval);
  // long enough for the start of a pass to die away, as far as the record can be mirrored
  const double settling = 2 / (cfc * interval);
  const std::size_t count =
      std::min(signal.size() - 1, std::max<std::size_t>(100, std::size_t(settling)));
  std::vector<double> y = padded(signal.y, count);
  pass(y, c);
  std::reverse(y.begin(), y.end());
  pass(y, c);
  std::reverse(y.begin(), y.end());
  Signal out = signal;
  std::copy_n(y.begin() + std::ptrdiff_t(count), out.size(), out.y.begin());
  return out;
}

const std::vector<std::string>& cfc_names() {
  static const std::vector<std::string> names{"CFC60", "CFC180", "CFC600", "CFC1000"};
  return names;
}

double cfc_of(const std::string& name) { return std::stod(name.substr(3)); }

}  // namespace fabrica
