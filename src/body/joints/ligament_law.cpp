#include "body/joints/ligament_law.h"

#include <algorithm>
#include <cmath>

namespace fabrica::body {

double ligament_force(const LigamentStiffness& law, double elongation) {
  const double x = elongation - law.slack;
  if (x <= 0) return 0;
  if (law.toe > 0) {
    const double n = law.k1 * law.toe / law.toe_force;
    return law.toe_force * (x <= law.toe ? std::pow(x / law.toe, n) : 1) +
           law.k1 * std::max(x - law.toe, 0.0);
  }
  if (law.strain1 > 0) {
    const double bend = law.strain1 * law.length;
    return law.k1 * std::min(x, bend) + law.k2 * std::max(x - bend, 0.0);
  }
  const double s = 0.03 * law.length;
  return x <= 2 * s ? law.k1 * x * x / (4 * s) : law.k1 * (x - s);
}

Law ligament_curve(const LigamentStiffness& law, int strands, const std::string& source,
                   const std::string& flag) {
  Law curve{"MAT_SPRING_NONLINEAR_ELASTIC", {}, "lcd", {}, source, flag};
  std::vector<double> x{-1000, 0};
  const auto toe = [&](double end, int pieces) {
    for (int i = 1; i <= pieces; ++i) x.push_back(end * i / pieces);
  };
  if (law.toe > 0)
    toe(law.toe, 8);
  else if (law.strain1 > 0)
    x.push_back(law.strain1 * law.length);
  else
    toe(0.06 * law.length, 4);
  x.push_back(x.back() + 1000);
  for (double at : x) {
    const double elongation = at + std::max(law.slack, 0.0);
    curve.curve.emplace_back(elongation, ligament_force(law, elongation) / strands);
  }
  curve.curve.front() = {-1000, 0};
  if (law.slack > 0) curve.curve.insert(curve.curve.begin() + 1, {0, 0});
  return curve;
}

Law pull_only(const std::string& source, const std::string& flag) {
  return {"MAT_SPRING_NONLINEAR_ELASTIC",     {},     "lcd",
          {{-1000, 0}, {0, 0}, {1000, 1000}}, source, flag};
}

}  // namespace fabrica::body
