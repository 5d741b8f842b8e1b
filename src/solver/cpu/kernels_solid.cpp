// Instantiates the solid kernels for every material law of the list.
#include <stdexcept>

#include "element/hex8.h"
#include "element/hex8_full.h"
#include "element/penta6.h"
#include "element/tet4.h"
#include "material/materials.h"
#include "solver/cpu/kernel_of.h"
#include "solver/cpu/make.h"
#include "solver/cpu/nodal_tet.h"

namespace fabrica {

template <class E, class M>
void KernelOf<E, M>::read(const ElementParameters& p, const Real* block, int lane, const Vec3d*,
                          ElementReadout& out) const {
  const StateView<Real> s{const_cast<Real*>(block) + lane +
                          E::template point_at<M>(p) * block_size};
  read_solid_point<M>(s, out);
}

std::unique_ptr<Kernel> make_solid_kernel(ElementKind kind, const Material& material,
                                          const Parameters& parameters, const Parameters* eos) {
  return make_for_law<in_solids>(
      "solids", material, parameters, eos, [&](auto law) -> std::unique_ptr<Kernel> {
        using M = decltype(law);
        switch (kind) {
          case ElementKind::hex8:
            return std::make_unique<KernelOf<Hex8<false>, M>>(law);
          case ElementKind::hex8_exact:
            return std::make_unique<KernelOf<Hex8<true>, M>>(law);
          case ElementKind::tet4:
            return std::make_unique<KernelOf<Tet4, M>>(law);
          case ElementKind::hex8_full:
            return std::make_unique<KernelOf<Hex8Full, M>>(law);
          case ElementKind::penta6:
            return std::make_unique<KernelOf<Penta6, M>>(law);
          case ElementKind::tet4_nodal:
            // the nodal pressure follows from a constant bulk modulus; laws of F keep the plain
            // element
            if constexpr (M::total)
              return std::make_unique<KernelOf<Tet4, M>>(law);
            else
              return std::make_unique<NodalTet<M>>(law);
          default:
            throw std::invalid_argument("this solid formulation is not available");
        }
      });
}

}  // namespace fabrica
