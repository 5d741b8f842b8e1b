#pragma once
// Eight-node brick with 2x2x2 points and mean dilatation (ELFORM 2), and with assumed transverse
// shear (-1, -2).
//
// Mean dilatation (B-bar): the volume part of the strain rate is the element mean,
//   D_bar = dev D(q) + 1/3 (b_bar_A . v_A) I,   b_bar = (1/V) sum_q w_q grad N_A(q) = exact mean
//   gradient   (1) f_A = - sum_q w_q [ dev sigma grad N_A + p grad N_bar_A ] (2)
// ELFORM -1, -2: the parasitic shear of thin elements is weakened. In local coordinates along the
// element's axes the off-diagonal gradients of a bending mode are scaled by (shortest/longest edge
// of the plane)^2, limited to 1, which keeps bending right for boxes and changes nothing for cubes.
// Source: Hughes, The Finite Element Method (B-bar), sec. 4.5; Borrvall, 7th European LS-DYNA conf.
// 2009 (idea of -1, -2).
#include "element/hex_geometry.h"
#include "element/solid.h"

namespace fabrica {

struct Hex8Full {
  static constexpr int corners = 8;
  static constexpr bool rotations = false;
  static constexpr int length = 0, initial_volume = 1;

  // per point: [reference gradients of total laws], point
  template <class M>
  static constexpr int point_fields = (M::total ? 24 : 0) + SolidPoint<M>::fields;
  template <class M>
  static int state_fields(const ElementParameters&) {
    return 2 + 8 * point_fields<M>;
  }
  // the point that output shows: the first
  template <class M>
  static int point_at(const ElementParameters&) {
    return 2 + (M::total ? 24 : 0);
  }

  static void lump(const ElementParameters& p, const Corners<double, 8>& c, const Given<double>&,
                   double (&mass)[8], double (&)[8]) {
    const double m = double(p.density) * hex_gradient<true>(c.x).volume / 8;
    for (double& corner : mass) corner = m;
  }

