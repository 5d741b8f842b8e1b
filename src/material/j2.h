#pragma once
// Return mapping of von Mises plasticity with isotropic and linear kinematic hardening, in three
// dimensions and in plane stress, where transverse shear flows with the rest or stays elastic.
//   xi = s - a,   q^2 = 3/2 dev(xi):dev(xi),   q <= Y(ep + dep),   dep = 2/3 lambda q      (1)
//   d(plastic strain) = lambda dev(xi),   da = 2/3 Hk lambda dev(xi)
//   q(lambda)^2 = A / (1 + ca lambda)^2 + B / (1 + cb lambda)^2,   cb = 2G + 2/3 Hk        (2)
//     three dimensions: A = 0, B = q_trial^2
//     plane stress: A = (xx+yy)^2/4, B = 3/4 (yy-xx)^2 + 3 (xy^2+yz^2+zx^2),
//       ca = E/(3(1-nu)) + 2/3 Hk
// xi of plane stress is s - (a - a_zz I), so that its zz part vanishes.
// Source: Simo and Taylor, Int. J. Num. Meth. Eng. 22 (1986); Simo and Hughes, Computational
// Inelasticity, ch. 3.
#include "material/lookup.h"
#include "material/point.h"

namespace fabrica {

struct J2Moduli {
  Real bulk, shear, kinematic;  // K, G, Hk
  FABRICA_FN Real youngs() const { return 9 * bulk * shear / (3 * bulk + shear); }
  FABRICA_FN Real poisson() const { return (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear)); }
};

// q(lambda) of equation (2), over x = cb lambda; ratio = ca / cb
template <class L>
struct J2Modes {
  L A, B;
  Real ratio, cb;

  // q^2 and, in fall, -q dq/dx
  template <bool plane>
  FABRICA_FN L square(const L& x, L& fall) const {
    const L pb = L(1.0) + x;
    if constexpr (plane) {
      // one division for both reciprocals
      const L pa = fma(L(ratio), x, L(1.0));
      const L r = L(1.0) / (pa * pb);
      const L a = pb * r, b = pa * r;
      const L part_a = A * a * a, part_b = B * b * b;
      fall = fma(part_a * L(ratio), a, part_b * b);
      return part_a + part_b;
    } else {
      const L b = L(1.0) / pb, part_b = B * b * b;
      fall = part_b * b;
      return part_b;
    }
  }
};

// lambda of the yield condition q = Y(dep) where the yield stress depends on the plastic increment
// through yield(dep, slope): Newton on Y/q - 1, which is nearly linear in lambda. Trial states
// inside the yield surface give 0.
template <bool plane, int passes, class L, class Yield>
FABRICA_FN L j2_newton(const J2Modes<L>& modes, const Yield& yield) {
  const L per_x = L(Real(2.0 / 3.0) / modes.cb);
  L x = L(0.0);
  for (int i = 0; i < passes; ++i) {
    L fall = L(0.0), hardening = L(0.0);
    const L square = modes.template square<plane>(x, fall), q = sqrt(square);
    const L Y = yield(per_x * x * q, hardening);
    const L slope = fma(per_x * hardening * q, fma(-x, fall, square), Y * fall);
    x = max(fma((q - Y) / max(slope, L(1e-30)), square, x), L(0.0));
  }
  return x * L(1 / modes.cb);
}

