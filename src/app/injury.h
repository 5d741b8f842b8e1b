#pragma once
// `fabrica injury`: injury measures and risks from channels.
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fabrica {

struct InjuryCommand {
  std::vector<std::string> inputs, channels, units, settings, parts;
  std::string time_unit, json, strain = "logarithmic";
  bool list = false;
};
void add_injury(CLI::App& app, InjuryCommand& command);

// 0 done; 1 where a measure has its channels but cannot be computed from them. Other errors are
// thrown.
int injury_command(const InjuryCommand& command);

}  // namespace fabrica
