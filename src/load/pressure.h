#pragma once
// Pressure on a four- or three-node segment: the force -p A n is shared equally by its corners,
// with the area vector
//   A n = 1/2 (x3 - x1) x (x4 - x2)
// Positive pressure acts against the normal that the node order gives by the right-hand rule.
#include "base/tensor.h"

namespace fabrica {

// Force on each corner; triangle: x[3] equal to x[2], three corners share.
inline Vec3d pressure_corner_force(const Vec3d (&x)[4], bool triangle, double pressure) {
  const Vec3d area = 0.5 * cross(x[2] - x[0], x[3] - x[1]);
  return (-pressure / (triangle ? 3.0 : 4.0)) * area;
}

}  // namespace fabrica
