#pragma once
// Where a bone's frame stands: p_global = t + R p_bone, lengths in mm. Sides are mirror images
// about y = 0.
#include <cmath>
#include <vector>

#include "base/tensor.h"

namespace fabrica::body {

using Point = Vec3d;
enum class Side { midline, right, left };

struct Placement {
  Mat3d R{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Point t{0, 0, 0};  // [mm]
  Point operator()(const Point& p) const { return t + R * p; }
  Point inverse(const Point& p) const { return transpose(R) * (p - t); }
};

// rotation by `angle` [rad] about the unit vector a (Rodrigues)
inline Mat3d rotation_about(const Point& a, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), v = 1 - c;
  return {{{c + v * a.x * a.x, v * a.x * a.y - s * a.z, v * a.x * a.z + s * a.y},
           {v * a.x * a.y + s * a.z, c + v * a.y * a.y, v * a.y * a.z - s * a.x},
           {v * a.x * a.z - s * a.y, v * a.y * a.z + s * a.x, c + v * a.z * a.z}}};
}

inline Point unit(const Point& p) { return (1 / norm(p)) * p; }
inline Point middle_of(const std::vector<Point>& points) {
  Point sum{0, 0, 0};
  for (const Point& p : points) sum += p;
  return (1.0 / double(points.size())) * sum;
}
inline Point mirror(const Point& p) { return {p.x, -p.y, p.z}; }
// the placement of the bone of the other side: t_y -> -t_y, R -> M R M, M = diag(1, -1, 1)
inline Placement mirror(const Placement& p) {
  Placement q{p.R, mirror(p.t)};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if ((i == 1) != (j == 1)) q.R(i, j) = -q.R(i, j);
  return q;
}

}  // namespace fabrica::body
