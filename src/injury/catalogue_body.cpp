// Measures of neck, thorax and legs; formulas and symbols in injury/body.h.
#include <fmt/format.h>

#include "injury/body.h"
#include "injury/catalogue.h"
#include "injury/head.h"
#include "signal/units.h"

namespace fabrica {
namespace {

Finding of_nij(const Subject& s, const Channels& c) {
  const Signal moment =
      occipital_moment(filtered(c, "neck.my", 600), filtered(c, "neck.fx", 600), 1e-3 * s.neck_arm);
  const Nij n = nij(filtered(c, "neck.fz", 600), moment, neck_intercepts(s.neck));
  const double v = n.largest();
  return {v,
          fmt::format("intercepts {}; tension-flexion {:.3f}, tension-extension {:.3f}, "
                      "compression-flexion {:.3f}, "
                      "compression-extension {:.3f}",
                      s.neck, n.tension_flexion, n.tension_extension, n.compression_flexion,
                      n.compression_extension),
          {{"AIS2+", logistic(-2.054 + 1.195 * v), "Eppinger et al. 1999"},
           {"AIS3+", logistic(-3.227 + 1.969 * v), "Eppinger et al. 1999"}}};
}

double deflection_mm(const Channels& c) {
  return largest_magnitude(in_unit(filtered(c, "chest.deflection", 180), "mm"));
}

Finding of_deflection(const Subject&, const Channels& c) {
  const double d = deflection_mm(c);
  return {d,
          "",
          {{"AIS3+ Hybrid III", logistic(-3.7124 + 0.0475 * d), "Eppinger et al. 1999"},
           {"AIS4+ Hybrid III", logistic(-5.0952 + 0.0475 * d), "Eppinger et al. 1999"},
           {"AIS3+ Hybrid III, NCAP", logistic(-10.5456 + 1.568 * std::pow(d, 0.4612)),
            "NHTSA NCAP 2008"}}};
}

// logit = b_0 + b_age age + b_c c: fitted to 90 of the 93 cadaver tests of Kent and Patrie 2005
// (injury/logistic_test)
Finding of_compression(const Subject& s, const Channels& c) {
  const double percent = 100 * deflection_mm(c) / s.chest_depth;
  const char* source =
      "fit made here to the 93 tests of Kent and Patrie 2005, Forensic Sci Int 149";
  auto risk = [&](double b0, double b_age, double b_c) {
    return logistic(b0 + b_age * s.age + b_c * percent);
  };
  return {percent,
          fmt::format("chest depth {} mm, age {}; AIS after Kroell {:.1f}", s.chest_depth, s.age,
                      -3.78 + 0.1956 * percent),
          {{"1 rib fracture or more", risk(-8.8164, 0.085942, 0.17559), source},
           {"6 rib fractures or more", risk(-10.7224, 0.061213, 0.22171), source},
           {"7 rib fractures or more", risk(-9.2773, 0.046916, 0.18521), source}}};
}

Finding of_vc(const Subject& s, const Channels& c) {
  Signal d = filtered(c, "chest.deflection", 180);
  return {viscous_criterion(d, 1e-3 * s.chest_depth, s.vc_factor),
          fmt::format("depth {} mm, factor {}", s.chest_depth, s.vc_factor),
          {}};
}

Finding of_chest_clip(const Subject&, const Channels& c) {
  const Signal a = in_g(filtered_resultant(c, "chest", 180));
  return {clip(a, 0.003), fmt::format("in all {:.1f} g", clip(a, 0.003, Clip::cumulative)), {}};
}

Finding of_cti(const Subject&, const Channels& c) {
  const double v = combined_thoracic_index(clip(in_g(filtered_resultant(c, "chest", 180)), 0.003),
                                           deflection_mm(c));
  const char* source = "Kleinberger et al. 1998";
  return {v,
          "intercepts of the Hybrid III 50M: 85 g, 102 mm",
          {{"AIS2+", logistic(-4.847 + 6.036 * v), source, "one program has 4.847, another 4.870"},
           {"AIS3+", logistic(-8.224 + 7.125 * v), source},
           {"AIS4+", logistic(-9.872 + 7.125 * v), source},
           {"AIS5+", logistic(-14.242 + 6.589 * v), source}}};
}

Finding of_pelvis(const Subject&, const Channels& c) {
  return {clip(in_g(filtered_resultant(c, "pelvis", 1000)), 0.003), "", {}};
}

template <bool left>
Finding of_femur(const Subject&, const Channels& c) {
  const double f = largest_compression(
      in_unit(filtered(c, left ? "femur_left.fz" : "femur_right.fz", 600), "kN"));
  const char* source = "Kuppa et al. 2001, Stapp 45";
  return {f,
          "",
          {{"AIS2+", logistic(-5.795 + 0.5196 * f), source},
           {"AIS3+", logistic(-4.9795 + 0.326 * f), source}}};
}

template <bool left>
Finding of_tibia_force(const Subject&, const Channels& c) {
  return {largest_compression(
              in_unit(filtered(c, left ? "tibia_left.fz" : "tibia_right.fz", 600), "kN")),
          "",
          {}};
}

template <bool left>
Finding of_tibia_index(const Subject& s, const Channels& c) {
  const std::string leg = left ? "tibia_left" : "tibia_right";
  return {tibia_index(filtered(c, leg + ".mx", 600), filtered(c, leg + ".my", 600),
                      filtered(c, leg + ".fz", 600), tibia_limits(s.leg)),
          "limits " + s.leg,
          {}};
}

}  // namespace

std::vector<Measure> neck_measures() {
  return {{"Nij",
           "neck",
           "1",
           {"neck.fz", "neck.fx", "neck.my"},
           "CFC 600",
           "max Fz/Fint + Moc/Mint, Moc = My - e Fx",
           1.0,
           "49 CFR 571.208 S6.6",
           "Eppinger et al. 1999, NHTSA",
           of_nij}};
}

std::vector<Measure> thorax_measures() {
  return {{"chest deflection",
           "thorax",
           "mm",
           {"chest.deflection"},
           "CFC 180",
           "max |D|",
           63,
           "49 CFR 571.208 S6.4(b); 76 mm in (a); UN R94, 5.2.1.4: 42 mm",
           "FMVSS 208",
           of_deflection},
          {"Cmax",
           "thorax",
           "%",
           {"chest.deflection"},
           "CFC 180",
           "100 max |D| / chest depth",
           {},
           "",
           "Kent and Patrie 2005; AIS = -3.78 + 19.56 C: Kroell et al. 1974",
           of_compression},
          {"VC",
           "thorax",
           "m/s",
           {"chest.deflection"},
           "CFC 180",
           "max s V D / D_ref",
           1.0,
           "UN R94, 5.2.1.5",
           "Lau and Viano 1986 (1.0 m/s: 25 % AIS4+ from the front); Euro NCAP TB 021",
           of_vc},
          {"a3ms chest",
           "thorax",
           "g",
           {"chest.ax", "chest.ay", "chest.az"},
           "CFC 180",
           "highest level exceeded for 3 ms without a break",
           60,
           "49 CFR 571.208 S6.3",
           "NHTSA, program CLIP 2.1",
           of_chest_clip},
          {"CTI",
           "thorax",
           "1",
           {"chest.ax", "chest.ay", "chest.az", "chest.deflection"},
           "CFC 180",
           "A_3ms/85 g + D/102 mm",
           1.0,
           "Kleinberger et al. 1998: proposed, not made a rule",
           "Kleinberger et al. 1998, NHTSA",
           of_cti}};
}

std::vector<Measure> leg_measures() {
  std::vector<Measure> out{{"a3ms pelvis",
                            "pelvis",
                            "g",
                            {"pelvis.ax", "pelvis.ay", "pelvis.az"},
                            "CFC 1000",
                            "highest level exceeded for 3 ms without a break",
                            {},
                            "",
                            "SAE J211",
                            of_pelvis}};
  for (const bool left : {true, false}) {
    const std::string side = left ? "left" : "right", tibia = "tibia_" + side;
    out.push_back({"femur force " + side,
                   "leg",
                   "kN",
                   {"femur_" + side + ".fz"},
                   "CFC 600",
                   "max compression",
                   10,
                   "49 CFR 571.208 S6.5 (2250 lbf)",
                   "49 CFR 571.208",
                   left ? of_femur<true> : of_femur<false>});
    out.push_back({"tibia force " + side,
                   "leg",
                   "kN",
                   {tibia + ".fz"},
                   "CFC 600",
                   "max compression",
                   8,
                   "UN R94, 5.2.1.7",
                   "UN R94",
                   left ? of_tibia_force<true> : of_tibia_force<false>});
    out.push_back({"tibia index " + side,
                   "leg",
                   "1",
                   {tibia + ".mx", tibia + ".my", tibia + ".fz"},
                   "CFC 600",
                   "max sqrt(Mx^2+My^2)/Mc + |Fz|/Fc",
                   1.3,
                   "UN R94, 5.2.1.8",
                   "Euro NCAP TB 021",
                   left ? of_tibia_index<true> : of_tibia_index<false>});
  }
  return out;
}

}  // namespace fabrica
