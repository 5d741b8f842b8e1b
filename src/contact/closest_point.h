#pragma once
// Closest point of a segment to a point x.
//   bilinear quad X(r,s) = sum phi_i X_i, phi = (1 +- r)(1 +- s)/4:  (x - X).X,r = 0, (x - X).X,s =
//   0 by Newton's method; where r or s leave [-1,1] the closest point lies on an edge or a corner.
//   triangle: closed form in barycentric coordinates.
// The distance is continuous in x and in the corners (1-Lipschitz): forces do not jump at edges.
#include <algorithm>
#include <cmath>

#include "base/tensor.h"

namespace fabrica {

struct SurfacePoint {
  double phi[4];  // weights of the corners; sum 1
  Vec3d x;        // closest point
  Vec3d normal;   // unit normal of the segment there
  double r, s;
  int feature;  // 0 inside; 1-4 on edge i-1 -> i; 5-8 corner i-5
};

namespace contact_detail {

inline Vec3d unit(const Vec3d& a) {
  const double length = norm(a);
  return length > 0 ? (1 / length) * a : Vec3d{0, 0, 1};
}

// closest point on the edges of a polygon of `corners` corners
inline double closest_on_edges(const Vec3d* X, int corners, const Vec3d& x, SurfacePoint& p) {
  double best = 1e300;
  for (int i = 0; i < corners; ++i) {
    const int j = (i + 1) % corners;
    const Vec3d d = X[j] - X[i], e = x - X[i];
    const double length2 = dot(d, d);
    double t = length2 > 0 ? dot(d, e) / length2 : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    const Vec3d gap = e - t * d;
    const double distance2 = dot(gap, gap);
    if (distance2 >= best) continue;
    best = distance2;
    p.feature = t == 0 ? 5 + i : t == 1 ? 5 + j : 1 + i;
    for (double& w : p.phi) w = 0;
    p.phi[i] = 1 - t, p.phi[j] = t;
    p.x = X[i] + t * d;
  }
  return best;
}

inline void natural_coordinates_of_edge_point(SurfacePoint& p) {
  p.r = p.phi[1] + p.phi[2] - p.phi[0] - p.phi[3];
  p.s = p.phi[2] + p.phi[3] - p.phi[0] - p.phi[1];
}

}  // namespace contact_detail

// Triangle with corners X[0..2].
inline SurfacePoint closest_point_triangle(const Vec3d* X, const Vec3d& x) {
  SurfacePoint p;
  p.r = p.s = 0, p.feature = 0;
  const Vec3d a = X[1] - X[0], b = X[2] - X[0], e = x - X[0];
  const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), ea = dot(e, a), eb = dot(e, b);
  const double d = aa * bb - ab * ab;
  p.normal = contact_detail::unit(cross(a, b));
  const double u = bb * ea - ab * eb, v = aa * eb - ab * ea;
  if (d > 0 && u >= 0 && v >= 0 && u + v <= d) {
    p.phi[1] = u / d, p.phi[2] = v / d, p.phi[0] = 1 - p.phi[1] - p.phi[2], p.phi[3] = 0;
    p.x = X[0] + p.phi[1] * a + p.phi[2] * b;
    return p;
  }
  contact_detail::closest_on_edges(X, 3, x, p);
  return p;
}

// Quad with corners X[0..3]; r, s: where to start (a former solution or 0, 0).
inline SurfacePoint closest_point_quad(const Vec3d* X, const Vec3d& x, double r, double s) {
  SurfacePoint p;
  p.feature = 0;
  const Vec3d c = 0.25 * (X[0] + X[1] + X[2] + X[3]), a = 0.25 * (X[1] + X[2] - X[0] - X[3]);
  const Vec3d b = 0.25 * (X[2] + X[3] - X[0] - X[1]), g = 0.25 * (X[0] - X[1] + X[2] - X[3]);
  Vec3d t1, t2, e;
  const double size2 = dot(a, a) + dot(b, b);
  for (int i = 0; i < 12; ++i) {
    t1 = a + s * g, t2 = b + r * g;
    e = x - (c + r * a + s * b + (r * s) * g);
    const double e1 = dot(e, t1), e2 = dot(e, t2);
    const double k11 = dot(t1, t1), k22 = dot(t2, t2);
    double k12 = dot(t1, t2);
    const double curvature = dot(e, g);
    // the full Newton matrix only while it stays positive definite
    if ((k12 - curvature) * (k12 - curvature) < 0.9 * k11 * k22) k12 -= curvature;
    const double d = k11 * k22 - k12 * k12;
    if (!(d > 1e-24 * size2 * size2)) break;
    double dr = (k22 * e1 - k12 * e2) / d, ds = (k11 * e2 - k12 * e1) / d;
    const double largest = std::max(std::abs(dr), std::abs(ds));
    if (largest > 1) dr /= largest, ds /= largest;
    r = std::clamp(r + dr, -1.5, 1.5), s = std::clamp(s + ds, -1.5, 1.5);
    if (largest < 1e-6) break;  // the error is its square
  }
  if (std::abs(r) <= 1 && std::abs(s) <= 1) {
    p.phi[0] = 0.25 * (1 - r) * (1 - s), p.phi[1] = 0.25 * (1 + r) * (1 - s);
    p.phi[2] = 0.25 * (1 + r) * (1 + s), p.phi[3] = 0.25 * (1 - r) * (1 + s);
    p.x = c + r * a + s * b + (r * s) * g;
    p.r = r, p.s = s;
  } else {
    contact_detail::closest_on_edges(X, 4, x, p);
    contact_detail::natural_coordinates_of_edge_point(p);
  }
  p.normal = contact_detail::unit(cross(a + p.s * g, b + p.r * g));
  return p;
}

// Closest points of two straight edges p1 + a d1 and p2 + b d2, a and b in [0,1].
//   A = d1.d1, B = d1.d2, C = d2.d2, D = d1.(p1-p2), E = d2.(p1-p2):  a = (B E - C D)/(A C - B^2)
struct EdgePoints {
  double a, b;
  Vec3d gap;  // from the point on edge 2 to the point on edge 1
};
inline EdgePoints closest_points_edges(const Vec3d& p1, const Vec3d& d1, const Vec3d& p2,
                                       const Vec3d& d2) {
  const Vec3d w = p1 - p2;
  const double A = dot(d1, d1), B = dot(d1, d2), C = dot(d2, d2), D = dot(d1, w), E = dot(d2, w);
  const double det = A * C - B * B;
  auto limit = [](double t) { return t < 0 ? 0.0 : t > 1 ? 1.0 : t; };
  double a = det > 1e-10 * A * C ? limit((B * E - C * D) / det) : 0.0;
  const double b = limit(C > 0 ? (a * B + E) / C : 0.0);
  a = limit(A > 0 ? (b * B - D) / A : 0.0);
  return {a, b, w + a * d1 - b * d2};
}

}  // namespace fabrica
