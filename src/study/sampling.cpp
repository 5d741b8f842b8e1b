#include "study/sampling.h"

#include <numeric>
#include <random>
#include <utility>

namespace fabrica::study {
namespace {

// a number in [0, 1): the library's distributions differ between machines, its engines do not
double uniform(std::mt19937_64& engine) { return double(engine() >> 11) * 0x1p-53; }

}  // namespace

std::vector<std::vector<std::size_t>> grid(const std::vector<std::size_t>& counts) {
  std::vector<std::vector<std::size_t>> out = {{}};
  for (const std::size_t count : counts) {
    std::vector<std::vector<std::size_t>> longer;
    for (const auto& point : out)
      for (std::size_t i = 0; i < count; ++i) {
        longer.push_back(point);
        longer.back().push_back(i);
      }
    out = std::move(longer);
  }
  return out;
}

std::vector<std::vector<double>> latin_hypercube(int samples, int dimensions, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::vector<std::vector<double>> points(
      static_cast<std::size_t>(samples), std::vector<double>(static_cast<std::size_t>(dimensions)));
  std::vector<int> stretch(static_cast<std::size_t>(samples));
  for (std::size_t d = 0; d < std::size_t(dimensions); ++d) {
    // a random order of the stretches (Fisher and Yates)
    std::iota(stretch.begin(), stretch.end(), 0);
    for (std::size_t i = stretch.size(); i > 1; --i)
      std::swap(stretch[i - 1], stretch[std::size_t(uniform(engine) * double(i))]);
    for (std::size_t i = 0; i < stretch.size(); ++i)
      points[i][d] = (stretch[i] + uniform(engine)) / samples;
  }
  return points;
}

}  // namespace fabrica::study
