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

}  // namespace

RatingPair rating_pair(const Signal& reference, const Signal& given, std::optional<double> t_min,
                       std::optional<double> t_max, Samples deviation) {
  check(reference);
  check(given);
  if (reference.unit.empty() || reference.x_unit.empty())
    throw SignalError("unit-missing", fmt::format("the reference '{}' has no unit", reference.name),
                      "Name it in the header of the column, as force_kN or force [kN], or by an "
                      "option; 1 for a number");
  const bool other_unit = !given.unit.empty() && given.unit != reference.unit;
  const bool other_x = !given.x_unit.empty() && given.x_unit != reference.x_unit;
  Signal converted;
  if (other_unit || other_x) converted = given;
  if (other_unit) converted = in_unit(std::move(converted), reference.unit);
  if (other_x) converted = in_x_unit(std::move(converted), reference.x_unit);
  const Signal& signal = other_unit || other_x ? converted : given;

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
  RatingPair pair;
  pair.step = step, pair.x_unit = reference.x_unit, pair.unit = reference.unit;
  pair.x = Samples(reference.x).subspan(first, last - first + 1);
  pair.reference = Samples(reference.y).subspan(first, pair.x.size());
  if (other_unit) pair.converted = std::move(converted.y);
  pair.signal = Samples(other_unit ? pair.converted : given.y).subspan(first, pair.x.size());
  if (!deviation.empty()) pair.deviation = deviation.subspan(first, pair.x.size());
  return pair;
}

CorridorWidths corridor_widths(const RatingPair& pair, double norm, double a_0, double b_0,
                               double a_sigma, double b_sigma) {
  const CorridorWidths w{a_0 * norm, b_0 * norm, a_sigma, b_sigma, pair.deviation};
  for (std::size_t i = 0; i < pair.reference.size(); ++i)
    if (!(w.inner(i) >= 0) || !(w.outer(i) > w.inner(i)))
      throw SignalError(
          "empty-corridor",
          fmt::format(
              "at {} {} the outer corridor, half width {}, does not enclose the inner one, {}",
              pair.x[i], pair.x_unit, w.outer(i), w.inner(i)),
          "Make b_0 (b_sigma) larger than a_0 (a_sigma)");
  return w;
}

double corridor_score(const RatingPair& pair, const CorridorWidths& w, double exponent) {
  double sum = 0;
  for (std::size_t i = 0; i < pair.reference.size(); ++i) {
    const double error = std::abs(pair.signal[i] - pair.reference[i]);
    const double inner = w.inner(i), outer = w.outer(i);
    if (error > outer) continue;
    sum += error < inner ? 1 : std::pow((outer - error) / (outer - inner), exponent);
  }
  return sum / double(pair.reference.size());
}

CorridorEdges corridor_edges(const RatingPair& pair, const CorridorWidths& w) {
  auto edge = [&](auto&& offset) {
    Signal s{"corridor",
             pair.unit,
             pair.x_unit,
             {pair.x.begin(), pair.x.end()},
             {pair.reference.begin(), pair.reference.end()}};
    for (std::size_t i = 0; i < s.size(); ++i) s.y[i] += offset(i);
    return s;
  };
  return {edge([&](std::size_t i) { return -w.outer(i); }),
          edge([&](std::size_t i) { return -w.inner(i); }),
          edge([&](std::size_t i) { return w.inner(i); }),
          edge([&](std::size_t i) { return w.outer(i); })};
}

double reference_norm(Samples reference) {
  double largest = 0;
  for (const double y : reference) largest = std::max(largest, std::abs(y));
  if (largest == 0)
    throw SignalError("flat-reference", "the reference is zero over the whole interval",
                      "Rate against a curve that moves, or choose another interval");
  return largest;
}

}  // namespace fabrica
