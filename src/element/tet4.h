#pragma once
// Four-node tetrahedron with one point (ELFORM 10) and its nodal-pressure form (ELFORM 13).
//   K1 = e2 x e3, ..., det = e1 . K1, grad N_k = K_k / det, V = det / 6, f_k = -sigma K_k / 6 (1)
// Nodal pressure (Bonet and Burton): the volume rate is averaged to the nodes of the part with the
// element volumes as weights, the pressure follows there from the bulk modulus, and the element
// uses the mean of its four nodal pressures; forces are the exact derivative, so energy is
// conserved:
//   dp_A = K sum_e V_e tr(D_e) dt / sum_e V_e,    p_e = 1/4 sum_A p_A   (tension positive) (2)
// Source: Bonet and Burton, Commun. Numer. Meth. Engng 14 (1998) 437.
#include "element/hex_geometry.h"
#include "element/solid.h"

namespace fabrica {

template <class L>
struct TetGradient {
  Vec3<L> k[4];  // area vectors: grad N_A = k[A] / det
  L det;

  FABRICA_FN explicit TetGradient(const Vec3<L> (&x)[4]) {
    const Vec3<L> e1 = x[1] - x[0], e2 = x[2] - x[0], e3 = x[3] - x[0];
    k[1] = cross(e2, e3), k[2] = cross(e3, e1), k[3] = cross(e1, e2);
    k[0] = -(k[1] + k[2] + k[3]);
    det = dot(e1, k[1]);
  }
  FABRICA_FN L volume() const { return det * L(1.0 / 6.0); }
  FABRICA_FN Mat3<L> times(const Vec3<L> (&v)[4]) const {
    const L inverse = L(1.0) / det;
    const Vec3<L> a = v[1] - v[0], b = v[2] - v[0], c = v[3] - v[0];
    Mat3<L> r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        r.a[i][j] = inverse * fma(a[i], k[1][j], fma(b[i], k[2][j], c[i] * k[3][j]));
    return r;
  }
  // smallest altitude: det / largest 2 x face area
  FABRICA_FN L altitude() const {
    const L m = max(max(dot(k[0], k[0]), dot(k[1], k[1])), max(dot(k[2], k[2]), dot(k[3], k[3])));
    return det / sqrt(m);
  }
};

struct Tet4 {
  static constexpr int corners = 4;
  static constexpr bool rotations = false;
  static constexpr int length = 0, initial_volume = 1;
  template <class M>
  static constexpr int reference = 2;  // inverse of the initial edge matrix, total laws only
  template <class M>
  static constexpr int point_field = 2 + (M::total ? 9 : 0);
  template <class M>
  static int state_fields(const ElementParameters&) {
    return point_field<M> + SolidPoint<M>::fields;
  }
  template <class M>
  static int point_at(const ElementParameters&) {
    return point_field<M>;
  }

  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters&, const Corners<L, 4>& c,
                                    const Given<L>&, StateView<L> s) {
    const TetGradient<L> g(c.x);
    s.store(initial_volume, g.volume());
    s.store(length, cube_root_by_newton(g.volume()));
    if constexpr (M::total) {
      const L inverse = L(1.0) / g.det;
      for (int a = 1; a < 4; ++a) s.put(reference<M> + 3 * (a - 1), inverse * g.k[a]);
    }
    start_point<L, M>({s.block + point_field<M> * block_size});
  }

  static void lump(const ElementParameters& p, const Corners<double, 4>& c, const Given<double>&,
                   double (&mass)[4], double (&)[4]) {
    const double m = double(p.density) * TetGradient<double>(c.x).volume() / 4;
    for (double& corner : mass) corner = m;
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M& material, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 4>& c, StateView<L> s, CornerForces<L, 4>& out,
                                Totals<L>& totals) {
    compute<L, M, false>(material, p, dt_previous, c, L(0.0), L(0.0), s, out, totals);
  }

