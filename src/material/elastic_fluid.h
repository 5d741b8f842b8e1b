#pragma once
// Elastic fluid (*MAT_ELASTIC_FLUID): bulk elasticity with a cavitation limit and viscosity, no
// shear stiffness.
//   dp/dt = -K tr(D),  p >= -CP,   s = VC l c rho dev(D),  c = sqrt(K / rho) (1)
// p pressure, s deviator, l length of the element, rho density. Source: LS-DYNA keyword manual
// (public), MAT_001.
#include "material/point.h"
#include "material/relaxation.h"

namespace fabrica {

struct ElasticFluid {
  static constexpr std::string_view keyword = "MAT_ELASTIC_FLUID";
  static constexpr unsigned families = in_solids;
  static constexpr bool total = false, can_fail = false;
  static constexpr int rotated = 0;

  Real density, bulk;
  Real viscosity;  // VC [-]
  Real tension;    // CP [stress]: largest tension

  template <class L>
  struct State {};

  static ElasticFluid from(const Parameters& p) {
    const Elastic e = Elastic::from_youngs(p.real("ro"), p.real("e"), p.real("pr"));
    const double K = p.real("k") > 0 ? p.real("k") : e.bulk;
    const double tension = p.real("cp") > 0 ? p.real("cp") : 1e20;
    return {Real(e.density), Real(K), Real(p.real("vc")), Real(tension)};
  }
  Elastic elastic() const { return {density, bulk, 0}; }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                            State<L>&) const {
    const L mean = fma(L(bulk), trace(strain), trace(old) * L(1.0 / 3.0));
    // density over c: rho c = sqrt(K rho)
    const L impedance = sqrt(L(bulk) * L(density) / point.volume_ratio);
    const L rate = L(viscosity) * point.length * impedance / max(point.dt, L(1e-30));
    point.modulus = damped_modulus(L(bulk), L(Real(2.0 / 3.0) * viscosity));
    return plus_sphere(rate * deviator(strain), min(mean, L(tension)));
  }
};

}  // namespace fabrica
