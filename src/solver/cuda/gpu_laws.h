#pragma once
// The laws that have a GPU form: those without curves. A law of the list whose card names a curve
// is refused.
#include "material/materials.h"

namespace fabrica {

using GpuLaws = MaterialList<ElasticLaw, ElasticFluid, PlasticKinematic, Viscoelastic,
                             PiecewiseLinearPlasticity, MooneyRivlin, KelvinMaxwell>;

// whether a law read from its card points to curves in the model's memory
template <class M>
bool uses_curves(const M& law) {
  if constexpr (requires { law.curve, law.table, law.rate_curve; })
    return bool(law.curve) || bool(law.table) || bool(law.rate_curve);
  else
    return false;
}

// Calls make(law) for the law of a keyword; throws std::invalid_argument with the reason where the
// GPU has none.
template <unsigned families, class Make>
auto with_gpu_law(const std::string& keyword, const Parameters& p, const Parameters* eos,
                  Make make) {
  decltype(make(ElasticLaw{})) made{};
  for_each_material<families>(GpuLaws{}, [&]<class M>(LawTag<M>) {
    if (made || !serves<M>(keyword, p)) return;
    const M law = make_material<M>(p, eos);
    if (uses_curves(law))
      throw std::invalid_argument("*" + keyword + " with a curve or table does not run on the GPU");
    made = make(law);
  });
  if (!made)
    throw std::invalid_argument("*" + keyword + " does not run on the GPU in this element");
  return made;
}

}  // namespace fabrica
