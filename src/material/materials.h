#pragma once
// The list of material laws. Adding a law is its header and one line in Materials.
#include <concepts>
#include <stdexcept>
#include <string>
#include <utility>

#include "material/crushable_foam.h"
#include "material/elastic.h"
#include "material/elastic_fluid.h"
#include "material/hyperelastic_rubber.h"
#include "material/kelvin_maxwell.h"
#include "material/low_density_foam.h"
#include "material/modified_piecewise_linear_plasticity.h"
#include "material/mooney_rivlin.h"
#include "material/muscle.h"
#include "material/null.h"
#include "material/ogden.h"
#include "material/piecewise_linear_plasticity.h"
#include "material/plane_stress.h"
#include "material/plastic_kinematic.h"
#include "material/plasticity_compression_tension.h"
#include "material/uniaxial.h"
#include "material/viscoelastic.h"
#include "material/viscous_foam.h"

namespace fabrica {

template <class... Laws>
struct MaterialList {
  static constexpr int size = sizeof...(Laws);
};

using Materials =
    MaterialList<ElasticLaw, ElasticFluid, PlasticKinematic, Viscoelastic, Null,
                 PiecewiseLinearPlasticity, MooneyRivlin, LowDensityFoam, ViscousLowDensityFoam,
                 KelvinMaxwell, ViscousFoam, CrushableFoam, Ogden, ViscousOgden, Muscle,
                 HyperelasticRubber, PlasticityCompressionTension,
                 ViscousPlasticityCompressionTension, ModifiedPiecewiseLinearPlasticity>;

// carries a law's type through a generic lambda
template <class M>
struct LawTag {
  using Law = M;
};

// Calls visit(LawTag<M>{}) for every law of the list that may be used in one of the families.
template <unsigned families = in_solids | in_shells | in_beams, class... Laws, class Visit>
constexpr void for_each_material(MaterialList<Laws...>, Visit&& visit) {
  auto one = [&]<class M>(LawTag<M> tag) {
    if constexpr ((M::families & families) != 0) visit(tag);
  };
  (one(LawTag<Laws>{}), ...);
}

// Whether a law serves this card: its keyword, and where laws share one, its own choice.
template <class M>
bool serves(std::string_view keyword, const Parameters& p) {
  if (M::keyword != keyword) return false;
  if constexpr (requires { M::matches(p); })
    return M::matches(p);
  else
    return true;
}

// The law read from its card; eos: the card of its equation of state, or none.
// Throws std::invalid_argument with the keyword and the reason where the card asks for what the law
// cannot do.
template <class M>
M make_material(const Parameters& p, const Parameters* eos = nullptr) {
  if constexpr (requires { M::from(p, eos); })
    return M::from(p, eos);
  else
    return M::from(p);
}

// Calls visit(law) for the law of the keyword (canonical, e.g. "MAT_ELASTIC"); false when none of
// the families has it.
template <unsigned families = in_solids | in_shells | in_beams, class Visit>
bool with_material(std::string_view keyword, const Parameters& p, const Parameters* eos,
                   Visit&& visit) {
  bool found = false;
  for_each_material<families>(Materials{}, [&]<class M>(LawTag<M>) {
    if (!found && serves<M>(keyword, p)) {
      found = true;
      visit(make_material<M>(p, eos));
    }
  });
  return found;
}

// Position in Materials of the law that serves the card, or -1.
inline int material_index(std::string_view keyword, const Parameters& p) {
  int i = 0, found = -1;
  for_each_material(Materials{}, [&]<class M>(LawTag<M>) {
    if (found < 0 && serves<M>(keyword, p)) found = i;
    ++i;
  });
  return found;
}

}  // namespace fabrica
