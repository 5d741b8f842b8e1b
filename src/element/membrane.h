#pragma once
// Membranes (ELFORM 5 and 9): plane stress in the surface, no bending, no transverse shear, no
// rotations.
// ELFORM 5: one point with B1, B2 as in shell_bt.h and control of the in-plane hourglass modes
//   q_a = gamma.v_a,   Q_a = QM E h A BB/8 q_a sqrt(A)/c  (viscous)                            (1)
//   Q_a += QM E h A BB/8 q_a dt / 16  (IHQ >= 4; / 16: in amplitudes of the modes, as shell_bt.h),
//     held at s h sqrt(A)/4 while the point flows at the stress s
// ELFORM 9: 2 x 2 points, Almansi strain at each.
// Source: Belytschko, Lin, Tsay 1984 (membrane part); Flanagan and Belytschko 1981 (hourglass).
#include "element/shell_bt.h"

namespace fabrica {

// History of a membrane point: xx yy xy, [alive], material state.
template <class M>
struct MembranePoint {
  static constexpr int alive = 3;
  static constexpr int material = 3 + (M::can_fail ? 1 : 0);
  static constexpr int fields = material + material_fields<M>();

  template <class L>
  FABRICA_FN static void start(StateView<L> s) {
    if constexpr (M::can_fail) s.store(alive, L(1.0));
  }
  // n: h s; only the membrane members of the result count
  template <class L>
  FABRICA_FN static ShellResultants<L> advance(const M& law, const ElementParameters& p,
                                               const ShellStrain<L>& e, const L& h, Point<L> point,
                                               StateView<L> s) {
    using MaterialState = typename M::template State<L>;
    const L zero = L(0.0);
    ShellResultants<L> r{zero, zero, zero, zero,   zero,   zero,  zero,
                         zero, zero, zero, L(1.0), L(1.0), L(1.0)};
    const L initial = point.modulus;
    Sym3<L> old{s.load(0), s.load(1), zero, s.load(2), zero, zero};
    MaterialState state = s.template get<MaterialState>(material);
    Sym3<L> now = plane_stress(law, old, e.xx, e.yy, L(2.0) * e.xy, zero, zero, L(1.0), point,
                               state, r.thinning);
    if constexpr (M::can_fail) {
      r.alive = min(s.load(alive), point.alive);
      s.store(alive, r.alive);
      now = r.alive * now;
    }
    KeptStress<L> share;
    share.add(p, L(1.0), old, now, {e.xx, e.yy, zero, e.xy, zero, zero});
    r.flow = share.flow();
    s.store(0, now.xx), s.store(1, now.yy), s.store(2, now.xy);
    s.put(material, state);
    const L normal = fma(old.xx + now.xx, e.xx, (old.yy + now.yy) * e.yy);
    r.work = L(0.5) * h * fma(L(2.0) * (old.xy + now.xy), e.xy, normal);
    r.nxx = h * now.xx, r.nyy = h * now.yy, r.nxy = h * now.xy;
    r.stiffening = max(L(1.0), point.modulus / initial);
    return r;
  }
  static Sym3<Real> stress(StateView<Real> s) { return {s.load(0), s.load(1), 0, s.load(2), 0, 0}; }
  static Real plastic_strain(StateView<Real> s) {
    auto state = s.template get<typename M::template State<Real>>(material);
    if constexpr (requires { state.plastic_strain; })
      return state.plastic_strain;
    else
      return 0;
  }
};

// mass of a membrane: a quarter to each corner
inline void lump_membrane(const ElementParameters& p, const Corners<double, 4>& c,
                          const Given<double>& g, double (&mass)[4]) {
  const double h = 0.25 * (g.thickness[0] + g.thickness[1] + g.thickness[2] + g.thickness[3]);
  const double area = 0.5 * norm(cross(c.x[2] - c.x[0], c.x[3] - c.x[1]));
  for (double& m : mass) m = 0.25 * area * (double(p.density) * h + double(p.area_mass));
}

// adds stiffness damping of the membrane part only
template <class L>
FABRICA_FN L damp_membrane(const ElementParameters& p, ShellStrain<L> e, const L& h, const L& dt,
                           const L& step, ShellResultants<L>& r) {
  e.kxx = e.kyy = e.kxy = e.yz = e.zx = L(0.0);
  return damp_shell(p, e, h, dt, step, r);
}

struct Membrane {
  static constexpr int corners = 4;
  static constexpr bool rotations = false;
  static constexpr int thickness_field = 0, hourglass_field = 1, point_field = 3;

