#pragma once
// Six-node wedge with two points along its axis and mean dilatation (ELFORM 15 and bricks with two
// merged edges).
//
// N_A = L_i (1 -+ zeta)/2 with triangle coordinates L_1..L_3; nodes 1-2-3 below, 4-5-6 above;
// points at zeta = -+ 1/sqrt(3), L = 1/3. As in hex8_full.h the volume rate is the element mean:
//   f_A = - sum_q w_q [ dev sigma grad N_A + p grad N_bar_A ] (1)
// The two modes that both points miss, Gamma_1 = (1,-1,0,-1,1,0) and Gamma_2 = (1,1,-2,-1,-1,2)
// orthogonalised to the linear field, are held by a viscous hourglass force of the kind of hex8.h:
//   Q = QM rho V^(2/3) c / 4  gamma.v,   gamma = Gamma - (Gamma.x_j) grad N_j (2)
// Source: Flanagan and Belytschko 1981 for (2); Hughes, The Finite Element Method, for (1).
#include "element/hex_geometry.h"
#include "element/solid.h"

namespace fabrica {

struct Penta6 {
  static constexpr int corners = 6;
  static constexpr bool rotations = false;
  static constexpr int length = 0, initial_volume = 1;
  // per point: [reference gradients of total laws], point
  template <class M>
  static constexpr int point_fields = (M::total ? 18 : 0) + SolidPoint<M>::fields;
  template <class M>
  static int state_fields(const ElementParameters&) {
    return 2 + 2 * point_fields<M>;
  }
  template <class M>
  static int point_at(const ElementParameters&) {
    return 2 + (M::total ? 18 : 0);
  }

  // gradients at point q; returns the point's volume (weights 1/2 triangle area times 1: V = sum)
  template <class L>
  FABRICA_FN static L gradients(const Vec3<L> (&x)[6], int q, Vec3<L> (&b)[6]) {
    const double z = q == 0 ? -0.57735026918962576451 : 0.57735026918962576451;
    const double low = 0.5 * (1 - z), high = 0.5 * (1 + z);
    // derivatives to L1, L2 (L3 = 1 - L1 - L2) and zeta
    const double d1[6] = {low, 0, -low, high, 0, -high}, d2[6] = {0, low, -low, 0, high, -high};
    const double d3[6] = {-1. / 6, -1. / 6, -1. / 6, 1. / 6, 1. / 6, 1. / 6};
    Mat3<L> J;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) J.a[i][j] = L(0.0);
    for (int a = 0; a < 6; ++a) {
      const Vec3<L> d = x[a] - x[0];
      for (int j = 0; j < 3; ++j) {
        J.a[0][j] = fma(L(d1[a]), d[j], J.a[0][j]);
        J.a[1][j] = fma(L(d2[a]), d[j], J.a[1][j]);
        J.a[2][j] = fma(L(d3[a]), d[j], J.a[2][j]);
      }
    }
    const L determinant = det(J);
    const Mat3<L> inv = inverse(J);
    for (int a = 0; a < 6; ++a) b[a] = inv * Vec3<L>{L(d1[a]), L(d2[a]), L(d3[a])};
    return L(0.5) * determinant;
  }

