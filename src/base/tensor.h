#pragma once
// Small vectors and tensors over a lane type. Symmetric tensors use the order xx, yy, zz, xy, yz,
// zx everywhere; shear components are tensor components (half the engineering shear strain).
#include "base/lane.h"

namespace fabrica {

template <class L>
struct Vec3 {
  L x, y, z;
  FABRICA_FN L& operator[](int i) { return (&x)[i]; }
  FABRICA_FN const L& operator[](int i) const { return (&x)[i]; }
};
using Vec3d = Vec3<double>;

template <class L>
FABRICA_FN Vec3<L> operator+(const Vec3<L>& a, const Vec3<L>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class L>
FABRICA_FN Vec3<L> operator-(const Vec3<L>& a, const Vec3<L>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class L>
FABRICA_FN Vec3<L> operator-(const Vec3<L>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class L>
FABRICA_FN Vec3<L> operator*(const L& s, const Vec3<L>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class L>
FABRICA_FN Vec3<L>& operator+=(Vec3<L>& a, const Vec3<L>& b) {
  a.x += b.x, a.y += b.y, a.z += b.z;
  return a;
}
template <class L>
FABRICA_FN Vec3<L>& operator-=(Vec3<L>& a, const Vec3<L>& b) {
  a.x -= b.x, a.y -= b.y, a.z -= b.z;
  return a;
}
template <class L>
FABRICA_FN L dot(const Vec3<L>& a, const Vec3<L>& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
template <class L>
FABRICA_FN Vec3<L> cross(const Vec3<L>& a, const Vec3<L>& b) {
  return {fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x))};
}
template <class L>
FABRICA_FN L norm(const Vec3<L>& a) {
  return sqrt(dot(a, a));
}

// row-major 3x3 matrix
template <class L>
struct Mat3 {
  L a[3][3];
  FABRICA_FN L& operator()(int i, int j) { return a[i][j]; }
  FABRICA_FN const L& operator()(int i, int j) const { return a[i][j]; }
};
using Mat3d = Mat3<double>;

template <class L>
FABRICA_FN Mat3<L> identity3() {
  return {{{L(1.0), L(0.0), L(0.0)}, {L(0.0), L(1.0), L(0.0)}, {L(0.0), L(0.0), L(1.0)}}};
}
template <class L>
FABRICA_FN Mat3<L> operator+(const Mat3<L>& a, const Mat3<L>& b) {
  Mat3<L> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.a[i][j] = a.a[i][j] + b.a[i][j];
  return r;
}
template <class L>
FABRICA_FN Mat3<L> operator*(const Mat3<L>& a, const Mat3<L>& b) {
  Mat3<L> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r.a[i][j] = fma(a.a[i][0], b.a[0][j], fma(a.a[i][1], b.a[1][j], a.a[i][2] * b.a[2][j]));
  return r;
}
template <class L>
FABRICA_FN Vec3<L> operator*(const Mat3<L>& a, const Vec3<L>& b) {
  return {fma(a.a[0][0], b.x, fma(a.a[0][1], b.y, a.a[0][2] * b.z)),
          fma(a.a[1][0], b.x, fma(a.a[1][1], b.y, a.a[1][2] * b.z)),
          fma(a.a[2][0], b.x, fma(a.a[2][1], b.y, a.a[2][2] * b.z))};
}
template <class L>
FABRICA_FN Mat3<L> transpose(const Mat3<L>& a) {
  Mat3<L> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.a[i][j] = a.a[j][i];
  return r;
}
template <class L>
FABRICA_FN L det(const Mat3<L>& m) {
  const auto& a = m.a;
  return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
         a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
         a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}
// inverse of m; the determinant must not vanish
template <class L>
FABRICA_FN Mat3<L> inverse(const Mat3<L>& m) {
  const auto& a = m.a;
  const L i = L(1.0) / det(m);
  return {
      {{i * (a[1][1] * a[2][2] - a[1][2] * a[2][1]), i * (a[0][2] * a[2][1] - a[0][1] * a[2][2]),
        i * (a[0][1] * a[1][2] - a[0][2] * a[1][1])},
       {i * (a[1][2] * a[2][0] - a[1][0] * a[2][2]), i * (a[0][0] * a[2][2] - a[0][2] * a[2][0]),
        i * (a[0][2] * a[1][0] - a[0][0] * a[1][2])},
       {i * (a[1][0] * a[2][1] - a[1][1] * a[2][0]), i * (a[0][1] * a[2][0] - a[0][0] * a[2][1]),
        i * (a[0][0] * a[1][1] - a[0][1] * a[1][0])}}};
}

template <class L>
struct Sym3 {
  L xx, yy, zz, xy, yz, zx;
  FABRICA_FN L& operator[](int i) { return (&xx)[i]; }
  FABRICA_FN const L& operator[](int i) const { return (&xx)[i]; }
};

template <class L>
FABRICA_FN Sym3<L> operator+(const Sym3<L>& a, const Sym3<L>& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.yz + b.yz, a.zx + b.zx};
}
template <class L>
FABRICA_FN Sym3<L> operator-(const Sym3<L>& a, const Sym3<L>& b) {
  return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.yz - b.yz, a.zx - b.zx};
}
template <class L>
FABRICA_FN Sym3<L> operator*(const L& s, const Sym3<L>& a) {
  return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.yz, s * a.zx};
}
template <class L>
FABRICA_FN Sym3<L>& operator+=(Sym3<L>& a, const Sym3<L>& b) {
  for (int i = 0; i < 6; ++i) a[i] += b[i];
  return a;
}
template <class L>
FABRICA_FN L trace(const Sym3<L>& a) {
  return a.xx + a.yy + a.zz;
}
// a : b
template <class L>
FABRICA_FN L ddot(const Sym3<L>& a, const Sym3<L>& b) {
  const L normal = fma(a.xx, b.xx, fma(a.yy, b.yy, a.zz * b.zz));
  const L shear = fma(a.xy, b.xy, fma(a.yz, b.yz, a.zx * b.zx));
  return fma(L(2.0), shear, normal);
}
template <class L>
FABRICA_FN Sym3<L> plus_sphere(const Sym3<L>& a, const L& p) {
  return {a.xx + p, a.yy + p, a.zz + p, a.xy, a.yz, a.zx};
}
template <class L>
FABRICA_FN Sym3<L> deviator(const Sym3<L>& a) {
  return plus_sphere(a, -(trace(a) * L(1.0 / 3.0)));
}
template <class L>
FABRICA_FN Sym3<L> sym(const Mat3<L>& m) {
  const L h = L(0.5);
  return {m.a[0][0],
          m.a[1][1],
          m.a[2][2],
          h * (m.a[0][1] + m.a[1][0]),
          h * (m.a[1][2] + m.a[2][1]),
          h * (m.a[2][0] + m.a[0][2])};
}
// B = F F^T
template <class L>
FABRICA_FN Sym3<L> left_cauchy_green(const Mat3<L>& F) {
  Sym3<L> b;
  auto row = [&](int i, int j) {
    return fma(F.a[i][0], F.a[j][0], fma(F.a[i][1], F.a[j][1], F.a[i][2] * F.a[j][2]));
  };
  b.xx = row(0, 0), b.yy = row(1, 1), b.zz = row(2, 2);
  b.xy = row(0, 1), b.yz = row(1, 2), b.zx = row(2, 0);
  return b;
}
// a a, the square of a symmetric tensor
template <class L>
FABRICA_FN Sym3<L> square(const Sym3<L>& a) {
  return {a.xx * a.xx + a.xy * a.xy + a.zx * a.zx, a.xy * a.xy + a.yy * a.yy + a.yz * a.yz,
          a.zx * a.zx + a.yz * a.yz + a.zz * a.zz, a.xx * a.xy + a.xy * a.yy + a.zx * a.yz,
          a.xy * a.zx + a.yy * a.yz + a.yz * a.zz, a.xx * a.zx + a.xy * a.yz + a.zx * a.zz};
}
template <class L>
FABRICA_FN Vec3<L> operator*(const Sym3<L>& s, const Vec3<L>& n) {
  return {fma(s.xx, n.x, fma(s.xy, n.y, s.zx * n.z)), fma(s.xy, n.x, fma(s.yy, n.y, s.yz * n.z)),
          fma(s.zx, n.x, fma(s.yz, n.y, s.zz * n.z))};
}
// R s R^T
template <class L>
FABRICA_FN Sym3<L> rotate(const Mat3<L>& R, const Sym3<L>& s) {
  const Mat3<L> S{{{s.xx, s.xy, s.zx}, {s.xy, s.yy, s.yz}, {s.zx, s.yz, s.zz}}};
  return sym(R * S * transpose(R));
}
// sqrt(3/2 dev(s):dev(s)), the von Mises stress of a deviator
template <class L>
FABRICA_FN L von_mises_of_deviator(const Sym3<L>& s) {
  return sqrt(L(1.5) * ddot(s, s));
}

}  // namespace fabrica
