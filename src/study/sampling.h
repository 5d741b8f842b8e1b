#pragma once
// Points of a parameter study: a full grid, or a Latin hypercube (M. D. McKay, R. J. Beckman,
// W. J. Conover, Technometrics 21 (1979) 239-245).
#include <cstdint>
#include <vector>

namespace fabrica::study {

// All combinations of the indices 0..counts[i]-1; the last one moves fastest.
std::vector<std::vector<std::size_t>> grid(const std::vector<std::size_t>& counts);

// `samples` points in the unit cube of `dimensions`: along every axis each of the `samples` equal
// stretches holds exactly one point, at a random place in it. The same seed gives the same points
// on every machine.
std::vector<std::vector<double>> latin_hypercube(int samples, int dimensions, std::uint64_t seed);

}  // namespace fabrica::study
