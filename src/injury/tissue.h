#pragma once
// Measures from the elements of a tissue, each with its volume and the largest value over time.
//   MPS_q    the q-quantile by volume of the first principal strain
//   CSDM(x)  the volume fraction above x
//   ribs     p = Phi((ln e + 2.9866 + 0.0130 age) / 0.3026), e the strain of a rib's cortical bone,
//            age in years, Phi the normal distribution (Larsson et al. 2021, doi
//            10.3389/fbioe.2021.677768); or p = share of twelve subjects whose coupons broke below
//            e / (1 - 0.0051 (age - 25)) (Forman et al. 2012, Ann Adv Automot Med 56:109-124);
//            P(N >= k) of independent ribs by the Poisson-binomial recursion
#include <vector>

namespace fabrica {

// The value below which the part q of the volume lies; q = 1 is the largest. "empty-signal",
// "ragged-signal", "bad-setting" for a negative volume or q outside [0, 1].
double volume_quantile(const std::vector<double>& values, const std::vector<double>& volumes,
                       double q);

// Part of the volume whose value exceeds the threshold.
double volume_fraction_above(const std::vector<double>& values, const std::vector<double>& volumes,
                             double threshold);

double rib_fracture_probability(double strain, double age_years);
double rib_fracture_probability_forman(double strain, double age_years);

// P(N >= k) where event i has the probability p[i].
double at_least(const std::vector<double>& p, int k);

}  // namespace fabrica
