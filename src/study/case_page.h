#pragma once
// The pages of cases: one each, the index of all, and the table of ratings as text.
#include <string>
#include <vector>

#include "study/case_file.h"
#include "study/html.h"
#include "study/outcome.h"

namespace fabrica::study {

// What a page shows beside the outcome.
struct PageExtras {
  std::vector<std::pair<std::string, Curve>> energies;  // over time, of glstat
  std::string picture;                                  // file name beside the page; empty: none
  std::string picture_remark;                           // why there is none
  std::string readme;                                   // what the case's folder says of itself
  std::vector<std::string> files;                       // that the run read
};

// OUT/NAME/index.html
std::string case_page(const Case& c, const Outcome& outcome, const PageExtras& extras);

// OUT/index.html
std::string index_page(const std::vector<Outcome>& outcomes);

// What stands for a signal in the line of CORA's rating of them all.
inline constexpr const char* all_signals = "all signals";

// All ratings as text, the published one beside ours where there is one, then the rows of
// `published` ("test/signal", total) that no signal names.
std::string rating_table(const std::vector<Outcome>& outcomes,
                         const std::vector<std::pair<std::string, double>>& published);

}  // namespace fabrica::study
