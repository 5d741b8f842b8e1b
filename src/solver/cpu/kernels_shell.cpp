// Instantiates the shell kernels with rotations for every law that may be used in shells.
#include "solver/cpu/kernels_shell.h"

#include <algorithm>

#include "element/shell_bt.h"
#include "element/shell_full.h"
#include "element/shell_triangle.h"
#include "solver/cpu/membranes.h"

namespace fabrica {

template <class E, class M>
void KernelOf<E, M>::read(const ElementParameters& p, const Real* block, int lane, const Vec3d* x,
                          ElementReadout& out) const {
  read_shell<E, M>(p, block, lane, x, out);
}

std::unique_ptr<Kernel> make_shell_kernel(ElementKind kind, const Material& material,
                                          const Parameters& parameters) {
  if (kind == ElementKind::membrane || kind == ElementKind::membrane_full)
    return make_membrane_kernel(kind, material, parameters);
  return make_for_law<in_shells>(
      "shells", material, parameters, nullptr, [&](auto law) -> std::unique_ptr<Kernel> {
        using M = decltype(law);
        switch (kind) {
          case ElementKind::shell_bt:
            return std::make_unique<KernelOf<ShellBT, M>>(law);
          case ElementKind::shell_triangle:
            return std::make_unique<KernelOf<ShellTriangle, M>>(law);
          case ElementKind::shell_full:
            return std::make_unique<KernelOf<ShellFull, M>>(law);
          default:
            throw std::invalid_argument("this shell formulation is not available");
        }
      });
}

}  // namespace fabrica
