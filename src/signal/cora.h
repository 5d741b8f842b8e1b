#pragma once
// CORA 3.6 (correlation and analysis): how like a signal is to its reference, from 0 to 1.
// Theory, symbols and sources: docs/theory/cora.md.
#include <optional>
#include <string>
#include <vector>

#include "signal/rating_pair.h"

namespace fabrica {

struct CoraOptions {
  // evaluation interval [t_min, t_max] in units of x; where not given: the automatic interval
  std::optional<double> t_min, t_max;
  double a_threshold = 0.030, b_threshold = 0.075, a_evaluation = 0.010, b_delta_end = 0.200;
  // corridor: half widths as parts of Y_norm, multiples of the references' standard deviation,
  // exponent
  double a_0 = 0.05, b_0 = 0.50, a_sigma = 0, b_sigma = 0, k = 2;
  std::optional<double> y_norm;  // given instead of the extremum of the reference
  double min_norm = 0;           // least Y_norm, as a part of the largest reference of a group
  double group_norm = 0;         // that largest extremum; 0: none
  // cross-correlation
  double d_min = 0.01, d_max = 0.12, int_min = 0.80;
  double k_v = 10, k_g = 1, k_p = 1;
  double g_v = 0.50, g_g = 0.25, g_p = 0.25;
  // total
  double g_1 = 0.50, g_2 = 0.50;
  bool edges = true;  // give the corridor, too
};

struct CoraRating {
  double corridor = 0, progression = 0, size = 0, phase = 0;
  double correlation = 0;  // C2
  double total = 0;
  double shift = 0;             // that aligns best, in units of x; negative: the signal is late
  double largest_k = 0;         // cross-correlation at that shift
  double t_min = 0, t_max = 0;  // interval that was used
  double y_norm = 0;
  CorridorEdges edges;  // over the interval, where asked for
};

// Rates `signal` against `reference`, sampled at the same constant step over at least the interval.
// `deviation` (standard deviation at each sample of the reference) may be empty. Throws SignalError
// "different-time-base", "unit-missing" (reference), "different-units", "empty-corridor",
// "flat-reference", "bad-interval", and those of check() and sample_interval().
CoraRating cora(const Signal& reference, const Signal& signal, const CoraOptions& options = {},
                const std::vector<double>& deviation = {});

// "Excellent" from 0.86, "Good" from 0.65, "Fair" from 0.44, "Marginal" from 0.26, else
// "Unacceptable".
std::string cora_word(double total);

// Total of parts: weights as in options.
double cora_correlation(double progression, double size, double phase,
                        const CoraOptions& options = {});
double cora_total(double corridor, double correlation, const CoraOptions& options = {});

// Mean of several totals with weights WF; normalised by the sum of the weights if `normalise`
// (WF_NORM).
double cora_combined(const std::vector<double>& totals, const std::vector<double>& weights,
                     bool normalise = true);

}  // namespace fabrica