  // NodalPressure: mean_rate is the element's averaged tr(D), pressure the mean nodal pressure
  // (tension positive)
  template <class L, class M, bool NodalPressure>
  FABRICA_FN static void compute(const M& material, const ElementParameters& p, Real dt_previous,
                                 const Corners<L, 4>& c, const L& mean_rate, const L& pressure,
                                 StateView<L> s, CornerForces<L, 4>& out, Totals<L>& totals) {
    const L dt = L(dt_previous);
    const TetGradient<L> g(c.x);
    const L volume = g.volume();
    const Mat3<L> gradient = g.times(c.v);
    Mat3<L> middle = mid_step_gradient(gradient, dt);
    const L rate = middle.a[0][0] + middle.a[1][1] + middle.a[2][2];
    if constexpr (NodalPressure) {
      const L shift = L(1.0 / 3.0) * (mean_rate - rate);
      for (int i = 0; i < 3; ++i) middle.a[i][i] += shift;
    }

    L l = s.load(length);
    l -= (l * l * l - volume) / (L(3.0) * l * l);
    s.store(length, l);
    const L ratio = volume / s.load(initial_volume);

    StateView<L> at{s.block + point_field<M> * block_size};
    Point<L> point = elastic_point<L>(p, dt, ratio, l);
    Mat3<L> F;
    if constexpr (M::total) F = deformation<L, M>(c, s, at, dt * rate, ratio, point);
    const L old_pressure = NodalPressure ? mean_pressure(at) : L(0.0);
    PointResult<L> r = advance_point<L, M>(material, middle, F, dt, point, at);
    if constexpr (NodalPressure) replace_pressure(pressure, old_pressure, at, r);

    const L density = L(p.density) / ratio;
    const L sound = sqrt(point.modulus / density);
    const L size = g.altitude();
    const L q = point.alive * bulk_viscosity(p, density, sound, rate, size, l);
    totals.time_step = stable_step(p, sound, rate, size);
    const L mid_volume = volume * (L(1.0) - L(0.5) * dt * rate);
    Sym3<L> strain = r.strain;
    if constexpr (NodalPressure)
      strain = plus_sphere(strain, L(1.0 / 3.0) * dt * (rate - mean_rate));
    totals.internal = mid_volume * (ddot(r.mean_stress, strain) - q * dt * rate);
    totals.volume = volume;
    Sym3<L> stress = plus_sphere(r.stress, -q);
    if (p.stiffness_damping != 0) {
      const Sym3<L> d = damping_stress(p, middle, totals.time_step);
      totals.damping = mid_volume * ddot(d, strain);
      stress += d;
    }
    if constexpr (M::can_fail) totals.alive = point.alive, stress = point.alive * stress;
    stress = L(-1.0 / 6.0) * stress;
    for (int a = 1; a < 4; ++a) out.f[a] = stress * g.k[a];
    out.f[0] = -(out.f[1] + out.f[2] + out.f[3]);
  }

 private:
  template <class L>
  FABRICA_FN static L mean_pressure(StateView<L> at) {
    return L(1.0 / 3.0) * (at.load(0) + at.load(1) + at.load(2));
  }
  template <class L>
  FABRICA_FN static void replace_pressure(const L& pressure, const L& old_pressure, StateView<L> at,
                                          PointResult<L>& r) {
    r.stress = plus_sphere(deviator(r.stress), pressure);
    r.mean_stress = plus_sphere(deviator(r.mean_stress), L(0.5) * (pressure + old_pressure));
    at.put(0, r.stress);
  }
  template <class L, class M>
  FABRICA_FN static Mat3<L> deformation(const Corners<L, 4>& c, StateView<L> s, StateView<L> at,
                                        const L& strain, const L& ratio, Point<L>& point) {
    Mat3<L> F;
    const Vec3<L> e[3] = {c.x[1] - c.x[0], c.x[2] - c.x[0], c.x[3] - c.x[0]};
    Vec3<L> k[3];
    for (int a = 0; a < 3; ++a) k[a] = s.template get<Vec3<L>>(reference<M> + 3 * a);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        F.a[i][j] = fma(e[0][i], k[0][j], fma(e[1][i], k[1][j], e[2][i] * k[2][j]));
    point.volume_ratio = follow_volume<L>(at, SolidPoint<M>::log_volume, strain, ratio);
    return scale_volume(F, point.volume_ratio);
  }
};

}  // namespace fabrica
