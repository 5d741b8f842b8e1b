#pragma once
// Finds the law of a material card in the list and builds a kernel for it.
#include <memory>
#include <stdexcept>
#include <type_traits>

#include "element/solid.h"
#include "material/materials.h"
#include "solver/kernel.h"

namespace fabrica {

// The value of a history field by name, where the law has it.
template <class S>
double plastic_strain_of(const S& s) {
  if constexpr (requires { s.plastic_strain; })
    return double(s.plastic_strain);
  else
    return 0;
}

// Stress, plastic strain and life of a solid point.
template <class M>
void read_solid_point(StateView<Real> s, ElementReadout& out) {
  using P = SolidPoint<M>;
  const auto stress = s.template get<Sym3<Real>>(P::stress);
  for (int i = 0; i < 6; ++i) out.stress[0][i] = double(stress[i]);
  out.plastic_strain[0] =
      plastic_strain_of(s.template get<typename M::template State<Real>>(P::material));
  if constexpr (M::can_fail) out.alive = double(s.load(P::alive));
}

// Calls make(law) for the law of a material card that may be used in Family.
template <unsigned Family, class Make>
std::unique_ptr<Kernel> make_for_law(const char* family_name, const Material& material,
                                     const Parameters& parameters, const Parameters* eos,
                                     Make make) {
  std::unique_ptr<Kernel> kernel;
  if (with_material<Family>(material.law, parameters, eos, [&](auto law) { kernel = make(law); }))
    return kernel;
  if (material_index(material.law, parameters) < 0)
    throw std::invalid_argument("material *" + material.law + " has no law in this program");
  throw std::invalid_argument("material *" + material.law + " cannot be used in " + family_name);
}

}  // namespace fabrica
