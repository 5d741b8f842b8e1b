#pragma once
// Belytschko-Schwer beam (ELFORM 2): elastic resultants in a frame that turns with the chord; axes
// r, s, t = e1, e2, e3.
//   N = E A dL/L0,  dL = sum of (L^2 - L(old)^2)/(L + L(old)),   T = G J (phi2 - phi1)_r / L0
//   M1 = E I/(L0 (1+P)) [(4+P) phi1 + (2-P) phi2],  M2 likewise
//   P = 12 E I/(G As L0^2), 0 where As = 0                                                      (1)
// about s with Iss, about t with Itt; phi: rotation vectors of the end sections relative to E
// (beam.h). The sum keeps small stretches free of the rounding of L. Shear from equilibrium of
// moments. Damping DA, DB: the fraction of critical of the highest axial mode, N and T with beta =
// DA L/c, M with beta = DB L/c.
// Stable step: min of L/c and L/(2 c sqrt(3 I (3/(12 I + A L^2) + 1/(A L^2))))                  (2)
// Source: Belytschko, Schwer, Klein, Int. J. Num. Meth. Eng. 11 (1977) 65.
#include "element/beam.h"

namespace fabrica {

struct BeamSchwer {
  static constexpr int corners = 2;
  static constexpr bool rotations = true;
  // history: length at the start, e2, rotations of the ends, resultants N T Ms1 Ms2 Mt1 Mt2, dL
  static constexpr int length_field = 0, axis_field = 1, rotation_field = 4, resultant_field = 10;
  static constexpr int stretch_field = 16, fields = 17;

  template <class M>
  static int state_fields(const ElementParameters&) {
    return fields;
  }
  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters&, const Corners<L, 2>& c,
                                    const Given<L>& g, StateView<L> s) {
    s.store(length_field, norm(c.x[1] - c.x[0]));
    s.put(axis_field, beam_axis(c, g.orientation));
  }
  static void lump(const ElementParameters& p, const Corners<double, 2>& c, const Given<double>&,
                   double (&mass)[2], double (&inertia)[2]) {
    lump_beam(p, c, mass, inertia);
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M&, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 2>& c, StateView<L> s, CornerForces<L, 2>& out,
                                Totals<L>& totals) {
    const L dt = L(dt_previous);
    const BeamFrame<L> e(c, dt, s.template get<Vec3<L>>(axis_field));
    s.put(axis_field, e.e2);
    // A(new) = exp(d) A(old): rotation vectors add up to the first commutator
    Vec3<L> phi[2];
    for (int a = 0; a < 2; ++a) {
      phi[a] = s.template get<Vec3<L>>(rotation_field + 3 * a);
      phi[a] += e.d[a] + L(0.5) * cross(e.d[a], phi[a]);
      s.put(rotation_field + 3 * a, phi[a]);
    }
    const L initial = s.load(length_field), inverse = L(1.0) / initial;
    const L stretch = s.load(stretch_field) + e.stretch;
    s.store(stretch_field, stretch);
    L r[6], rate[6] = {e.stretch, e.d[1].x - e.d[0].x, e.d[0].y, e.d[1].y, e.d[0].z, e.d[1].z};
    const L deformation[6] = {stretch, phi[1].x - phi[0].x, phi[0].y, phi[1].y, phi[0].z, phi[1].z};
    resultants(p, inverse, deformation, r);
    L internal = L(0.0);
    for (int k = 0; k < 6; ++k) {
      internal = fma(L(0.5) * (s.load(resultant_field + k) + r[k]), rate[k], internal);
      s.store(resultant_field + k, r[k]);
    }
    totals.internal = internal;
    totals.volume = L(p.area) * e.length;
    totals.time_step = stable_step(p, e.length);
    if (p.axial_damping != 0 || p.bending_damping != 0) {
      L viscous[6];
      resultants(p, inverse, rate, viscous);
      const L scale = initial / (L(sqrt(p.youngs / p.density)) * max(dt, L(1e-30)));
      for (int k = 0; k < 6; ++k) {
        viscous[k] *= L(k < 2 ? p.axial_damping : p.bending_damping) * scale;
        totals.damping = fma(viscous[k], rate[k], totals.damping);
        r[k] += viscous[k];
      }
    }
    corner_forces(e, r, out);
  }

  // output: axial, shear s, t, moment s, t (first end), torsion, moment s, t (second end)
  template <class M>
  static void resultants(const ElementParameters&, StateView<Real> s, double (&out)[8]) {
    double r[6];
    for (int k = 0; k < 6; ++k) r[k] = s.load(resultant_field + k);
    const double length = s.load(length_field);
    out[0] = r[0], out[1] = -(r[4] + r[5]) / length, out[2] = (r[2] + r[3]) / length;
    out[3] = r[2], out[4] = r[4], out[5] = r[1], out[6] = r[3], out[7] = r[5];
  }

 private:
  // equation (1): N T Ms1 Ms2 Mt1 Mt2
  template <class L>
  FABRICA_FN static void resultants(const ElementParameters& p, const L& inverse, const L (&u)[6],
                                    L (&r)[6]) {
    const Real J = p.torsion != 0 ? p.torsion : p.iss + p.itt;
    r[0] = L(p.youngs * p.area) * inverse * u[0];
    r[1] = L(p.shear * J) * inverse * u[1];
    for (int k = 0; k < 2; ++k) {
      const Real stiffness = p.youngs * (k ? p.itt : p.iss);
      const Real flexible = p.shear_area > 0 ? 12 * stiffness / (p.shear * p.shear_area) : Real(0);
      const L P = L(flexible) * inverse * inverse, b = L(stiffness) * inverse / (L(1.0) + P);
      const L& first = u[2 + 2 * k];
      const L& second = u[3 + 2 * k];
      r[2 + 2 * k] = b * fma(L(4.0) + P, first, (L(2.0) - P) * second);
      r[3 + 2 * k] = b * fma(L(4.0) + P, second, (L(2.0) - P) * first);
    }
  }
  // equation (2)
  template <class L>
  FABRICA_FN static L stable_step(const ElementParameters& p, const L& length) {
    const L I = L(p.iss > p.itt ? p.iss : p.itt), slender = L(p.area) * length * length;
    const L bending = sqrt(L(3.0) * I * (L(3.0) / fma(L(12.0), I, slender) + L(1.0) / slender));
    return length / (L(sqrt(p.youngs / p.density)) * max(L(1.0), L(2.0) * bending));
  }
  template <class L>
  FABRICA_FN static void corner_forces(const BeamFrame<L>& e, const L (&r)[6],
                                       CornerForces<L, 2>& out) {
    const L inverse = L(1.0) / e.length;
    const Vec3<L> f{r[0], -(inverse * (r[4] + r[5])), inverse * (r[2] + r[3])};
    out.f[0] = e.global(f);
    out.f[1] = -out.f[0];
    out.m[0] = e.global({r[1], -r[2], -r[4]});
    out.m[1] = e.global({-r[1], -r[3], -r[5]});
  }
};

}  // namespace fabrica
