#pragma once
// Plane stress for shells from any rate law written in three dimensions.
// The thickness strain increment e_zz is found so that s_zz(e_zz) = 0 by secant steps from two
// guesses:
//   e0 = -nu/(1-nu) (e_xx + e_yy)  elastic,     e1 = -(e_xx + e_yy)  constant volume (1)
// Laws with s_zz linear in e_zz are exact after the first secant step. A law may offer its own
//   Sym3<L> plane_stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>&, State<L>&, L& dzz)
//   const
// (strain.zz is not read), which is preferred. Source: Hallquist, LS-DYNA theory manual (public),
// plane stress.
#include "material/point.h"

namespace fabrica {

template <class M, class L>
concept HasPlaneStress = requires(const M& m, const Sym3<L>& s, Point<L>& p,
                                  typename M::template State<L>& h, L& d) {
  m.plane_stress(s, s, p, h, d);
};

namespace detail {

// Secant search on one strain component: returns the stress with s_zz = 0 and the strain with its
// zz set.
template <int passes, class L, class M>
FABRICA_FN Sym3<L> free_thickness(const M& material, const Sym3<L>& old, Sym3<L>& strain,
                                  Point<L>& point, typename M::template State<L>& state) {
  const Elastic e = material.elastic();
  const Real ratio = Real((e.bulk - 2.0 / 3.0 * e.shear) / (e.bulk + 4.0 / 3.0 * e.shear));
  const Real wave = Real(e.bulk + 4.0 / 3.0 * e.shear);
  const L plane = strain.xx + strain.yy;
  const Point<L> start_point = point;
  const typename M::template State<L> start = state;
  auto normal_stress = [&](const L& zz) {
    point = start_point, state = start;
    strain.zz = zz;
    return material.stress(old, strain, point, state);
  };
  // the old normal stress is zero but for a change of the law's parameters in time
  L before = fma(L(-ratio), plane, -(old.zz / L(wave)));
  L at_before = normal_stress(before).zz;
  L now = select(abs(plane) > L(0.0), -plane, before - at_before / L(wave));
  Sym3<L> s = normal_stress(now);
  for (int i = 0; i < passes; ++i) {
    const L rise = s.zz - at_before, run = now - before;
    // where the secant has no slope left, the elastic slope serves
    const auto flat = abs(rise) <= L(1e-6) * L(wave) * abs(run);
    const L step = select(flat, s.zz / L(wave), s.zz * run / select(flat, L(1.0), rise));
    before = now, at_before = s.zz;
    now = now - step;
    s = normal_stress(now);
  }
  s.zz = L(0.0);
  return s;
}

}  // namespace detail

// Advances one shell point: in-plane strain increments e_xx, e_yy, engineering shear increments
// g_xy, g_yz, g_zx (the transverse ones are multiplied by shear_factor). old: stress at t(n-1),
// turned to t(n), zz = 0. Returns the stress at t(n) with zz = 0 and, in dzz, the thickness strain
// increment.
template <class L, class M>
FABRICA_FN Sym3<L> plane_stress(const M& material, const Sym3<L>& old, const L& e_xx, const L& e_yy,
                                const L& g_xy, const L& g_yz, const L& g_zx, const L& shear_factor,
                                Point<L>& point, typename M::template State<L>& state, L& dzz) {
  static_assert(!M::total, "laws of the deformation gradient have no plane stress form");
  const L half = L(0.5), transverse = half * shear_factor;
  Sym3<L> strain{e_xx, e_yy, L(0.0), half * g_xy, transverse * g_yz, transverse * g_zx};
  if constexpr (HasPlaneStress<M, L>) {
    return material.plane_stress(old, strain, point, state, dzz);
  } else {
    const Sym3<L> s = detail::free_thickness<4>(material, old, strain, point, state);
    dzz = strain.zz;
    return s;
  }
}

}  // namespace fabrica
