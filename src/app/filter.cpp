// `fabrica filter`: operations on curves, in a fixed order: units, resample, shift, zero, offset
// and scale, CFC, resultant, derivative, integral, crop, corridor.
#include "signal/filter.h"

#include <fmt/core.h>

#include <filesystem>

#include "app/signals.h"
#include "result/plot.h"
#include "signal/channel_file.h"
#include "signal/corridor.h"
#include "signal/iso_mme.h"
#include "signal/operations.h"
#include "signal/units.h"

namespace fabrica {
namespace {

std::vector<Signal> read_inputs(const FilterCommand& c) {
  std::vector<Signal> out;
  for (const std::string& input : c.inputs) {
    const bool whole =
        std::filesystem::is_directory(input) || std::filesystem::path(input).extension() == ".mme";
    for (Signal& s : whole ? read_all_signals(input) : std::vector{read_signal(input)})
      out.push_back(std::move(s));
  }
  for (Signal& s : out) {
    if (!c.unit.empty()) s = s.unit.empty() ? (s.unit = c.unit, s) : in_unit(s, c.unit);
    if (!c.x_unit.empty()) s = s.x_unit.empty() ? (s.x_unit = c.x_unit, s) : in_x_unit(s, c.x_unit);
  }
  return out;
}

Signal treated(const FilterCommand& c, Signal s) {
  if (c.resample) s = resampled(s, *c.resample);
  if (c.shift) s = shifted(s, *c.shift);
  if (c.zero_until) s = zeroed(s, *c.zero_until);
  if (c.offset) s = offset(s, *c.offset);
  if (c.scale)
    for (double& y : s.y) y *= *c.scale;
  if (c.cfc) s = cfc_filtered(s, *c.cfc);
  return s;
}

Signal finished(const FilterCommand& c, Signal s) {
  if (c.differentiate) s = differentiated(s);
  if (c.integrate) s = integrated(s);
  if (c.crop_from || c.crop_to) s = cropped(s, c.crop_from, c.crop_to);
  return s;
}

// the corridor as a table: x of each edge differs in arc-length averages, so they are columns over
// a running number
std::vector<Signal> corridor_table(const FilterCommand& c, const std::vector<Signal>& curves) {
  if (c.corridor == "mean") {
    const Corridor k = mean_corridor(curves, c.deviations);
    Signal sd = k.mean;
    sd.name = "sd", sd.y = k.deviation_y;
    return {k.mean, k.low, k.high, sd};
  }
  const Corridor k = arc_length_corridor(curves, c.deviations);
  std::vector<Signal> out;
  std::vector<double> length;
  for (std::size_t i = 0; i < k.mean.size(); ++i)
    length.push_back(double(i) / double(k.mean.size() - 1));
  for (const auto& [name, s] : {std::pair("mean", &k.mean), {"low", &k.low}, {"high", &k.high}}) {
    out.push_back({std::string(name) + "_x", s->x_unit, "1", length, s->x});
    out.push_back({std::string(name) + "_y", s->unit, "1", length, s->y});
  }
  return out;
}

void draw(const FilterCommand& c, const std::vector<Signal>& inputs,
          const std::vector<Signal>& result) {
  PlotOptions o;
  o.output = c.plot;
  std::vector<PlotCurve> curves;
  const auto add_inputs = [&] {
    for (std::size_t i = 0; i < inputs.size(); ++i)
      curves.push_back(
          {i < c.inputs.size() ? c.inputs[i] : inputs[i].name, inputs[i].x, inputs[i].y});
  };
  o.x_label = fmt::format("time [{}]", result[0].x_unit);
  if (c.corridor == "arc-length") {
    add_inputs();
    for (std::size_t i = 0; i + 1 < result.size(); i += 2)
      curves.push_back(
          {result[i].name.substr(0, result[i].name.find('_')), result[i].y, result[i + 1].y, true});
    o.x_label = fmt::format("x [{}]", inputs[0].x_unit);
  } else if (c.corridor == "mean") {
    add_inputs();
    for (std::size_t i = 0; i < 3; ++i)  // without the deviation
      curves.push_back({i == 0 ? "mean" : result[i].name, result[i].x, result[i].y, true});
  } else {
    for (const Signal& s : result) curves.push_back({s.name, s.x, s.y});
  }
  o.y_label = fmt::format("[{}]", inputs[0].unit);
  draw_curves(o, curves);
}

}  // namespace

int filter_command(const FilterCommand& c) {
  std::vector<Signal> curves = read_inputs(c);
  if (c.corridor != "arc-length")  // loops are not functions of x
    for (Signal& s : curves) s = treated(c, s);
  else if (c.cfc || c.resample)
    throw SignalError("not-a-time-history", "loops over x cannot be filtered or resampled",
                      "Filter their histories first");
  if (c.resultant) curves = {resultant(curves)};
  if (c.corridor != "arc-length")
    for (Signal& s : curves) s = finished(c, s);
  const std::vector<Signal> result = c.corridor.empty() ? curves : corridor_table(c, curves);
  if (std::filesystem::path(c.out).extension() == ".csv")
    write_csv(c.out, result);
  else
    write_mme_test(c.out, std::filesystem::path(c.out).filename().string(), result);
  if (!c.plot.empty()) draw(c, curves, result);
  fmt::print("{}: {} curves of {} samples\n", c.out, result.size(), result[0].size());
  return 0;
}

}  // namespace fabrica
