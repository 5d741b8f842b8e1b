#pragma once
// Finite rotations in double precision.
//   q = (w, x, y, z), unit;  exp(a) = (cos |a|/2, sin(|a|/2) a/|a|);  R(q) turns body components
//   into global ones. log R(q) = the rotation vector a with |a| <= pi and exp(a) = +-q.
#include <array>
#include <cmath>

#include "base/tensor.h"

namespace fabrica {

struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
  Vec3d vector() const { return {x, y, z}; }
  Quaternion conjugate() const { return {w, -x, -y, -z}; }
};

inline Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
inline Quaternion normalised(const Quaternion& q) {
  const double s = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {s * q.w, s * q.x, s * q.y, s * q.z};
}

// The rotation by the vector a (radians).
inline Quaternion exponential(const Vec3d& a) {
  const double angle = norm(a), half = 0.5 * angle;
  // sin(h)/(2h), by its series where the division would lose digits
  const double s =
      half > 1e-4 ? std::sin(half) / angle : 0.5 * (1 - half * half / 6 * (1 - half * half / 20));
  return {std::cos(half), s * a.x, s * a.y, s * a.z};
}

// The rotation vector of q (radians), |a| <= pi.
inline Vec3d logarithm(const Quaternion& p) {
  const double sign = p.w < 0 ? -1 : 1;
  const Vec3d v = sign * p.vector();
  const double s = norm(v), c = sign * p.w;
  const double f = s > 1e-9 ? 2 * std::atan2(s, c) / s : 2 / c;
  return f * v;
}

// The matrix of a unit quaternion: global components from body components.
inline Mat3d matrix_of(const Quaternion& q) {
  const double w = q.w, x = q.x, y = q.y, z = q.z;
  return {{{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}}};
}

// The unit quaternion of a rotation matrix (Shepperd's choice of the largest component).
inline Quaternion quaternion_of(const Mat3d& m) {
  const double t = m(0, 0) + m(1, 1) + m(2, 2);
  Quaternion q;
  if (t >= m(0, 0) && t >= m(1, 1) && t >= m(2, 2))
    q = {1 + t, m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)};
  else if (m(0, 0) >= m(1, 1) && m(0, 0) >= m(2, 2))
    q = {m(2, 1) - m(1, 2), 1 + 2 * m(0, 0) - t, m(0, 1) + m(1, 0), m(0, 2) + m(2, 0)};
  else if (m(1, 1) >= m(2, 2))
    q = {m(0, 2) - m(2, 0), m(0, 1) + m(1, 0), 1 + 2 * m(1, 1) - t, m(1, 2) + m(2, 1)};
  else
    q = {m(1, 0) - m(0, 1), m(0, 2) + m(2, 0), m(1, 2) + m(2, 1), 1 + 2 * m(2, 2) - t};
  return normalised(q);
}

struct PrincipalAxes {
  Vec3d value;  // principal values
  Mat3d axes;   // columns: principal directions in global components, right-handed
};

// Principal values and axes of a symmetric matrix by cyclic Jacobi rotations.
inline PrincipalAxes principal_axes(const Mat3d& symmetric) {
  Mat3d a = symmetric, v = identity3<double>();
  for (int sweep = 0; sweep < 40; ++sweep) {
    const double off = std::abs(a(0, 1)) + std::abs(a(0, 2)) + std::abs(a(1, 2));
    const double on = std::abs(a(0, 0)) + std::abs(a(1, 1)) + std::abs(a(2, 2));
    if (off <= 1e-17 * on) break;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a(p, q) == 0) continue;
        const double theta = 0.5 * (a(q, q) - a(p, p)) / a(p, q);
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        Mat3d g = identity3<double>();
        g(p, p) = g(q, q) = c, g(p, q) = s, g(q, p) = -s;
        a = transpose(g) * a * g;
        a(p, q) = a(q, p) = 0;
        v = v * g;
      }
  }
  if (det(v) < 0)
    for (int i = 0; i < 3; ++i) v(i, 2) = -v(i, 2);
  return {{a(0, 0), a(1, 1), a(2, 2)}, v};
}

// Two unit vectors that make a right-handed triad with the unit vector e: {p, q}, p x q = e.
inline std::array<Vec3d, 2> normal_pair(const Vec3d& e) {
  const double ax = std::abs(e.x), ay = std::abs(e.y), az = std::abs(e.z);
  const Vec3d a = ax <= ay && ax <= az ? Vec3d{1, 0, 0}
                  : ay <= az           ? Vec3d{0, 1, 0}
                                       : Vec3d{0, 0, 1};
  Vec3d p = cross(a, e);
  p = (1 / norm(p)) * p;
  return {p, cross(e, p)};
}

}  // namespace fabrica
