#pragma once
// Kelvin or Maxwell viscoelastic solid (*MAT_KELVIN-MAXWELL_VISCOELASTIC, 061).
//   FO = 0 (Maxwell): s = 2 int (GI + (G0 - GI) e^(-DC (t-u))) dev(D) du (1) FO = 1 (Kelvin): ds/dt
//   + s/DC = 2 G0 de/dt + 2 (GI/DC) e                                              (2) dp/dt = -K
//   tr(D)
// The solution of (2) is (1) with the decay constant 1/DC. Source: LS-DYNA theory manual (public),
// MAT_061.
#include "material/viscoelastic.h"

namespace fabrica {

struct KelvinMaxwell : ViscoelasticSolid {
  static constexpr std::string_view keyword = "MAT_KELVIN-MAXWELL_VISCOELASTIC";
  static constexpr unsigned families = in_solids;

  static KelvinMaxwell from(const Parameters& p) {
    const double dc = p.real("dc");
    const bool kelvin = p.integer("fo") == 1;
    const double decay = kelvin ? (dc > 0 ? 1 / dc : 0.0) : dc;
    return {{Real(p.real("ro")), Real(p.real("bulk")), Real(p.real("g0")), Real(p.real("gi")),
             Real(decay)}};
  }
};

}  // namespace fabrica
