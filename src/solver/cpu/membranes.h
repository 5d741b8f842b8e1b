#pragma once
#include <memory>

#include "solver/kernel.h"

namespace fabrica {

std::unique_ptr<Kernel> make_membrane_kernel(ElementKind, const Material&, const Parameters&);

}  // namespace fabrica
