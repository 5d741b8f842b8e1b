// `fabrica rate`: one pair of curves, their ratings as a table, JSON and a chart.
#include <fmt/core.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "app/signals.h"
#include "result/plot.h"
#include "signal/channel_file.h"
#include "signal/cora.h"
#include "signal/filter.h"
#include "signal/iso18571.h"
#include "signal/units.h"

namespace fabrica {
namespace {

using nlohmann::ordered_json;

// CORA's own names of its parameters
CoraOptions cora_options(const RateCommand& c) {
  CoraOptions o;
  const std::map<std::string, double*> names{{"A_THRES", &o.a_threshold},
                                             {"B_THRES", &o.b_threshold},
                                             {"A_EVAL", &o.a_evaluation},
                                             {"B_DELTA_END", &o.b_delta_end},
                                             {"K", &o.k},
                                             {"G_1", &o.g_1},
                                             {"G_2", &o.g_2},
                                             {"a_0", &o.a_0},
                                             {"b_0", &o.b_0},
                                             {"a_sigma", &o.a_sigma},
                                             {"b_sigma", &o.b_sigma},
                                             {"D_MIN", &o.d_min},
                                             {"D_MAX", &o.d_max},
                                             {"INT_MIN", &o.int_min},
                                             {"K_V", &o.k_v},
                                             {"K_G", &o.k_g},
                                             {"K_P", &o.k_p},
                                             {"G_V", &o.g_v},
                                             {"G_G", &o.g_g},
                                             {"G_P", &o.g_p},
                                             {"MIN_NORM", &o.min_norm},
                                             {"GROUP_NORM", &o.group_norm}};
  for (const std::string& text : c.parameters) {
    const std::size_t equal = text.find('=');
    const std::string name = text.substr(0, equal);
    std::size_t used = 0;
    double value = 0;
    try {
      value = std::stod(text.substr(equal == std::string::npos ? 0 : equal + 1), &used);
    } catch (const std::exception&) {
    }
    const auto found = names.find(name);
    if (equal == std::string::npos || used + equal + 1 != text.size() ||
        (found == names.end() && name != "Y_NORM")) {
      std::string all = "Y_NORM";
      for (const auto& n : names) all += ", " + n.first;
      throw SignalError("unknown-parameter",
                        "'" + text + "' is not NAME=NUMBER of a CORA parameter",
                        "Known are: " + all);
    }
    if (found == names.end())
      o.y_norm = value;
    else
      *found->second = value;
  }
  o.t_min = c.t_min, o.t_max = c.t_max, o.edges = !c.plot.empty();
  return o;
}

// Both curves filtered and on one base where that is asked for.
void prepare(const RateCommand& c, Signal& reference, Signal& signal) {
  if (!c.unit.empty() && reference.unit.empty()) reference.unit = c.unit;
  if (!c.x_unit.empty() && reference.x_unit.empty()) reference.x_unit = c.x_unit;
  check(reference);
  check(signal);
  if (signal.x_unit.empty()) signal.x_unit = reference.x_unit;
  if (!reference.x_unit.empty() && signal.x_unit != reference.x_unit)
    signal = in_x_unit(signal, reference.x_unit);
  if (c.resample) {
    const double low = c.t_min.value_or(std::max(reference.x.front(), signal.x.front()));
    const double high = c.t_max.value_or(std::min(reference.x.back(), signal.x.back()));
    if (!(high > low))
      throw SignalError(
          "different-time-base",
          fmt::format("'{}' and '{}' have no common range of x", reference.name, signal.name),
          "Check their units and shift one of them");
    reference = resampled(reference, low, high, *c.resample);
    signal = resampled(signal, low, high, *c.resample);
  }
  if (c.filter)
    reference = cfc_filtered(reference, *c.filter), signal = cfc_filtered(signal, *c.filter);
}

ordered_json report(const CoraRating& r, const std::string& x_unit, const std::string& unit) {
  return {{"total", r.total},
          {"word", cora_word(r.total)},
          {"corridor", r.corridor},
          {"correlation", r.correlation},
          {"progression", r.progression},
          {"size", r.size},
          {"phase", r.phase},
          {"shift", r.shift},
          {"largest_k", r.largest_k},
          {"t_min", r.t_min},
          {"t_max", r.t_max},
          {"y_norm", r.y_norm},
          {"x_unit", x_unit},
          {"unit", unit}};
}
ordered_json report(const Iso18571Rating& r, const std::string& x_unit, const std::string& unit) {
  return {{"total", r.total},
          {"word", iso18571_word(r.total)},
          {"corridor", r.corridor},
          {"phase", r.phase},
          {"magnitude", r.magnitude},
          {"slope", r.slope},
          {"shift", r.shift},
          {"largest_correlation", r.largest_correlation},
          {"magnitude_error", r.magnitude_error},
          {"slope_error", r.slope_error},
          {"t_min", r.t_min},
          {"t_max", r.t_max},
          {"norm", r.norm},
          {"x_unit", x_unit},
          {"unit", unit}};
}

// A page that is touched for the first time costs more than what is done with it here: memory that
// is freed stays for the next curve, and comes in large pieces.
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_TOP_PAD, 1 << 25);
#endif
}

