#pragma once
// What a case came to: kept as outcome.json beside its result, and shown on its page, in the index
// and in the table of ratings.
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/measure.h"

namespace fabrica::study {

// A signal of a case: its curve, what it is compared with, and the ratings.
struct SignalResult {
  std::string name, unit, x_name, x_unit, filter;
  Curve model, reference;
  Curve low, high;  // corridor that is drawn: of the reference file, or CORA's inner one
  Curve outer_low, outer_high;  // CORA's outer corridor, where rated
  std::string corridor_name;
  std::string provenance, reference_source;
  std::string remark;  // "no reference curve available", or why there is no rating
  double peak = 0, peak_at = 0;
  std::optional<double> reference_peak, reference_peak_at;
  // method -> parts in order, the total last: {"cora", {{"corridor", 0.9}, ..., {"total", 0.8}}}
  std::map<std::string, std::vector<std::pair<std::string, double>>> ratings;
  double rated_from = 0, rated_to = 0;  // interval of the ratings
  double weight = 1;                    // in the rating of all signals
  std::string paper;
  std::optional<double> paper_total;  // the published rating of this signal
};

enum class State { passed, failed, skipped };

struct Outcome {
  std::string name, title;
  State state = State::skipped;
  std::string reason;  // of a skipped or broken case
  std::string fingerprint, version, resolution, finished;
  double run_seconds = 0;
  nlohmann::ordered_json summary;  // of the run
  std::vector<SignalResult> signals;
  std::vector<CheckResult> checks;
  // CORA's weighted mean of the totals of all rated signals, where there are two or more
  std::optional<double> cora_of_all;
};

std::string state_name(State state);

// Without the curves: these stand on the page.
nlohmann::ordered_json to_json(const Outcome& outcome);
Outcome outcome_from(const nlohmann::ordered_json& json);

// Writes a file whole or not at all. Throws StudyError.
void write_file(const std::string& path, const std::string& text);
// The text of a file; empty where there is none.
std::string read_file(const std::string& path);

}  // namespace fabrica::study
