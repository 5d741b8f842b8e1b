#pragma once
// How rigid walls stop free nodes, and what programs call it (docs/theory/rigid_walls.md).
#include <string>
#include <vector>

namespace fabrica {

enum class WallMethod {
  impulse,    // before they are behind the wall, with Coulomb friction
  constraint  // put back once they are found behind a plane
};

inline const std::vector<std::string>& wall_method_names() {
  static const std::vector<std::string> names{"impulse", "constraint"};
  return names;
}

}  // namespace fabrica