  // gradients of the eight shape functions at Gauss point q; returns det J (weight of the point, V
  // = sum)
  template <class L>
  FABRICA_FN static L gradients(const Vec3<L> (&x)[8], int q, Vec3<L> (&b)[8]) {
    constexpr int sx[8] = {-1, 1, 1, -1, -1, 1, 1, -1}, sy[8] = {-1, -1, 1, 1, -1, -1, 1, 1},
                  sz[8] = {-1, -1, -1, -1, 1, 1, 1, 1};
    constexpr double g = 0.57735026918962576451;
    const double r = g * sx[q], s = g * sy[q], t = g * sz[q];
    Vec3<L> n[8];
    Mat3<L> J{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) J.a[i][j] = L(0.0);
    for (int a = 0; a < 8; ++a) {
      n[a] = {L(0.125 * sx[a] * (1 + s * sy[a]) * (1 + t * sz[a])),
              L(0.125 * sy[a] * (1 + r * sx[a]) * (1 + t * sz[a])),
              L(0.125 * sz[a] * (1 + r * sx[a]) * (1 + s * sy[a]))};
      const Vec3<L> d = x[a] - x[0];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) J.a[i][j] = fma(n[a][i], d[j], J.a[i][j]);
    }
    const L determinant = det(J);
    const Mat3<L> inv = inverse(J);
    for (int a = 0; a < 8; ++a) b[a] = inv * n[a];
    return determinant;
  }

  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters&, const Corners<L, 8>& c,
                                    const Given<L>&, StateView<L> s) {
    L volume = L(0.0);
    for (int q = 0; q < 8; ++q) {
      Vec3<L> b[8];
      volume += gradients(c.x, q, b);
      StateView<L> at{s.block + (2 + q * point_fields<M>)*block_size};
      if constexpr (M::total) {
        for (int a = 0; a < 8; ++a) at.put(3 * a, b[a]);
        at.block += 24 * block_size;
      }
      start_point<L, M>(at);
    }
    s.store(initial_volume, volume);
    s.store(length, cube_root_by_newton(volume));
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M& material, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 8>& c, StateView<L> s, CornerForces<L, 8>& out,
                                Totals<L>& totals) {
    const L dt = L(dt_previous);
    const HexGradient<L> mean = hex_gradient<true>(c.x);
    const Mat3<L> mean_gradient = mid_step_gradient(mean.times(c.v), dt);
    const L rate = mean_gradient.a[0][0] + mean_gradient.a[1][1] + mean_gradient.a[2][2];
    L l = s.load(length);
    l -= (l * l * l - mean.volume) / (L(3.0) * l * l);
    s.store(length, l);
    const L ratio = mean.volume / s.load(initial_volume);
    const L density = L(p.density) / ratio;

    for (int a = 0; a < 8; ++a) out.f[a] = {L(0.0), L(0.0), L(0.0)};
    totals.internal = L(0.0), totals.hourglass = L(0.0);
    L smallest = L(1e30), modulus = L(0.0), alive = L(1.0);
    const ShearScale<L> shear = shear_scale(p, c.x);
    for (int q = 0; q < 8; ++q) {
      Vec3<L> b[8];
      const L weight = gradients(c.x, q, b);
      smallest = min(smallest, weight);
      Mat3<L> local = velocity_gradient(b, c.v);
      if (p.formulation < 0) shear.weaken(mean.times(c.v), local);
      Mat3<L> gradient = mid_step_gradient(local, dt);
      const L own = gradient.a[0][0] + gradient.a[1][1] + gradient.a[2][2];
      for (int i = 0; i < 3; ++i) gradient.a[i][i] += L(1.0 / 3.0) * (rate - own);
      StateView<L> at{s.block + (2 + q * point_fields<M>)*block_size};
      Point<L> point = elastic_point<L>(p, dt, ratio, l);
      Mat3<L> F;
      if constexpr (M::total) {
        F = deformation<L, M>(c.x, at, ratio, point);
        at.block += 24 * block_size;
      }
      const PointResult<L> r = advance_point<L, M>(material, gradient, F, dt, point, at);
      modulus = max(modulus, point.modulus);
      if constexpr (M::can_fail) alive = min(alive, point.alive);
      totals.internal += weight * ddot(r.mean_stress, r.strain);
      add_forces(r.stress, weight, b, mean, p, shear, out);
    }
    const L sound = sqrt(modulus / density);
    const L size = min(mean.volume, L(8.0) * smallest) / hex_largest_face(c.x);
    const L q = bulk_viscosity(p, density, sound, rate, size, l);
    totals.time_step = stable_step(p, sound, rate, size);
    totals.internal =
        (L(1.0) - L(0.5) * dt * rate) * (totals.internal - mean.volume * q * dt * rate);
    totals.volume = L(8.0) * smallest;
    for (int a = 0; a < 8; ++a) out.f[a] += (mean.volume * q) * mean.b[a];
    if constexpr (M::can_fail) {
      totals.alive = alive;
      for (int a = 0; a < 8; ++a) out.f[a] = alive * out.f[a];
    }
  }

 private:
  // ELFORM -1, -2: factors of the off-mean shear of each plane pair in the element's own axes
  template <class L>
  struct ShearScale {
    Vec3<L> e[3];
    L k[3][3];  // k[i][j] scales d u_i / d x_j beyond the mean

    // replaces g by mean + scaled (g - mean), off-diagonal terms in the element axes only
    FABRICA_FN void weaken(const Mat3<L>& mean, Mat3<L>& g) const {
      Mat3<L> d;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) d.a[i][j] = g.a[i][j] - mean.a[i][j];
      const Mat3<L> scaled = apply(d);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) g.a[i][j] = mean.a[i][j] + scaled.a[i][j];
    }
    FABRICA_FN Mat3<L> apply(const Mat3<L>& d) const {
      const Mat3<L> R{
          {{e[0].x, e[0].y, e[0].z}, {e[1].x, e[1].y, e[1].z}, {e[2].x, e[2].y, e[2].z}}};
      Mat3<L> local = R * d * transpose(R);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          if (i != j) local.a[i][j] = k[i][j] * local.a[i][j];
      return transpose(R) * local * R;
    }
  };
  template <class L>
  FABRICA_FN static ShearScale<L> shear_scale(const ElementParameters& p, const Vec3<L> (&x)[8]) {
    ShearScale<L> s;
    if (p.formulation >= 0) return s;
    const Vec3<L> d1 = x[6] - x[0], d2 = x[7] - x[1], d3 = x[4] - x[2], d4 = x[5] - x[3];
    const Vec3<L> r[3] = {d1 - d2 - d3 + d4, d1 + d2 - d3 - d4, d1 + d2 + d3 + d4};
    s.e[0] = (L(1.0) / norm(r[0])) * r[0];
    const Vec3<L> second = r[1] - dot(r[1], s.e[0]) * s.e[0];
    s.e[1] = (L(1.0) / norm(second)) * second;
    s.e[2] = cross(s.e[0], s.e[1]);
    const L length[3] = {abs(dot(s.e[0], r[0])), abs(dot(s.e[1], r[1])), abs(dot(s.e[2], r[2]))};
    // bending in the plane i-j: u_i ~ x_i x_j makes the shear d u_i / d x_j ~ x_i, exact bending
    // has none of it
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const L a = length[j] / length[i];
        s.k[i][j] = min(L(1.0), a * a);
      }
    return s;
  }

  template <class L>
  FABRICA_FN static Mat3<L> velocity_gradient(const Vec3<L> (&b)[8], const Vec3<L> (&v)[8]) {
    Mat3<L> g;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        L sum = v[0][i] * b[0][j];
        for (int a = 1; a < 8; ++a) sum = fma(v[a][i], b[a][j], sum);
        g.a[i][j] = sum;
      }
    return g;
  }

  // equation (2); for ELFORM < 0 the transpose of the weakened gradient acts on the deviator
  template <class L>
  FABRICA_FN static void add_forces(const Sym3<L>& stress, const L& weight, const Vec3<L> (&b)[8],
                                    const HexGradient<L>& mean, const ElementParameters& p,
                                    const ShearScale<L>& shear, CornerForces<L, 8>& out) {
    const L pressure = L(1.0 / 3.0) * trace(stress);
    const Sym3<L> s = plus_sphere(stress, -pressure);
    if (p.formulation >= 0) {
      for (int a = 0; a < 8; ++a) out.f[a] -= weight * (s * b[a] + pressure * mean.b[a]);
      return;
    }
    const Mat3<L> S{{{s.xx, s.xy, s.zx}, {s.xy, s.yy, s.yz}, {s.zx, s.yz, s.zz}}};
    const Mat3<L> W = shear.apply(S);
    for (int a = 0; a < 8; ++a)
      out.f[a] -= weight * (s * mean.b[a] + W * (b[a] - mean.b[a]) + pressure * mean.b[a]);
  }

  template <class L, class M>
  FABRICA_FN static Mat3<L> deformation(const Vec3<L> (&x)[8], StateView<L> at, const L& ratio,
                                        Point<L>& point) {
    Mat3<L> F = identity3<L>();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        L sum = L(0.0);
        for (int a = 1; a < 8; ++a) sum = fma(x[a][i] - x[0][i], at.load(3 * a + j), sum);
        F.a[i][j] = sum;
      }
    point.volume_ratio = ratio;
    const L e = ratio / det(F);
    // F-bar: (J / det F)^(1/3) by two Newton steps from 1
    L f = L(1.0) + L(1.0 / 3.0) * (e - L(1.0));
    f -= (f * f * f - e) / (L(3.0) * f * f);
    f -= (f * f * f - e) / (L(3.0) * f * f);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) F.a[i][j] = f * F.a[i][j];
    return F;
  }
};

}  // namespace fabrica
