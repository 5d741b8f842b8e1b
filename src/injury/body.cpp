#include "injury/body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "signal/units.h"

namespace fabrica {
namespace {

void need_one_base(const Signal& a, const Signal& b) {
  if (!same_base(a, b))
    throw SignalError("different-time-base",
                      "'" + a.name + "' and '" + b.name + "' are not sampled at the same times",
                      "Resample them to one step");
}

template <class Set, std::size_t n>
const Set& chosen(const std::array<Set, n>& sets, const std::string& name, const char* what) {
  std::string all;
  for (const Set& s : sets) {
    if (s.name == name) return s;
    all += (all.empty() ? "" : ", ") + s.name;
  }
  throw SignalError("unknown-set", std::string("no ") + what + " of '" + name + "'",
                    "There are: " + all);
}

}  // namespace

NeckIntercepts neck_intercepts(const std::string& name) {
  static const std::array<NeckIntercepts, 3> sets{{{"H3-50M", 6806, -6160, 310, -135},
                                                   {"H3-05F", 4287, -3880, 155, -67},
                                                   {"THOR-50M", 4200, -6400, 88.1, -117}}};
  return chosen(sets, name, "neck intercepts");
}

double Nij::largest() const {
  return std::max({tension_flexion, tension_extension, compression_flexion, compression_extension});
}

Nij nij(const Signal& axial_force, const Signal& moment, const NeckIntercepts& set) {
  const Signal f = in_unit(axial_force, "N"), m = in_unit(moment, "Nm");
  need_one_base(f, m);
  Nij worst;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const bool tension = f.y[i] >= 0, flexion = m.y[i] >= 0;
    const double value = f.y[i] / (tension ? set.tension : set.compression) +
                         m.y[i] / (flexion ? set.flexion : set.extension);
    double& of_case = tension ? (flexion ? worst.tension_flexion : worst.tension_extension)
                              : (flexion ? worst.compression_flexion : worst.compression_extension);
    of_case = std::max(of_case, value);
  }
  return worst;
}

Signal occipital_moment(const Signal& moment, const Signal& shear_force, double e) {
  Signal m = in_unit(moment, "Nm");
  const Signal f = in_unit(shear_force, "N");
  need_one_base(m, f);
  for (std::size_t i = 0; i < m.size(); ++i) m.y[i] -= e * f.y[i];
  return m;
}

double viscous_criterion(const Signal& deflection, double depth, double factor) {
  const Signal d = in_x_unit(in_unit(deflection, "m"), "s");
  const double interval = sample_interval(d);
  if (!(depth > 0))
    throw SignalError("bad-setting", "the chest depth is not positive", "Set chest_depth_mm");
  double largest = 0;
  for (std::size_t i = 2; i + 2 < d.size(); ++i) {
    const double v = (8 * (d.y[i + 1] - d.y[i - 1]) - (d.y[i + 2] - d.y[i - 2])) / (12 * interval);
    largest = std::max(largest, factor * v * d.y[i] / depth);
  }
  return largest;
}

double combined_thoracic_index(double clip_g, double deflection_mm, double intercept_g,
                               double intercept_mm) {
  return clip_g / intercept_g + deflection_mm / intercept_mm;
}

TibiaLimits tibia_limits(const std::string& name) {
  static const std::array<TibiaLimits, 5> sets{{{"H3-50M", 225, 35900},
                                                {"THOR-50M", 225, 35900},
                                                {"H3-05F", 115, 22900},
                                                {"H3-95M", 307, 44200},
                                                {"revised", 240, 12000}}};
  return chosen(sets, name, "tibia limits");
}

double tibia_index(const Signal& moment_x, const Signal& moment_y, const Signal& axial_force,
                   const TibiaLimits& set) {
  const Signal x = in_unit(moment_x, "Nm"), y = in_unit(moment_y, "Nm"),
               f = in_unit(axial_force, "N");
  need_one_base(x, y);
  need_one_base(x, f);
  double largest = 0;
  for (std::size_t i = 0; i < f.size(); ++i)
    largest =
        std::max(largest, std::hypot(x.y[i], y.y[i]) / set.moment + std::abs(f.y[i]) / set.force);
  return largest;
}

double largest_magnitude(const Signal& s) {
  double largest = 0;
  for (const double y : s.y) largest = std::max(largest, std::abs(y));
  return largest;
}

double largest_compression(const Signal& s) {
  double largest = 0;
  for (const double y : s.y) largest = std::max(largest, -y);
  return largest;
}

}  // namespace fabrica
