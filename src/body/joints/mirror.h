#pragma once
// Which nodes mirror each other y -> -y as bones stand: those of a left bone the nodes of the right
// one, those of a bone of the midline the nodes on its other side.
#include <vector>

#include "body/placed_bone.h"

namespace fabrica::body {

struct Mirror {
  // bones that mirror each other, or themselves, within 1e-6 mm
  explicit Mirror(const std::vector<PlacedBone>& bones);
  std::vector<int> twin;  // of each bone the one that is its mirror image, -1: none stands so
  std::vector<char> own;  // the bone mirrors itself by mesh.image
};

// Moves the bones that mirror themselves so that they do it to the bit.
void restore_symmetry(const Mirror& mirrors, std::vector<PlacedBone>& bones);

}  // namespace fabrica::body
