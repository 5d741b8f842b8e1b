#include "study/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "signal/filter.h"
#include "study/error.h"
#include "study/rate_curve.h"
#include "study/toml_fields.h"

namespace fabrica::study {
namespace {

std::string bound_of(const CheckSpec& c) {
  if (c.expected) {
    if (c.tolerance == 0) return fmt::format("{:.6g}", *c.expected);
    if (*c.expected == 0) return fmt::format("0 within {:.3g}", c.tolerance);
    return fmt::format("{:.6g} within {:.3g} %", *c.expected, 100 * c.tolerance);
  }
  if (c.least && c.most) return fmt::format("{:.6g} to {:.6g}", *c.least, *c.most);
  return c.least ? fmt::format("at least {:.6g}", *c.least)
                 : fmt::format("at most {:.6g}", *c.most);
}

bool holds(const CheckSpec& c, double value) {
  if (!std::isfinite(value)) return false;
  if (c.expected) {
    const double scale = *c.expected == 0 ? 1 : std::abs(*c.expected);
    return std::abs(value - *c.expected) <= c.tolerance * scale;
  }
  return (!c.least || value >= *c.least) && (!c.most || value <= *c.most);
}

// The energy of a check, sampled as its load.
std::vector<double> energy_beside(const CheckSpec& c, Channels& channels) {
  const auto [x, y] = samples(c.energy, c.range ? c.over : "", "", c.window, channels);
  return c.range ? within(*c.range, x, y) : y;
}

}  // namespace

double mean_over(const std::vector<double>& x, const std::vector<double>& y, double low,
                 double high) {
  double work = 0, way = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (std::min(x[i - 1], x[i]) < low || std::max(x[i - 1], x[i]) > high) continue;
    work += 0.5 * (y[i - 1] + y[i]) * (x[i] - x[i - 1]);
    way += x[i] - x[i - 1];
  }
  if (way == 0)
    throw StudyError(
        fmt::format("the run never passes from {} to {}. Correct the range", low, high));
  return work / way;
}

std::vector<double> within(const std::pair<double, double>& range, const std::vector<double>& x,
                           const std::vector<double>& y) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i] >= range.first && x[i] <= range.second) kept.push_back(y[i]);
  if (kept.empty())
    throw StudyError(fmt::format("the run has no sample from {} to {}. Correct the range",
                                 range.first, range.second));
  return kept;
}

Curve samples(const std::string& model, const std::string& over, const std::string& filter,
              const std::optional<std::pair<double, double>>& window, Channels& channels) {
  std::vector<double> y = channels.column(model);
  std::vector<double> x = over.empty() ? channels.abscissa(model) : channels.column(over);
  if (x.size() != y.size())
    throw StudyError("'" + model + "' and '" + over + "' are not sampled at the same times. " +
                     "Give both databases one interval");
  for (const double v : y)
    if (!std::isfinite(v))
      throw StudyError("'" + model + "' holds a value that is not a number. Look at the run");
  if (!filter.empty())
    y = filtered(filter, {channels.abscissa(model), std::move(y)}, channels.time_unit());
  if (window) {
    const std::vector<double> times = channels.abscissa(model);
    x = within(*window, times, x), y = within(*window, times, y);
  }
  return {std::move(x), std::move(y)};
}

double first_reaching(const std::vector<double>& x, const std::vector<double>& y, double level) {
  for (std::size_t i = 0; i < y.size() && i < x.size(); ++i) {
    const double now = std::abs(y[i]);
    if (now < level) continue;
    if (i == 0) return x[0];
    const double before = std::abs(y[i - 1]);
    return x[i - 1] + (level - before) / (now - before) * (x[i] - x[i - 1]);
  }
  throw StudyError(
      fmt::format("the curve never reaches {:g}, from which it counts. Correct start_at", level));
}

const std::vector<std::string>& statistic_names() {
  static const std::vector<std::string> names{"mean", "last",      "max",    "min",
                                              "peak", "magnitude", "failure"};
  return names;
}

std::string read_filter(Fields& f) {
  const std::string filter = f.text("filter", "");
  if (!filter.empty()) f.one_of("filter", filter, cfc_names());
  return filter;
}

std::string read_time_unit(Fields& f) {
  const std::string unit = f.text("time_unit", "ms");
  f.one_of("time_unit", unit, {"ms", "s"});
  return unit;
}

void read_statistic(Fields& f, CheckSpec& c) {
  c.filter = read_filter(f);
  c.over = f.text("over", "");
  c.window = f.interval("window");
  c.range = f.interval("range");
  c.statistic = f.text("statistic", "last");
  f.one_of("statistic", c.statistic, statistic_names());
  c.energy = f.text("energy", "");
  if (c.energy.empty() == (c.statistic == "failure"))
    f.fail("energy", c.energy.empty() ? "is missing" : "is given without the statistic failure",
           "failure takes the column of the energy stored in the part that breaks, as "
           "matsum:internal_energy:PART");
}

double failure_load(const std::vector<double>& load, const std::vector<double>& energy) {
  if (load.size() != energy.size())
    throw StudyError(
        "load and energy of failure are not sampled at the same times. "
        "Give both databases one interval");
  const double overall = energy.empty() ? 0 : *std::max_element(energy.begin(), energy.end());
  double largest = 0, stored = 0, up_to_now = 0;
  for (std::size_t i = 0; i < load.size(); ++i) {
    if (stored >= 0.25 * overall && energy[i] < 0.98 * stored) return largest;
    up_to_now = std::max(up_to_now, std::abs(load[i]));
    if (energy[i] >= stored) stored = energy[i], largest = up_to_now;
  }
  return up_to_now;
}

double statistic(const CheckSpec& c, Channels& channels) {
  const bool mean = c.statistic == "mean";
  auto [x, y] = samples(c.model, mean || c.range ? c.over : "", c.filter, c.window, channels);
  if (mean) {
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    return c.range ? mean_over(x, y, c.range->first, c.range->second)
                   : mean_over(x, y, *low, *high);
  }
  if (c.range) y = within(*c.range, x, y);
  if (c.statistic == "failure") return failure_load(y, energy_beside(c, channels));
  if (c.statistic == "last") return y.back();
  if (c.statistic == "max") return *std::max_element(y.begin(), y.end());
  if (c.statistic == "min") return *std::min_element(y.begin(), y.end());
  const double peak = *std::max_element(
      y.begin(), y.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return c.statistic == "peak" ? peak : std::abs(peak);
}

CheckResult evaluate(const CheckSpec& c, Channels& channels,
                     const std::function<double(const std::string&)>& named) {
  CheckResult r;
  r.name = c.name;
  r.bound = bound_of(c);
  try {
    const bool single = c.model.starts_with("rating:") || c.model.starts_with("fit:");
    r.value = single ? named(c.model) : statistic(c, channels);
    r.computed = true;
    r.passed = holds(c, r.value);
  } catch (const std::exception& e) {
    r.problem = e.what();
  }
  return r;
}

}  // namespace fabrica::study
