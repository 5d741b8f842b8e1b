#pragma once
// Von Mises plasticity whose yield stress differs in compression and tension, with a viscoelastic
// stress beside it (*MAT_PLASTICITY_COMPRESSION_TENSION, 124).
//   s  = s_p + sum_i h_i
//   s_p: E, nu, q(s_p) <= Y = (1 - w) St(ep) ft(r) + w Sc(ep) fc(r)                        (1)
//   w  = (p + PT) / (PC + PT) between -PT and PC, p the pressure; 0 in more tension, 1 in more
//        compression; PC = PT = 0: the sign of p                                             (2)
//   St, Sc: curves LCIDT, LCIDC;  f = (1 + (r/C)^(1/P)) times LCSRT, LCSRC
//   r: SRFLAG 0: sqrt(D:D); 1: sqrt(2/3 D':D'); 2: rate of ep
//   h_i = int 2 GI e^(-BETAI (t-u)) dev(D) du                                                 (3)
// (3) is not bounded by (1): parallel to it, it adds rate effects to the elastic and to the plastic
// range. A point fails where ep > FAIL. Return mapping: j2.h; recursion of (3): relaxation.h.
// Source: LS-DYNA manual (public), MAT_124; Simo and Hughes, Computational Inelasticity, ch. 3.
#include <stdexcept>
#include <string>

#include "material/j2.h"
#include "material/relaxation.h"

namespace fabrica {

inline constexpr int compression_tension_branches = 6;

template <bool viscous>
struct PlasticityCompressionTensionOf {
  static constexpr std::string_view keyword = "MAT_PLASTICITY_COMPRESSION_TENSION";
  static constexpr unsigned families = in_solids | in_shells;
  static constexpr bool total = false, can_fail = true;
  static constexpr int rotated = viscous ? compression_tension_branches : 0;

  Real density = 0;
  J2Moduli moduli{};                                     // K, G [stress]
  CurveView compression, tension;                        // LCIDC, LCIDT [stress]
  CurveView compression_rate, tension_rate;              // LCSRC, LCSRT [-]
  Real compression_mean = 0, tension_mean = 0;           // PC, PT [stress]
  Real rate_constant = 0, rate_exponent = 0;             // C [1/time], 1 / P; C = 0: none
  Real failure_strain = 0;                               // FAIL; 0: none
  int rate_form = 0;                                     // SRFLAG
  int branches = 0;                                      // of equation (3)
  Real branch_shear[compression_tension_branches] = {};  // GI [stress]
  Real decay[compression_tension_branches] = {};         // BETAI [1/time]

  template <class L>
  struct Plain {
    L plastic_strain;  // ep
  };
  template <class L>
  struct Branched {
    Sym3<L> part[compression_tension_branches];  // h_i
    L plastic_strain;                            // ep
  };
  template <class L>
  using State = std::conditional_t<viscous, Branched<L>, Plain<L>>;

  // whether this variant serves the card
  static bool matches(const Parameters& p) { return viscous == (p.rows() > 0); }
  static PlasticityCompressionTensionOf from(const Parameters& p);
  // of what does not relax
  Elastic elastic() const { return {density, moduli.bulk, moduli.shear}; }
  bool may_fail() const { return j2_may_fail(failure_strain); }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                            State<L>& state) const {
    Sym3<L> before = j2_no_back<L>(), after = j2_no_back<L>();
    if constexpr (viscous) relax(strain, point, state, before, after);
    const Sym3<L> s = j2_isotropic(moduli, Sym3<L>(old - before), strain, failure_strain, point,
                                   state.plastic_strain, [&](const J2Trial<L>& trial) {
                                     const L lambda = flow<false>(trial, strain, point, state);
                                     stiffen(lambda, point, state);
                                     return lambda;
                                   });
    return s + after;
  }

  // with branches the thickness strain is searched for (plane_stress.h)
  template <class L>
  requires(!viscous) FABRICA_FN Sym3<L> plane_stress(const Sym3<L>& old, const Sym3<L>& strain,
                                                     Point<L>& point, State<L>& state, L& dzz)
  const {
    return j2_isotropic_plane(moduli, old, strain, failure_strain, point, state.plastic_strain, dzz,
                              [&](const J2Trial<L>& trial) {
                                return flow<true>(trial, plane_flow_strain(strain), point, state);
                              });
  }

 private:
  // equation (3): the sum of the branches before and after the step
  template <class L>
  FABRICA_FN void relax(const Sym3<L>& strain, Point<L>& point, State<L>& state, Sym3<L>& before,
                        Sym3<L>& after) const {
    const Sym3<L> e = deviator(strain);
    L stiff = L(moduli.shear);
    for (int i = 0; i < branches; ++i) {
      L fade;
      const L phi = relaxation(L(decay[i]) * point.dt, fade);
      before += state.part[i];
      state.part[i] = fade * state.part[i] + (L(2 * branch_shear[i]) * phi) * e;
      after += state.part[i];
      stiff += L(branch_shear[i]);
    }
    point.modulus = max(point.modulus, fma(L(4.0 / 3.0), stiff, L(moduli.bulk)));
  }

