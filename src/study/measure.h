#pragma once
// Checks of a case: a statistic of a result and the bounds it must keep.
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/case_file.h"
#include "study/channels.h"

namespace fabrica::study {

class Fields;

struct CheckResult {
  std::string name;
  double value = 0;
  bool computed = false;  // false: `problem` says why there is no value
  bool passed = false;
  std::string bound;  // "26.8 within 25 %", "at most 0.1"
  std::string problem;
};

// The values of y where x lies within the range. Throws StudyError if x never does.
std::vector<double> within(const std::pair<double, double>& range, const std::vector<double>& x,
                           const std::vector<double>& y);

// A column over another one or, where `over` is empty, over time; behind a filter, if one is named,
// and then within a window of time. Throws StudyError where they differ in length, y is not a
// number or the window is empty.
Curve samples(const std::string& model, const std::string& over, const std::string& filter,
              const std::optional<std::pair<double, double>>& window, Channels& channels);

// Integral of y dx over the length of the path of x within [low, high], by the trapezoid rule.
// Throws StudyError if the path never lies within.
double mean_over(const std::vector<double>& x, const std::vector<double>& y, double low,
                 double high);

// The abscissa at which the magnitude of y first reaches a level, between two samples by a straight
// line. Throws StudyError if it never does.
double first_reaching(const std::vector<double>& x, const std::vector<double>& y, double level);

// The statistics that a check may ask for: mean, last, max, min, peak (the value of largest
// magnitude, with its sign), magnitude (without) and failure (see failure_load).
const std::vector<std::string>& statistic_names();

// Reads "filter": one of cfc_names() (signal/filter.h), or nothing.
std::string read_filter(Fields& f);

// Reads "time_unit" of a case or a plan: ms (default) or s.
std::string read_time_unit(Fields& f);

// Reads what a check asks for of its column: filter, over, window, range, statistic, energy.
void read_statistic(Fields& f, CheckSpec& c);

// The load under which something broke: the largest magnitude up to the moment at which the energy
// stored in it is greatest before it first falls by 2 %, counted from a quarter of its overall
// maximum on. A fracture frees energy at once and for good, while the load at a support swings
// before and after. Without such a fall the overall peak. Energy and load of equal length.
double failure_load(const std::vector<double>& load, const std::vector<double>& energy);

// The statistic that a check asks for, of the samples within its window and range, if it has them.
double statistic(const CheckSpec& check, Channels& channels);

// The outcome of a check. `named` gives numbers that are no columns ("rating:...", "fit:...").
CheckResult evaluate(const CheckSpec& check, Channels& channels,
                     const std::function<double(const std::string&)>& named);

}  // namespace fabrica::study
