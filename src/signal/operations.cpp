#include "signal/operations.h"

#include <fmt/format.h>

#include <cmath>

#include "signal/units.h"

namespace fabrica {
namespace {

// each is the rate of change of the one before it
const std::vector<std::vector<const char*>> chains{
    {"m", "m/s", "m/s2"}, {"rad", "rad/s", "rad/s2"}, {"deg", "deg/s", "deg/s2"}, {"N s", "N"}};

struct UnitAndFactor {
  std::string unit;
  double factor = 1;
};

// The unit of a derivative (order 1) or integral (order -1) of y over x, and the factor to it from
// unit(y)/unit(x).
UnitAndFactor changed_unit(const Signal& s, int order) {
  if (!known_unit(s.unit) || !known_unit(s.x_unit)) return {};
  for (const auto& chain : chains)
    for (int i = 0; i < int(chain.size()); ++i) {
      const int j = i + order;
      if (j < 0 || j >= int(chain.size())) continue;
      try {
        const double y = unit_factor(s.unit, chain[i]), x = unit_factor(s.x_unit, "s");
        return {chain[j], order > 0 ? y / x : y * x};
      } catch (const SignalError&) {  // another quantity
      }
    }
  return {};
}

}  // namespace

Signal cropped(const Signal& s, std::optional<double> low, std::optional<double> high) {
  check(s);
  Signal out{s.name, s.unit, s.x_unit, {}, {}};
  const double margin = 1e-9 * (s.x.back() - s.x.front());
  for (std::size_t i = 0; i < s.size(); ++i) {
    if ((low && s.x[i] < *low - margin) || (high && s.x[i] > *high + margin)) continue;
    out.x.push_back(s.x[i]);
    out.y.push_back(s.y[i]);
  }
  if (out.size() < 2)
    throw SignalError(
        "empty-signal",
        fmt::format("'{}' has {} samples in the interval; it is known from {} to {} {}", s.name,
                    out.size(), s.x.front(), s.x.back(), s.x_unit),
        "Choose an interval inside the record");
  return out;
}

Signal offset(Signal s, double value) {
  for (double& y : s.y) y += value;
  return s;
}

Signal shifted(Signal s, double value) {
  for (double& x : s.x) x += value;
  return s;
}

Signal zeroed(const Signal& s, double until) {
  const Signal before = cropped(s, {}, until);
  double mean = 0;
  for (const double y : before.y) mean += y / double(before.size());
  return offset(s, -mean);
}

Signal integrated(const Signal& s, double start) {
  check(s);
  const UnitAndFactor to = changed_unit(s, -1);
  Signal out{s.name, to.unit, s.x_unit, s.x, s.y};
  double sum = 0;
  out.y[0] = start;
  for (std::size_t i = 1; i < s.size(); ++i) {
    sum += 0.5 * (s.y[i] + s.y[i - 1]) * (s.x[i] - s.x[i - 1]);
    out.y[i] = start + to.factor * sum;
  }
  return out;
}

Signal differentiated(const Signal& s) {
  check(s);
  if (s.size() < 3)
    throw SignalError("empty-signal", "'" + s.name + "' has two samples",
                      "A derivative needs three");
  const UnitAndFactor to = changed_unit(s, 1);
  Signal out{s.name, to.unit, s.x_unit, s.x, s.y};
  const std::size_t n = s.size();
  // slope at `at` of the parabola through samples m - 1, m, m + 1
  auto slope = [&](std::size_t m, double at) {
    const double h = s.x[m] - s.x[m - 1], k = s.x[m + 1] - s.x[m];
    const double before = (s.y[m] - s.y[m - 1]) / h, after = (s.y[m + 1] - s.y[m]) / k;
    const double curvature = (after - before) / (h + k);
    return before + curvature * (2 * at - s.x[m - 1] - s.x[m]);
  };
  for (std::size_t i = 0; i < n; ++i)
    out.y[i] = to.factor * slope(i == 0 ? 1 : i + 1 == n ? n - 2 : i, s.x[i]);
  return out;
}

Signal resultant(const std::vector<Signal>& components) {
  if (components.empty())
    throw SignalError("empty-signal", "no components", "Give one to three channels");
  Signal out = components[0];
  check(out);
  for (double& y : out.y) y *= y;
  for (std::size_t c = 1; c < components.size(); ++c) {
    const Signal& s = components[c];
    check(s);
    if (!same_base(components[0], s))
      throw SignalError("different-time-base",
                        fmt::format("'{}' and '{}' differ in x", components[0].name, s.name),
                        "Resample them to one step");
    const double factor = s.unit == out.unit ? 1 : unit_factor(s.unit, out.unit);
    for (std::size_t i = 0; i < out.size(); ++i) out.y[i] += factor * s.y[i] * factor * s.y[i];
  }
  for (double& y : out.y) y = std::sqrt(y);
  out.name = "resultant of " + components[0].name;
  return out;
}

}  // namespace fabrica
