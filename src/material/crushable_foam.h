#pragma once
// Crushable foam (*MAT_CRUSHABLE_FOAM, 063): elastic until a principal stress reaches its bound.
//   trial s_e + C(E, PR) : D dt;  each principal value is held in  -LCID(1 - V) <= s_i <= TSC (1)
//   s_v = DAMP rho c l D,  c = sqrt(E / rho) (2)
// V relative volume, 1 - V its loss; unloading is elastic. Source: LS-DYNA theory manual (public),
// MAT_063.
#include <stdexcept>

#include "base/eigen3.h"
#include "material/lookup.h"
#include "material/point.h"
#include "material/relaxation.h"

namespace fabrica {

struct CrushableFoam {
  static constexpr std::string_view keyword = "MAT_CRUSHABLE_FOAM";
  static constexpr unsigned families = in_solids;
  static constexpr bool total = false, can_fail = false;
  static constexpr int rotated = 1;

  Real density, bulk, shear, youngs;
  CurveView curve;  // LCID: yield stress over volumetric strain, both positive in compression
  Real tension;     // TSC [stress]
  Real damping;     // DAMP [-]

  template <class L>
  struct State {
    Sym3<L> viscous;  // s_v of the last step
  };

  static CrushableFoam from(const Parameters& p) {
    if (p.integer("model") != 0)
      throw std::invalid_argument("MAT_CRUSHABLE_FOAM: only MODEL = 0 is supported");
    const Elastic e = Elastic::from_youngs(p.real("ro"), p.real("e"), p.real("pr"));
    return {Real(e.density), Real(e.bulk),        Real(e.shear),       Real(p.real("e")),
            p.curve("lcid"), Real(p.real("tsc")), Real(p.real("damp"))};
  }
  Elastic elastic() const { return {density, bulk, shear}; }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                            State<L>& state) const {
    const L zero = L(0.0), volumetric = trace(strain) * L(bulk - Real(2.0 / 3.0) * shear);
    const Sym3<L> trial = plus_sphere((old - state.viscous) + L(2 * shear) * strain, volumetric);
    L slope = zero;
    const L crush = max(lookup(curve, max(L(1.0) - point.volume_ratio, zero), slope), zero);
    Eigen3<L> e = eigen_symmetric(trial);
    for (int i = 0; i < 3; ++i) e.value[i] = clamp(e.value[i], -crush, L(tension));

    const L moving = select(point.dt > zero, L(1.0), zero);
    const L impedance = sqrt(L(youngs) * L(density)) * point.length;
    state.viscous = (moving * L(damping) * impedance / max(point.dt, L(1e-30))) * strain;
    // while crushing the bound rises with the slope times V
    const L stiff = max(point.modulus, slope * point.volume_ratio);
    point.modulus = damped_modulus(stiff, L(damping));
    return from_principal(e.value, e.vector) + state.viscous;
  }
};

}  // namespace fabrica
