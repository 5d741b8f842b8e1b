#pragma once
// The laws of *ELEMENT_DISCRETE. Each gives the force F (or moment) along the element's axis from
// its elongation (or twist) d, tension positive, and the tangents dF/dd and dF/d(rate) for the time
// step.
//
//   S01 elastic             F = K d (1) S02 viscous damper      F = DC d' (2) S03 elastoplastic F =
//   K (d - p), |F| <= FY + H a, H = K KT / (K - KT)                   (3)
//                           p: plastic elongation, a: its accumulated amount (isotropic hardening)
//   S04 nonlinear elastic   F = LCD(d) LCR(d'), or F = table(d; d') (4) S05 nonlinear damper    F =
//   LCDR(d')                                                          (5) S06 general nonlinear see
//   GeneralSpring                                                     (6) S07 Maxwell             F
//   = int (KI + (K0 - KI) exp(-BETA (t - u))) d'(u) du, FC after TC     (7) S08 inelastic
//   one-sided: y = LCFD(x) for x >= m, else max(0, LCFD(m) - KU (m - x))  (8)
//                           x: elongation, or shortening if CTF = 1; m: largest x so far
//
//   S15 muscle              see MuscleSpring                                                 (9)
//
// Field names are those of the keyword manual. All values in double; no units are assumed.
#include <array>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "base/parameters.h"
#include "material/discrete/hysteresis.h"
#include "material/discrete/polyline.h"

namespace fabrica {

// what a law is asked for
struct SpringMotion {
  double d = 0;       // elongation or twist at t(n)
  double rate = 0;    // its rate at t(n-1/2)
  double dt = 0;      // step from t(n-1) to t(n)
  double time = 0;    // t(n)
  double length = 0;  // of the element at t(n); 0 for torsion
};
struct SpringForce {
  double force = 0;
  double stiffness = 0;  // dF/dd, not negative
  double damping = 0;    // dF/d(rate), not negative
};

// Memory of one element, all zero at the start; a law uses the fields it needs.
struct SpringState {
  double last = 0;           // d of the previous call
  double plastic = 0;        // p of (3), m of (8), shift of the loading curve in (6)
  double amount = 0;         // a of (3)
  double viscous = 0;        // fading part of (7)
  double shift = 0;          // of the unloading curve in (6)
  double high = 0, low = 0;  // yield window of (6), relative to its start
  double reached_high = 0, reached_low = 0;  // of (6): where each side is on the loading curve
  double back = 0;                           // of (6): force by which the loading curve is moved
  double side = 0;                           // of (6): side that yielded last
  double yielded = 0;  // of (6): 0 not yet, +1 or -1 on the loading curve, 2 on the unloading curve
};

struct ElasticSpring {
  static constexpr std::string_view keyword = "MAT_SPRING_ELASTIC";
  double k;
  static ElasticSpring from(const Parameters& p) { return {p.real("k")}; }
  SpringForce force(const SpringMotion& m, SpringState&) const { return {k * m.d, k, 0}; }
};

struct ViscousDamper {
  static constexpr std::string_view keyword = "MAT_DAMPER_VISCOUS";
  double dc;
  static ViscousDamper from(const Parameters& p) { return {p.real("dc")}; }
  SpringForce force(const SpringMotion& m, SpringState&) const { return {dc * m.rate, 0, dc}; }
};

struct ElastoplasticSpring {
  static constexpr std::string_view keyword = "MAT_SPRING_ELASTOPLASTIC";
  double k, kt, fy;
  static ElastoplasticSpring from(const Parameters& p) {
    return {p.real("k"), p.real("kt"), p.real("fy")};
  }
  SpringForce force(const SpringMotion& m, SpringState& s) const;
};

struct NonlinearSpring {
  static constexpr std::string_view keyword = "MAT_SPRING_NONLINEAR_ELASTIC";
  Polyline deflection, rate_factor;
  std::vector<double> rates;  // of a table
  std::vector<Polyline> family;
  bool log_rate = false;
  static NonlinearSpring from(const Parameters& p);
  SpringForce force(const SpringMotion& m, SpringState&) const;