// The same where the slope of the yield stress is unbounded at small rates: regula falsi (Anderson
// and Bjorck 1973) on cb lambda = bound root^4, 0 <= root <= 1; bound follows from the static yield
// stress, the least that Y can be.
template <bool plane, int passes, class L, class Yield>
FABRICA_FN L j2_bracket(const J2Modes<L>& modes, const L& q_trial, const L& static_yield,
                        const Yield& yield) {
  const Real least = plane && modes.ratio < 1 ? modes.ratio : Real(1);
  const L excess = q_trial / max(static_yield, L(1e-6) * q_trial + L(1e-30)) - L(1.0);
  const L bound = max(excess, L(0.0)) * L(1 / least);
  const L per_x = L(Real(2.0 / 3.0) / modes.cb);
  auto residual = [&](const L& root) {
    L fall = L(0.0), hardening = L(0.0);
    const L second = root * root, x = bound * second * second;
    const L q = sqrt(modes.template square<plane>(x, fall));
    return q - yield(per_x * x * q, hardening);
  };
  // a and b enclose the root, b is the newer
  L a = L(0.0), at_a = q_trial - static_yield, b = L(1.0), at_b = residual(b), root = b;
  for (int i = 0; i < passes; ++i) {
    const L rise = at_b - at_a;
    const auto flat = rise == L(0.0);
    root = select(flat, b,
                  clamp(b - at_b * (b - a) / select(flat, L(1.0), rise), min(a, b), max(a, b)));
    const L at = residual(root);
    // an end that stays is weighted down, or the secant creeps
    const auto crossed = ((at > L(0.0)) & (at_b <= L(0.0))) | ((at <= L(0.0)) & (at_b > L(0.0)));
    const L weight = L(1.0) - at / select(at_b == L(0.0), L(1.0), at_b);
    const L kept = at_a * select(weight > L(0.0), weight, L(0.5));
    a = select(crossed, b, a), at_a = select(crossed, at_b, kept);
    b = root, at_b = at;
  }
  const L second = root * root;
  return select(q_trial > static_yield, bound * second * second, L(0.0)) * L(1 / modes.cb);
}

// Laws without kinematic hardening: no back stress.
template <class L>
FABRICA_FN Sym3<L> j2_no_back() {
  return {L(0.0), L(0.0), L(0.0), L(0.0), L(0.0), L(0.0)};
}

// Whether points fail at a plastic strain; decks write 1e20 or 1e21 where nothing is to fail.
FABRICA_FN bool j2_may_fail(Real failure_strain) {
  return failure_strain > 0 && failure_strain < Real(1e20);
}

// Adds an increment to the plastic strain; the point fails beyond the failure strain, 0: never.
template <class L>
FABRICA_FN void j2_take_up(const L& increment, Real failure_strain, Point<L>& point,
                           L& plastic_strain) {
  plastic_strain += increment;
  if (failure_strain > 0)
    point.alive = select(plastic_strain > L(failure_strain), L(0.0), point.alive);
}

// Strain increments completed for the rate measure: yield matters where the material flows, and
// flow keeps volume.
template <class L>
FABRICA_FN Sym3<L> plane_flow_strain(const Sym3<L>& strain) {
  return {strain.xx, strain.yy, -(strain.xx + strain.yy), strain.xy, strain.yz, strain.zx};
}
template <class L>
FABRICA_FN Sym3<L> fibre_flow_strain(const Sym3<L>& strain) {
  const L lateral = L(-0.5) * strain.xx;
  return {strain.xx, lateral, lateral, strain.xy, L(0.0), strain.zx};
}

// Elastic trial in three dimensions: the whole stress and the trial xi with its modes.
template <class L>
struct J2Trial {
  Sym3<L> stress, xi;
  J2Modes<L> modes;
  L q;
};

template <class L>
FABRICA_FN J2Trial<L> j2_trial(const J2Moduli& m, const Sym3<L>& old, const Sym3<L>& strain,
                               const Sym3<L>& back) {
  J2Trial<L> t;
  const L volumetric = trace(strain) * L(m.bulk - Real(2.0 / 3.0) * m.shear);
  t.stress = plus_sphere(old + L(2 * m.shear) * strain, volumetric);
  t.xi = deviator(t.stress) - back;
  const L square = L(1.5) * ddot(t.xi, t.xi);
  t.q = sqrt(square);
  t.modes = {L(0.0), square, Real(0), 2 * m.shear + Real(2.0 / 3.0) * m.kinematic};
  return t;
}