  static void lump(const ElementParameters& p, const Corners<double, 6>& c, const Given<double>&,
                   double (&mass)[6], double (&)[6]) {
    double volume = 0;
    for (int q = 0; q < 2; ++q) {
      Vec3<double> b[6];
      volume += gradients(c.x, q, b);
    }
    for (double& corner : mass) corner = double(p.density) * volume / 6;
  }

  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters&, const Corners<L, 6>& c,
                                    const Given<L>&, StateView<L> s) {
    L volume = L(0.0);
    for (int q = 0; q < 2; ++q) {
      Vec3<L> b[6];
      volume += gradients(c.x, q, b);
      StateView<L> at{s.block + (2 + q * point_fields<M>)*block_size};
      if constexpr (M::total) {
        for (int a = 0; a < 6; ++a) at.put(3 * a, b[a]);
        at.block += 18 * block_size;
      }
      start_point<L, M>(at);
    }
    s.store(initial_volume, volume);
    s.store(length, cube_root_by_newton(volume));
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M& material, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 6>& c, StateView<L> s, CornerForces<L, 6>& out,
                                Totals<L>& totals) {
    const L dt = L(dt_previous);
    Vec3<L> b[2][6], mean[6];
    const L w[2] = {gradients(c.x, 0, b[0]), gradients(c.x, 1, b[1])};
    const L volume = w[0] + w[1];
    for (int a = 0; a < 6; ++a) mean[a] = (w[0] / volume) * b[0][a] + (w[1] / volume) * b[1][a];
    const Mat3<L> mean_gradient = gradient_of(mean, c.v);
    const Mat3<L> middle = mid_step_gradient(mean_gradient, dt);
    const L rate = middle.a[0][0] + middle.a[1][1] + middle.a[2][2];

    L l = s.load(length);
    l -= (l * l * l - volume) / (L(3.0) * l * l);
    s.store(length, l);
    const L ratio = volume / s.load(initial_volume);
    const L density = L(p.density) / ratio;

    for (int a = 0; a < 6; ++a) out.f[a] = {L(0.0), L(0.0), L(0.0)};
    L energy = L(0.0), modulus = L(0.0), alive = L(1.0);
    for (int q = 0; q < 2; ++q) {
      Mat3<L> gradient = mid_step_gradient(gradient_of(b[q], c.v), dt);
      const L own = gradient.a[0][0] + gradient.a[1][1] + gradient.a[2][2];
      for (int i = 0; i < 3; ++i) gradient.a[i][i] += L(1.0 / 3.0) * (rate - own);
      StateView<L> at{s.block + (2 + q * point_fields<M>)*block_size};
      Point<L> point = elastic_point<L>(p, dt, ratio, l);
      Mat3<L> F;
      if constexpr (M::total) {
        F = deformation<L>(c.x, at, ratio);
        at.block += 18 * block_size;
      }
      const PointResult<L> r = advance_point<L, M>(material, gradient, F, dt, point, at);
      modulus = max(modulus, point.modulus);
      if constexpr (M::can_fail) alive = min(alive, point.alive);
      energy += w[q] * ddot(r.mean_stress, r.strain);
      const L pressure = L(1.0 / 3.0) * trace(r.stress);
      const Sym3<L> deviatoric = plus_sphere(r.stress, -pressure);
      for (int a = 0; a < 6; ++a) out.f[a] -= w[q] * (deviatoric * b[q][a] + pressure * mean[a]);
    }
    const L sound = sqrt(modulus / density);
    const L size = volume / largest_face(c.x);
    const L q = bulk_viscosity(p, density, sound, rate, size, l);
    totals.time_step = stable_step(p, sound, rate, size);
    totals.internal = (L(1.0) - L(0.5) * dt * rate) * (energy - volume * q * dt * rate);
    totals.volume = L(2.0) * min(w[0], w[1]);
    totals.hourglass = L(0.0);
    for (int a = 0; a < 6; ++a) out.f[a] += (volume * q) * mean[a];
    hold_missed_modes(p, c, mean, mean_gradient, density * sound * l * l, dt, out, totals);
    if constexpr (M::can_fail) {
      totals.alive = alive;
      for (int a = 0; a < 6; ++a) out.f[a] = alive * out.f[a];
    }
  }

 private:
  template <class L>
  FABRICA_FN static Mat3<L> gradient_of(const Vec3<L> (&b)[6], const Vec3<L> (&v)[6]) {
    Mat3<L> g;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        L sum = v[0][i] * b[0][j];
        for (int a = 1; a < 6; ++a) sum = fma(v[a][i], b[a][j], sum);
        g.a[i][j] = sum;
      }
    return g;
  }

  template <class L>
  FABRICA_FN static void hold_missed_modes(const ElementParameters& p, const Corners<L, 6>& c,
                                           const Vec3<L> (&mean)[6], const Mat3<L>& gradient,
                                           const L& impedance, const L& dt, CornerForces<L, 6>& out,
                                           Totals<L>& totals) {
    constexpr double modes[2][6] = {
        {1, -1, 0, -1, 1, 0},
        {0.57735026918962576, 0.57735026918962576, -1.1547005383792515, -0.57735026918962576,
         -0.57735026918962576, 1.1547005383792515}};
    const L k = L(p.hourglass_coefficient * Real(0.25)) * impedance;
    for (const auto& mode : modes) {
      Vec3<L> x{L(0.0), L(0.0), L(0.0)}, h{L(0.0), L(0.0), L(0.0)};
      for (int a = 0; a < 6; ++a) x += L(mode[a]) * (c.x[a] - c.x[0]), h += L(mode[a]) * c.v[a];
      h = h - gradient * x;
      const Vec3<L> q = k * h;
      totals.hourglass += dt * dot(q, h);
      for (int a = 0; a < 6; ++a) out.f[a] -= (L(mode[a]) - dot(x, mean[a])) * q;
    }
  }

  template <class L>
  FABRICA_FN static L largest_face(const Vec3<L> (&x)[6]) {
    auto quad = [&](int a, int b, int c, int d) {
      const Vec3<L> n = cross(x[c] - x[a], x[d] - x[b]);
      return dot(n, n);
    };
    auto triangle = [&](int a, int b, int c) {
      const Vec3<L> n = cross(x[b] - x[a], x[c] - x[a]);
      return dot(n, n);
    };
    const L m = max(max(quad(0, 1, 4, 3), quad(1, 2, 5, 4)),
                    max(quad(2, 0, 3, 5), max(triangle(0, 1, 2), triangle(3, 4, 5))));
    return L(0.5) * sqrt(m);
  }

  template <class L>
  FABRICA_FN static Mat3<L> deformation(const Vec3<L> (&x)[6], StateView<L> at, const L& ratio) {
    Mat3<L> F;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        L sum = L(0.0);
        for (int a = 1; a < 6; ++a) sum = fma(x[a][i] - x[0][i], at.load(3 * a + j), sum);
        F.a[i][j] = sum;
      }
    const L e = ratio / det(F);
    L f = L(1.0) + L(1.0 / 3.0) * (e - L(1.0));
    f -= (f * f * f - e) / (L(3.0) * f * f);
    f -= (f * f * f - e) / (L(3.0) * f * f);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) F.a[i][j] = f * F.a[i][j];
    return F;
  }
};

}  // namespace fabrica
