#pragma once
// Von Mises plasticity with an arbitrary hardening curve and rate effects
// (*MAT_PIECEWISE_LINEAR_PLASTICITY, 024).
//   Y = S(ep) f(r)             f = 1 + (r/C)^(1/P), or the curve LCSR                      (1)
//   Y = S(ep) + S0 (r/C)^(1/P) with VP = 1; S0 = SIGY, or S(0) where SIGY is blank         (2)
//   Y = table(ep, r)           where LCSS is a table                                       (3)
// S: curve LCSS, or points EPS/ES, or SIGY + Ep ep with Ep = E ETAN / (E - ETAN).
// r: VP = 0: sqrt(D:D); VP = -1: effective deviatoric rate sqrt(2/3 D':D'); VP = 1: rate of ep.
// A point fails where ep > FAIL. Return mapping: j2.h.
// Source: Simo and Hughes, Computational Inelasticity, ch. 3; Cowper and Symonds 1957.
#include "material/j2.h"

namespace fabrica {

struct PiecewiseLinearPlasticity {
  static constexpr std::string_view keyword = "MAT_PIECEWISE_LINEAR_PLASTICITY";
  static constexpr unsigned families = in_solids | in_shells | in_beams;
  static constexpr bool total = false, can_fail = true;
  static constexpr int rotated = 0;

  Real density = 0;
  J2Moduli moduli{};        // K, G [stress]
  Real yield_stress = 0;    // SIGY [stress]
  Real hardening = 0;       // Ep [stress]
  Real failure_strain = 0;  // FAIL; 0: none
  Real rate_constant = 0;   // C [1/time]; 0: none
  Real rate_exponent = 0;   // 1 / P
  int rate_form = 0;        // VP
  CurveView curve;          // LCSS
  TableView table;          // LCSS as a table
  CurveView rate_curve;     // LCSR
  int points = 0;           // EPS/ES pairs in use
  Real strain_points[8] = {}, stress_points[8] = {};

  template <class L>
  struct State {
    L plastic_strain;  // ep
  };

  static PiecewiseLinearPlasticity from(const Parameters& p);
  Elastic elastic() const { return {density, moduli.bulk, moduli.shear}; }
  bool may_fail() const { return j2_may_fail(failure_strain); }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                            State<L>& state) const {
    return j2_isotropic(
        moduli, old, strain, failure_strain, point, state.plastic_strain,
        [&](const J2Trial<L>& trial) { return flow<false>(trial, strain, point, state); });
  }