// Elastic trial of a beam or truss fibre: s_yy = s_zz = s_yz = 0; strain.xx, xy, zx are read.
//   A = xi_xx^2, B = 3 (xy^2 + zx^2), ca = 2/3 (E + Hk), xi_xx = s_xx - 3/2 a_xx
template <class L>
FABRICA_FN J2Trial<L> j2_fibre_trial(const J2Moduli& m, const Sym3<L>& old, const Sym3<L>& strain,
                                     const Sym3<L>& back) {
  const L zero = L(0.0), twice = L(2 * m.shear);
  J2Trial<L> t;
  t.stress = {fma(L(m.youngs()), strain.xx, old.xx), zero, zero,
              fma(twice, strain.xy, old.xy),         zero, fma(twice, strain.zx, old.zx)};
  t.xi = {t.stress.xx - L(1.5) * back.xx, zero, zero,
          t.stress.xy - back.xy,          zero, t.stress.zx - back.zx};
  const Real hardening = Real(2.0 / 3.0) * m.kinematic, cb = 2 * m.shear + hardening;
  t.modes = {t.xi.xx * t.xi.xx, L(3.0) * fma(t.xi.xy, t.xi.xy, t.xi.zx * t.xi.zx),
             (Real(2.0 / 3.0) * m.youngs() + hardening) / cb, cb};
  t.q = sqrt(t.modes.A + t.modes.B);
  return t;
}

// Fibre stress after the flow lambda.
template <class L>
FABRICA_FN Sym3<L> j2_fibre_finish(const J2Moduli& m, const J2Trial<L>& t, const L& lambda,
                                   Sym3<L>* back, L& increment) {
  const L x = L(t.modes.cb) * lambda, pa = fma(L(t.modes.ratio), x, L(1.0)), pb = L(1.0) + x;
  const L r = L(1.0) / (pa * pb), a = pb * r, b = pa * r, zero = L(0.0), twice = L(2 * m.shear);
  increment = L(2.0 / 3.0) * lambda * sqrt(fma(t.modes.A * a, a, t.modes.B * b * b));
  const L axial = L(2.0 / 3.0) * lambda * a * t.xi.xx;
  const Sym3<L> flow{axial, L(-0.5) * axial,     L(-0.5) * axial, lambda * b * t.xi.xy,
                     zero,  lambda * b * t.xi.zx};
  if (back) *back += L(Real(2.0 / 3.0) * m.kinematic) * flow;
  return {t.stress.xx - L(m.youngs()) * axial, zero, zero,
          t.stress.xy - twice * flow.xy,       zero, t.stress.zx - twice * flow.zx};
}

// Stress after the flow lambda; moves the back stress and returns dep in `increment`.
template <class L>
FABRICA_FN Sym3<L> j2_finish(const J2Moduli& m, const J2Trial<L>& t, const L& lambda, Sym3<L>* back,
                             L& increment) {
  const L scale = L(1.0) / fma(L(t.modes.cb), lambda, L(1.0));
  const L flow = lambda * scale;
  increment = L(2.0 / 3.0) * flow * t.q;
  if (back) *back += (L(Real(2.0 / 3.0) * m.kinematic) * flow) * t.xi;
  return t.stress - (L(2 * m.shear) * flow) * t.xi;
}

// Whether transverse shear of plane stress takes part in the yield function.
enum class TransverseShear { flows, elastic };

// Elastic trial in plane stress; strain.zz is not read.
template <TransverseShear across, class L>
FABRICA_FN J2Trial<L> j2_plane_trial(const J2Moduli& m, const Sym3<L>& old, const Sym3<L>& strain,
                                     const Sym3<L>& back) {
  const Real E = m.youngs(), nu = m.poisson(), c = E / (1 - nu * nu);
  const L direct = L(c), cross = L(nu * c), twice = L(2 * m.shear);
  J2Trial<L> t;
  t.stress.xx = fma(direct, strain.xx, fma(cross, strain.yy, old.xx));
  t.stress.yy = fma(direct, strain.yy, fma(cross, strain.xx, old.yy));
  t.stress.zz = L(0.0);
  t.stress.xy = fma(twice, strain.xy, old.xy);
  t.stress.yz = fma(twice, strain.yz, old.yz);
  t.stress.zx = fma(twice, strain.zx, old.zx);
  t.xi = plus_sphere(t.stress - back, back.zz);
  if constexpr (across == TransverseShear::elastic) t.xi.yz = t.xi.zx = L(0.0);
  const L sum = t.xi.xx + t.xi.yy, difference = t.xi.yy - t.xi.xx;
  const L shear = fma(t.xi.xy, t.xi.xy, fma(t.xi.yz, t.xi.yz, t.xi.zx * t.xi.zx));
  const Real hardening = Real(2.0 / 3.0) * m.kinematic;
  const Real cb = 2 * m.shear + hardening;
  t.modes = {L(0.25) * sum * sum, fma(L(0.75), difference * difference, L(3.0) * shear),
             (E / (3 * (1 - nu)) + hardening) / cb, cb};
  t.q = sqrt(t.modes.A + t.modes.B);
  return t;
}

