#pragma once
// Cases by one command: runs those whose result is not up to date, compares them with their
// references, and writes a page for each.
#include <map>
#include <string>
#include <vector>

namespace fabrica::study {

struct ValidateOptions {
  std::vector<std::string> names;  // empty: all that are not slow
  std::string cases = "cases";     // folder below which they lie
  std::string out = "out/validation";
  std::string resolution;                    // of generated bodies; empty: their default
  std::map<std::string, std::string> paths;  // --set name=folder
  int jobs = 1;
  int threads = 0;            // of each run; 0 (command line only): cores over jobs
  bool slow = false;          // also cases marked as slow
  bool compare_only = false;  // nothing is run
};

// Prints a line per check and a summary. 0: all passed or were skipped for want of a folder;
// 1: a check failed or a case is broken. Throws StudyError for a name that is no case.
int validate(const ValidateOptions& options);

// Prints the ratings of all cases computed so far in options.out.
int print_ratings(const ValidateOptions& options);

}  // namespace fabrica::study