  template <class L>
  FABRICA_FN Sym3<L> plane_stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                                  State<L>& state, L& dzz) const {
    return j2_isotropic_plane(moduli, old, strain, failure_strain, point, state.plastic_strain, dzz,
                              [&](const J2Trial<L>& trial) {
                                return flow<true>(trial, plane_flow_strain(strain), point, state);
                              });
  }

  template <class L>
  FABRICA_FN Sym3<L> uniaxial(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                              State<L>& state) const {
    const J2Trial<L> trial = j2_fibre_trial(moduli, old, strain, j2_no_back<L>());
    const L lambda = flow<true>(trial, fibre_flow_strain(strain), point, state);
    L increment;
    const Sym3<L> s =
        j2_fibre_finish(moduli, trial, lambda, static_cast<Sym3<L>*>(nullptr), increment);
    j2_take_up(increment, failure_strain, point, state.plastic_strain);
    return s;
  }

 private:
  FABRICA_FN bool rate_dependent() const {
    return rate_constant > 0 || bool(rate_curve) || bool(table);
  }

  // S(ep) of equation (1)
  template <class L>
  FABRICA_FN L static_yield(const L& ep, L& slope) const {
    if (curve) return lookup(curve, ep, slope);
    if (points > 0) return lookup(CurveView{strain_points, stress_points, points, true}, ep, slope);
    slope = L(hardening);
    return fma(L(hardening), ep, L(yield_stress));
  }
  template <class L>
  FABRICA_FN L rate_factor(const L& r) const {
    L slope = L(0.0);
    if (rate_curve) return lookup(rate_curve, r, slope);
    return L(1.0) + pow(r / L(rate_constant), L(rate_exponent));
  }
  // equations (1) and (3) at a known rate
  template <class L>
  FABRICA_FN L yield(const L& ep, const L& r, const L& factor, L& slope) const {
    if (table) return lookup(table, ep, r, slope);
    const L S = static_yield(ep, slope);
    slope = slope * factor;
    return S * factor;
  }
  // equations (2) and (3), and (1) with LCSR, at the plastic rate r
  template <class L>
  FABRICA_FN L viscoplastic_yield(const L& ep, const L& r) const {
    L slope = L(0.0);
    if (table) return lookup(table, ep, r, slope);
    const L S = static_yield(ep, slope);
    if (rate_curve) return S * rate_factor(r);
    const L base = yield_stress > 0 ? L(yield_stress) : static_yield(L(0.0), slope);
    return fma(base, pow(r / L(rate_constant), L(rate_exponent)), S);
  }

  template <bool plane, class L>
  FABRICA_FN L flow(const J2Trial<L>& trial, const Sym3<L>& strain, const Point<L>& point,
                    const State<L>& state) const {
    const L ep = state.plastic_strain;
    if (!rate_dependent()) {
      if (!curve && points == 0) return bilinear_flow<plane>(trial, ep);
      return j2_newton<plane, 3>(
          trial.modes, [&](const L& dep, L& slope) { return static_yield(ep + dep, slope); });
    }
    const L per_time = L(1.0) / max(point.dt, L(1e-30));
    if (rate_form == 1) {
      const L least = viscoplastic_yield(ep, L(0.0));
      return j2_bracket<plane, 10>(trial.modes, trial.q, least, [&](const L& dep, L&) {
        return viscoplastic_yield(ep + dep, dep * per_time);
      });
    }
    const Sym3<L> measured = rate_form == -1 ? deviator(strain) : strain;
    const L weight = rate_form == -1 ? L(2.0 / 3.0) : L(1.0);
    const L r = sqrt(weight * ddot(measured, measured)) * per_time;
    const L factor = table ? L(1.0) : rate_factor(r);
    return j2_newton<plane, 4>(
        trial.modes, [&](const L& dep, L& slope) { return yield(ep + dep, r, factor, slope); });
  }
  template <bool plane, class L>
  FABRICA_FN L bilinear_flow(const J2Trial<L>& trial, const L& ep) const {
    const L H = L(hardening), Y = fma(H, ep, L(yield_stress));
    if constexpr (plane) {
      return j2_newton<true, 3>(trial.modes, [&](const L& dep, L& slope) {
        slope = H;
        return fma(H, dep, Y);
      });
    } else {
      // dep in closed form, then lambda = 3/2 dep / q with q after the flow
      const L excess = max(trial.q - Y, L(0.0)), scale = L(3 * moduli.shear);
      const L dep = excess / (scale + H);
      return L(1.5) * dep / max(trial.q - scale * dep, L(1e-30));
    }
  }
};

inline PiecewiseLinearPlasticity PiecewiseLinearPlasticity::from(const Parameters& p) {
  const double E = p.real("e"), tangent = p.real("etan");
  const Elastic e = Elastic::from_youngs(p.real("ro"), E, p.real("pr"));
  PiecewiseLinearPlasticity m;
  m.density = Real(e.density);
  m.moduli = {Real(e.bulk), Real(e.shear), Real(0)};
  m.yield_stress = Real(p.real("sigy"));
  m.hardening = Real(E * tangent / (E - tangent));
  m.failure_strain = Real(p.real("fail"));
  m.rate_form = p.integer("vp");
  if (p.real("p") > 0) {
    m.rate_constant = Real(p.real("c"));
    m.rate_exponent = Real(1 / p.real("p"));
  }
  m.table = p.table("lcss");
  if (!m.table) m.curve = p.curve("lcss");
  m.rate_curve = p.curve("lcsr");
  // EPS/ES pairs: in use up to the last one whose strain is above the one before
  const std::string_view eps[8] = {"eps1", "eps2", "eps3", "eps4", "eps5", "eps6", "eps7", "eps8"};
  const std::string_view es[8] = {"es1", "es2", "es3", "es4", "es5", "es6", "es7", "es8"};
  for (int i = 0; i < 8; ++i) {
    const double strain = p.real(eps[i]), stress = p.real(es[i]);
    if (stress <= 0 || (i > 0 && strain <= m.strain_points[i - 1])) break;
    m.strain_points[i] = Real(strain), m.stress_points[i] = Real(stress);
    m.points = i + 1;
  }
  return m;
}

}  // namespace fabrica
