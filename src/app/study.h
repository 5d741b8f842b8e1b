#pragma once
// `fabrica validate` and `fabrica study`.
#include <string>
#include <vector>

#include "study/campaign.h"
#include "study/validate.h"

namespace CLI {
class App;
}

namespace fabrica {

struct StudyCommands {
  study::ValidateOptions validate;
  std::vector<std::string> validate_paths;
  bool table = false;
  study::StudyOptions study;
  std::vector<std::string> study_paths;
};
void add_study(CLI::App& app, StudyCommands& commands);

}  // namespace fabrica
