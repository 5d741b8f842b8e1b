// Which family makes which kernel.
#include <stdexcept>

#include "solver/kernel.h"

namespace fabrica {

std::unique_ptr<Kernel> make_kernel(ElementKind kind, const Material& material,
                                    const Parameters& parameters, const Parameters* eos) {
  switch (kind) {
    case ElementKind::hex8:
    case ElementKind::hex8_exact:
    case ElementKind::hex8_full:
    case ElementKind::tet4:
    case ElementKind::tet4_nodal:
    case ElementKind::penta6:
      return make_solid_kernel(kind, material, parameters, eos);
    case ElementKind::shell_bt:
    case ElementKind::shell_triangle:
    case ElementKind::shell_full:
    case ElementKind::membrane:
    case ElementKind::membrane_full:
      return make_shell_kernel(kind, material, parameters);
    case ElementKind::truss:
    case ElementKind::beam_resultant:
    case ElementKind::beam_hughes_liu:
      return make_beam_kernel(kind, material, parameters);
  }
  throw std::invalid_argument("unknown element kind");
}

}  // namespace fabrica
