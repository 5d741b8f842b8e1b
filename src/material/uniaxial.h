#pragma once
// Beam and truss fibres from any rate law written in three dimensions: axial strain and two
// transverse shears are given, s_yy = s_zz = s_yz = 0. An isotropic law strains both lateral
// directions alike, e_yy = e_zz = e, and e_yz = 0; e is found by secant steps so that s_yy + s_zz =
// 0. Laws with stress linear in e are exact after the first step. A law may offer its own
//   Sym3<L> uniaxial(const Sym3<L>& old, const Sym3<L>& strain, Point<L>&, State<L>&) const
// (strain.xx, xy, zx are read), which is preferred.
#include "material/point.h"

namespace fabrica {

template <class M, class L>
concept HasUniaxial = requires(const M& m, const Sym3<L>& s, Point<L>& p,
                               typename M::template State<L>& h) {
  m.uniaxial(s, s, p, h);
};

namespace detail {

template <int passes, class L, class M>
FABRICA_FN Sym3<L> free_sides(const M& material, const Sym3<L>& old, Sym3<L>& strain,
                              Point<L>& point, typename M::template State<L>& state) {
  const Elastic e = material.elastic();
  const Real poisson = Real(e.poisson()), stiffness = Real(2 * e.bulk + 2.0 / 3.0 * e.shear);
  const Point<L> start_point = point;
  const typename M::template State<L> start = state;
  auto side_stress = [&](const L& lateral, L& side) {
    point = start_point, state = start;
    strain.yy = lateral, strain.zz = lateral;
    const Sym3<L> s = material.stress(old, strain, point, state);
    side = L(0.5) * (s.yy + s.zz);
    return s;
  };
  L before = L(-poisson) * strain.xx, at_before = L(0.0), at = L(0.0);
  side_stress(before, at_before);
  L now = select(abs(strain.xx) > L(0.0), L(-0.499) * strain.xx, before - at_before / L(stiffness));
  Sym3<L> s = side_stress(now, at);
  for (int i = 0; i < passes; ++i) {
    const L rise = at - at_before, run = now - before;
    const auto flat = abs(rise) <= L(1e-6) * L(stiffness) * abs(run);
    const L step = select(flat, at / L(stiffness), at * run / select(flat, L(1.0), rise));
    before = now, at_before = at;
    now = now - step;
    s = side_stress(now, at);
  }
  s.yy = L(0.0), s.zz = L(0.0), s.yz = L(0.0);
  return s;
}

}  // namespace detail

// Advances one fibre: axial strain increment e_xx, engineering shear increments g_xy, g_zx
// (multiplied by shear_factor). old: stress at t(n-1). Returns the stress at t(n) with yy = zz = yz
// = 0.
template <class L, class M>
FABRICA_FN Sym3<L> uniaxial(const M& material, const Sym3<L>& old, const L& e_xx, const L& g_xy,
                            const L& g_zx, const L& shear_factor, Point<L>& point,
                            typename M::template State<L>& state) {
  static_assert(!M::total, "laws of the deformation gradient have no uniaxial form");
  const L transverse = L(0.5) * shear_factor, zero = L(0.0);
  Sym3<L> strain{e_xx, zero, zero, transverse * g_xy, zero, transverse * g_zx};
  if constexpr (HasUniaxial<M, L>)
    return material.uniaxial(old, strain, point, state);
  else
    return detail::free_sides<4>(material, old, strain, point, state);
}

}  // namespace fabrica
