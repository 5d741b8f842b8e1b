// Instantiates trusses and beams.
#include "element/beam_hughes_liu.h"
#include "element/beam_schwer.h"
#include "element/truss.h"
#include "solver/cpu/kernel_of.h"
#include "solver/cpu/make.h"

namespace fabrica {

template <class E, class M>
void KernelOf<E, M>::read(const ElementParameters& p, const Real* block, int lane, const Vec3d*,
                          ElementReadout& out) const {
  const StateView<Real> s{const_cast<Real*>(block) + lane};
  E::template resultants<M>(p, s, out.resultants);
  if constexpr (requires { E::template stress<M>(p, s, 0); }) {
    const Sym3<Real> t = E::template stress<M>(p, s, 0);
    for (int i = 0; i < 6; ++i) out.stress[0][i] = double(t[i]);
    out.plastic_strain[0] = double(E::template plastic_strain<M>(p, s, 0));
  }
}

std::unique_ptr<Kernel> make_beam_kernel(ElementKind kind, const Material& material,
                                         const Parameters& parameters) {
  return make_for_law<in_beams>(
      "beams", material, parameters, nullptr, [&](auto law) -> std::unique_ptr<Kernel> {
        using M = decltype(law);
        switch (kind) {
          case ElementKind::truss:
            return std::make_unique<KernelOf<Truss, M>>(law);
          case ElementKind::beam_hughes_liu:
            if constexpr (requires { M::axial_only; })
              throw std::invalid_argument("*" + std::string(M::keyword) +
                                          " is for trusses only; use formulation 3");
            else
              return std::make_unique<KernelOf<BeamHughesLiu, M>>(law);
          case ElementKind::beam_resultant:
            if constexpr (M::keyword == std::string_view("MAT_ELASTIC"))
              return std::make_unique<KernelOf<BeamSchwer, M>>(law);
            else
              throw std::invalid_argument(
                  "beam formulation 2 takes *MAT_ELASTIC only; use formulation 1");
          default:
            throw std::invalid_argument("this beam formulation is not available");
        }
      });
}

}  // namespace fabrica
