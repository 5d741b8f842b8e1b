#pragma once
// Eight-node brick with one integration point (ELFORM 1) and hourglass control.
//
// Nodes 1-4 bottom, counter-clockwise seen from above, 5-8 above them.
// Gradient of the shape functions, two variants:
//   centre (Exact = false): J_ij = 1/8 sum_A xi_Ai x_Aj,  grad N_A = J^-1 xi_A / 8,  V = 8 det J
//   exact  (Exact = true):  grad N_A = (1/V) dV/dx_A, which passes the patch test on warped bricks
// Force on node A:  f_iA = -V sigma_ij dN_A/dx_j - sum_a Q_ia gamma_aA                       (1)
// Hourglass:  gamma_aA = Gamma_aA - (Gamma_a . x_j) dN_A/dx_j,   h_ia = gamma_aA v_iA         (2)
//   viscous (IHQ 2, 3)    Q_ia = QM rho V^(2/3) c / 4  h_ia; IHQ 1 with Gamma for gamma
//   stiffness (IHQ 4, 5)  Q_ia += dt QM/16 (lambda + 2G) V (grad N_A . grad N_A) h_ia, turned with
//                         the element
//   both bounded in distorted bricks (hex_hourglass.h)
//   assumed strain (6)    Belytschko-Bindeman, in a frame that turns with the element
//   of 4 to 6 h is taken at mid step, for their energy
// Source: Flanagan and Belytschko, IJNME 17 (1981) 679; Belytschko and Bindeman, CMAME 105 (1993)
// 225.
#include "element/hex_geometry.h"
#include "element/hex_hourglass.h"
#include "element/solid.h"

namespace fabrica {

template <bool Exact>
struct Hex8 {
  static constexpr int corners = 8;
  static constexpr bool rotations = false;

  // history: length, initial volume, [reference gradients of total laws], [hourglass forces], point
  static constexpr int length = 0, initial_volume = 1;
  template <class M>
  static constexpr int reference = 2;
  template <class M>
  static constexpr int hourglass_at = 2 + (M::total ? 12 : 0);
  template <class M>
  FABRICA_FN static int point_at(const ElementParameters& p) {
    return hourglass_at<M> + (p.hourglass >= 4 ? 12 : 0);
  }
  template <class M>
  static int state_fields(const ElementParameters& p) {
    return point_at<M>(p) + SolidPoint<M>::fields;
  }

  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters& p, const Corners<L, 8>& c,
                                    const Given<L>&, StateView<L> s) {
    const HexGradient<L> g = hex_gradient<Exact>(c.x);
    s.store(initial_volume, g.volume);
    s.store(length, cube_root_by_newton(g.volume));
    if constexpr (M::total) {
      const HexGradient<L> centre = hex_gradient<false>(c.x);
      for (int a = 0; a < 4; ++a) s.put(reference<M> + 3 * a, centre.b[a]);
    }
    start_point<L, M>({s.block + point_at<M>(p) * block_size});
  }

  static void lump(const ElementParameters& p, const Corners<double, 8>& c, const Given<double>&,
                   double (&mass)[8], double (&)[8]) {
    const double m = double(p.density) * hex_gradient<true>(c.x).volume / 8;
    for (double& corner : mass) corner = m;
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M& material, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 8>& c, StateView<L> s, CornerForces<L, 8>& out,
                                Totals<L>& totals) {
    const L dt = L(dt_previous);
    const HexGradient<L> g = hex_gradient<Exact>(c.x);
    const Mat3<L> gradient = g.times(c.v);
    const Mat3<L> middle = mid_step_gradient(gradient, dt);
    const L rate = middle.a[0][0] + middle.a[1][1] + middle.a[2][2];

    // sizes
    L l = s.load(length);
    l -= (l * l * l - g.volume) / (L(3.0) * l * l);
    s.store(length, l);
    const L v0 = s.load(initial_volume);
    const L ratio = g.volume / v0;
    const L size = g.volume / hex_largest_face(c.x);

    // stress
    StateView<L> at{s.block + point_at<M>(p) * block_size};
    Point<L> point = elastic_point<L>(p, dt, ratio, l);
    Mat3<L> F;
    if constexpr (M::total) F = deformation<L, M>(c, s, at, dt * rate, ratio, point);
    const PointResult<L> r = advance_point<L, M>(material, middle, F, dt, point, at);

    // viscosity, time step, energy
    const L density = L(p.density) / ratio;
    const L sound = sqrt(point.modulus / density);
    const L q = point.alive * bulk_viscosity(p, density, sound, rate, size, l);
    totals.time_step = stable_step(p, sound, rate, size);
    const L mid_volume = g.volume * (L(1.0) - L(0.5) * dt * rate);
    totals.internal = g.volume * work_of_step(r, gradient, dt) - mid_volume * q * dt * rate;
    totals.volume = g.volume;
    Sym3<L> stress = plus_sphere(r.stress, -q);
    if (p.stiffness_damping != 0) {
      const Sym3<L> d = damping_stress(p, middle, totals.time_step);
      totals.damping = mid_volume * ddot(d, r.strain);
      stress += d;
    }

    // forces: T = V sigma - sum_a Q_a (Gamma_a . x), so that (1) becomes f = -T grad N - Q Gamma
    HexHourglass<L> hg;
    hg.measure(p.hourglass != 1, c.x, c.v, gradient);
    hexhourglass_forces(p, point, dt, density, sound, l, g, c, gradient, middle,
                        StateView<L>{s.block + hourglass_at<M> * block_size}, hg, totals);
    if constexpr (M::can_fail)
      hg.scale(point.alive), totals.alive = point.alive, stress = point.alive * stress;
    hexcorner_forces(g, g.volume, stress, hg, out);
  }

 private:
  // F of a total law; its determinant is replaced by the accumulated volume ratio
  template <class L, class M>
  FABRICA_FN static Mat3<L> deformation(const Corners<L, 8>& c, StateView<L> s, StateView<L> at,
                                        const L& strain, const L& ratio, Point<L>& point) {
    Mat3<L> F;
    const Vec3<L> d[4] = {c.x[0] - c.x[6], c.x[1] - c.x[7], c.x[2] - c.x[4], c.x[3] - c.x[5]};
    Vec3<L> b[4];
    for (int a = 0; a < 4; ++a) b[a] = s.template get<Vec3<L>>(reference<M> + 3 * a);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        F.a[i][j] =
            fma(d[0][i], b[0][j], fma(d[1][i], b[1][j], fma(d[2][i], b[2][j], d[3][i] * b[3][j])));
    point.volume_ratio = follow_volume<L>(at, SolidPoint<M>::log_volume, strain, ratio);
    return scale_volume(F, point.volume_ratio);
  }
};

}  // namespace fabrica
