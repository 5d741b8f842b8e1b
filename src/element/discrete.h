#pragma once
// Kinematics of springs and discrete beams, in double.
//
// A spring joins points a and b (b may be a fixed point of the ground) and acts along the unit axis
// e:
//   along the line      e = (b - a) / |b - a|                d = |b - a|
//   along a direction   e given                              d = e.(b - a)
//   in a plane          e = P(b - a) / |P(b - a)|            d = |P(b - a)|,  P = I - n n^T
// Force F (tension positive) pulls the points together: +F e on a, -F e on b.
//
// A discrete beam carries a triad R (rows: local axes r, s, t) that turns with angular velocity w:
//   R(n) = R(n-1) exp(-dt [w]x) (Rodrigues)
#include <cmath>

#include "base/tensor.h"

namespace fabrica {

struct SpringAxis {
  Vec3d e{};     // unit vector, or zero where it is not defined
  double d = 0;  // length along it
};

// unit vector of v, or zero if v is shorter than tiny
inline Vec3d unit_or_zero(const Vec3d& v, double tiny = 1e-300) {
  const double l = norm(v);
  return l > tiny ? (1.0 / l) * v : Vec3d{0, 0, 0};
}

inline SpringAxis axis_along_line(const Vec3d& a, const Vec3d& b) {
  const Vec3d r = b - a;
  return {unit_or_zero(r), norm(r)};
}
inline SpringAxis axis_along_direction(const Vec3d& a, const Vec3d& b, const Vec3d& e) {
  return {e, dot(e, b - a)};
}
inline SpringAxis axis_in_plane(const Vec3d& a, const Vec3d& b, const Vec3d& normal) {
  const Vec3d r = b - a;
  const Vec3d p = r - dot(normal, r) * normal;
  return {unit_or_zero(p), norm(p)};
}

// v turned by the rotation vector phi (angle |phi| about its direction)
inline Vec3d turned(const Vec3d& v, const Vec3d& phi) {
  const double angle = norm(phi);
  if (angle == 0) return v;
  const Vec3d k = (1.0 / angle) * phi;
  const double c = std::cos(angle), s = std::sin(angle);
  return c * v + s * cross(k, v) + ((1 - c) * dot(k, v)) * k;
}

// rows of a matrix as vectors
inline Vec3d row_of(const Mat3d& m, int i) { return {m.a[i][0], m.a[i][1], m.a[i][2]}; }
inline Mat3d from_rows(const Vec3d& r, const Vec3d& s, const Vec3d& t) {
  return {{{r.x, r.y, r.z}, {s.x, s.y, s.z}, {t.x, t.y, t.z}}};
}

// right-handed orthonormal rows from r and a vector near s; r must not vanish nor be parallel to s
inline Mat3d orthonormal_rows(const Vec3d& r, const Vec3d& s) {
  const Vec3d e = unit_or_zero(r);
  const Vec3d t = unit_or_zero(cross(e, s));
  return from_rows(e, cross(t, e), t);
}

// the triad after turning by phi = w dt, made orthonormal again
inline Mat3d turned_rows(const Mat3d& R, const Vec3d& phi) {
  return orthonormal_rows(turned(row_of(R, 0), phi), turned(row_of(R, 1), phi));
}

// largest stable step of a spring and damper: 2 / (sqrt(w^2 + g^2) + g) with w^2 = k (1/m1 + 1/m2)
// and g = c (1/m1 + 1/m2) / 2; this is (2/w) (sqrt(1 + xi^2) - xi) with damping at the lagged half
// step
inline double spring_time_step(double w2, double g) {
  const double root = std::sqrt(w2 + g * g) + g;
  return root > 0 ? 2 / root : INFINITY;
}

}  // namespace fabrica