// low edge forward and high edge back: one closed outline
PlotCurve outline(const std::string& name, const Signal& low, const Signal& high) {
  PlotCurve c{name, low.x, low.y, true};
  c.x.insert(c.x.end(), high.x.rbegin(), high.x.rend());
  c.y.insert(c.y.end(), high.y.rbegin(), high.y.rend());
  return c;
}

template <class Rating>
std::vector<PlotCurve> corridors(const Rating& r) {
  return {outline("inner corridor", r.edges.inner_low, r.edges.inner_high),
          outline("outer corridor", r.edges.outer_low, r.edges.outer_high)};
}

void draw(const RateCommand& c, const Signal& reference, const Signal& signal,
          std::vector<PlotCurve> corridor, const std::string& title) {
  std::vector<PlotCurve> curves{{"reference " + reference.name, reference.x, reference.y},
                                {"signal " + signal.name, signal.x, signal.y}};
  curves.insert(curves.end(), corridor.begin(), corridor.end());
  if (!signal.unit.empty() && signal.unit != reference.unit)
    curves[1].y = in_unit(signal, reference.unit).y;
  PlotOptions o;
  o.output = c.plot, o.title = title;
  o.x_label = reference.x_unit == "s" || reference.x_unit == "ms"
                  ? fmt::format("time [{}]", reference.x_unit)
                  : fmt::format("x [{}]", reference.x_unit);
  o.y_label = fmt::format("{} [{}]", reference.name, reference.unit);
  draw_curves(o, curves);
}

}  // namespace

int rate_command(const RateCommand& c) {
  keep_freed_memory();
  Signal reference = read_signal(c.reference), signal = read_signal(c.signal);
  prepare(c, reference, signal);
  ordered_json json{{"reference", c.reference}, {"signal", c.signal}, {"version", FABRICA_VERSION}};
  std::vector<PlotCurve> corridor;
  std::string title;
  if (c.method != "iso18571") {
    std::vector<double> deviation;
    if (!c.deviation.empty()) {
      Signal d = read_signal(c.deviation);
      if (c.resample) d = resampled(d, reference.x.front(), reference.x.back(), *c.resample);
      deviation = d.y;
    }
    const CoraRating r = cora(reference, signal, cora_options(c), deviation);
    json["cora"] = report(r, reference.x_unit, reference.unit);
    fmt::print("CORA 3.6, {:.6g} to {:.6g} {}\n", r.t_min, r.t_max, reference.x_unit);
    fmt::print("  corridor        {:.3f}\n  progression     {:.3f}\n  size            {:.3f}\n",
               r.corridor, r.progression, r.size);
    fmt::print("  phase           {:.3f}   shift {:.4g} {}\n  correlation     {:.3f}\n", r.phase,
               r.shift, reference.x_unit, r.correlation);
    fmt::print("  total           {:.3f}   {}\n", r.total, cora_word(r.total));
    if (!c.plot.empty()) corridor = corridors(r);
    title = fmt::format("CORA {:.3f} {}", r.total, cora_word(r.total));
  }
  if (c.method != "cora") {
    Iso18571Options o;
    o.t_min = c.t_min, o.t_max = c.t_max, o.edges = !c.plot.empty();
    if (!c.full_sampling &&
        (reference.x_unit == "s" || reference.x_unit == "ms" || reference.x_unit == "us"))
      o.least_step = 1e-4 / unit_factor(reference.x_unit, "s");
    const Iso18571Rating r = iso18571(reference, signal, o);
    json["iso18571"] = report(r, reference.x_unit, reference.unit);
    fmt::print("ISO/TS 18571, {:.6g} to {:.6g} {}\n", r.t_min, r.t_max, reference.x_unit);
    fmt::print("  corridor Z      {:.3f}\n  phase EP        {:.3f}   shift {:.4g} {}\n", r.corridor,
               r.phase, r.shift, reference.x_unit);
    fmt::print("  magnitude EM    {:.3f}\n  slope ES        {:.3f}\n", r.magnitude, r.slope);
    fmt::print("  total R         {:.3f}   {}\n", r.total, iso18571_word(r.total));
    if (!c.plot.empty() && corridor.empty()) corridor = corridors(r);
    title += fmt::format("{}ISO 18571 {:.3f} {}", title.empty() ? "" : ", ", r.total,
                         iso18571_word(r.total));
  }
  if (!c.json.empty()) {
    std::ofstream out(c.json);
    out << json.dump(2) << '\n';
    if (!out) throw SignalError("cannot-write", "cannot write " + c.json, "Check the folder");
  }
  if (!c.plot.empty()) draw(c, reference, signal, corridor, title);
  return 0;
}

}  // namespace fabrica
