#pragma once
// Gradients, volume and faces of the eight-node brick; see hex8.h for symbols.
#include "element/kernel.h"

namespace fabrica {

template <class L>
struct HexGradient {
  Vec3<L> b[8];  // grad N_A
  L volume;
  bool antisymmetric;  // b[6] = -b[0], b[7] = -b[1], b[4] = -b[2], b[5] = -b[3]

  // velocity gradient sum_A v_A (x) b_A
  FABRICA_FN Mat3<L> times(const Vec3<L> (&v)[8]) const {
    Mat3<L> r;
    if (antisymmetric) {
      const Vec3<L> d[4] = {v[0] - v[6], v[1] - v[7], v[2] - v[4], v[3] - v[5]};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          r.a[i][j] = fma(d[0][i], b[0][j],
                          fma(d[1][i], b[1][j], fma(d[2][i], b[2][j], d[3][i] * b[3][j])));
    } else {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          L sum = v[0][i] * b[0][j];
          for (int a = 1; a < 8; ++a) sum = fma(v[a][i], b[a][j], sum);
          r.a[i][j] = sum;
        }
    }
    return r;
  }
  // sum_A |b_A|^2
  FABRICA_FN L squares() const {
    L sum = dot(b[0], b[0]);
    for (int a = 1; a < (antisymmetric ? 4 : 8); ++a) sum += dot(b[a], b[a]);
    return antisymmetric ? L(2.0) * sum : sum;
  }
};

// one component of dV/dx of node `a`, from the two other coordinates of all nodes
template <class L>
FABRICA_FN L hex_volume_row(const Vec3<L> (&x)[8], int a, int y, int z) {
  // the neighbours of node a in the order that maps the formula of node 1 onto it
  constexpr int ring[8][6] = {{1, 2, 3, 4, 5, 7}, {2, 3, 0, 5, 6, 4}, {3, 0, 1, 6, 7, 5},
                              {0, 1, 2, 7, 4, 6}, {7, 6, 5, 0, 3, 1}, {4, 7, 6, 1, 0, 2},
                              {5, 4, 7, 2, 1, 3}, {6, 5, 4, 3, 2, 0}};
  const int* n = ring[a];
  auto Y = [&](int k) { return x[n[k]][y]; };
  auto Z = [&](int k) { return x[n[k]][z]; };
  // k: 0 -> node 2, 1 -> 3, 2 -> 4, 3 -> 5, 4 -> 6, 5 -> 8
  return L(1.0 / 12.0) *
         (Y(0) * ((Z(4) - Z(1)) - (Z(2) - Z(3))) + Y(1) * (Z(0) - Z(2)) +
          Y(2) * ((Z(1) - Z(5)) - (Z(3) - Z(0))) + Y(3) * ((Z(5) - Z(4)) - (Z(0) - Z(2))) +
          Y(4) * (Z(3) - Z(0)) + Y(5) * (Z(2) - Z(3)));
}

template <bool Exact, class L>
FABRICA_FN HexGradient<L> hex_gradient(const Vec3<L> (&at)[8]) {
  HexGradient<L> g;
  g.antisymmetric = !Exact;
  Vec3<L> x[8];
  for (int a = 0; a < 8; ++a) x[a] = Exact ? at[a] - at[0] : at[a];
  if constexpr (Exact) {
    for (int a = 0; a < 8; ++a)
      g.b[a] = {hex_volume_row(x, a, 1, 2), hex_volume_row(x, a, 2, 0), hex_volume_row(x, a, 0, 1)};
    L volume = L(0.0);
    for (int a = 1; a < 8; ++a) volume += g.b[a].x * x[a].x;
    g.volume = volume;
    const L inverse = L(1.0) / volume;
    for (int a = 0; a < 8; ++a) g.b[a] = inverse * g.b[a];
    return g;
  }
  const Vec3<L> d1 = x[6] - x[0], d2 = x[7] - x[1], d3 = x[4] - x[2], d4 = x[5] - x[3];
  const Vec3<L> r1 = d1 - d2 - d3 + d4, r2 = d1 + d2 - d3 - d4, r3 = d1 + d2 + d3 + d4;
  const Vec3<L> c1 = cross(r2, r3), c2 = cross(r3, r1), c3 = cross(r1, r2);
  const L det = dot(r1, c1);
  g.volume = det * L(1.0 / 64.0);
  const L inverse = L(1.0) / det;
  const Vec3<L> k1 = inverse * c1, k2 = inverse * c2, k3 = inverse * c3;
  g.b[0] = -(k1 + k2 + k3);
  g.b[1] = k1 - k2 - k3;
  g.b[2] = k1 + k2 - k3;
  g.b[3] = k2 - k1 - k3;
  g.b[6] = -g.b[0], g.b[7] = -g.b[1], g.b[4] = -g.b[2], g.b[5] = -g.b[3];
  return g;
}

// Area of the largest of the six faces.
template <class L>
FABRICA_FN L hex_largest_face(const Vec3<L> (&x)[8]) {
  auto square = [&](int a, int b, int c, int d) {
    const Vec3<L> n = cross(x[c] - x[a], x[d] - x[b]);
    return dot(n, n);
  };
  const L m = max(max(square(0, 1, 2, 3), square(4, 5, 6, 7)),
                  max(max(square(0, 1, 5, 4), square(1, 2, 6, 5)),
                      max(square(2, 3, 7, 6), square(3, 0, 4, 7))));
  return L(0.5) * sqrt(m);
}

// Cube root by Newton's method from a scale-free start; used once per element at set-up.
template <class L>
FABRICA_FN L cube_root_by_newton(const L& v) {
  L r;
  for (int i = 0; i < LaneTraits<L>::width; ++i)
    set(r, i, ScalarOf<L>(__builtin_cbrt(double(get(v, i)))));
  return r;
}

// J accumulated as ln J from the strain trace (exact in float) and pulled slowly towards the
// geometry.
template <class L>
FABRICA_FN L follow_volume(StateView<L> s, int field, const L& strain, const L& ratio) {
  if constexpr (sizeof(Real) == 8) return ratio;
  // state holds J - 1; J(n) = J(n-1) (1 + e + e^2/2), e = tr(D) dt
  const L old = s.load(field);
  const L grown = fma(old + L(1.0), fma(L(0.5) * strain, strain, strain), old);
  const L pulled = fma(L(1e-4), (ratio - L(1.0)) - grown, grown);
  s.store(field, pulled);
  return L(1.0) + pulled;
}

// F (J / det F)^(1/3), the cube root by its series: det F differs from J by rounding only
template <class L>
FABRICA_FN Mat3<L> scale_volume(const Mat3<L>& F, const L& J) {
  const L e = J / det(F) - L(1.0);
  const L f = fma(e, fma(e, L(-1.0 / 9.0), L(1.0 / 3.0)), L(1.0));
  Mat3<L> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.a[i][j] = f * F.a[i][j];
  return r;
}

}  // namespace fabrica
