#pragma once
// Eigenvalues and eigenvectors of a symmetric 3x3 tensor over any lane: cyclic Jacobi with a fixed
// number of sweeps.
//   rotation in the plane (p, q): tan phi = sign(d) 2 a_pq / (|d| + sqrt(d^2 + 4 a_pq^2)),  d =
//   a_qq - a_pp  (1)
// Source: Golub and Van Loan, Matrix Computations, section 8.5.
#include "base/tensor.h"

namespace fabrica {

template <class L>
struct Eigen3 {
  Vec3<L> value;      // in no particular order
  Vec3<L> vector[3];  // orthonormal, vector[i] belongs to value[i]
};

template <class L>
FABRICA_FN Eigen3<L> eigen_symmetric(const Sym3<L>& s) {
  L a[3][3] = {{s.xx, s.xy, s.zx}, {s.xy, s.yy, s.yz}, {s.zx, s.yz, s.zz}};
  const Mat3<L> one = identity3<L>();
  Vec3<L> v[3] = {{one.a[0][0], one.a[0][1], one.a[0][2]},
                  {one.a[1][0], one.a[1][1], one.a[1][2]},
                  {one.a[2][0], one.a[2][1], one.a[2][2]}};
  constexpr int sweeps = sizeof(ScalarOf<L>) == 8 ? 6 : 4;
  const L zero = L(0.0);
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        const int r = 3 - p - q;
        const L d = a[q][q] - a[p][p], twice = L(2.0) * a[p][q];
        const L length = abs(d) + sqrt(fma(d, d, twice * twice));
        const L ratio = min(abs(twice) / select(length > zero, length, L(1.0)), L(1.0));
        const L t =
            select(((d < zero) & (twice < zero)) | ((d >= zero) & (twice >= zero)), ratio, -ratio);
        const L c = L(1.0) / sqrt(fma(t, t, L(1.0))), sine = t * c;
        a[p][p] = a[p][p] - t * a[p][q];
        a[q][q] = a[q][q] + t * a[p][q];
        a[p][q] = zero, a[q][p] = zero;
        const L ap = a[r][p], aq = a[r][q];
        a[r][p] = fma(c, ap, -(sine * aq)), a[r][q] = fma(sine, ap, c * aq);
        a[p][r] = a[r][p], a[q][r] = a[r][q];
        const Vec3<L> vp = v[p], vq = v[q];
        v[p] = c * vp - sine * vq, v[q] = sine * vp + c * vq;
      }
  return {{a[0][0], a[1][1], a[2][2]}, {v[0], v[1], v[2]}};
}

// sum over i of value[i] n_i n_i
template <class L>
FABRICA_FN Sym3<L> from_principal(const Vec3<L>& value, const Vec3<L> (&n)[3]) {
  Sym3<L> s{L(0.0), L(0.0), L(0.0), L(0.0), L(0.0), L(0.0)};
  for (int i = 0; i < 3; ++i) {
    const Vec3<L> w = value[i] * n[i];
    s.xx = fma(w.x, n[i].x, s.xx), s.yy = fma(w.y, n[i].y, s.yy), s.zz = fma(w.z, n[i].z, s.zz);
    s.xy = fma(w.x, n[i].y, s.xy), s.yz = fma(w.y, n[i].z, s.yz), s.zx = fma(w.z, n[i].x, s.zx);
  }
  return s;
}

}  // namespace fabrica
