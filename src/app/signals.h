#pragma once
// `fabrica rate` and `fabrica filter`: what is done with curves.
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fabrica {

struct RateCommand {
  std::string reference, signal, deviation, method = "both", json, plot;
  std::string unit, x_unit;  // of a reference that does not name them
  std::optional<double> t_min, t_max, resample, filter;
  std::vector<std::string> parameters;  // CORA: NAME=VALUE
  bool full_sampling = false;
};

struct FilterCommand {
  std::vector<std::string> inputs;
  std::string out, name, unit, x_unit, corridor, plot;
  std::optional<double> cfc, resample, crop_from, crop_to, offset, shift, zero_until, scale;
  double deviations = 1;
  bool integrate = false, differentiate = false, resultant = false;
};

struct SignalCommands {
  RateCommand rate;
  FilterCommand filter;
};
void add_signals(CLI::App& app, SignalCommands& commands);

// each: 0 done; errors are thrown
int rate_command(const RateCommand& command);
int filter_command(const FilterCommand& command);

}  // namespace fabrica
