#include "result/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace fabrica {
namespace {

constexpr Rgb ink{40, 40, 44}, pale{226, 228, 232}, axis_color{120, 122, 128};

struct Frame {
  double left, right, top, bottom;  // pixels
  double x0, x1, y0, y1;            // values
  double px(double x) const { return left + (x - x0) / (x1 - x0) * (right - left); }
  double py(double y) const { return bottom - (y - y0) / (y1 - y0) * (bottom - top); }
};

std::pair<double, double> bounds(const std::vector<PlotCurve>& curves,
                                 std::vector<double> PlotCurve::*values) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const PlotCurve& c : curves)
    for (const double v : c.*values) {
      if (!std::isfinite(v)) continue;
      low = std::min(low, v);
      high = std::max(high, v);
    }
  if (low > high) throw std::runtime_error("the curves hold no numbers");
  if (low == high) {
    const double room = low == 0 ? 1 : 0.1 * std::abs(low);
    return {low - room, high + room};
  }
  return {low, high};
}

// of the n-th dashed curve: black, then lighter and lighter
Rgb dashed_color(int n) {
  const auto grey = static_cast<unsigned char>(30 + 55 * std::min(n, 3));
  return {grey, grey, grey};
}

// the parts of a curve inside the frame; gaps where it is not a number
void add_curve(Drawing& d, const Frame& f, const PlotCurve& c, const Rgb& color) {
  Stroke s{{}, {}, color, c.dashed ? 1.8 : 2.0, c.dashed};
  auto finish = [&] {
    if (s.x.size() > 1) d.strokes.push_back(s);
    s.x.clear();
    s.y.clear();
  };
  const std::size_t n = std::min(c.x.size(), c.y.size());
  for (std::size_t i = 0; i + 1 < n; ++i) {
    // Liang and Barsky: the piece from a to b of the segment lies in the frame
    const double p[2] = {c.x[i], c.y[i]}, q[2] = {c.x[i + 1], c.y[i + 1]};
    const double low[2] = {f.x0, f.y0}, high[2] = {f.x1, f.y1};
    double a = 0, b = 1;
    bool inside = std::isfinite(p[0] + p[1] + q[0] + q[1]);
    for (int k = 0; k < 2 && inside; ++k) {
      const double step = q[k] - p[k];
      if (step == 0) {
        inside = p[k] >= low[k] && p[k] <= high[k];
        continue;
      }
      const double t0 = (low[k] - p[k]) / step, t1 = (high[k] - p[k]) / step;
      a = std::max(a, std::min(t0, t1));
      b = std::min(b, std::max(t0, t1));
    }
    if (!inside || a > b) {
      finish();
      continue;
    }
    auto add = [&](double t) {
      s.x.push_back(f.px(p[0] + t * (q[0] - p[0])));
      s.y.push_back(f.py(p[1] + t * (q[1] - p[1])));
    };
    if (s.x.empty() || a > 0) {
      finish();
      add(a);
    }
    add(b);
    if (b < 1) finish();
  }
  finish();
}

// Ticks in units of 10^exponent, a multiple of three; 0 where the numbers are short as they are.
int exponent_of(const std::vector<double>& ticks) {
  const double most = std::max(std::abs(ticks.front()), std::abs(ticks.back()));
  if (most >= 1e-2 && most < 1e5) return 0;
  return 3 * int(std::floor(std::log10(most) / 3));
}

std::string number(double v, const std::vector<double>& ticks) {
  const double step = ticks[1] - ticks[0];
  return fmt::format("{:.6g}",
                     std::abs(v) < 1e-9 * step ? 0.0 : v / std::pow(10, exponent_of(ticks)));
}

void add_axes(Drawing& d, const Frame& f, const std::vector<double>& xs,
              const std::vector<double>& ys) {
  auto line = [&](double x0, double y0, double x1, double y1, const Rgb& c, double w) {
    d.strokes.push_back({{x0, x1}, {y0, y1}, c, w, false});
  };
  for (const double x : xs) {
    if (x < f.x0 - 1e-9 * (f.x1 - f.x0) || x > f.x1 + 1e-9 * (f.x1 - f.x0)) continue;
    line(f.px(x), f.top, f.px(x), f.bottom, pale, 1);
    d.labels.push_back({f.px(x), f.bottom + 18, number(x, xs), 14, ink, Anchor::middle});
  }
  for (const double y : ys) {
    if (y < f.y0 - 1e-9 * (f.y1 - f.y0) || y > f.y1 + 1e-9 * (f.y1 - f.y0)) continue;
    line(f.left, f.py(y), f.right, f.py(y), pale, 1);
    d.labels.push_back({f.left - 9, f.py(y), number(y, ys), 14, ink, Anchor::end});
  }
  if (const int e = exponent_of(xs))
    d.labels.push_back(
        {f.right, f.bottom + 38, fmt::format("x 1e{}", e), 13, axis_color, Anchor::end});
  if (const int e = exponent_of(ys))
    d.labels.push_back({f.left, f.top - 12, fmt::format("x 1e{}", e), 13, axis_color});
  if (f.y0 < 0 && f.y1 > 0) line(f.left, f.py(0), f.right, f.py(0), axis_color, 1);
  line(f.left, f.top, f.left, f.bottom, axis_color, 1.4);
  line(f.left, f.bottom, f.right, f.bottom, axis_color, 1.4);
}

