#pragma once
// The laws of discrete beams (ELFORM 6). Six independent directions: translations along the local
// axes r, s, t and rotations about them; u is node 2 relative to node 1 in the local triad.
//
//   066 linear             F_i = K_i u_i + C_i u_i' + F0_i (1) 119 general nonlinear  F_i =
//   H_i(u_i) + D_i(u_i') E_i(u_i) + DAMPF sqrt(k m) u_i'             (2)
//       H: loading and unloading curves (hysteresis.h), D: damping curve, E: its scale (1 without a
//       curve), k: KT or KR, m: reduced mass or inertia of the two nodes failure: sum over
//       directions of (u_i / limit_i)^2 >= 1, with positive and negative limits taken separately
//       (FCRIT = 0) or in one sum (FCRIT = 1)                                          (3)
//
// With IFLAG = 1 translations enter the curves as u / L0 (L0: initial length; 1 for zero length).
#include <array>
#include <optional>
#include <string_view>
#include <variant>

#include "base/parameters.h"
#include "material/discrete/hysteresis.h"

namespace fabrica {

struct BeamMotion {
  std::array<double, 6> u{};     // relative translation and rotation at t(n)
  std::array<double, 6> rate{};  // their rates at t(n-1/2)
  double length = 0;             // initial length
  double mass = 0, inertia = 0;  // reduced mass and inertia of the two nodes
};
struct BeamForce {
  std::array<double, 6> force{}, stiffness{}, damping{};
  bool failed = false;
};
struct BeamLawState {
  std::array<SideState, 6> positive{}, negative{};
};

struct LinearBeam {
  static constexpr std::string_view keyword = "MAT_LINEAR_ELASTIC_DISCRETE_BEAM";
  std::array<double, 6> k, c, preload;
  static LinearBeam from(const Parameters& p);
  BeamForce force(const BeamMotion& m, BeamLawState& s) const;
};

struct GeneralBeam {
  static constexpr std::string_view keyword = "MAT_GENERAL_NONLINEAR_6DOF_DISCRETE_BEAM";
  std::array<Hysteresis, 6> path;
  std::array<Polyline, 6> damping, damping_scale;
  std::array<double, 6> positive_limit, negative_limit;  // 0: none
  std::array<double, 6> initial;                         // added to u
  double kt, kr, dampf;
  bool one_criterion, strain;
  static GeneralBeam from(const Parameters& p);
  BeamForce force(const BeamMotion& m, BeamLawState& s) const;

 private:
  bool fails(const std::array<double, 6>& u) const;
};

using BeamLaw = std::variant<LinearBeam, GeneralBeam>;

// The law of a canonical keyword, or nothing if it is not one of the above.
std::optional<BeamLaw> beam_law(std::string_view keyword, const Parameters& parameters);

// Resultants and tangents; the state is updated. Call once per step.
BeamForce beam_force(const BeamLaw& law, const BeamMotion& motion, BeamLawState& state);

}  // namespace fabrica
