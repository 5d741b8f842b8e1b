#include "app/signals.h"

#include <CLI/CLI.hpp>

namespace fabrica {
namespace {

void add_rate(CLI::App& app, RateCommand& c) {
  auto* rate =
      app.add_subcommand("rate", "Rate a curve against its reference by CORA 3.6 and ISO/TS 18571");
  rate->add_option("--reference", c.reference,
                   "measured curve: file.csv:column, file.csv:x:y, test.mme:code")
      ->required();
  rate->add_option("--signal", c.signal, "computed curve, named the same way")->required();
  rate->add_option("--method", c.method, "cora, iso18571 or both")
      ->check(CLI::IsMember({"cora", "iso18571", "both"}))
      ->capture_default_str();
  rate->add_option("--t-min", c.t_min,
                   "start of the evaluation interval, in the reference's unit of time");
  rate->add_option("--t-max", c.t_max, "its end");
  rate->add_option("--resample", c.resample,
                   "read both curves at this step, in the reference's unit of time");
  rate->add_option("--filter", c.filter,
                   "channel frequency class for both curves: 60, 180, 600 or 1000");
  rate->add_option("--unit", c.unit, "unit of a reference that names none; 1 for a number");
  rate->add_option("--x-unit", c.x_unit, "unit of its time or abscissa");
  rate->add_option("--deviation", c.deviation,
                   "standard deviation of the references, a curve like them (a_sigma, b_sigma)");
  rate->add_option("--set", c.parameters, "CORA parameter NAME=VALUE, such as A_EVAL=0.05")
      ->delimiter(',');
  rate->add_flag("--full-sampling", c.full_sampling, "ISO 18571 without thinning to 0.1 ms");
  rate->add_option("--json", c.json, "write all figures here");
  rate->add_option("--plot", c.plot, "draw curves and corridors (.png or .svg)");
  rate->callback([&c] { throw CLI::RuntimeError(rate_command(c)); });
}

void add_filter(CLI::App& app, FilterCommand& c) {
  auto* filter =
      app.add_subcommand("filter", "Filter, resample, integrate, combine and average curves");
  filter
      ->add_option("inputs", c.inputs,
                   "curves: file.csv:column, file.csv:x:y@column=value, test.mme:code")
      ->required();
  filter->add_option("--cfc", c.cfc, "SAE J211 channel frequency class: 60, 180, 600 or 1000");
  filter->add_option("--resample", c.resample, "constant step, in the unit of x");
  filter->add_option("--from", c.crop_from, "drop what lies before");
  filter->add_option("--to", c.crop_to, "drop what lies after");
  filter->add_option("--offset", c.offset, "add to the values");
  filter->add_option("--shift", c.shift, "add to x");
  filter->add_option("--zero-until", c.zero_until, "subtract the mean of what lies before");
  filter->add_option("--scale", c.scale, "multiply the values");
  filter->add_flag("--integrate", c.integrate, "integral over x from zero");
  filter->add_flag("--differentiate", c.differentiate, "derivative by x");
  filter->add_flag("--resultant", c.resultant, "root of the sum of squares of all inputs");
  filter->add_option("--corridor", c.corridor, "mean (time histories) or arc-length (loops)")
      ->check(CLI::IsMember({"mean", "arc-length"}));
  filter->add_option("--deviations", c.deviations, "standard deviations from mean to edge")
      ->capture_default_str();
  filter->add_option("--unit", c.unit,
                     "convert the values to this unit, or declare it where none is named");
  filter->add_option("--x-unit", c.x_unit, "the same for x");
  filter->add_option("--out", c.out, "table.csv, or a folder for an ISO-MME test")->required();
  filter->add_option("--plot", c.plot, "draw the result (.png or .svg)");
  filter->callback([&c] { throw CLI::RuntimeError(filter_command(c)); });
}

}  // namespace

void add_signals(CLI::App& app, SignalCommands& commands) {
  add_rate(app, commands.rate);
  add_filter(app, commands.filter);
}

}  // namespace fabrica
