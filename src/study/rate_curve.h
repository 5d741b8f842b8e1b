#pragma once
// The ratings and filters of src/signal, as cases use them.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/outcome.h"

namespace fabrica::study {

constexpr double most_rated_samples = 100000;

struct RatedUnits {
  std::string unit, time_unit;
};

// Parts in order, the total last; the interval that was rated; the corridors about the reference.
struct Rating {
  std::vector<std::pair<std::string, double>> parts;
  double from = 0, to = 0;
  Curve inner_low, inner_high, outer_low, outer_high;
};

// "cora" (CORA 3.6 with its defaults, the interval given by hand) or "iso18571" (ISO/TS 18571:2014)
// of a curve over time; the interval is the one given, else all that both cover. Both curves are
// read at the steps of the finer one. Throws SignalError where they cannot be compared.
Rating rate_curve(const std::string& method, const Curve& reference, const Curve& model,
                  const RatedUnits& units,
                  const std::optional<std::pair<double, double>>& interval);

// the word of a method's scale for a total
std::string rating_word(const std::string& method, double total);

// The ordinates of a curve over time behind one of cfc_names() (signal/filter.h), forwards and
// backwards.
std::vector<double> filtered(const std::string& filter, const Curve& curve,
                             const std::string& time_unit);

}  // namespace fabrica::study
