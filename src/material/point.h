#pragma once
// The contract between elements and material laws.
//
// A law is a plain struct of parameters (Real, CurveView) with
//   keyword    canonical keyword, "MAT_ELASTIC"
//   families   where it may be used: in_solids | in_shells | in_beams
//   rotated    how many members of its State turn with the material, see there
//   total      false: rate law, true: law of the deformation gradient
//   can_fail   true: may set Point::alive to 0; then bool may_fail() const tells whether it does so
//              with these parameters
// all static constexpr, and
//   static Law from(const Parameters&)   reads the card
//   Elastic elastic() const              density and initial elastic moduli, for mass, time step,
//                                        contact
//   template <class L> struct State      history of one point: only L and Sym3<L> members, all zero
//                                        at the start; the first `rotated` Sym3 members turn with
//                                        the material and are rotated by the element before the
//                                        call
//   int layers_to_fail() const           optional, of shells: how many layers of an in-plane point
//                                        take the others along; 0: each fails alone
// and one of
//   Sym3<L> stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>&, State<L>&) const
//       a rate law. old: Cauchy stress at t(n-1), already rotated to t(n); strain: D dt (tensor
//       components); returns Cauchy stress at t(n)
//   Sym3<L> stress(const Mat3<L>& F, Point<L>&, State<L>&) const
//       a total law. F: deformation gradient, with det F = point.volume_ratio; returns Cauchy
//       stress
// Kernels: no data-dependent branch except select(), no allocation, no global state.
#include <string_view>

#include "base/curve.h"
#include "base/lane.h"
#include "base/parameters.h"
#include "base/tensor.h"

namespace fabrica {

inline constexpr unsigned in_solids = 1, in_shells = 2, in_beams = 4;

struct Elastic {
  double density = 0, bulk = 0, shear = 0;
  double youngs() const { return 9 * bulk * shear / (3 * bulk + shear); }
  double poisson() const { return (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear)); }
  double wave_modulus() const { return bulk + 4.0 / 3.0 * shear; }  // K + 4G/3
  static Elastic from_youngs(double density, double E, double nu) {
    return {density, E / (3 * (1 - 2 * nu)), E / (2 * (1 + nu))};
  }
};

template <class L>
struct Point {
  L dt;            // step over which `strain` grew
  L volume_ratio;  // J = V / V0 at t(n)
  L length;        // characteristic length of the element
  L modulus;       // in: initial K + 4G/3; out: the tangent now, for the time step (raise it where
                   // stiffer)
  L shear;         // in: initial G; out: tangent now, for hourglass stiffness
  L alive;         // out: set to 0 where the point has failed; 1 on entry
};

}  // namespace fabrica
