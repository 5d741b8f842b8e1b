#pragma once
// What is done to signals before they are rated or judged.
#include <optional>
#include <vector>

#include "signal/curve.h"

namespace fabrica {

// Samples with low <= x <= high; "empty-signal" if fewer than two are left.
Signal cropped(const Signal& signal, std::optional<double> low, std::optional<double> high);

// y + value, or x + value.
Signal offset(Signal signal, double value);
Signal shifted(Signal signal, double value);

// y less its mean over x <= until: the signal before the impact is zero.
Signal zeroed(const Signal& signal, double until);

// Integral from the first sample by the trapezoidal rule, starting at `start`; central differences,
// exact for parabolas at a constant step. Both in units of y times or over seconds where x is a
// time and such a unit is known, else "".
Signal integrated(const Signal& signal, double start = 0);
Signal differentiated(const Signal& signal);

// sqrt(sum of squares) of components of one base and unit; "different-time-base",
// "different-units".
Signal resultant(const std::vector<Signal>& components);

}  // namespace fabrica
