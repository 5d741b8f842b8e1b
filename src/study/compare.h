#pragma once
// A signal of a case beside its reference: filtered, scaled, with corridors and ratings.
#include "study/case_file.h"
#include "study/channels.h"
#include "study/outcome.h"

namespace fabrica::study {

// The curves, peaks and ratings of a signal. A rating is computed only where the reference file
// says at its head that its numbers are tabulated, digitised or measured and gives the unit that
// the signal has; else `remark` says what is missing. Throws StudyError where a named column is not
// there or the curves cannot be compared.
SignalResult compare_signal(const SignalSpec& spec, Channels& channels, const Case& c);

// The total of a row of the published table of ratings, "test/signal". Throws StudyError for a row
// that is not there, naming the signals of the test.
double published_rating(const std::string& row, const std::string& file, int line);

// All rows of that table, "test/signal" and total.
std::vector<std::pair<std::string, double>> published_ratings();

}  // namespace fabrica::study
