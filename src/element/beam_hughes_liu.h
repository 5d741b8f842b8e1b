#pragma once
// Hughes-Liu beam (ELFORM 1): one point along the axis, points (s, t) in the section, stress by the
// uniaxial law. With the relative rotations d_I of beam.h, k = (d2 - d1)/L:
//   exx = e + t k_y - s k_z,   2exy = -mean d_z - t k_x,   2exz = mean d_y + s k_x              (1)
// Forces are the transposes. The point's area is area * weight / sum of weights.
// Source: Hughes and Liu, CMAME 26 and 27 (1981); one-point form as in Hallquist, theory manual
// (public).
#include "element/beam.h"
#include "material/uniaxial.h"

namespace fabrica {

struct BeamHughesLiu {
  static constexpr int corners = 2;
  static constexpr bool rotations = true;
  // history: e2, resultants N Qs Qt Ms Mt T, points
  static constexpr int axis_field = 0, resultant_field = 3, points_field = 9;
  template <class M>
  static constexpr int material_field = 3 + (M::can_fail ? 1 : 0);
  template <class M>
  static constexpr int stride = material_field<M> + material_fields<M>();

  template <class M>
  static int state_fields(const ElementParameters& p) {
    return points_field + stride<M> * p.section_points;
  }
  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters& p, const Corners<L, 2>& c,
                                    const Given<L>& g, StateView<L> s) {
    s.put(axis_field, beam_axis(c, g.orientation));
    if constexpr (M::can_fail)
      for (int q = 0; q < p.section_points; ++q) s.store(points_field + q * stride<M> + 3, L(1.0));
  }
  static void lump(const ElementParameters& p, const Corners<double, 2>& c, const Given<double>&,
                   double (&mass)[2], double (&inertia)[2]) {
    lump_beam(p, c, mass, inertia);
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M& material, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 2>& c, StateView<L> s, CornerForces<L, 2>& out,
                                Totals<L>& totals) {
    using MaterialState = typename M::template State<L>;
    const L dt = L(dt_previous), zero = L(0.0), half = L(0.5);
    const BeamFrame<L> e(c, dt, s.template get<Vec3<L>>(axis_field));
    s.put(axis_field, e.e2);
    const Vec3<L> k = (L(1.0) / e.length) * (e.d[1] - e.d[0]);
    const L shear_s = -(half * (e.d[0].z + e.d[1].z)), shear_t = half * (e.d[0].y + e.d[1].y);
    const Point<L> start{dt,         L(1.0), e.length, L(p.bulk + Real(4.0 / 3.0) * p.shear),
                         L(p.shear), L(1.0)};
    L modulus = start.modulus, work = zero;
    L r[6] = {zero, zero, zero, zero, zero, zero};
    Real weights = 0;
    for (int q = 0; q < p.section_points; ++q) weights += p.section_weight[q];
    if constexpr (M::can_fail) totals.alive = zero;
    for (int q = 0; q < p.section_points; ++q) {
      StateView<L> at{s.block + (points_field + q * stride<M>)*block_size};
      const L S = L(p.section_s[q]), T = L(p.section_t[q]),
              area = L(p.area * p.section_weight[q] / weights);
      const L xx = e.axial + T * k.y - S * k.z, xy = fma(-T, k.x, shear_s),
              zx = fma(S, k.x, shear_t);
      const Sym3<L> old{at.load(0), zero, zero, at.load(1), zero, at.load(2)};
      MaterialState state = at.template get<MaterialState>(material_field<M>);
      Point<L> point = start;
      Sym3<L> now = uniaxial(material, old, xx, xy, zx, L(p.shear_factor), point, state);
      if constexpr (M::can_fail) {
        const L alive = min(at.load(3), point.alive);
        at.store(3, alive);
        totals.alive = max(totals.alive, alive);
        now = alive * now;
      }
      at.store(0, now.xx), at.store(1, now.xy), at.store(2, now.zx);
      at.put(material_field<M>, state);
      modulus = max(modulus, point.modulus);
      const L axial = area * now.xx, across_s = area * now.xy, across_t = area * now.zx;
      r[0] += axial, r[1] += across_s, r[2] += across_t;
      r[3] = fma(T, axial, r[3]), r[4] = fma(-S, axial, r[4]);
      r[5] += S * across_t - T * across_s;
      const L sum = fma(old.xx + now.xx, xx, fma(old.xy + now.xy, xy, (old.zx + now.zx) * zx));
      work = fma(half * area, sum, work);
    }
    for (int i = 0; i < 6; ++i) s.store(resultant_field + i, r[i]);
    totals.internal = e.length * work;
    totals.volume = L(p.area) * e.length;
    totals.time_step = e.length / (L(sqrt(p.youngs / p.density)) * sqrt(modulus / start.modulus));
    if (p.stiffness_damping != 0) damp(p, e, k, shear_s, shear_t, dt, r, totals);
    corner_forces(e, r, out);
  }

  // output: axial, shear s, t, moment s, t, torsion
  template <class M>
  static void resultants(const ElementParameters&, StateView<Real> s, double (&out)[8]) {
    for (double& o : out) o = 0;
    for (int i = 0; i < 6; ++i) out[i] = s.load(resultant_field + i);
  }
  template <class M>
  static Sym3<Real> stress(const ElementParameters&, StateView<Real> s, int q) {
    const StateView<Real> at{s.block + (points_field + q * stride<M>)*block_size};
    return {at.load(0), 0, 0, at.load(1), 0, at.load(2)};
  }
  template <class M>
  static Real plastic_strain(const ElementParameters&, StateView<Real> s, int q) {
    const StateView<Real> at{s.block + (points_field + q * stride<M>)*block_size};
    auto state = at.template get<typename M::template State<Real>>(material_field<M>);
    if constexpr (requires { state.plastic_strain; })
      return state.plastic_strain;
    else
      return 0;
  }

 private:
  // beta C : D on the section: axial, shear and the two moments
  template <class L>
  FABRICA_FN static void damp(const ElementParameters& p, const BeamFrame<L>& e, const Vec3<L>& k,
                              const L& shear_s, const L& shear_t, const L& dt, L (&r)[6],
                              Totals<L>& totals) {
    const L beta = p.stiffness_damping > 0 ? L(p.stiffness_damping) * totals.time_step
                                           : L(-p.stiffness_damping);
    const L rate = totals.alive * beta / max(dt, L(1e-30));
    const L u[5] = {e.axial, shear_s, shear_t, k.y, k.z};
    const Real c[5] = {p.youngs * p.area, p.shear_factor * p.shear * p.area,
                       p.shear_factor * p.shear * p.area, p.youngs * p.iss, p.youngs * p.itt};
    for (int i = 0; i < 5; ++i) {
      const L viscous = rate * L(c[i]) * u[i];
      r[i] += viscous;
      totals.damping += e.length * viscous * u[i];
    }
  }
  template <class L>
  FABRICA_FN static void corner_forces(const BeamFrame<L>& e, const L (&r)[6],
                                       CornerForces<L, 2>& out) {
    const L half = L(0.5) * e.length;
    out.f[0] = e.global({r[0], r[1], r[2]});
    out.f[1] = -out.f[0];
    const Vec3<L> bend = e.global({r[5], r[3], r[4]}),
                  lever = e.global({L(0.0), -(half * r[2]), half * r[1]});
    out.m[0] = bend + lever, out.m[1] = lever - bend;
  }
};

}  // namespace fabrica