// "glstat:kinetic_energy" -> "kinetic energy" where all curves are of one database
std::vector<std::string> legend_names(const std::vector<PlotCurve>& curves) {
  auto database = [](const PlotCurve& c) { return c.name.substr(0, c.name.find(':')); };
  bool one = true;
  for (const PlotCurve& c : curves) one = one && (c.dashed || database(c) == database(curves[0]));
  std::vector<std::string> out;
  for (const PlotCurve& c : curves) {
    std::string n = one && !c.dashed ? c.name.substr(c.name.find(':') + 1) : c.name;
    if (!c.dashed)
      for (char& ch : n) ch = ch == '_' ? ' ' : ch == ':' ? ' ' : ch;
    out.push_back(n);
  }
  return out;
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int count) {
  const double rough = (high - low) / count, power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double m : {5.0, 2.0, 1.0})
    if (m * power >= rough * 0.999) step = m * power;
  std::vector<double> out;
  for (double k = std::floor(low / step + 1e-9); k <= std::ceil(high / step - 1e-9); ++k)
    out.push_back(k * step);
  return out;
}

Drawing make_chart(const PlotOptions& o, const std::vector<PlotCurve>& curves) {
  if (o.width < 200 || o.height < 150 || o.width > 8000 || o.height > 8000)
    throw std::runtime_error("a chart is 200 to 8000 pixels wide and 150 to 8000 high");
  Drawing d;
  d.width = o.width;
  d.height = o.height;

  // y ends at round numbers, x where the curves end
  const auto [x0, x1] = o.x_range.value_or(bounds(curves, &PlotCurve::x));
  const auto [low, high] = o.y_range.value_or(bounds(curves, &PlotCurve::y));
  if (!(x1 > x0) || !(high > low)) throw std::runtime_error("the range of an axis must rise");
  const std::vector<double> xs = round_ticks(x0, x1, std::max(o.width / 130, 2)),
                            ys = round_ticks(low, high, std::max(o.height / 90, 2));
  const double y0 = o.y_range ? low : ys.front(), y1 = o.y_range ? high : ys.back();

  std::size_t widest = 1;
  for (const double y : ys) widest = std::max(widest, number(y, ys).size());
  const std::vector<std::string> names = legend_names(curves);
  const std::string y_label = !o.y_label.empty() ? o.y_label : curves.size() == 1 ? names[0] : "";
  const bool legend = curves.size() > 1;

  // legend above the frame, in as many columns as fit
  std::size_t longest = 1;
  for (const std::string& n : names) longest = std::max(longest, n.size());
  const double entry = 50 + 7.8 * double(longest),
               left = 30 + 8.5 * double(widest) + (y_label.empty() ? 0 : 26);
  const int columns = std::max(1, int((o.width - left - 20) / entry));
  const int rows = legend ? (int(names.size()) + columns - 1) / columns : 0;
  const double title = o.title.empty() ? 16 : 46;
  const Frame f{
      left, double(o.width) - 24, title + 24 * rows + 18, double(o.height) - 58, x0, x1, y0, y1};
  if (f.bottom - f.top < 40) throw std::runtime_error("too many curves for a chart of this height");

  add_axes(d, f, xs, ys);
  int dashed = 0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Rgb color = curves[i].dashed ? dashed_color(dashed++) : distinct_color(int(i));
    add_curve(d, f, curves[i], color);
    if (!legend) continue;
    const double x = left + entry * double(int(i) % columns),
                 y = title + 10 + 24 * double(int(i) / columns);
    d.strokes.push_back({{x, x + 26}, {y, y}, color, 3, curves[i].dashed});
    d.labels.push_back({x + 34, y, names[i], 14, ink});
  }
  if (!o.title.empty()) d.labels.push_back({left, 26, o.title, 18, ink});
  const std::string x_label = !o.x_label.empty() ? o.x_label : o.x.empty() ? "time" : o.x;
  d.labels.push_back(
      {(f.left + f.right) / 2, double(o.height) - 18, x_label, 15, ink, Anchor::middle});
  if (!y_label.empty())
    d.labels.push_back({20, (f.top + f.bottom) / 2, y_label, 15, ink, Anchor::middle, true});
  return d;
}

}  // namespace fabrica
