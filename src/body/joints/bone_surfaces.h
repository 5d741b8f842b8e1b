#pragma once
// The surfaces of placed bones, each made when it is first asked for.
#include <memory>
#include <vector>

#include "body/joints/bone_surface.h"
#include "body/placed_bone.h"

namespace fabrica::body {

class BoneSurfaces {
 public:
  // the bones must outlive it
  explicit BoneSurfaces(const std::vector<PlacedBone>& bones)
      : bones_(bones), made_(bones.size()) {}
  const BoneSurface& operator[](int bone) const {
    auto& made = made_[std::size_t(bone)];
    const PlacedBone& b = bones_[std::size_t(bone)];
    if (!made) made = std::make_unique<BoneSurface>(b.nodes, b.mesh.surface);
    return *made;
  }
  void renew(int bone) { made_[std::size_t(bone)].reset(); }  // after its nodes have moved

 private:
  const std::vector<PlacedBone>& bones_;
  mutable std::vector<std::unique_ptr<BoneSurface>> made_;
};

}  // namespace fabrica::body
