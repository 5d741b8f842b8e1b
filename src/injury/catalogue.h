#pragma once
// The measures of each region, and the risk curves that they share.
#include <cmath>
#include <vector>

#include "injury/measures.h"

namespace fabrica {

std::vector<Measure> head_measures();
std::vector<Measure> neck_measures();
std::vector<Measure> thorax_measures();
std::vector<Measure> leg_measures();
std::vector<Measure> tissue_measures();

// What is open about a number that nothing confirms but one program.
inline constexpr const char* read_once = "coefficients read in one program only";

// 1 / (1 + exp(-x))
inline double logistic(double x) { return 1 / (1 + std::exp(-x)); }
// 1 - exp(-(x / scale)^shape)
inline double weibull(double x, double scale, double shape) {
  return -std::expm1(-std::pow(x / scale, shape));
}
// standard normal distribution function
inline double normal(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// The channel filtered by its class. A record sampled too slowly for it throws "sampling-too-slow".
Signal filtered(const Channels& channels, const std::string& role, double cfc);
// Root of the sum of squares of <place>.ax, ay, az, each filtered.
Signal filtered_resultant(const Channels& channels, const std::string& place, double cfc);
// Acceleration in multiples of that of free fall.
Signal in_g(const Signal& acceleration);

}  // namespace fabrica
