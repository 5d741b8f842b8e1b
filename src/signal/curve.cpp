#include "signal/curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fabrica {
namespace {

constexpr double step_tolerance = 1e-3;  // of a step: times are often printed with few digits

}  // namespace

std::string listed(std::vector<std::string> names, const std::string& wanted) {
  constexpr std::size_t most = 24;
  const std::size_t colon = wanted.find(':');
  const std::string id = colon == std::string::npos ? "" : wanted.substr(colon);
  if (!id.empty())
    std::stable_partition(names.begin(), names.end(),
                          [&](const std::string& n) { return n.ends_with(id); });
  std::string out;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) out += (i ? ", " : "") + names[i];
  if (names.size() > most) out += fmt::format(" and {} more", names.size() - most);
  return out;
}

void check(const Signal& s) {
  if (s.x.size() != s.y.size())
    throw SignalError(
        "ragged-signal",
        fmt::format("'{}' has {} times and {} values", s.name, s.x.size(), s.y.size()),
        "Give one value for each time");
  if (s.x.size() < 2)
    throw SignalError("empty-signal", fmt::format("'{}' has {} samples", s.name, s.x.size()),
                      "A curve needs at least two");
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i]))
      throw SignalError(
          "not-a-number",
          fmt::format("'{}', sample {} of {}, is not a number", s.name, i + 1, s.size()),
          "Remove the sample, or crop the signal to where it is known");
    if (i > 0 && s.x[i] <= s.x[i - 1])
      throw SignalError(
          "time-not-ascending",
          fmt::format("'{}', sample {}: {} follows {}", s.name, i + 1, s.x[i], s.x[i - 1]),
          "Sort the samples and remove repeated ones");
  }
}

double sample_interval(const Signal& s) {
  check(s);
  const double step = (s.x.back() - s.x.front()) / double(s.size() - 1);
  // every sample must lie on the grid: that also bounds the sum of rounding
  for (std::size_t i = 0; i < s.size(); ++i)
    if (std::abs(s.x[i] - s.x.front() - double(i) * step) >
        std::max(step_tolerance, 1e-6 * double(i)) * step)
      throw SignalError(
          "not-uniform",
          fmt::format("'{}' is not sampled at a constant step near {}", s.name, s.x[i]),
          "Resample it (fabrica filter --resample STEP, fabrica rate --resample STEP)");
  return step;
}

bool same_base(const Signal& a, const Signal& b) {
  if (a.size() != b.size() || a.size() < 2) return false;
  const double step = (a.x.back() - a.x.front()) / double(a.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(std::abs(a.x[i] - b.x[i]) <= step_tolerance * step)) return false;
  return true;
}

double value_at(const Signal& s, double x) {
  if (x <= s.x.front()) return s.y.front();
  if (x >= s.x.back()) return s.y.back();
  const std::size_t i = std::size_t(std::upper_bound(s.x.begin(), s.x.end(), x) - s.x.begin());
  const double part = (x - s.x[i - 1]) / (s.x[i] - s.x[i - 1]);
  return s.y[i - 1] + part * (s.y[i] - s.y[i - 1]);
}

Signal resampled(const Signal& s, double low, double high, double step) {
  check(s);
  if (!(step > 0) || !(high > low))
    throw SignalError("bad-interval",
                      fmt::format("cannot sample from {} to {} by {}", low, high, step),
                      "The step must be positive and the end after the start");
  const double early = 0.5 * (s.x[1] - s.x[0]), late = 0.5 * (s.x.back() - s.x[s.size() - 2]);
  if (low < s.x.front() - early || high > s.x.back() + late)
    throw SignalError("interval-not-covered",
                      fmt::format("'{}' is known from {} to {} {}, not from {} to {}", s.name,
                                  s.x.front(), s.x.back(), s.x_unit, low, high),
                      "Shorten the interval, or give the signal that covers it");
  Signal out{s.name, s.unit, s.x_unit, {}, {}};
  const std::size_t n = std::size_t(std::floor((high - low) / step * (1 + 1e-12) + 1e-6)) + 1;
  if (n < 2)
    throw SignalError("bad-interval",
                      fmt::format("a step of {} {} is longer than '{}', known from {} to {}", step,
                                  s.x_unit, s.name, low, high),
                      "Give the step in the unit of the record");
  out.x.resize(n), out.y.resize(n);
  std::size_t at = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = out.x[i] = low + double(i) * step;
    while (at + 1 < s.size() && s.x[at] < x) ++at;
    const double part = std::clamp((x - s.x[at - 1]) / (s.x[at] - s.x[at - 1]), 0.0, 1.0);
    out.y[i] = s.y[at - 1] + part * (s.y[at] - s.y[at - 1]);
  }
  return out;
}

Signal resampled(const Signal& s, double step) {
  check(s);
  return resampled(s, s.x.front(), s.x.back(), step);
}

}  // namespace fabrica
