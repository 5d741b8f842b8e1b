// Measures of the head; formulas and symbols in injury/head.h.
#include <fmt/format.h>

#include "injury/catalogue.h"
#include "injury/head.h"
#include "signal/filter.h"
#include "signal/operations.h"
#include "signal/units.h"

namespace fabrica {

Signal filtered(const Channels& channels, const std::string& role, double cfc) {
  return cfc_filtered(channels.at(role), cfc);
}
Signal filtered_resultant(const Channels& channels, const std::string& place, double cfc) {
  return resultant({filtered(channels, place + ".ax", cfc), filtered(channels, place + ".ay", cfc),
                    filtered(channels, place + ".az", cfc)});
}
Signal in_g(const Signal& acceleration) { return in_unit(acceleration, "g"); }

namespace {

const std::vector<std::string> accelerations{"head.ax", "head.ay", "head.az"};
const std::vector<std::string> rotations{"head.wx", "head.wy", "head.wz"};

Finding of_hic(const Hic& h) {
  return {h.value, fmt::format("from {:.2f} to {:.2f} ms", 1000 * h.from, 1000 * h.to), {}};
}

Finding hic15(const Subject&, const Channels& c) {
  Finding f = of_hic(hic(filtered_resultant(c, "head", 1000), 0.015));
  const double h = f.value;
  const char* source = "NHTSA 1995, expanded Prasad-Mertz curves";
  if (h <= 0) return f;
  f.risks = {
      {"AIS1+", logistic(-(1.54 + 200 / h - 0.00650 * h)), source},
      {"AIS2+", logistic(-(2.49 + 200 / h - 0.00483 * h)), source},
      {"AIS3+", logistic(-(3.39 + 200 / h - 0.00372 * h)), source},
      {"AIS4+", logistic(-(4.90 + 200 / h - 0.00351 * h)), source},
      {"AIS5+", logistic(-(7.82 + 200 / h - 0.00429 * h)), source},
      {"skull fracture AIS2+", normal((std::log(h) - 6.96352) / 0.84664), "Mertz 1997", read_once}};
  return f;
}
Finding hic36(const Subject&, const Channels& c) {
  return of_hic(hic(filtered_resultant(c, "head", 1000), 0.036));
}

Finding head_clip(const Subject&, const Channels& c) {
  const Signal a = in_g(filtered_resultant(c, "head", 1000));
  return {clip(a, 0.003, Clip::cumulative),
          fmt::format("without a break {:.1f} g", clip(a, 0.003)),
          {}};
}

Finding of_bric(const Subject&, const Channels& c) {
  const double b =
      bric({filtered(c, "head.wx", 60), filtered(c, "head.wy", 60), filtered(c, "head.wz", 60)});
  const char* source = "Takhounts et al. 2013, Stapp 57 (MPS)";
  return {b,
          "",
          {{"AIS1+", weibull(b, 0.120, 2.84), source},
           {"AIS2+", weibull(b, 0.602, 2.84), source},
           {"AIS3+", weibull(b, 0.987, 2.84), source},
           {"AIS4+", weibull(b, 1.204, 2.84), source, read_once},
           {"AIS5+", weibull(b, 1.252, 2.84), source, read_once}}};
}

Finding of_damage(const Subject&, const Channels& c) {
  return {damage({differentiated(filtered(c, "head.wx", 60)),
                  differentiated(filtered(c, "head.wy", 60)),
                  differentiated(filtered(c, "head.wz", 60))}),
          "",
          {}};
}

}  // namespace

std::vector<Measure> head_measures() {
  const std::string hic_formula = "max (t2-t1) [1/(t2-t1) integral a dt]^2.5, t2-t1 <= ";
  return {{"HIC15", "head", "1", accelerations, "CFC 1000", hic_formula + "15 ms", 700,
           "49 CFR 571.208 S6.2(b)", "Versace 1971, SAE 710881; FMVSS 208", hic15},
          {"HIC36", "head", "1", accelerations, "CFC 1000", hic_formula + "36 ms", 1000,
           "49 CFR 571.208 S6.2(a), before HIC15", "Versace 1971, SAE 710881; FMVSS 208", hic36},
          {"a3ms head", "head", "g", accelerations, "CFC 1000",
           "highest level exceeded for 3 ms in all", 80, "UN R94, 5.2.1.1", "UN R94, annex 4",
           head_clip},
          {"BrIC",
           "head",
           "1",
           rotations,
           "CFC 60",
           "sqrt(sum (max|w_i|/w_ic)^2), w_c 66.25 56.45 42.87 rad/s",
           {},
           "",
           "Takhounts et al. 2013, Stapp 57",
           of_bric},
          {"DAMAGE",
           "head",
           "1",
           rotations,
           "CFC 60",
           "d'' + C d' + K d = alpha; 2.9903 max|d|",
           {},
           "",
           "Gabler et al. 2019; Euro NCAP TB 035",
           of_damage}};
}

}  // namespace fabrica
