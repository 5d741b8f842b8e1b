#pragma once
// The cranial vault as a radius over directions from a centre inside: real orthonormal spherical
// harmonics
//   R(theta, phi) = sum_lm a_lm Y_lm,   Y_l0 = N P_l(cos theta),  Y_lm = sqrt2 N P_lm cos m phi (m
//   > 0), sqrt2 N P_l|m| sin |m| phi (m < 0),   N = sqrt((2l + 1) / (4 pi) (l - m)! / (l + m)!),
//   (1)
// without the Condon-Shortley phase; theta from +z, phi from +x to +y (table
// data/anatomy/bones/skull_vault.csv).
#include <string>
#include <vector>

#include "body/mesh/bone_mesh.h"

namespace fabrica::body {

inline constexpr Point vault_centre{8.2, 0.0, 84.67};  // [mm] frame head

class VaultSurface {
 public:
  explicit VaultSurface(const std::string& column);  // "outer" or "inner"
  // [mm] along a unit vector; linear between directions two degrees apart
  double radius(const Point& direction) const;
  // [mm] the sum (1) itself
  double exact_radius(double theta, double phi) const;

 private:
  struct Term {
    int l, m;
    double a;
  };
  std::vector<Term> terms_;
  std::vector<double> samples_;  // theta by row, phi by column
};

}  // namespace fabrica::body
