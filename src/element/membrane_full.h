#pragma once
// Membrane with 2 x 2 points (ELFORM 9): plane stress at each point, no hourglass modes, no
// rotations. Geometry and derivatives as in shell_full.h, equation (1); Almansi strain at each
// point.
#include "element/membrane.h"
#include "element/shell_full.h"

namespace fabrica {

struct MembraneFull {
  static constexpr int corners = 4;
  static constexpr bool rotations = false;
  static constexpr int thickness_field = 0, points_field = 1;

  template <class M>
  static int state_fields(const ElementParameters&) {
    return points_field + 4 * MembranePoint<M>::fields;
  }
  template <class M, class L>
  FABRICA_FN static StateView<L> point_view(StateView<L> s, int k) {
    return {s.block + (points_field + k * MembranePoint<M>::fields) * block_size};
  }
  template <class L>
  FABRICA_FN static ShellAxes<L> frame(const Vec3<L> (&x)[4]) {
    return quad_axes<ShellFrame::invariant>(x);
  }
  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters&, const Corners<L, 4>&,
                                    const Given<L>& g, StateView<L> s) {
    s.store(thickness_field,
            L(0.25) * (g.thickness[0] + g.thickness[1] + g.thickness[2] + g.thickness[3]));
    for (int k = 0; k < 4; ++k) MembranePoint<M>::start(point_view<M>(s, k));
  }
  static void lump(const ElementParameters& p, const Corners<double, 4>& c, const Given<double>& g,
                   double (&mass)[4], double (&)[4]) {
    lump_membrane(p, c, g, mass);
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M& material, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 4>& c, StateView<L> s, CornerForces<L, 4>& out,
                                Totals<L>& totals) {
    using Modes = ShellFull::Modes<L>;
    using Place = ShellFull::Place<L>;
    const L dt = L(dt_previous), zero = L(0.0);
    const ShellFull::Geometry<L> g(c.x);
    Vec3<L> v[4];
    for (int a = 0; a < 4; ++a) v[a] = g.axes.local(c.v[a]);
    const Modes u[3] = {Modes(v[0].x, v[1].x, v[2].x, v[3].x),
                        Modes(v[0].y, v[1].y, v[2].y, v[3].y),
                        Modes(v[0].z, v[1].z, v[2].z, v[3].z)};
    const Place centre(g.mx, g.my, 0, 0);
    const L area = L(4.0) * centre.D;
    L h = s.load(thickness_field), thinning = zero, stiffening = L(1.0);
    const Point<L> point{dt,         L(1.0), sqrt(area), L(p.bulk + Real(4.0 / 3.0) * p.shear),
                         L(p.shear), L(1.0)};
    const L initial_step = quad_step(p, c.x, area, L(1.0));
    Modes fx{zero, zero, zero, zero}, fy = fx;
    totals.alive = zero, totals.internal = zero;
    for (int k = 0; k < 4; ++k) {
      constexpr double a = 0.5773502691896257;
      const Place at(g.mx, g.my, k == 1 || k == 2 ? a : -a, k > 1 ? a : -a);
      const L inverse = L(1.0) / at.D;
      ShellGradient<L> d;
      for (int i = 0; i < 3; ++i) d.x[i] = inverse * at.dx(u[i]), d.y[i] = inverse * at.dy(u[i]);
      d.wx = d.wy = zero;
      ShellStrain<L> e{};
      almansi(d, dt, e);
      ShellResultants<L> r =
          MembranePoint<M>::advance(material, p, e, h, point, point_view<M>(s, k));
      const L mid_area = at.D * (L(1.0) - L(0.5) * (e.xx + e.yy));
      totals.internal = fma(mid_area, r.work, totals.internal);
      if (p.stiffness_damping != 0)
        totals.damping += mid_area * r.alive * damp_membrane(p, e, h, dt, initial_step, r);
      at.transpose(r.nxx, r.nxy, fx), at.transpose(r.nxy, r.nyy, fy);
      thinning = fma(L(0.25), r.thinning, thinning);
      stiffening = max(stiffening, r.stiffening);
      totals.alive = max(totals.alive, r.alive);
    }
    if (p.thickness_update) h *= L(1.0) + thinning;
    s.store(thickness_field, h);
    totals.time_step = initial_step / sqrt(stiffening);
    totals.volume = area * h;
    constexpr double sign_xi[4] = {-1, 1, 1, -1}, sign_eta[4] = {-1, -1, 1, 1},
                     sign_h[4] = {1, -1, 1, -1};
    for (int a = 0; a < 4; ++a) {
      auto corner = [&](const Modes& m) {
        return L(-0.25) * fma(L(sign_xi[a]), m.xi, fma(L(sign_eta[a]), m.eta, L(sign_h[a]) * m.h));
      };
      out.f[a] = g.axes.global(corner(fx), corner(fy));
    }
  }

  // output: means of the four points
  static Real thickness(StateView<Real> s) { return s.load(thickness_field); }
  template <class M>
  static Sym3<Real> stress(const ElementParameters&, StateView<Real> s, int) {
    Sym3<Real> sum{};
    for (int k = 0; k < 4; ++k) sum += Real(0.25) * MembranePoint<M>::stress(point_view<M>(s, k));
    return sum;
  }
  template <class M>
  static Real plastic_strain(const ElementParameters&, StateView<Real> s, int) {
    Real sum = 0;
    for (int k = 0; k < 4; ++k)
      sum += Real(0.25) * MembranePoint<M>::plastic_strain(point_view<M>(s, k));
    return sum;
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
