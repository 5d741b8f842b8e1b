// Instantiates the membrane kernels.
#include <algorithm>

#include "element/membrane_full.h"
#include "solver/cpu/kernels_shell.h"
#include "solver/cpu/membranes.h"

namespace fabrica {

template <class E, class M>
void KernelOf<E, M>::read(const ElementParameters&, const Real* block, int lane, const Vec3d* x,
                          ElementReadout& out) const {
  const StateView<Real> s{const_cast<Real*>(block) + lane};
  StateView<Real> at = s;
  if constexpr (requires { E::template point_view<M>(s, 0); })
    at = E::template point_view<M>(s, 0);
  else
    at.block += E::point_field * block_size;
  out.thickness = double(s.load(E::thickness_field));
  put_layer<M>(shell_turn<E>(x), 0, MembranePoint<M>::stress(at),
               MembranePoint<M>::plastic_strain(at), out);
  if constexpr (M::can_fail) out.alive = double(at.load(MembranePoint<M>::alive));
}

std::unique_ptr<Kernel> make_membrane_kernel(ElementKind kind, const Material& material,
                                             const Parameters& parameters) {
  return make_for_law<in_shells>("membranes", material, parameters, nullptr,
                                 [&](auto law) -> std::unique_ptr<Kernel> {
                                   using M = decltype(law);
                                   if (kind == ElementKind::membrane)
                                     return std::make_unique<KernelOf<Membrane, M>>(law);
                                   return std::make_unique<KernelOf<MembraneFull, M>>(law);
                                 });
}

}  // namespace fabrica
