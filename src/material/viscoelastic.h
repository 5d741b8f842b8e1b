#pragma once
// Linear viscoelastic solid with one Maxwell branch (*MAT_VISCOELASTIC, 006).
//   s = 2 int (GI + (G0 - GI) e^(-BETA (t-u))) dev(D) du,   dp/dt = -K tr(D) (1)
// Source: Herrmann and Peterson 1968; recursion: relaxation.h.
#include "material/point.h"
#include "material/relaxation.h"

namespace fabrica {

// The parameters and the step of (1), shared with the Kelvin-Maxwell solid.
struct ViscoelasticSolid {
  static constexpr bool total = false, can_fail = false;
  static constexpr int rotated = 2;

  Real density, bulk;
  Real short_shear, long_shear;  // G0, GI [stress]
  Real decay;                    // BETA [1/time]

  template <class L>
  struct State {
    Sym3<L> elastic;  // deviatoric stress of the long-term spring
    Sym3<L> maxwell;  // and of the Maxwell branch
  };

  FABRICA_FN Elastic elastic() const {
    return {density, bulk, short_shear > long_shear ? short_shear : long_shear};
  }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                            State<L>& state) const {
    L fade;
    const L phi = relaxation(L(decay) * point.dt, fade);
    const Sym3<L> e = deviator(strain);
    state.elastic += L(2 * long_shear) * e;
    state.maxwell = fade * state.maxwell + (L(2 * (short_shear - long_shear)) * phi) * e;
    const L mean = fma(L(bulk), trace(strain), trace(old) * L(1.0 / 3.0));
    return plus_sphere(state.elastic + state.maxwell, mean);
  }
};

struct Viscoelastic : ViscoelasticSolid {
  static constexpr std::string_view keyword = "MAT_VISCOELASTIC";
  static constexpr unsigned families = in_solids | in_shells | in_beams;

  static Viscoelastic from(const Parameters& p) {
    return {{Real(p.real("ro")), Real(p.real("bulk")), Real(p.real("g0")), Real(p.real("gi")),
             Real(p.real("beta"))}};
  }
};

}  // namespace fabrica
