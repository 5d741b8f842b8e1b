#pragma once
// Corridors from several curves. Theory and source: docs/theory/corridors.md.
#include <vector>

#include "signal/curve.h"

namespace fabrica {

// Characteristic curve with its spread: low and high lie `deviations` standard deviations (sample,
// n - 1) to either side. For time histories all share the x of the mean; for arc-length averages
// the three differ in x and y.
struct Corridor {
  Signal mean, low, high;
  std::vector<double> deviation_x, deviation_y;
};

// Mean +- SD at each time: the curves are read, linearly, at the samples of the first within the
// range that all cover. Needs two curves of one unit; "too-few-curves", "different-units",
// "interval-not-covered".
Corridor mean_corridor(const std::vector<Signal>& curves, double deviations = 1);

// Arc-length characteristic average of curves y(x) that may turn back in x, such as force over
// deflection, at `points` equal parts of their length; the corridor is the envelope of the ellipses
// whose half axes are the deviations in x and y. Lengths are measured after division by the curves'
// mean extents, so that units do not matter.
Corridor arc_length_corridor(const std::vector<Signal>& curves, double deviations = 1,
                             int points = 200);

}  // namespace fabrica
