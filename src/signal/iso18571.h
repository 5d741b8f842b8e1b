#pragma once
// ISO/TS 18571: objective rating of a signal against its reference, from 0 to 1.
// Theory, symbols and sources: docs/theory/iso18571.md.
#include <optional>
#include <string>

#include "signal/rating_pair.h"

namespace fabrica {

struct Iso18571Options {
  std::optional<double> t_min,
      t_max;  // evaluation interval in units of x; the whole record if not given
  double a_0 = 0.05, b_0 = 0.50, k_z = 2;
  double init_min = 0.8, k_p = 1;
  double eps_m = 0.5, k_m = 1, window = 0.1;
  double e_s = 2.0, k_s = 1;
  double w_z = 0.4, w_p = 0.2, w_m = 0.2, w_s = 0.2;
  double least_step =
      0;              // a finer sampling is made this coarse first (the standard: 0.1 ms); 0: never
  bool edges = true;  // give the corridor, too
};

struct Iso18571Rating {
  double corridor = 0, phase = 0, magnitude = 0, slope = 0;  // Z, EP, EM, ES
  double total = 0;                                          // R
  double shift = 0;  // n_eps steps, in units of x; negative: the signal is late
  double largest_correlation = 0, magnitude_error = 0, slope_error = 0;
  double t_min = 0, t_max = 0, norm = 0;
  CorridorEdges edges;  // where asked for
};

// Rates `signal` against `reference`; what is asked of both and the errors are those of cora().
Iso18571Rating iso18571(const Signal& reference, const Signal& signal,
                        const Iso18571Options& options = {});

// "Excellent" above 0.94, "Good" above 0.80, "Fair" above 0.58, else "Poor".
std::string iso18571_word(double total);

}  // namespace fabrica
