#pragma once
// Dynamic time warping of two curves within a band: the path through pairs (i, j) from the first to
// the last samples with the least sum of (a_i - b_j)^2.
#include <span>

namespace fabrica {

// Sums along the path, the measure of magnitude of ISO/TS 18571.
struct WarpedSums {
  double difference = 0;  // |a_i - b_j|
  double reference = 0;   // |b_j|
};

// a and b have n samples each; |i - j| < band. Of equal costs the steps are preferred in the order
// (i-1, j), (i, j-1), (i-1, j-1), as when tracing the path back. Memory O(band); time O(n band).
WarpedSums warped_sums(std::span<const double> a, std::span<const double> b, long band);

}  // namespace fabrica
