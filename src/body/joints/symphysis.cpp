#include "body/joints/symphysis.h"

#include <algorithm>
#include <cmath>

namespace fabrica::body {

double fit_symphysis(std::vector<PlacedBone>& bones) {
  constexpr double width = 5, fade = 20, most = 3;  // [mm]
  const int right = find_bone(bones, "hip_bone", Side::right),
            left = find_bone(bones, "hip_bone", Side::left);
  if (right < 0 || left < 0) return 0;
  double nearest = 1e30;
  for (const Point& p : bones[std::size_t(right)].mesh.nodes)
    nearest = std::min(nearest, std::abs(p.y));
  const double half = 0.5 * width * bones[std::size_t(right)].mesh.scale.y;
  const double shift = std::clamp(nearest - half, 0.0, most);
  for (const int b : {right, left}) {
    PlacedBone& bone = bones[std::size_t(b)];
    for (std::size_t n = 0; n < bone.nodes.size(); ++n) {
      Point& p = bone.mesh.nodes[n];
      const double t = std::clamp((std::abs(p.y) - nearest) / fade, 0.0, 1.0);
      p.y -= std::copysign(shift * (1 - t * t * (3 - 2 * t)), p.y);
      bone.nodes[n] = bone.placement(p);
    }
  }
  return shift;
}

}  // namespace fabrica::body
