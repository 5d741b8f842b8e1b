#pragma once
// What CORA and ISO/TS 18571 have in common: the pair of curves over the evaluation interval, the
// corridor around the reference and its score, the search for the shift that aligns two curves
// best.
#include <optional>
#include <span>
#include <vector>

#include "signal/curve.h"

namespace fabrica {

using Samples = std::span<const double>;

// n samples of both curves at one constant step: pieces of the curves that were given, which must
// outlive them, or of a converted one.
struct RatingPair {
  Samples x, reference, signal;
  Samples deviation;  // of the reference, or empty
  double step = 0;
  std::string x_unit, unit;
  std::vector<double> converted;  // the signal in the reference's unit, where it had another

  RatingPair() = default;
  RatingPair(RatingPair&&) = default;  // a moved vector stays where it is
  RatingPair& operator=(RatingPair&&) = default;
};

// Checks both curves and their units, brings the signal to the units of the reference, and crops
// both to [t_min, t_max] (not given: the whole record). A signal without a unit is taken to have
// the reference's. Errors: see cora().
RatingPair rating_pair(const Signal& reference, const Signal& signal, std::optional<double> t_min,
                       std::optional<double> t_max, Samples deviation = {});

// Half widths of a corridor at each sample: a constant and a multiple of the deviation.
struct CorridorWidths {
  double inner_part = 0, outer_part = 0, inner_sigma = 0, outer_sigma = 0;
  Samples deviation;
  double sigma(std::size_t i) const { return deviation.empty() ? 0 : deviation[i]; }
  double inner(std::size_t i) const { return inner_part + inner_sigma * sigma(i); }
  double outer(std::size_t i) const { return outer_part + outer_sigma * sigma(i); }
};

// a_0 Y + a_sigma sigma and b_0 Y + b_sigma sigma; "empty-corridor" unless 0 <= inner < outer at
// every sample.
CorridorWidths corridor_widths(const RatingPair& pair, double norm, double a_0, double b_0,
                               double a_sigma = 0, double b_sigma = 0);

// Mean over the samples of 1 inside the inner corridor, 0 outside the outer one,
// ((outer - |difference|) / (outer - inner))^exponent between.
double corridor_score(const RatingPair& pair, const CorridorWidths& widths, double exponent);

// reference - outer, - inner, + inner, + outer, as curves to draw.
struct CorridorEdges {
  Signal outer_low, inner_low, inner_high, outer_high;
};
CorridorEdges corridor_edges(const RatingPair& pair, const CorridorWidths& widths);

// Largest absolute value; "flat-reference" if that is zero.
double reference_norm(Samples reference);

// The shift m, |m| <= most, with the largest correlation of reference[i + m] and signal[i] over the
// overlap, for m > 0 the signal being early. Raw: sum(xy)/sqrt(sum(xx) sum(yy)); centred:
// Pearson's. Among shifts that are equal to rounding the first of 0, -1, +1, -2, +2, ... is taken.
// O(n log n).
struct BestShift {
  long shift = 0;
  double value = 0;
};
BestShift best_shift(Samples reference, Samples signal, long most, bool centred);

}  // namespace fabrica