 private:
  SpringForce from_family(const SpringMotion& m) const;
};

struct NonlinearDamper {
  static constexpr std::string_view keyword = "MAT_DAMPER_NONLINEAR_VISCOUS";
  Polyline curve;
  static NonlinearDamper from(const Parameters& p) { return {Polyline(p.curve("lcdr"))}; }
  SpringForce force(const SpringMotion& m, SpringState&) const {
    SpringForce r;
    r.force = curve.at(m.rate, r.damping);
    r.damping = std::max(r.damping, 0.0);
    return r;
  }
};

// Inside the yield window [low, high] the path is elastic: the loading curve L before the first
// yield, then the unloading curve U shifted through the point where unloading began. At the edge of
// the window the force follows L, shifted so that it meets the edge, and the window moves:
//   BETA = 0  only the edge that is reached, also downwards (softening)
//   BETA = 1  both edges outwards by the same amount (isotropic)
//   else      both edges along by the same amount (kinematic); L restarts at the side's first yield
//   force,
//             moved to the edge in force as well
struct GeneralSpring {
  static constexpr std::string_view keyword = "MAT_SPRING_GENERAL_NONLINEAR";
  Polyline loading, unloading;
  double beta, tension_yield, compression_yield;
  static GeneralSpring from(const Parameters& p);
  SpringForce force(const SpringMotion& m, SpringState& s) const;

 private:
  double high(const SpringState& s) const { return tension_yield + s.high; }
  double low(const SpringState& s) const { return compression_yield + s.low; }
  void move_window(int side, double force, SpringState& s) const;
  void enter(int side, SpringState& s) const;
  SpringForce yield(int side, double d, SpringState& s) const;
};

struct MaxwellSpring {
  static constexpr std::string_view keyword = "MAT_SPRING_MAXWELL";
  double k0, ki, beta, tc, fc;
  static MaxwellSpring from(const Parameters& p);
  SpringForce force(const SpringMotion& m, SpringState& s) const;
};

struct InelasticSpring {
  static constexpr std::string_view keyword = "MAT_SPRING_INELASTIC";
  Polyline curve;
  double unloading;
  int side;  // +1 tension only, -1 compression only
  static InelasticSpring from(const Parameters& p);
  SpringForce force(const SpringMotion& m, SpringState& s) const;
};

// F = FMAX (a(t) TL(x) TV(r) + h(x)),  x = length / L0,  r = rate / (VMAX SV(a))              (9)
// h = FPE(x), or (exp(KSH (x - 1) / LMAX) - 1) / (exp(KSH) - 1) for x > 1; TL and TV are not taken
// below 0, and the curves of time and activation are held at their ends.
struct MuscleSpring {
  static constexpr std::string_view keyword = "MAT_SPRING_MUSCLE";
  double l0, vmax, sv, a, fmax, lmax, ksh;
  bool exponential;
  Polyline activation, speed, length, velocity, passive;
  static MuscleSpring from(const Parameters& p);
  SpringForce force(const SpringMotion& m, SpringState&) const;

 private:
  double passive_part(double x, double& slope) const;
};

using SpringLaw =
    std::variant<ElasticSpring, ViscousDamper, ElastoplasticSpring, NonlinearSpring,
                 NonlinearDamper, GeneralSpring, MaxwellSpring, InelasticSpring, MuscleSpring>;

// The law of a canonical keyword ("MAT_SPRING_ELASTIC"), or nothing if it is not one of the above.
std::optional<SpringLaw> spring_law(std::string_view keyword, const Parameters& parameters);

// Force and tangents of a law; the state is updated. Call once per step.
SpringForce spring_force(const SpringLaw& law, const SpringMotion& motion, SpringState& state);

}  // namespace fabrica
