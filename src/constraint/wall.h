#pragma once
// Signed distance g (positive outside) and outward normal of a point to analytic walls.
//   plane, flat: infinite or a rectangle l x m; prism: rectangle with depth against the normal;
//   cylinder: infinite or of a length; sphere.
// Finite walls act on what is in front of them only: `inside` tells whether the foot of the point
// is on the wall.
#include <algorithm>
#include <cmath>

#include "base/tensor.h"

namespace fabrica {

enum class WallShape { plane, prism, cylinder, sphere };

struct WallGeometry {
  WallShape shape = WallShape::plane;
  Vec3d origin{};         // a corner of rectangles, start of the axis, centre of a sphere
  Vec3d normal{0, 0, 1};  // outward; axis of a cylinder
  Vec3d edge_l{1, 0, 0}, edge_m{0, 1, 0};
  double length_l = 0, length_m = 0;  // 0: infinite
  double radius = 0, length = 0;      // length of a cylinder, depth of a prism; 0: infinite
};

struct WallPoint {
  double distance;
  Vec3d normal;
  bool on_wall;
};

// The point's place relative to the wall; |distance| changes no faster than the point moves.
inline WallPoint wall_point(const WallGeometry& w, const Vec3d& x) {
  const Vec3d d = x - w.origin;
  if (w.shape == WallShape::sphere) {
    const double r = norm(d);
    return {r - w.radius, r > 0 ? (1 / r) * d : Vec3d{0, 0, 1}, true};
  }
  const double h = dot(d, w.normal);
  if (w.shape == WallShape::cylinder) {
    const Vec3d across = d - h * w.normal;
    const double r = norm(across);
    const bool on = w.length <= 0 || (h >= 0 && h <= w.length);
    return {r - w.radius, r > 0 ? (1 / r) * across : w.edge_l, on};
  }
  const double a = dot(d, w.edge_l), b = dot(d, w.edge_m);
  const bool on = (w.length_l <= 0 || (a >= 0 && a <= w.length_l)) &&
                  (w.length_m <= 0 || (b >= 0 && b <= w.length_m));
  if (w.shape == WallShape::plane || !on || h >= 0) return {h, w.normal, on};
  // inside a prism: out through the nearest face
  WallPoint p{h, w.normal, w.length <= 0 || h >= -w.length};
  auto face = [&](double distance, const Vec3d& n) {
    if (distance > p.distance) p.distance = distance, p.normal = n;
  };
  if (w.length_l > 0) face(-a, -w.edge_l), face(a - w.length_l, w.edge_l);
  if (w.length_m > 0) face(-b, -w.edge_m), face(b - w.length_m, w.edge_m);
  if (w.length > 0) face(-w.length - h, -w.normal);
  return p;
}

// A lower bound of the distance: what must be travelled before the point can be on the wall.
inline double wall_clearance(const WallGeometry& w, const Vec3d& x) {
  const Vec3d d = x - w.origin;
  const double h = dot(d, w.normal);
  if (w.shape == WallShape::sphere) return norm(d) - w.radius;
  if (w.shape == WallShape::cylinder) {
    const double r = norm(d - h * w.normal) - w.radius;
    return w.length > 0 ? std::max({r, -h, h - w.length}) : r;
  }
  double c = h;
  if (w.shape == WallShape::prism && w.length > 0) c = std::max(c, -w.length - h);
  if (w.shape == WallShape::prism || h >= 0) {
    const double a = dot(d, w.edge_l), b = dot(d, w.edge_m);
    if (w.length_l > 0) c = std::max({c, -a, a - w.length_l});
    if (w.length_m > 0) c = std::max({c, -b, b - w.length_m});
  }
  return c;
}

}  // namespace fabrica
