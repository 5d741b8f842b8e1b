#pragma once
// `fabrica joints`: how far the joints of a body came apart in a run.
#include <string>

namespace CLI {
class App;
}

namespace fabrica {

struct JointsCommand {
  std::string result, joints, csv;
  int rows = 10;
};
void add_joints(CLI::App& app, JointsCommand& command);

}  // namespace fabrica
