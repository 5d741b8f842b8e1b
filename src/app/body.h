#pragma once
// `fabrica body`: the human body as a deck.
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fabrica {

struct BodyCommand {
  std::string sex = "male", posture = "standing", resolution = "coarse", goals, out = "body.k",
              only = "skeleton", trial = "none", fracture = "count";
  int random = 0, draw = 0;
  double stature = 1750, mass = 77;
  std::vector<std::string> set, bones;
  bool pictures = false, list = false, quiet = false, no_joints = false;
};
void add_body(CLI::App& app, BodyCommand& command);
// 0 done, 1 bad input or a mesh that fails its gates
int body_command(const BodyCommand& command);

}  // namespace fabrica
