#pragma once
// Low density urethane foam (*MAT_LOW_DENSITY_FOAM, 057): no coupling between the principal
// directions.
//   sigma_i = tau_i / (lam_j lam_k) (1) tau_i = -LCID(1 - lam_i) f   in compression,   f = 1 - (1 -
//   HU) (1 - (W / Wmax)^SHAPE)                  (2) tau_i = min(E (lam_i - 1), TC)  in tension;
//   FAIL = 1: no tension once TC has been reached W = sum over compressed directions of int LCID;
//   Wmax <- max(W, Wmax e^(-BETA dt)) sigma_v = DAMP rho c l D + h,  dh/dt = ED D - BETA1 h,  c =
//   sqrt(E / rho)                                (3)
// lam_i principal stretches, tau_i nominal stress, l length of the element, D rate of deformation
// from the increment of ln(V), V = sqrt(F F^T). W is a function of the stretches, so one cycle with
// HU returns exactly HU + (1 - HU) / (1 + SHAPE) of the work. Source: LS-DYNA theory manual
// (public), MAT_057; Chang, Song, Sakai, SAE 1994.
#include "base/eigen3.h"
#include "material/lookup.h"
#include "material/point.h"
#include "material/relaxation.h"

namespace fabrica {

// The two laws of the keyword differ only in their history, so foams without ED carry no branch.
template <bool viscous>
struct LowDensityFoamOf {
  static constexpr std::string_view keyword = "MAT_LOW_DENSITY_FOAM";
  static constexpr unsigned families = in_solids;
  static constexpr bool total = true, can_fail = false;
  static constexpr int rotated = viscous ? 2 : 1;

  Real density, youngs;   // E [stress]
  CurveView curve;        // LCID: nominal stress over 1 - lam, compression positive
  Real tension;           // TC [stress]
  Real unloading, shape;  // HU, SHAPE [-]
  Real recovery;          // BETA [1/time]
  Real damping;           // DAMP [-]
  bool tears;             // FAIL = 1
  Real branch, fading;    // ED [stress], BETA1 [1/time]

  template <class L>
  struct Plain {
    Sym3<L> strain;  // ln(V) at the end of the last step
    L peak;          // Wmax
    L torn;          // 1 where tension has been lost
  };
  template <class L>
  struct Branched {
    Sym3<L> strain, maxwell;  // h [stress]
    L peak, torn;
  };
  template <class L>
  using State = std::conditional_t<viscous, Branched<L>, Plain<L>>;

