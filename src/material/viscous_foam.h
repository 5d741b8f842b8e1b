#pragma once
// Viscous foam (*MAT_VISCOUS_FOAM, 062): a nonlinear spring beside a nonlinear Maxwell branch.
//   E_t = E1 V^(-N1),   V_t = V2 |1 - V|^N2 (1) ds_e/dt = C(E_t, PR) : D,   ds_v/dt = C(E2, PR) : D
//   - (E2 / V_t) s_v,   s = s_e + s_v                   (2)
// V relative volume; E2 bounds the stiffness of the branch. Source: LS-DYNA theory manual (public),
// MAT_062.
#include "material/point.h"
#include "material/relaxation.h"

namespace fabrica {

struct ViscousFoam {
  static constexpr std::string_view keyword = "MAT_VISCOUS_FOAM";
  static constexpr unsigned families = in_solids;
  static constexpr bool total = false, can_fail = false;
  static constexpr int rotated = 1;

  Real density, poisson;
  Real spring, spring_power;      // E1 [stress], N1
  Real viscosity, viscous_power;  // V2 [stress time], N2
  Real branch;                    // E2 [stress]

  template <class L>
  struct State {
    Sym3<L> viscous;  // s_v
  };

  static ViscousFoam from(const Parameters& p) {
    return {Real(p.real("ro")), Real(p.real("pr")), Real(p.real("e1")), Real(p.real("n1")),
            Real(p.real("v2")), Real(p.real("n2")), Real(p.real("e2"))};
  }
  Elastic elastic() const {
    return Elastic::from_youngs(density, double(spring) + branch, poisson);
  }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                            State<L>& state) const {
    const L V = point.volume_ratio;
    const L E = L(spring) * pow(V, L(-spring_power));
    // stress of unit Young's modulus
    const Real twice_shear = 1 / (1 + poisson),
               lame = poisson / ((1 + poisson) * (1 - 2 * poisson));
    const Sym3<L> unit = plus_sphere(L(twice_shear) * strain, L(lame) * trace(strain));

    const L V_t = L(viscosity) * pow(abs(L(1.0) - V), L(viscous_power));
    L fade;
    const L phi = relaxation(L(branch) * point.dt / max(V_t, L(1e-30)), fade);
    const Sym3<L> spring_stress = (old - state.viscous) + E * unit;
    state.viscous = fade * state.viscous + (L(branch) * phi) * unit;

    const L wave = L(lame + twice_shear) * (E + L(branch));
    point.modulus = max(point.modulus, wave);
    point.shear = max(point.shear, L(Real(0.5) * twice_shear) * (E + L(branch)));
    return spring_stress + state.viscous;
  }
};

}  // namespace fabrica
