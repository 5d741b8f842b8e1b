#pragma once
// What a study writes: study.csv, and index.html with scatter plots.
#include <string>
#include <vector>

#include "study/plan.h"

namespace fabrica::study {

struct StudyRow {
  std::size_t number = 0;
  int status = -1;  // of the run; -1: not run yet
  double seconds = 0;
  std::vector<double> outputs;  // not a number where there is none
  std::string problem;
};

struct StudyReport {
  const Plan& plan;
  std::vector<StudyRow> rows;
  std::vector<std::vector<double>> references;  // per output: one number a row, or nothing
};

// One line a row: number, what varies, outputs, references, status, seconds.
std::string study_table(const StudyReport& report);

// Writes both into a folder and prints how outputs compare with their references.
void write_report(const StudyReport& report, const std::string& folder);

}  // namespace fabrica::study