  // whether this variant serves the card
  static bool matches(const Parameters& p) { return viscous == (p.real("ed") > 0); }
  static LowDensityFoamOf from(const Parameters& p) {
    LowDensityFoamOf m{};
    m.density = Real(p.real("ro")), m.youngs = Real(p.real("e"));
    m.curve = p.curve("lcid");
    m.curve.extrapolate = true;
    m.tension = p.real("tc") > 0 ? Real(p.real("tc")) : Real(1e20);
    m.unloading = Real(p.real("hu")),
    m.shape = p.real("shape") > 0 ? Real(p.real("shape")) : Real(1);
    m.recovery = Real(p.real("beta")), m.damping = Real(p.real("damp"));
    m.tears = p.integer("fail") == 1;
    m.branch = Real(p.real("ed")), m.fading = Real(p.real("beta1"));
    return m;
  }
  // without lateral coupling K = E/3, G = E/2: K + 4G/3 = E
  Elastic elastic() const {
    double E = youngs;
    for (int i = 0; i + 1 < curve.n; ++i)
      if (curve.x[i] <= 0 || i == 0) {
        const double rise = (curve.y[i + 1] - curve.y[i]) / (curve.x[i + 1] - curve.x[i]);
        E = rise > E ? rise : E;
      }
    E += viscous ? double(branch) : 0.0;
    return {density, E / 3, E / 2};
  }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Mat3<L>& F, Point<L>& point, State<L>& state) const {
    const L zero = L(0.0), one = L(1.0);
    Mat3<L> H = F;
    for (int i = 0; i < 3; ++i) H.a[i][i] = H.a[i][i] - one;
    const Eigen3<L> e = eigen_symmetric(L(2.0) * sym(H) + left_cauchy_green(H));

    // loading curve, its energy and slope along each axis
    Vec3<L> stretch, loading, slope, logarithm;
    L W = zero;
    for (int i = 0; i < 3; ++i) {
      stretch[i] = sqrt(one + e.value[i]);
      logarithm[i] = L(0.5) * log1p(e.value[i]);
      // 1 - lam = -(lam^2 - 1) / (lam + 1)
      const L shortening = max(-(e.value[i] / (stretch[i] + one)), zero);
      L area = zero, rise = zero;
      loading[i] = lookup_with_area(curve, shortening, rise, area);
      slope[i] = rise;
      W += area;
    }
    const L faded = recovery > 0 ? state.peak * exp(-(L(recovery) * point.dt)) : state.peak;
    state.peak = max(W, faded);
    const L share = select(state.peak > zero, W / max(state.peak, L(1e-30)), one);
    const L power = pow(share, L(shape));
    const L factor = one - L(1 - unloading) * (one - power);

    // nominal stress, equation (2)
    Vec3<L> tau;
    L torn = state.torn;
    for (int i = 0; i < 3; ++i) {
      const L pull = L(youngs) * (stretch[i] - one);
      if (tears) torn = select(pull >= L(tension), one, torn);
      const L held = select(torn > zero, zero, min(pull, L(tension)));
      tau[i] = select(e.value[i] < zero, -(factor * loading[i]), held);
    }
    state.torn = torn;

    // where the foam unloads, W falls with the strain and adds to the slope: tau^2 df/dW
    const auto unloads = share < one;
    const L steeper = select(unloads, L((1 - unloading) * shape) * power / max(W, L(1e-30)), zero);
    const L per_volume = one / point.volume_ratio;
    L modulus = zero, most = zero;
    Vec3<L> principal;
    for (int i = 0; i < 3; ++i) {
      const L local = select(e.value[i] < zero,
                             fma(steeper * loading[i], loading[i], slope[i] * factor), L(youngs));
      modulus = max(modulus, stretch[i] * stretch[i] * max(local, L(youngs)));
      most = max(most, stretch[i] * abs(tau[i]));
      principal[i] = per_volume * stretch[i] * tau[i];
    }
    // shear between two axes: (t_i - t_j) / (lam_i^2 - lam_j^2) x the larger lam^2, t = lam tau; a
    // wave along the bisector of two axes meets half of the axial stiffness and all of the shear
    L shear = zero;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const L across = abs(stretch[i] * tau[i] - stretch[j] * tau[j]) /
                       max(abs(e.value[i] - e.value[j]), L(1e-3));
      shear = max(shear, across * (one + max(e.value[i], e.value[j])));
    }
    modulus = max(modulus, fma(L(0.5), modulus, shear));
    const Sym3<L> viscous_part = viscous_stress(from_principal(logarithm, e.vector), point, state);
    const L impedance =
        sqrt(L(youngs) * L(density)) / max(sqrt((modulus + most) * L(density)), L(1e-30));
    point.modulus = damped_modulus((modulus + most) * per_volume + L(viscous ? branch : Real(0)),
                                   L(damping) * impedance);
    return from_principal(principal, e.vector) + viscous_part;
  }

  // strain energy of loading per initial volume, compression only
  template <class L>
  FABRICA_FN L loading_energy(const L& stretch) const {
    L slope, area;
    lookup_with_area(curve, max(L(1.0) - stretch, L(0.0)), slope, area);
    return area;
  }

 private:
  // equation (3)
  template <class L>
  FABRICA_FN Sym3<L> viscous_stress(const Sym3<L>& strain, const Point<L>& point,
                                    State<L>& state) const {
    const Sym3<L> change = strain - state.strain;
    state.strain = strain;
    const L still = select(point.dt > L(0.0), L(1.0), L(0.0));
    const L impedance = sqrt(L(youngs) * L(density)) * point.length;
    Sym3<L> s = (still * L(damping) * impedance / max(point.dt, L(1e-30))) * change;
    if constexpr (viscous) {
      L fade;
      const L phi = relaxation(L(fading) * point.dt, fade);
      state.maxwell = fade * state.maxwell + (L(branch) * phi) * change;
      s += state.maxwell;
    }
    return s;
  }
};

using LowDensityFoam = LowDensityFoamOf<false>;
using ViscousLowDensityFoam = LowDensityFoamOf<true>;

}  // namespace fabrica
