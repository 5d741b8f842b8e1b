#pragma once
// Force over elongation of a ligament: nothing in compression and until slack is taken up.
//
//   one slope k:   F = k x^2 / (4 s),  0 <= x <= 2 s;   F = k (x - s) beyond,  s = 0.03 L     (1)
//                  (toe of Blankevoort, Huiskes 1991 with a linear strain limit of 0.03)
//   two slopes:    F = k1 x,  x <= e1 L;                F = k1 e1 L + k2 (x - e1 L)           (2)
//   a measured toe: F = Ft (x / xt)^n,  x <= xt;        F = Ft + k (x - xt),  n = k xt / Ft   (3)
//                  (Mattucci, Cronin 2015: averages of tests end their toe at xt, Ft)
//
// x: elongation beyond slack [mm], L: reference length [mm], k in kN/mm.
#include "body/piece.h"

namespace fabrica::body {

struct LigamentStiffness {
  double length = 1;                   // L [mm]
  double k1 = 0, strain1 = 0, k2 = 0;  // [kN/mm], [-], [kN/mm]; strain1 = 0: one slope k1
  double slack = 0;                    // [mm] elongation at which force begins
  double toe = 0, toe_force = 0;       // xt [mm], Ft [kN]; toe = 0: law (1) or (2)
};

// force [kN] of the law at an elongation [mm], exactly
double ligament_force(const LigamentStiffness& law, double elongation);
// *MAT_SPRING_NONLINEAR_ELASTIC with the law as a curve of straight pieces, for one of `strands`
// equal strands
Law ligament_curve(const LigamentStiffness& law, int strands, const std::string& source,
                   const std::string& flag);

// *MAT_SPRING_NONLINEAR_ELASTIC of 1 kN/mm under tension, nothing under compression; the scale of a
// line is its stiffness
Law pull_only(const std::string& source, const std::string& flag);

}  // namespace fabrica::body
