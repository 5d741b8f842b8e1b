#pragma once
// `fabrica validate` and `fabrica study`.
#include <string>
#include <vector>

#include "study/validate.h"

namespace CLI {
class App;
}

namespace fabrica {

struct StudyCommands {
  study::ValidateOptions validate;
  std::vector<std::string> validate_paths;
  bool table = false;
};
void add_study(CLI::App& app, StudyCommands& commands);

}  // namespace fabrica
