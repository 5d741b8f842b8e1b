#pragma once
// How rigid walls stop free nodes, and what programs call it (docs/theory/rigid_walls.md).
#include <algorithm>
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

// of one of these names
inline WallMethod wall_method(const std::string& name) {
  const auto& names = wall_method_names();
  return WallMethod(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace fabrica
