#pragma once
// The contract between element kernels and the drivers that feed them.
//
// An element is a struct of static functions, templated on the lane L and the material law M:
//   static constexpr int corners                     nodes
//   static constexpr bool rotations                  corners carry angular velocity and receive
//   moments template <class M> static int state_fields(const ElementParameters&)
//                                                    Reals of history per element; field f of lane
//                                                    i of a block lies at block[f * block_size + i]
//   template <class L, class M> static void initialise(const M&, const ElementParameters&, const
//   Corners<L, N>&,
//                                                      const Given<L>&, StateView<L>)
//                                                    fills the history at t = 0 (it is zero before
//                                                    the call)
//   template <class L, class M> static void forces(const M&, const ElementParameters&, Real
//   dt_previous,
//                                                  const Corners<L, N>&, StateView<L>,
//                                                  CornerForces<L, N>&, Totals<L>&)
//                                                    advances stress from t(n-1) to t(n) with the
//                                                    velocity of the half step and returns what the
//                                                    element does at t(n)
//   static void lump(const ElementParameters&, const Corners<double, N>&, const Given<double>&,
//                    double mass[N], double inertia[N])      lumped mass and scalar rotary inertia
// Forces are the forces ON the nodes. Kernels are pure functions of their arguments. At dt_previous
// = 0 (the first call) the strain increment is zero and only forces and the time step are computed.
#include <type_traits>

#include "base/real.h"
#include "base/tensor.h"
#include "material/point.h"

namespace fabrica {

inline constexpr int max_layers = 10;

// Everything an element needs to know about its part; uniform over a tile.
struct ElementParameters {
  Real density = 0, bulk = 0, shear = 0, youngs = 0, poisson = 0;
  int formulation = 0;
  // hourglass control
  int hourglass = 0;                                  // IHQ
  Real hourglass_coefficient = 0;                     // QM
  Real hourglass_bending = 0, hourglass_warping = 0;  // QB, QW (shells)
  // bulk viscosity
  Real quadratic_viscosity = Real(1.5), linear_viscosity = Real(0.06);
  int shell_viscosity = 0;  // shells: 0 none, 1 without its energy, 2 with it
  // part stiffness damping, as in the dossier: beta = coefficient * element time step; 0: none
  Real stiffness_damping = 0;
  // shells
  Real shear_factor = 1, reference_location = 0, area_mass = 0;
  int layers = 2;
  Real layer_z[max_layers] = {};       // position of each point, -1..1 over the thickness
  Real layer_weight[max_layers] = {};  // sums to 1
  int thickness_update = 0;            // ISTUPD
  int warping = 0;                     // BWC = 1: Belytschko-Wong-Chiang
  int projection = 0;                  // PROJ
  int time_step_option = 0;            // ISDO
  // beams
  Real area = 0, iss = 0, itt = 0, torsion = 0, shear_area = 0;
  Real axial_damping = 0, bending_damping = 0;  // DA, DB of *MAT_ELASTIC
  int section_points = 4;
  Real section_s[9] = {}, section_t[9] = {},
       section_weight[9] = {};  // Hughes-Liu: positions [length], area weights
  // mass scaling: time step that lighter elements are brought to; 0: none
  Real mass_scaling_time_step = 0;
};

// What differs from element to element at the start.
template <class L>
struct Given {
  L thickness[4];       // shells, per corner
  Vec3<L> orientation;  // beams: a vector in the r-s plane
};

// Corner data of one pack of elements, relative to the tile's anchor.
template <class L, int N>
struct Corners {
  Vec3<L> x[N];  // position at t(n)
  Vec3<L> v[N];  // velocity at t(n-1/2)
  Vec3<L> w[N];  // angular velocity; only where the element has rotations
};

template <class L, int N>
struct CornerForces {
  Vec3<L> f[N];
  Vec3<L> m[N];
};

template <class L>
struct Totals {
  L internal = L(0.0);  // energy increments of the step
  L hourglass = L(0.0);
  L damping = L(0.0);
  L time_step;        // the element's own stable step, unscaled
  L alive = L(1.0);   // 0: the element has failed and gives no force
  L volume = L(0.0);  // current volume; <= 0 stops the run
};

// History of one pack: reads and writes structs that consist of L members only.
template <class L>
struct StateView {
  Real* block;  // already offset to the first lane of this pack

  FABRICA_FN L load(int field) const {
    if constexpr (LaneTraits<L>::width == 1)
      return L(block[field * block_size]);
    else
      return L::load(block + field * block_size);
  }
  FABRICA_FN void store(int field, const L& value) const {
    if constexpr (LaneTraits<L>::width == 1)
      block[field * block_size] = Real(value);
    else
      value.store(block + field * block_size);
  }
  template <class S>
  FABRICA_FN S get(int field) const {
    constexpr int n = sizeof(S) / sizeof(L);
    S s;
    if constexpr (!std::is_empty_v<S>)
      for (int i = 0; i < n; ++i) reinterpret_cast<L*>(&s)[i] = load(field + i);
    return s;
  }
  template <class S>
  FABRICA_FN void put(int field, const S& s) const {
    constexpr int n = sizeof(S) / sizeof(L);
    if constexpr (!std::is_empty_v<S>)
      for (int i = 0; i < n; ++i) store(field + i, reinterpret_cast<const L*>(&s)[i]);
  }
};

// number of Reals in a state struct
template <class S>
constexpr int fields_of() {
  if constexpr (std::is_empty_v<S>)
    return 0;
  else
    return int(sizeof(S) / sizeof(Real));
}
template <class M>
constexpr int material_fields() {
  return fields_of<typename M::template State<Real>>();
}

// rotates the first M::rotated tensors of a material state with the increment of spin: Jaumann,
// midpoint
template <class L>
FABRICA_FN Sym3<L> jaumann_increment(const Sym3<L>& s, const Vec3<L>& w) {
  // w: rotation increments about x, y, z (half the curl times dt)
  const L two = L(2.0);
  return {two * (s.zx * w.y - s.xy * w.z),
          two * (s.xy * w.z - s.yz * w.x),
          two * (s.yz * w.x - s.zx * w.y),
          (s.xx - s.yy) * w.z + s.yz * w.y - s.zx * w.x,
          (s.yy - s.zz) * w.x + s.zx * w.z - s.xy * w.y,
          (s.zz - s.xx) * w.y + s.xy * w.x - s.yz * w.z};
}
template <class L>
FABRICA_FN Sym3<L> turn(const Sym3<L>& s, const Vec3<L>& w) {
  const Sym3<L> half = s + L(0.5) * jaumann_increment(s, w);
  return s + jaumann_increment(half, w);
}

}  // namespace fabrica