  template <class M>
  static int state_fields(const ElementParameters&) {
    return point_field + MembranePoint<M>::fields;
  }
  template <class L>
  FABRICA_FN static StateView<L> point_view(StateView<L> s) {
    return {s.block + point_field * block_size};
  }
  template <class L>
  FABRICA_FN static ShellAxes<L> frame(const Vec3<L> (&x)[4]) {
    return quad_axes<ShellFrame::side>(x);
  }
  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters&, const Corners<L, 4>&,
                                    const Given<L>& g, StateView<L> s) {
    s.store(thickness_field,
            L(0.25) * (g.thickness[0] + g.thickness[1] + g.thickness[2] + g.thickness[3]));
    MembranePoint<M>::start(point_view<L>(s));
  }
  static void lump(const ElementParameters& p, const Corners<double, 4>& c, const Given<double>& g,
                   double (&mass)[4], double (&)[4]) {
    lump_membrane(p, c, g, mass);
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M& material, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 4>& c, StateView<L> s, CornerForces<L, 4>& out,
                                Totals<L>& totals) {
    const L dt = L(dt_previous), zero = L(0.0);
    const ShellBT::Geometry<L> g(c.x);
    const Vec3<L> v31 = g.axes.local(c.v[2] - c.v[0]), v42 = g.axes.local(c.v[3] - c.v[1]);
    const Vec3<L> hv = g.axes.local((c.v[0] - c.v[1]) + (c.v[2] - c.v[3]));
    ShellGradient<L> d;
    for (int i = 0; i < 3; ++i) d.x[i] = g.dx(v31[i], v42[i]), d.y[i] = g.dy(v31[i], v42[i]);
    d.wx = d.wy = zero;
    ShellStrain<L> e{};
    almansi(d, dt, e);

    L h = s.load(thickness_field);
    const L root_area = sqrt(g.area);
    const Point<L> point{dt,         L(1.0), root_area, L(p.bulk + Real(4.0 / 3.0) * p.shear),
                         L(p.shear), L(1.0)};
    ShellResultants<L> r = MembranePoint<M>::advance(material, p, e, h, point, point_view<L>(s));
    if (p.thickness_update) h *= L(1.0) + r.thinning;
    s.store(thickness_field, h);
    totals.time_step = quad_step(p, c.x, g.area, sqrt(r.stiffening));
    totals.volume = g.area * h;
    totals.alive = r.alive;
    const L mid_area = g.area * (L(1.0) - L(0.5) * (e.xx + e.yy));
    totals.internal = mid_area * r.work;
    if (p.stiffness_damping != 0)
      totals.damping = mid_area * r.alive * damp_membrane(p, e, h, dt, totals.time_step, r);

    // hourglass forces in the plane, equation (1)
    const L bb = L(2.0) * g.half_inverse * g.half_inverse *
                 (fma(g.x31, g.x31, g.y31 * g.y31) + fma(g.x42, g.x42, g.y42 * g.y42));
    const L stiffness = L(p.hourglass_coefficient * p.youngs / 8) * h * g.area * bb;
    const L viscous = root_area * L(1 / plate_speed(p));
    const L elastic = L(ShellBT::stiffness_share) * stiffness * dt;
    const L bound = L(0.25) * h * root_area * r.flow;
    L Q[2], energy = zero;
    for (int a = 0; a < 2; ++a) {
      const L rate = hv[a] - fma(g.hx, d.x[a], g.hy * d.y[a]);
      if (p.hourglass >= 4) {
        const L old = s.load(hourglass_field + a);
        Q[a] = r.alive * clamp(fma(elastic, rate, old), -bound, bound);
        s.store(hourglass_field + a, Q[a]);
        energy = fma(L(0.5) * (old + Q[a]), rate, energy);
      } else {
        Q[a] = r.alive * (stiffness * viscous * rate);
        energy = fma(Q[a], rate, energy);
      }
    }
    totals.hourglass = dt * energy;

    Vec3<L> P{zero, zero, zero}, R{zero, zero, zero};
    const L n[2][2] = {{r.nxx, r.nxy}, {r.nxy, r.nyy}};
    for (int a = 0; a < 2; ++a) {
      const L n1 = g.half_inverse * fma(g.area, n[a][0], -(Q[a] * g.hx));
      const L n2 = g.half_inverse * fma(g.area, n[a][1], -(Q[a] * g.hy));
      P[a] = fma(g.y42, n1, -(g.x42 * n2)), R[a] = fma(g.y31, n1, -(g.x31 * n2));
    }
    const Vec3<L> Pg = g.axes.global(P.x, P.y), Rg = g.axes.global(R.x, R.y),
                  Qg = g.axes.global(Q[0], Q[1]);
    out.f[0] = Pg - Qg, out.f[2] = -(Pg + Qg), out.f[1] = Qg - Rg, out.f[3] = Rg + Qg;
  }

  // output
  static Real thickness(StateView<Real> s) { return s.load(thickness_field); }
  template <class M>
  static Sym3<Real> stress(const ElementParameters&, StateView<Real> s, int) {
    return MembranePoint<M>::stress(point_view<Real>(s));
  }
  template <class M>
  static Real plastic_strain(const ElementParameters&, StateView<Real> s, int) {
    return MembranePoint<M>::plastic_strain(point_view<Real>(s));
  }
  template <class M>
  static void resultants(const ElementParameters& p, StateView<Real> s, double (&out)[8]) {
    const Sym3<Real> t = stress<M>(p, s, 0);
    const double h = thickness(s);
    for (double& o : out) o = 0;
    out[5] = h * t.xx, out[6] = h * t.yy, out[7] = h * t.xy;
  }
};

}  // namespace fabrica
