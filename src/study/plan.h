#pragma once
// A study: which deck, which parameters take which values, what is kept of every run.
// docs/manual/study.md describes every key of the plan.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "study/case_file.h"

namespace fabrica::study {

// One number of every run.
struct OutputSpec {
  CheckSpec measure;      // name, model, over, range, statistic
  std::string reference;  // file with one number per row, from elsewhere; or none
};

struct Plan {
  std::string file, title;
  Case base;                       // deck or body, end time, fixed parameters
  std::vector<std::string> names;  // of what varies: *PARAMETERs, "option.end_time", "body.<key>"
  std::vector<std::vector<std::string>> rows;  // their values, one list per run
  std::vector<OutputSpec> outputs;
};

// Reads a plan; file names in it are relative to its folder, {name} stands for what `paths` gives.
// Throws StudyError with file, line, key and remedy.
Plan read_plan(const std::string& file, const std::map<std::string, std::string>& paths);

}  // namespace fabrica::study
