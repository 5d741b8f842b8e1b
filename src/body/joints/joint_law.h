#pragma once
// The laws of data/anatomy/joints/materials.csv by name.
#include <string>

#include "body/piece.h"

namespace fabrica::body {

// Throws BodyError that names the row when it is not there or a field is no number.
Law joint_law(const std::string& name);

}  // namespace fabrica::body