// Plane stress after the flow lambda; dzz is the thickness strain increment, elastic and plastic.
template <class L>
FABRICA_FN Sym3<L> j2_plane_finish(const J2Moduli& m, const Sym3<L>& old, const J2Trial<L>& t,
                                   const L& lambda, Sym3<L>* back, L& increment, L& dzz) {
  const L x = L(t.modes.cb) * lambda, pa = fma(L(t.modes.ratio), x, L(1.0)), pb = L(1.0) + x;
  const L r = L(1.0) / (pa * pb), a = pb * r, b = pa * r;
  const L sum = a * (t.xi.xx + t.xi.yy), difference = b * (t.xi.yy - t.xi.xx);
  const L half = L(0.5);
  const Sym3<L> xi{half * (sum - difference),
                   half * (sum + difference),
                   L(0.0),
                   b * t.xi.xy,
                   b * t.xi.yz,
                   b * t.xi.zx};
  const L third = sum * L(1.0 / 3.0);
  const Sym3<L> flow = lambda * plus_sphere(xi, -third);
  increment = L(2.0 / 3.0) * lambda * sqrt(fma(t.modes.A * a, a, t.modes.B * b * b));
  // stress = trial - C : flow, in the plane; the elastic lanes keep their trial stress to the bit
  const Real E = m.youngs(), nu = m.poisson(), c = E / (1 - nu * nu);
  const L twice = L(2 * m.shear);
  const Sym3<L> stress{t.stress.xx - L(c) * fma(L(nu), flow.yy, flow.xx),
                       t.stress.yy - L(c) * fma(L(nu), flow.xx, flow.yy),
                       L(0.0),
                       t.stress.xy - twice * flow.xy,
                       t.stress.yz - twice * flow.yz,
                       t.stress.zx - twice * flow.zx};
  dzz = fma(L(-nu / E), (stress.xx - old.xx) + (stress.yy - old.yy), flow.zz);
  if (back) *back += L(Real(2.0 / 3.0) * m.kinematic) * flow;
  return stress;
}

// The step of a law without back stress: trial, the flow lambda that flow(trial) gives, its stress.
// Failure as j2_take_up.
template <class L, class Flow>
FABRICA_FN Sym3<L> j2_isotropic(const J2Moduli& m, const Sym3<L>& old, const Sym3<L>& strain,
                                Real failure_strain, Point<L>& point, L& plastic_strain,
                                const Flow& flow) {
  const J2Trial<L> trial = j2_trial(m, old, strain, j2_no_back<L>());
  L increment;
  const Sym3<L> s = j2_finish(m, trial, flow(trial), static_cast<Sym3<L>*>(nullptr), increment);
  j2_take_up(increment, failure_strain, point, plastic_strain);
  return s;
}
// The same in plane stress, transverse shear flows with the rest.
template <class L, class Flow>
FABRICA_FN Sym3<L> j2_isotropic_plane(const J2Moduli& m, const Sym3<L>& old, const Sym3<L>& strain,
                                      Real failure_strain, Point<L>& point, L& plastic_strain,
                                      L& dzz, const Flow& flow) {
  const J2Trial<L> trial = j2_plane_trial<TransverseShear::flows>(m, old, strain, j2_no_back<L>());
  L increment;
  const Sym3<L> s =
      j2_plane_finish(m, old, trial, flow(trial), static_cast<Sym3<L>*>(nullptr), increment, dzz);
  j2_take_up(increment, failure_strain, point, plastic_strain);
  return s;
}

}  // namespace fabrica
