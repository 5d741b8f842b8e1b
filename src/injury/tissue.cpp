#include "injury/tissue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "signal/curve.h"

namespace fabrica {
namespace {

void check_elements(const std::vector<double>& values, const std::vector<double>& volumes) {
  if (values.empty())
    throw SignalError("empty-signal", "there are no elements", "Give one row for each element");
  if (values.size() != volumes.size())
    throw SignalError("ragged-signal", "values and volumes differ in number",
                      "Give both for each element");
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]) || !(volumes[i] >= 0))
      throw SignalError("not-a-number", "an element has no finite value or a negative volume",
                        "Correct its row");
}

}  // namespace

double volume_quantile(const std::vector<double>& values, const std::vector<double>& volumes,
                       double q) {
  check_elements(values, volumes);
  if (!(q >= 0 && q <= 1))
    throw SignalError("bad-setting", "a quantile lies between 0 and 1", "Correct it");
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  const double wanted = q * std::accumulate(volumes.begin(), volumes.end(), 0.0) * (1 - 1e-12);
  double below = 0;
  for (const std::size_t i : order)
    if ((below += volumes[i]) >= wanted) return values[i];
  return values[order.back()];
}

double volume_fraction_above(const std::vector<double>& values, const std::vector<double>& volumes,
                             double threshold) {
  check_elements(values, volumes);
  double above = 0, all = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    all += volumes[i];
    if (values[i] > threshold) above += volumes[i];
  }
  if (all == 0)
    throw SignalError("empty-signal", "the elements have no volume", "Give their volumes");
  return above / all;
}

double rib_fracture_probability(double strain, double age) {
  constexpr double deviation = 0.3026;  // of the logarithm of the strain at fracture
  const double median = -2.9866 - 0.0130 * age;
  return strain <= 0 ? 0
                     : 0.5 * std::erfc(-(std::log(strain) - median) / (std::sqrt(2.0) * deviation));
}

double rib_fracture_probability_forman(double strain, double age) {
  // strains at fracture of the twelve, taken to 25 years [%]
  constexpr std::array broken{1.654, 2.012, 2.119, 2.227, 2.382, 2.983,
                              3.212, 3.293, 3.434, 3.590, 4.089, 4.102};
  const double kept = 1 - 0.0051 * (age - 25);  // of the strain that bone bears at 25 years
  if (strain <= 0 || kept <= 0) return strain > 0;
  const double adjusted = 100 * strain / kept;
  const auto below = std::lower_bound(broken.begin(), broken.end(), adjusted) - broken.begin();
  return double(below) / double(broken.size());
}

double at_least(const std::vector<double>& p, int k) {
  // exactly[n]: probability of n events among those seen so far
  std::vector<double> exactly(p.size() + 1, 0.0);
  exactly[0] = 1;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t n = i + 2; n-- > 0;)
      exactly[n] = exactly[n] * (1 - p[i]) + (n > 0 ? exactly[n - 1] * p[i] : 0);
  double sum = 0;
  for (std::size_t n = std::size_t(std::max(k, 0)); n < exactly.size(); ++n) sum += exactly[n];
  return std::min(sum, 1.0);  // a sum of all of them exceeds one by rounding
}

}  // namespace fabrica
