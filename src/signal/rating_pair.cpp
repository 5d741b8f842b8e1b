#include "signal/rating_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "signal/units.h"

namespace fabrica {
namespace {

// samples [first, last] of a uniform base that lie in [low, high], to a thousandth of a step
std::pair<std::size_t, std::size_t> samples_within(const Signal& s, double step, double low,
                                                   double high) {
  const double first = std::ceil((low - s.x.front()) / step - 1e-3);
  const double last = std::floor((high - s.x.front()) / step + 1e-3);
  if (first < 0 || last > double(s.size() - 1) || last < first + 1)
    throw SignalError("bad-interval",
                      fmt::format("the interval {} to {} is not within the reference's {} to {} {}",
                                  low, high, s.x.front(), s.x.back(), s.x_unit),
                      "Choose t_min and t_max inside the record");
  return {std::size_t(first), std::size_t(last)};
}

std::vector<double> slice(const std::vector<double>& v, std::size_t first, std::size_t last) {
  return {v.begin() + std::ptrdiff_t(first), v.begin() + std::ptrdiff_t(last) + 1};
}

}  // namespace

RatingPair rating_pair(const Signal& reference, const Signal& given, std::optional<double> t_min,
                       std::optional<double> t_max, const std::vector<double>& deviation) {
  check(reference);
  check(given);
  if (reference.unit.empty() || reference.x_unit.empty())
    throw SignalError("unit-missing", fmt::format("the reference '{}' has no unit", reference.name),
                      "Name it in the header of the column, as force_kN or force [kN], or by an "
                      "option; 1 for a number");
  Signal signal = given;
  if (signal.unit.empty()) signal.unit = reference.unit;
  if (signal.x_unit.empty()) signal.x_unit = reference.x_unit;
  if (signal.unit != reference.unit) signal = in_unit(std::move(signal), reference.unit);
  if (signal.x_unit != reference.x_unit) signal = in_x_unit(std::move(signal), reference.x_unit);

  const double step = sample_interval(reference);
  if (!same_base(reference, signal))
    throw SignalError(
        "different-time-base",
        fmt::format(
            "the reference '{}' has {} samples from {} to {}, the signal '{}' has {} from {} "
            "to {} {}",
            reference.name, reference.size(), reference.x.front(), reference.x.back(), signal.name,
            signal.size(), signal.x.front(), signal.x.back(), reference.x_unit),
        "Resample both to one step and interval (fabrica rate --resample STEP)");
  if (!deviation.empty() && deviation.size() != reference.size())
    throw SignalError("ragged-signal",
                      fmt::format("{} deviations for {} samples of '{}'", deviation.size(),
                                  reference.size(), reference.name),
                      "Give one for each sample");
  const auto [first, last] = samples_within(reference, step, t_min.value_or(reference.x.front()),
                                            t_max.value_or(reference.x.back()));
  RatingPair pair{slice(reference.x, first, last),
                  slice(reference.y, first, last),
                  slice(signal.y, first, last),
                  {},
                  step,
                  reference.x_unit,
                  reference.unit};
  if (!deviation.empty()) pair.deviation = slice(deviation, first, last);
  return pair;
}

CorridorWidths corridor_widths(const RatingPair& pair, double norm, double a_0, double b_0,
                               double a_sigma, double b_sigma) {
  const std::size_t n = pair.reference.size();
  CorridorWidths w{std::vector<double>(n, a_0 * norm), std::vector<double>(n, b_0 * norm)};
  for (std::size_t i = 0; i < pair.deviation.size(); ++i) {
    w.inner[i] += a_sigma * pair.deviation[i];
    w.outer[i] += b_sigma * pair.deviation[i];
  }
  for (std::size_t i = 0; i < n; ++i)
    if (!(w.inner[i] >= 0) || !(w.outer[i] > w.inner[i]))
      throw SignalError(
          "empty-corridor",
          fmt::format(
              "at {} {} the outer corridor, half width {}, does not enclose the inner one, {}",
              pair.x[i], pair.x_unit, w.outer[i], w.inner[i]),
          "Make b_0 (b_sigma) larger than a_0 (a_sigma)");
  return w;
}

double corridor_score(const RatingPair& pair, const CorridorWidths& w, double exponent) {
  double sum = 0;
  for (std::size_t i = 0; i < pair.reference.size(); ++i) {
    const double error = std::abs(pair.signal[i] - pair.reference[i]);
    if (error > w.outer[i]) continue;
    sum += error < w.inner[i]
               ? 1
               : std::pow((w.outer[i] - error) / (w.outer[i] - w.inner[i]), exponent);
  }
  return sum / double(pair.reference.size());
}

Signal corridor_edge(const RatingPair& pair, const std::vector<double>& width, double sign) {
  Signal edge{"corridor", pair.unit, pair.x_unit, pair.x, pair.reference};
  for (std::size_t i = 0; i < edge.size(); ++i) edge.y[i] += sign * width[i];
  return edge;
}

double reference_norm(const std::vector<double>& reference) {
  double largest = 0;
  for (const double y : reference) largest = std::max(largest, std::abs(y));
  if (largest == 0)
    throw SignalError("flat-reference", "the reference is zero over the whole interval",
                      "Rate against a curve that moves, or choose another interval");
  return largest;
}

}  // namespace fabrica
