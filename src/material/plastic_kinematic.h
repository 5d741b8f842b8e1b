#pragma once
// Von Mises plasticity with isotropic, kinematic or mixed linear hardening (*MAT_PLASTIC_KINEMATIC,
// 003).
//   Y  = (1 + (r/C)^(1/P)) (SIGY + BETA Ep ep),   Ep = E ETAN / (E - ETAN)                 (1)
//   da = 2/3 (1 - BETA) Ep d(plastic strain)                                               (2)
// r: rate of deformation sqrt(D:D) (VP = 0). VP = 1: Y = SIGY + BETA Ep ep + SIGY (r/C)^(1/P), r
// the rate of ep. C = SRC, P = SRP; C = 0: no rate effect. A point fails where ep > FS. Return
// mapping: j2.h. In shells transverse shear is elastic and outside the yield condition, as in
// published LS-DYNA results (docs/theory/elements/shell.md).
// Source: Krieg and Key 1976; Cowper and Symonds 1957.
#include "material/j2.h"

namespace fabrica {

struct PlasticKinematic {
  static constexpr std::string_view keyword = "MAT_PLASTIC_KINEMATIC";
  static constexpr unsigned families = in_solids | in_shells | in_beams;
  static constexpr bool total = false, can_fail = true;
  static constexpr int rotated = 1;

  Real density;
  J2Moduli moduli;      // K, G, (1 - BETA) Ep [stress]
  Real yield_stress;    // SIGY [stress]
  Real isotropic;       // BETA Ep [stress]
  Real rate_constant;   // C [1/time]; 0: none
  Real rate_exponent;   // 1 / P
  Real failure_strain;  // FS; 0: none
  bool viscoplastic;    // VP = 1

  template <class L>
  struct State {
    Sym3<L> back;      // a [stress]
    L plastic_strain;  // ep
  };

  static PlasticKinematic from(const Parameters& p) {
    const double E = p.real("e"), tangent = p.real("etan"), beta = p.real("beta");
    const Elastic e = Elastic::from_youngs(p.real("ro"), E, p.real("pr"));
    const double Ep = E * tangent / (E - tangent);
    const double P = p.real("srp");
    return {Real(e.density),
            {Real(e.bulk), Real(e.shear), Real((1 - beta) * Ep)},
            Real(p.real("sigy")),
            Real(beta * Ep),
            P > 0 ? Real(p.real("src")) : Real(0),
            P > 0 ? Real(1 / P) : Real(0),
            Real(p.real("fs")),
            p.integer("vp") == 1};
  }
  Elastic elastic() const { return {density, moduli.bulk, moduli.shear}; }
  bool may_fail() const { return j2_may_fail(failure_strain); }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                            State<L>& state) const {
    const J2Trial<L> trial = j2_trial(moduli, old, strain, state.back);
    const L lambda = flow<false>(trial, strain, point, state);
    L increment;
    const Sym3<L> s = j2_finish(moduli, trial, lambda, &state.back, increment);
    j2_take_up(increment, failure_strain, point, state.plastic_strain);
    return s;
  }

  template <class L>
  FABRICA_FN Sym3<L> plane_stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                                  State<L>& state, L& dzz) const {
    const J2Trial<L> trial =
        j2_plane_trial<TransverseShear::elastic>(moduli, old, strain, state.back);
    Sym3<L> flowing = plane_flow_strain(strain);
    flowing.yz = flowing.zx = L(0.0);
    const L lambda = flow<true>(trial, flowing, point, state);
    L increment;
    const Sym3<L> s = j2_plane_finish(moduli, old, trial, lambda, &state.back, increment, dzz);
    j2_take_up(increment, failure_strain, point, state.plastic_strain);
    return s;
  }

  template <class L>
  FABRICA_FN Sym3<L> uniaxial(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                              State<L>& state) const {
    const J2Trial<L> trial = j2_fibre_trial(moduli, old, strain, state.back);
    const L lambda = flow<true>(trial, fibre_flow_strain(strain), point, state);
    L increment;
    const Sym3<L> s = j2_fibre_finish(moduli, trial, lambda, &state.back, increment);
    j2_take_up(increment, failure_strain, point, state.plastic_strain);
    return s;
  }

 private:
  template <bool plane, class L>
  FABRICA_FN L flow(const J2Trial<L>& trial, const Sym3<L>& strain, const Point<L>& point,
                    const State<L>& state) const {
    const L Y = fma(L(isotropic), state.plastic_strain, L(yield_stress));
    if (rate_constant > 0 && viscoplastic) return viscous_flow<plane>(trial, Y, point.dt);
    const L factor = rate_factor(ddot(strain, strain), point.dt);
    const L start = factor * Y, H = factor * L(isotropic);
    if constexpr (plane) {
      return j2_newton<true, 3>(trial.modes, [&](const L& dep, L& slope) {
        slope = H;
        return fma(H, dep, start);
      });
    } else {
      // dep in closed form, then lambda = 3/2 dep / q with q after the flow
      const L excess = max(trial.q - start, L(0.0));
      const L scale = L(3 * moduli.shear + moduli.kinematic);
      const L dep = excess / (scale + H);
      return L(1.5) * dep / max(trial.q - scale * dep, L(1e-30));
    }
  }
  // 1 + (r/C)^(1/P) with r^2 dt^2 given
  template <class L>
  FABRICA_FN L rate_factor(const L& square, const L& dt) const {
    if (!(rate_constant > 0)) return L(1.0);
    const L r = sqrt(square) / max(dt, L(1e-30));
    return L(1.0) + pow(r / L(rate_constant), L(rate_exponent));
  }
  template <bool plane, class L>
  FABRICA_FN L viscous_flow(const J2Trial<L>& trial, const L& Y, const L& dt) const {
    const L scale = L(1.0) / (max(dt, L(1e-30)) * L(rate_constant));
    return j2_bracket<plane, 10>(trial.modes, trial.q, Y, [&](const L& dep, L&) {
      return Y + L(isotropic) * dep + L(yield_stress) * pow(dep * scale, L(rate_exponent));
    });
  }
};

}  // namespace fabrica
