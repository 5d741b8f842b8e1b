#pragma once
// Hill-type muscle of trusses (*MAT_MUSCLE, 156): contractile, elastic and viscous part in
// parallel.
//   sigma = PIS a(t) f(lam) g(r) + PIS h(lam) + DMP lam'                                     (1)
//   lam = SNO l / l0,   r = lam' / (SRM s(lam))                                              (2)
//   h = (exp(CER (lam - 1) / SSM) - 1) / (exp(CER) - 1) for lam > 1, else 0, where SSP = 0   (3)
// l length, l0 length at the start, lam stretch from the optimal length l0 / SNO, lam' its rate
// (shortening negative), a = ALM activation, f = SVS, g = SVR, h = SSP, s = SFR. A negative field
// names a curve; else ALM is a constant, f = g = s = 1, and SSP > 0 stands for h = 0. A muscle does
// not push: f and g are not taken below 0. RO is the density at the optimal length, so RO / SNO is
// that of the start.
// Source: Winters, in: Multiple Muscle Systems, Springer 1990, ch. 5; field names as in the keyword
// manual of LS-DYNA (public).
#include <cmath>
#include <stdexcept>
#include <string>

#include "material/lookup.h"
#include "material/point.h"
#include "material/relaxation.h"

namespace fabrica {

struct Muscle {
  static constexpr std::string_view keyword = "MAT_MUSCLE";
  static constexpr unsigned families = in_beams;
  static constexpr bool total = false, can_fail = false, axial_only = true;
  static constexpr int rotated = 0;

  Real density;       // RO / SNO [mass/length^3]
  Real stretch;       // SNO [-]
  Real fastest;       // SRM [1/time]
  Real peak;          // PIS [stress]
  Real full, shape;   // SSM, CER of equation (3) [-]
  Real viscosity;     // DMP [stress time]
  Real activation;    // ALM where it is a constant [-]
  bool exponential;   // equation (3) instead of a curve
  Real steepest;      // largest slope of SVR [-]
  CurveView active;   // ALM over time
  CurveView speed;    // SFR over lam
  CurveView length;   // SVS over lam
  CurveView rate;     // SVR over r
  CurveView passive;  // SSP over lam

  template <class L>
  struct State {
    L rest;          // l0 [length]; 0 before the first call
    L time, behind;  // time and what its sum has lost by rounding
  };

  static Muscle from(const Parameters& p) {
    Muscle m{};
    m.stretch = Real(p.given("sno") ? p.real("sno") : 1.0);
    if (m.stretch <= 0)
      throw std::invalid_argument("SNO, the stretch at the start, is not positive");
    m.density = Real(p.real("ro")) / m.stretch;
    m.peak = Real(p.real("pis"));
    if (m.peak <= 0) throw std::invalid_argument("PIS, the peak isometric stress, is not positive");
    m.viscosity = Real(p.real("dmp")), m.activation = Real(p.real("alm"));
    m.active = curve_of(p, "alm"), m.speed = curve_of(p, "sfr");
    m.length = curve_of(p, "svs"), m.rate = curve_of(p, "svr"), m.passive = curve_of(p, "ssp");
    m.active.extrapolate = m.speed.extrapolate = false;
    m.fastest = Real(p.real("srm"));
    if (m.rate && m.fastest <= 0)
      throw std::invalid_argument("SVR is a curve of the rate over SRM, but SRM is not positive");
    for (int i = 0; i + 1 < m.rate.n; ++i)
      m.steepest =
          std::max(m.steepest, (m.rate.y[i + 1] - m.rate.y[i]) / (m.rate.x[i + 1] - m.rate.x[i]));
    m.exponential = p.real("ssp") == 0;
    m.full = Real(p.real("ssm")), m.shape = Real(p.real("cer"));
    if (m.exponential && m.full <= 0)
      throw std::invalid_argument(
          "SSP = 0 asks for the exponential passive stress, but SSM, its strain at PIS, is not "
          "positive; give SSM, or a curve in SSP, or SSP = 1 for no passive stress");
    return m;
  }
  // the floor of the tangent; no lateral strain: K + 4G/3 = E
  Elastic elastic() const { return {density, peak / 3.0, peak / 2.0}; }

  // strain.xx is read; in it and in the stress only xx differs from zero
  template <class L>
  FABRICA_FN Sym3<L> uniaxial(const Sym3<L>&, const Sym3<L>& strain, Point<L>& point,
                              State<L>& s) const {
    const L zero = L(0.0), one = L(1.0);
    s.rest = select(s.rest > zero, s.rest, point.length);
    const L now = advance(point.dt, s);
    const L lam = L(stretch) * point.length / s.rest;
    // the increment is taken over the length at mid step
    const L per_time = select(point.dt > zero, one / max(point.dt, L(1e-30)), zero);
    const L lam_rate = lam / (one + L(0.5) * strain.xx) * strain.xx * per_time;

    L slope = zero, ignored = zero;
    const L a = active ? lookup(active, now, ignored) : L(activation);
    L f = one, g = one, f_slope = zero, scale = one;
    if (length) {
      f = lookup(length, lam, f_slope);
      f_slope = select(f > zero, f_slope, zero), f = max(f, zero);
    }
    if (speed) scale = max(lookup(speed, lam, ignored), L(1e-6));
    const L fast = L(fastest) * scale;
    if (rate) g = max(lookup(rate, lam_rate / fast, ignored), zero);
    const L h = passive_part(lam, slope);

    const L stress = L(peak) * fma(a * f, g, h) + L(viscosity) * lam_rate;
    L resistance = L(viscosity);
    if (rate) resistance = fma(L(peak) * a * f, L(steepest) / fast, resistance);
    const L tangent = lam * L(peak) * fma(a * abs(f_slope), g, max(slope, zero));
    const L modulus = max(tangent, L(peak));
    point.modulus = damped_modulus(
        modulus, lam * resistance / (sqrt(modulus * L(density)) * max(point.length, L(1e-30))));
    return {stress, zero, zero, zero, zero, zero};
  }

 private:
  // a curve where the field is negative; a missing one is an error
  static CurveView curve_of(const Parameters& p, const char* field) {
    if (p.real(field) >= 0) return {};
    const CurveView c = p.curve(field);
    if (c) return c;
    std::string name = field;
    for (char& letter : name) letter = char(letter - 'a' + 'A');
    throw std::invalid_argument(
        name + " names curve " + std::to_string(-p.integer(field)) +
        ", which is not a curve of the model; define it by points, or by a function that is "
        "evaluated");
  }
  // t(n), summed with compensation so that a long run keeps its time in single precision
  template <class L>
  FABRICA_FN L advance(const L& dt, State<L>& s) const {
    const L step = dt - s.behind, sum = s.time + step;
    s.behind = (sum - s.time) - step;
    s.time = sum;
    return sum;
  }
  // h and dh/dlam
  template <class L>
  FABRICA_FN L passive_part(const L& lam, L& slope) const {
    const L zero = L(0.0);
    slope = zero;
    if (passive) return lookup(passive, lam, slope);
    if (!exponential) return zero;
    const L strain = (lam - L(1.0)) / L(full);
    const auto pulled = strain > zero;
    if (shape <= 0) {
      slope = select(pulled, L(1 / full), zero);
      return max(strain, zero);
    }
    const L whole = expm1(L(shape)), grown = expm1(L(shape) * max(strain, zero));
    slope = select(pulled, L(shape / full) * (grown + L(1.0)) / whole, zero);
    return grown / whole;
  }
};

}  // namespace fabrica
