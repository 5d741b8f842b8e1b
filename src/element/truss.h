#pragma once
// Truss (beam ELFORM 3): two corners, constant area, axial stress only.
//   de = dt v21.xm / (xm.xm),  xm: x21 at mid step, so that a rigid rotation strains nothing    (1)
//   force = s A along x21, stable step = L/c, c = sqrt(E/rho)
#include "element/kernel.h"
#include "material/uniaxial.h"

namespace fabrica {

struct Truss {
  static constexpr int corners = 2;
  static constexpr bool rotations = false;
  static constexpr int stress_field = 0;
  template <class M>
  static constexpr int alive_field = 1;
  template <class M>
  static constexpr int material_field = 1 + (M::can_fail ? 1 : 0);
  template <class M>
  static int state_fields(const ElementParameters&) {
    return material_field<M> + material_fields<M>();
  }

  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters&, const Corners<L, 2>&,
                                    const Given<L>&, StateView<L> s) {
    if constexpr (M::can_fail) s.store(alive_field<M>, L(1.0));
  }
  static void lump(const ElementParameters& p, const Corners<double, 2>& c, const Given<double>&,
                   double (&mass)[2], double (&)[2]) {
    mass[0] = mass[1] = 0.5 * double(p.density) * double(p.area) * norm(c.x[1] - c.x[0]);
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M& material, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 2>& c, StateView<L> s, CornerForces<L, 2>& out,
                                Totals<L>& totals) {
    using MaterialState = typename M::template State<L>;
    const L dt = L(dt_previous), zero = L(0.0);
    const Vec3<L> x21 = c.x[1] - c.x[0], v21 = c.v[1] - c.v[0];
    const Vec3<L> middle = x21 - (L(0.5) * dt) * v21;
    const L length = norm(x21), strain = dt * dot(v21, middle) / dot(middle, middle);
    Point<L> point{dt, L(1.0), length, L(p.bulk + Real(4.0 / 3.0) * p.shear), L(p.shear), L(1.0)};
    const L modulus = point.modulus;
    const Sym3<L> old{s.load(stress_field), zero, zero, zero, zero, zero};
    MaterialState state = s.template get<MaterialState>(material_field<M>);
    Sym3<L> now = uniaxial(material, old, strain, zero, zero, L(1.0), point, state);
    if constexpr (M::can_fail) {
      totals.alive = min(s.load(alive_field<M>), point.alive);
      s.store(alive_field<M>, totals.alive);
      now = totals.alive * now;
    }
    s.store(stress_field, now.xx);
    s.put(material_field<M>, state);

    const L area = L(p.area);
    totals.volume = area * length;
    totals.internal = totals.volume * (L(0.5) * strain * (old.xx + now.xx));
    totals.time_step =
        length / (L(sqrt(p.youngs / p.density)) * sqrt(max(point.modulus / modulus, L(1.0))));
    L stress = now.xx;
    if (p.stiffness_damping != 0) {
      const L beta = p.stiffness_damping > 0 ? L(p.stiffness_damping) * totals.time_step
                                             : L(-p.stiffness_damping);
      const L viscous = totals.alive * beta * L(p.youngs) * strain / max(dt, L(1e-30));
      stress += viscous;
      totals.damping = totals.volume * viscous * strain;
    }
    out.f[0] = (area * stress / length) * x21;
    out.f[1] = -out.f[0];
  }

  // output: axial force first
  template <class M>
  static Sym3<Real> stress(const ElementParameters&, StateView<Real> s, int) {
    return {s.load(stress_field), 0, 0, 0, 0, 0};
  }
  template <class M>
  static Real plastic_strain(const ElementParameters&, StateView<Real> s, int) {
    auto state = s.template get<typename M::template State<Real>>(material_field<M>);
    if constexpr (requires { state.plastic_strain; })
      return state.plastic_strain;
    else
      return 0;
  }
  template <class M>
  static void resultants(const ElementParameters& p, StateView<Real> s, double (&out)[8]) {
    for (double& o : out) o = 0;
    out[0] = double(p.area) * s.load(stress_field);
  }
};

}  // namespace fabrica