  // w of equation (2)
  template <class L>
  FABRICA_FN L weight(const Sym3<L>& stress) const {
    const L pressure = trace(stress) * L(-1.0 / 3.0);
    const Real range = compression_mean + tension_mean;
    if (range > 0) return clamp((pressure + L(tension_mean)) * L(1 / range), L(0.0), L(1.0));
    return select(pressure > L(0.0), L(1.0), L(0.0));
  }
  // Where the yield stress rises with the pressure by k = |Sc - St| / (PC + PT), a flowing point
  // gains 2/3 k K of wave modulus.
  template <class L>
  FABRICA_FN void stiffen(const L& lambda, Point<L>& point, const State<L>& state) const {
    const Real range = compression_mean + tension_mean;
    if (!(range > 0)) return;
    L slope = L(0.0);
    const L rise = lookup(compression, state.plastic_strain, slope) -
                   lookup(tension, state.plastic_strain, slope);
    const L gain = L(2 * moduli.bulk / (3 * range)) * abs(rise);
    point.modulus += select(lambda > L(0.0), gain, L(0.0));
  }
  template <class L>
  FABRICA_FN L rate_factor(const CurveView& curve, const L& r) const {
    L slope = L(0.0), factor = L(1.0);
    if (rate_constant > 0) factor += pow(r / L(rate_constant), L(rate_exponent));
    if (curve) factor *= lookup(curve, r, slope);
    return factor;
  }
  FABRICA_FN bool rate_dependent() const {
    return rate_constant > 0 || bool(compression_rate) || bool(tension_rate);
  }

  // equation (1)
  template <class L>
  FABRICA_FN L yield(const L& w, const L& ep, const L& ft, const L& fc, L& slope) const {
    L slope_c = L(0.0);
    const L St = ft * lookup(tension, ep, slope), Sc = fc * lookup(compression, ep, slope_c);
    slope = fma(w, fc * slope_c - ft * slope, ft * slope);
    return fma(w, Sc - St, St);
  }

  template <bool plane, class L>
  FABRICA_FN L flow(const J2Trial<L>& trial, const Sym3<L>& strain, const Point<L>& point,
                    const State<L>& state) const {
    const L ep = state.plastic_strain, w = weight(trial.stress), one = L(1.0);
    if (!rate_dependent())
      return j2_newton<plane, 3>(
          trial.modes, [&](const L& dep, L& slope) { return yield(w, ep + dep, one, one, slope); });
    const L per_time = one / max(point.dt, L(1e-30));
    if (rate_form == 2) {
      L slope = L(0.0);
      const L still = L(0.0);
      const L least = yield(w, ep, rate_factor(tension_rate, still),
                            rate_factor(compression_rate, still), slope);
      return j2_bracket<plane, 10>(trial.modes, trial.q, least, [&](const L& dep, L&) {
        const L r = dep * per_time;
        return yield(w, ep + dep, rate_factor(tension_rate, r), rate_factor(compression_rate, r),
                     slope);
      });
    }
    const Sym3<L> measured = rate_form == 1 ? deviator(strain) : strain;
    const L part = rate_form == 1 ? L(2.0 / 3.0) : one;
    const L r = sqrt(part * ddot(measured, measured)) * per_time;
    const L ft = rate_factor(tension_rate, r), fc = rate_factor(compression_rate, r);
    return j2_newton<plane, 4>(
        trial.modes, [&](const L& dep, L& slope) { return yield(w, ep + dep, ft, fc, slope); });
  }
};

template <bool viscous>
PlasticityCompressionTensionOf<viscous> PlasticityCompressionTensionOf<viscous>::from(
    const Parameters& p) {
  auto refuse = [](const char* why) {
    throw std::invalid_argument(std::string(keyword) + ": " + why);
  };
  PlasticityCompressionTensionOf m;
  const double E = p.real("e");
  const Elastic e = Elastic::from_youngs(p.real("ro"), E, p.real("pr"));
  m.density = Real(e.density);
  m.moduli = {Real(e.bulk), Real(e.shear), Real(0)};
  m.compression = p.curve("lcidc"), m.tension = p.curve("lcidt");
  if (!m.compression || !m.tension)
    refuse("LCIDC and LCIDT must be curves of yield stress over plastic strain; give both");
  m.compression_rate = p.curve("lcsrc"), m.tension_rate = p.curve("lcsrt");
  m.compression_mean = Real(p.real("pc")), m.tension_mean = Real(p.real("pt"));
  if (m.compression_mean < 0 || m.tension_mean < 0) refuse("PC and PT must not be negative");
  // moduli of decks differ by less than a per cent; the law would not be conservative with two
  if (const double ec = p.real("ec"); ec > 0 && !(ec < 1.02 * E && ec > 0.98 * E))
    refuse("a modulus EC in compression more than 2 % away from E is not supported");
  if (p.integer("lcfail") != 0) refuse("a failure strain by rate (LCFAIL) is not supported");
  if (p.real("k") != 0) refuse("a bulk modulus K of the viscoelastic stress is not supported");
  if (p.rows() > compression_tension_branches) refuse("more than 6 viscoelastic terms");
  m.failure_strain = Real(p.real("fail"));
  m.rate_form = p.integer("srflag");
  if (p.real("p") > 0 && p.real("c") > 0) {
    m.rate_constant = Real(p.real("c"));
    m.rate_exponent = Real(1 / p.real("p"));
  }
  m.branches = p.rows();
  for (int i = 0; i < m.branches; ++i) {
    m.branch_shear[i] = Real(p.row(i, "gi"));
    m.decay[i] = Real(p.row(i, "betai"));
  }
  return m;
}

using PlasticityCompressionTension = PlasticityCompressionTensionOf<false>;
using ViscousPlasticityCompressionTension = PlasticityCompressionTensionOf<true>;

}  // namespace fabrica
