#include "signal/corridor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "signal/units.h"

namespace fabrica {
namespace {

void need_two(const std::vector<Signal>& curves) {
  if (curves.size() < 2)
    throw SignalError("too-few-curves", fmt::format("{} curves for a corridor", curves.size()),
                      "A spread needs at least two");
}

// all in the units of the first
std::vector<Signal> alike(std::vector<Signal> curves) {
  for (Signal& c : curves) {
    if (c.unit != curves[0].unit) c = in_unit(c, curves[0].unit);
    if (c.x_unit != curves[0].x_unit) c = in_x_unit(c, curves[0].x_unit);
  }
  return curves;
}

struct MeanAndDeviation {
  double mean = 0, deviation = 0;
};
MeanAndDeviation statistics(const std::vector<double>& values) {
  MeanAndDeviation m;
  for (const double v : values) m.mean += v / double(values.size());
  for (const double v : values)
    m.deviation += (v - m.mean) * (v - m.mean) / double(values.size() - 1);
  m.deviation = std::sqrt(m.deviation);
  return m;
}

double extent(const std::vector<double>& v) {
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  return *high - *low;
}

// The curve at `points` equal parts of its length, measured in x / scale_x and y / scale_y.
Signal by_length(const Signal& c, double scale_x, double scale_y, int points) {
  std::vector<double> length(c.size(), 0.0);
  for (std::size_t i = 1; i < c.size(); ++i)
    length[i] = length[i - 1] +
                std::hypot((c.x[i] - c.x[i - 1]) / scale_x, (c.y[i] - c.y[i - 1]) / scale_y);
  Signal out{c.name, c.unit, c.x_unit, {}, {}};
  std::size_t at = 1;
  for (int k = 0; k < points; ++k) {
    const double s = length.back() * double(k) / double(points - 1);
    while (at + 1 < c.size() && length[at] < s) ++at;
    const double piece = length[at] - length[at - 1];
    const double part = piece > 0 ? std::clamp((s - length[at - 1]) / piece, 0.0, 1.0) : 0;
    out.x.push_back(c.x[at - 1] + part * (c.x[at] - c.x[at - 1]));
    out.y.push_back(c.y[at - 1] + part * (c.y[at] - c.y[at - 1]));
  }
  return out;
}

void check_loop(const Signal& c) {
  if (c.x.size() != c.y.size() || c.size() < 2)
    throw SignalError("empty-signal", fmt::format("'{}' has {} samples", c.name, c.size()),
                      "A curve needs at least two");
  for (std::size_t i = 0; i < c.size(); ++i)
    if (!std::isfinite(c.x[i]) || !std::isfinite(c.y[i]))
      throw SignalError("not-a-number",
                        fmt::format("'{}', sample {}, is not a number", c.name, i + 1),
                        "Remove the sample");
}

// Moves every point of the mean to that point of its ellipse, half axes k times the deviations,
// whose outward normal is the mean's normal, on one side (sign).
Signal envelope(const Corridor& c, double deviations, double sign, double scale_x, double scale_y) {
  Signal edge = c.mean;
  const std::size_t n = edge.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1, b = i + 1 == n ? i : i + 1;
    const double tx = (c.mean.x[b] - c.mean.x[a]) / scale_x,
                 ty = (c.mean.y[b] - c.mean.y[a]) / scale_y;
    const double sx = deviations * c.deviation_x[i] / scale_x,
                 sy = deviations * c.deviation_y[i] / scale_y;
    const double support = std::hypot(sx * ty, sy * tx);  // normal (-ty, tx)
    if (support == 0) continue;
    edge.x[i] -= sign * scale_x * sx * sx * ty / support;
    edge.y[i] += sign * scale_y * sy * sy * tx / support;
  }
  return edge;
}

}  // namespace

Corridor mean_corridor(const std::vector<Signal>& given, double deviations) {
  need_two(given);
  for (const Signal& c : given) check(c);
  const std::vector<Signal> curves = alike(given);
  double low = -INFINITY, high = INFINITY;
  for (const Signal& c : curves)
    low = std::max(low, c.x.front()), high = std::min(high, c.x.back());
  Corridor out;
  out.mean = {"mean", curves[0].unit, curves[0].x_unit, {}, {}};
  out.low = out.high = out.mean;
  std::vector<double> values(curves.size());
  for (const double x : curves[0].x) {
    if (x < low || x > high) continue;
    for (std::size_t c = 0; c < curves.size(); ++c) values[c] = value_at(curves[c], x);
    const MeanAndDeviation m = statistics(values);
    out.mean.x.push_back(x), out.mean.y.push_back(m.mean);
    out.deviation_x.push_back(0), out.deviation_y.push_back(m.deviation);
    out.low.y.push_back(m.mean - deviations * m.deviation);
    out.high.y.push_back(m.mean + deviations * m.deviation);
  }
  if (out.mean.size() < 2)
    throw SignalError("interval-not-covered", "the curves have no common range of x",
                      "Shift or crop them");
  out.low.x = out.high.x = out.mean.x;
  out.low.name = "low", out.high.name = "high";
  return out;
}

Corridor arc_length_corridor(const std::vector<Signal>& given, double deviations, int points) {
  need_two(given);
  for (const Signal& c : given) check_loop(c);
  const std::vector<Signal> curves = alike(given);
  double scale_x = 0, scale_y = 0;
  for (const Signal& c : curves)
    scale_x += extent(c.x) / double(curves.size()), scale_y += extent(c.y) / double(curves.size());
  if (!(scale_x > 0) || !(scale_y > 0) || points < 3)
    throw SignalError("flat-reference", "the curves do not move in x or in y",
                      "Give curves with an extent");
  std::vector<Signal> even;
  for (const Signal& c : curves) even.push_back(by_length(c, scale_x, scale_y, points));

  Corridor out;
  out.mean = {"mean", curves[0].unit, curves[0].x_unit, {}, {}};
  std::vector<double> xs(curves.size()), ys(curves.size());
  for (int k = 0; k < points; ++k) {
    for (std::size_t c = 0; c < even.size(); ++c) xs[c] = even[c].x[k], ys[c] = even[c].y[k];
    const MeanAndDeviation x = statistics(xs), y = statistics(ys);
    out.mean.x.push_back(x.mean), out.mean.y.push_back(y.mean);
    out.deviation_x.push_back(x.deviation), out.deviation_y.push_back(y.deviation);
  }
  out.low = envelope(out, deviations, -1, scale_x, scale_y);
  out.high = envelope(out, deviations, 1, scale_x, scale_y);
  out.low.name = "low", out.high.name = "high";
  return out;
}

}  // namespace fabrica
