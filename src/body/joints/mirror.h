#pragma once
// Which nodes mirror each other y -> -y as bones stand: those of a left bone the nodes of the right
// one, those of a bone of the midline the nodes on its other side.
#include <vector>

#include "body/placed_bone.h"

namespace fabrica::body {

struct Mirror {
  // Bones that mirror each other within 1e-6 mm; bones of the midline that mirror themselves so are
  // moved to do it to the bit.
  explicit Mirror(std::vector<PlacedBone>& bones);
  std::vector<int> twin;  // of each bone the one that is its mirror image, -1: none stands so
  std::vector<char> own;  // the bone mirrors itself by mesh.image
};

}  // namespace fabrica::body
