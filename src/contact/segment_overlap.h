#pragma once
// Two segments pressed together, seen along a common direction n from segment 2 to segment 1.
//   Both are projected on the plane normal to n; A is the overlap of the projections. At a point of
//   A the segments lie at heights z1 and z2, each with its shape functions phi1, phi2:
//     d = z2 + t - z1 - d0                                 depth; t thickness, d0 depth that is not
//     pushed back I = int max(0, d) dA,   W_i = int max(0, d) phi_i dA / I
//   A pressure kappa d gives segment 1 the nodal forces kappa I W1_i n and segment 2 the opposite
//   with W2_i. A constant pressure arrives as its consistent nodal forces on both sides, whatever
//   their meshes; both resultants have the same line of action, so linear and angular momentum are
//   kept.
// Integration: the convex overlap is cut into triangles, three points each (exact to degree 2).
// Source: segment-based mortar penalty, M. A. Puso and T. A. Laursen, Comput. Methods Appl. Mech.
// Engrg. 193 (2004) 601-629, with the pressure taken at the points of integration.
#include <algorithm>
#include <cmath>

#include "base/tensor.h"
#include "contact/closest_point.h"

namespace fabrica {

struct SegmentOverlap {
  double integral = 0;                                       // I
  double area = 0;                                           // of the overlap where d > 0
  double depth = 0;                                          // largest d + d0
  double first[4] = {0, 0, 0, 0}, second[4] = {0, 0, 0, 0};  // W1, W2; sum 1
};

// Share of two segments' contact that the overlap carries; cosine: of the angle between one normal
// and the other turned.
inline double facing_share(double cosine) { return std::clamp((cosine - 0.5) / 0.2, 0.0, 1.0); }

namespace overlap_detail {

struct PlanePoint {
  double x, y;
};
inline double side(const PlanePoint& a, const PlanePoint& b, const PlanePoint& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// corners of a segment in the plane, counted counter-clockwise for clipping, and their heights
struct Projection {
  PlanePoint corner[4];
  double height[4];
  int count;
  bool clockwise;

  Projection(const Vec3d* X, bool triangle, const Vec3d& origin, const Vec3d& e1, const Vec3d& e2,
             const Vec3d& n)
      : count(triangle ? 3 : 4) {
    double area = 0;
    for (int i = 0; i < count; ++i) {
      const Vec3d u = X[i] - origin;
      corner[i] = {dot(u, e1), dot(u, e2)}, height[i] = dot(u, n);
    }
    for (int i = 0; i < count; ++i) {
      const PlanePoint &a = corner[i], &b = corner[(i + 1) % count];
      area += a.x * b.y - a.y * b.x;
    }
    clockwise = area < 0;
  }
  const PlanePoint& at(int i) const { return corner[clockwise ? count - 1 - i : i]; }

  // shape functions at a point of the plane; the height there
  double shape(const PlanePoint& p, double* phi) const {
    if (count == 3) {
      const double whole = side(corner[0], corner[1], corner[2]);
      phi[1] = side(corner[2], corner[0], p) / whole,
      phi[2] = side(corner[0], corner[1], p) / whole;
      phi[0] = 1 - phi[1] - phi[2], phi[3] = 0;
    } else {
      double r = 0, s = 0;
      for (int i = 0; i < 8; ++i) {  // Newton; one step where the quad is a parallelogram
        bilinear(r, s, phi);
        double ex = p.x, ey = p.y;
        for (int a = 0; a < 4; ++a) ex -= phi[a] * corner[a].x, ey -= phi[a] * corner[a].y;
        const PlanePoint t1 = edge(1, 0, 2, 3, s), t2 = edge(3, 0, 2, 1, r);
        const double det = t1.x * t2.y - t1.y * t2.x;
        if (det == 0) break;
        const double dr = (t2.y * ex - t2.x * ey) / det, ds = (t1.x * ey - t1.y * ex) / det;
        r = std::clamp(r + dr, -1.5, 1.5), s = std::clamp(s + ds, -1.5, 1.5);
        if (std::max(std::abs(dr), std::abs(ds)) < 1e-10) break;
      }
      bilinear(r, s, phi);
    }
    return phi[0] * height[0] + phi[1] * height[1] + phi[2] * height[2] +
           (count == 4 ? phi[3] * height[3] : 0);
  }

 private:
  static void bilinear(double r, double s, double* phi) {
    phi[0] = 0.25 * (1 - r) * (1 - s), phi[1] = 0.25 * (1 + r) * (1 - s);
    phi[2] = 0.25 * (1 + r) * (1 + s), phi[3] = 0.25 * (1 - r) * (1 + s);
  }
  // tangent: mean of the edges a-b and c-d at the other coordinate q
  PlanePoint edge(int a, int b, int c, int d, double q) const {
    return {0.25 * ((corner[a].x - corner[b].x) * (1 - q) + (corner[c].x - corner[d].x) * (1 + q)),
            0.25 * ((corner[a].y - corner[b].y) * (1 - q) + (corner[c].y - corner[d].y) * (1 + q))};
  }
};

// overlap of two convex polygons (Sutherland and Hodgman); at most 8 corners
inline int clip(const Projection& a, const Projection& b, PlanePoint* out) {
  PlanePoint list[2][16];
  int count = a.count, from = 0;
  for (int i = 0; i < count; ++i) list[0][i] = a.at(i);
  for (int k = 0; k < b.count && count > 0; ++k, from = 1 - from) {
    const PlanePoint &u = b.at(k), &v = b.at((k + 1) % b.count);
    int n = 0;
    for (int i = 0; i < count; ++i) {
      const PlanePoint &p = list[from][i], &q = list[from][(i + 1) % count];
      const double dp = side(u, v, p), dq = side(u, v, q);
      if (dp >= 0) list[1 - from][n++] = p;
      if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
        const double t = dp / (dp - dq);
        list[1 - from][n++] = {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
      }
    }
    count = std::min(n, 12);
  }
  std::copy(list[from], list[from] + count, out);
  return count;
}

}  // namespace overlap_detail

// X, Y: corners of segments 1 and 2; n: unit vector from 2 to 1. Depths beyond `limit` count as
// none.
inline SegmentOverlap segment_overlap(const Vec3d* X, bool triangle_x, const Vec3d* Y,
                                      bool triangle_y, const Vec3d& n, double thickness,
                                      double baseline, double limit) {
  using namespace overlap_detail;
  SegmentOverlap result;
  const Vec3d axis = std::abs(n.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d e1 = contact_detail::unit(cross(axis, n)), e2 = cross(n, e1);
  const Projection p(X, triangle_x, Y[0], e1, e2, n), q(Y, triangle_y, Y[0], e1, e2, n);
  // apart everywhere
  if (*std::min_element(p.height, p.height + p.count) >
      thickness + *std::max_element(q.height, q.height + q.count))
    return result;
  PlanePoint polygon[16];
  const int count = clip(p, q, polygon);
  for (int k = 2; k < count; ++k) {
    const PlanePoint &a = polygon[0], &b = polygon[k - 1], &c = polygon[k];
    const double third = side(a, b, c) / 6;
    if (!(third > 0)) continue;
    for (int i = 0; i < 3; ++i) {
      const double wa = i == 0 ? 2.0 / 3 : 1.0 / 6, wb = i == 1 ? 2.0 / 3 : 1.0 / 6,
                   wc = i == 2 ? 2.0 / 3 : 1.0 / 6;
      const PlanePoint at{wa * a.x + wb * b.x + wc * c.x, wa * a.y + wb * b.y + wc * c.y};
      double phi[4], psi[4];
      const double z1 = p.shape(at, phi), z2 = q.shape(at, psi);
      const double whole = z2 + thickness - z1;
      if (whole > thickness + limit) continue;
      result.depth = std::max(result.depth, whole);
      const double d = whole - baseline;
      if (!(d > 0)) continue;
      result.integral += third * d, result.area += third;
      for (int m = 0; m < 4; ++m)
        result.first[m] += third * d * phi[m], result.second[m] += third * d * psi[m];
    }
  }
  if (result.integral > 0)
    for (int m = 0; m < 4; ++m)
      result.first[m] /= result.integral, result.second[m] /= result.integral;
  return result;
}

}  // namespace fabrica
