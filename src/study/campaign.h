#pragma once
// A parameter study: runs the rows of a plan side by side, goes on after it was killed without
// repeating a finished run, and writes a table and a page of scatter plots.
#include <map>
#include <string>
#include <vector>

#include "study/plan.h"

namespace fabrica::study {

struct StudyOptions {
  std::string plan;
  std::string out;  // empty: out/studies/<name of the plan>
  std::string resolution;
  std::map<std::string, std::string> paths;
  int jobs = 1, threads = 1;
  int row = 0;                // from 1: only this one, without table; 0: all
  bool slurm = false;         // write a job array instead of running
  std::string set_arguments;  // the --set options as given, for the job array
};

// 0: every row has its result; 1: at least one has not. Throws StudyError.
int run_study(const StudyOptions& options);

// Mean of |ours / theirs - 1|, and Spearman's rank correlation; ranks of equal values are averaged.
double mean_error(const std::vector<double>& ours, const std::vector<double>& theirs);
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace fabrica::study
