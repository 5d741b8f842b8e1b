#include "study/rate_curve.h"

#include <algorithm>

#include "signal/cora.h"
#include "signal/filter.h"
#include "signal/iso18571.h"

namespace fabrica::study {
namespace {

Signal signal_of(const Curve& c, const std::string& name, const std::string& unit,
                 const std::string& x_unit) {
  return {name, unit, x_unit, c.x, c.y};
}

// the smallest step of a curve
double step_of(const Curve& c) {
  double step = c.x.back() - c.x.front();
  for (std::size_t i = 1; i < c.x.size(); ++i)
    if (c.x[i] > c.x[i - 1]) step = std::min(step, c.x[i] - c.x[i - 1]);
  return step;
}

Curve curve_of(const Signal& s) { return {s.x, s.y}; }

// the parts of a rating with its corridors, which both methods name alike
template <class Rated>
Rating result(std::vector<std::pair<std::string, double>> parts, double low, double high,
              const Rated& c) {
  return {std::move(parts),
          low,
          high,
          curve_of(c.edges.inner_low),
          curve_of(c.edges.inner_high),
          curve_of(c.edges.outer_low),
          curve_of(c.edges.outer_high)};
}

}  // namespace

Rating rate_curve(const std::string& method, const Curve& reference, const Curve& model,
                  const RatedUnits& units,
                  const std::optional<std::pair<double, double>>& interval) {
  const double low = interval ? interval->first : std::max(reference.x.front(), model.x.front());
  const double high = interval ? interval->second : std::min(reference.x.back(), model.x.back());
  if (!(low < high))
    throw SignalError("bad-interval", "signal and reference have no time in common",
                      "Compare their time units");
  // one base for both, as fine as the finer curve but no more than needed: a run may sample
  // millions of times
  const double step =
      std::max(std::min(step_of(reference), step_of(model)), (high - low) / most_rated_samples);
  const auto prepared = [&](const Curve& c, const char* name) {
    return resampled(signal_of(c, name, units.unit, units.time_unit), low, high, step);
  };
  const Signal r = prepared(reference, "reference"), m = prepared(model, "model");
  if (method == "cora") {
    CoraOptions options;
    options.t_min = low, options.t_max = r.x.back();
    const CoraRating c = cora(r, m, options);
    return result({{"corridor", c.corridor},
                   {"cross-correlation", c.progression},
                   {"size", c.size},
                   {"phase", c.phase},
                   {"correlation", c.correlation},
                   {"total", c.total}},
                  low, high, c);
  }
  const Iso18571Rating c = iso18571(r, m);
  return result({{"corridor", c.corridor},
                 {"phase", c.phase},
                 {"magnitude", c.magnitude},
                 {"slope", c.slope},
                 {"total", c.total}},
                low, high, c);
}

std::string rating_word(const std::string& method, double total) {
  return method == "cora" ? cora_word(total) : iso18571_word(total);
}

std::vector<double> filtered(const std::string& filter, const Curve& curve,
                             const std::string& time_unit) {
  const Signal s = signal_of(curve, "model", "", time_unit);
  // histories come at the multiples of an interval that the steps reach: nearly, not quite,
  // constant
  const double step = (curve.x.back() - curve.x.front()) / double(curve.x.size() - 1);
  const Signal even = resampled(s, curve.x.front(), curve.x.back(), step);
  const Signal smooth = cfc_filtered(even, cfc_of(filter));
  std::vector<double> out;
  for (const double x : curve.x) out.push_back(value_at(smooth, x));
  return out;
}

}  // namespace fabrica::study
