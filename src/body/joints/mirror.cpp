#include "body/joints/mirror.h"

#include "body/mesh/untangle.h"

namespace fabrica::body {

Mirror::Mirror(const std::vector<PlacedBone>& bones)
    : twin(bones.size(), -1), own(bones.size(), 0) {
  constexpr double off = 1e-6;  // [mm]
  for (std::size_t r = 0; r < bones.size(); ++r) {
    const PlacedBone& bone = bones[r];
    if (bone.side == Side::midline) {
      bool same = !bone.mesh.image.empty();
      for (std::size_t n = 0; same && n < bone.nodes.size(); ++n)
        same = norm(bone.nodes[n] - mirror(bone.nodes[std::size_t(bone.mesh.image[n])])) < off;
      own[r] = same;
    }
    if (bone.side != Side::right) continue;
    const int l = find_bone(bones, bone.mesh.name, Side::left);
    if (l < 0) continue;
    const std::vector<Point>& left = bones[std::size_t(l)].nodes;
    bool same = bone.nodes.size() == left.size();
    for (std::size_t n = 0; same && n < left.size(); ++n)
      same = norm(bone.nodes[n] - mirror(left[n])) < off;
    if (same) twin[r] = l, twin[std::size_t(l)] = int(r);
  }
}

void restore_symmetry(const Mirror& mirrors, std::vector<PlacedBone>& bones) {
  for (std::size_t b = 0; b < bones.size(); ++b)
    if (mirrors.own[b]) restore_symmetry(bones[b].mesh.image, bones[b].nodes);
}

}  // namespace fabrica::body
