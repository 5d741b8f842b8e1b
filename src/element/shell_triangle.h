#pragma once
// Shear-flexible triangle (ELFORM 3, 4, 17 and quadrilaterals with a doubled corner): constant
// membrane strain, constant curvature, transverse shear tied on the sides (MITC3), all at the
// centroid.
//   B1 = (y23, y31, y12)/2A,  B2 = (x32, x13, x21)/2A                                           (1)
//   er(1) = vz21 + x21 (wy1+wy2)/2 - y21 (wx1+wx2)/2 on side 1-2, es(2) likewise on side 1-3,
//   c = es(2) - er(1) - es(3) + er(3) with (3) on side 2-3;  er = er(1) + c/3,  es = es(2) - c/3
//     (2)
//   2dxz = (y31 er - y21 es)/2A,  2dyz = (x21 es - x31 er)/2A                                   (3)
// (2) in differences: er = vz21 + x21 mean wy - y21 mean wx + a, es = vz31 + x31 mean wy - y31 mean
// wx + b,
//   6a = (x21 - x31) wy21 - x21 wy31 - [(y21 - y31) wx21 - y21 wx31]
//   6b = (x31 - x21) wy31 - x31 wy21 - [(y31 - y21) wx31 - y31 wx21]                            (4)
// Source: Lee and Bathe, Computers and Structures 82 (2004) 945.
#include "element/shell.h"

namespace fabrica {

struct ShellTriangle {
  static constexpr int corners = 3;
  static constexpr bool rotations = true;
  static constexpr int thickness_field = 0, layers_field = 1;

  template <class M>
  static int state_fields(const ElementParameters& p) {
    return layers_field + ShellLayers<M>::fields(p);
  }
  template <class L>
  FABRICA_FN static StateView<L> layers(StateView<L> s) {
    return {s.block + layers_field * block_size};
  }
  template <class L>
  FABRICA_FN static ShellAxes<L> frame(const Vec3<L> (&x)[3]) {
    return shell_axes(cross(x[1] - x[0], x[2] - x[0]), x[1] - x[0]);
  }

  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters& p, const Corners<L, 3>&,
                                    const Given<L>& g, StateView<L> s) {
    s.store(thickness_field, L(1.0 / 3.0) * (g.thickness[0] + g.thickness[1] + g.thickness[2]));
    ShellLayers<M>::start(p, layers<L>(s));
  }

  static void lump(const ElementParameters& p, const Corners<double, 3>& c, const Given<double>& g,
                   double (&mass)[3], double (&inertia)[3]) {
    const double h = (g.thickness[0] + g.thickness[1] + g.thickness[2]) / 3;
    const double area = 0.5 * norm(cross(c.x[1] - c.x[0], c.x[2] - c.x[0]));
    const double m = area * (double(p.density) * h + double(p.area_mass)) / 3;
    for (int a = 0; a < 3; ++a) {
      mass[a] = m;
      inertia[a] = shell_inertia(m, h, area, 0.5 * h * double(p.reference_location));
    }
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M& material, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 3>& c, StateView<L> s, CornerForces<L, 3>& out,
                                Totals<L>& totals) {
    const L dt = L(dt_previous);
    const Geometry<L> g(c.x);
    ShellStrain<L> e;
    strain(g, c, dt, e);

    L h = s.load(thickness_field);
    const Point<L> point{dt,         L(1.0), sqrt(g.area), L(p.bulk + Real(4.0 / 3.0) * p.shear),
                         L(p.shear), L(1.0)};
    ShellResultants<L> r = ShellLayers<M>::advance(material, p, e, h, point, layers<L>(s));
    if (p.thickness_update) h *= L(1.0) + r.thinning;
    s.store(thickness_field, h);

    const L speed = L(plate_speed(p)) * sqrt(r.stiffening);
    L step = g.altitude(c.x) / speed, viscous = L(0.0);
    if (p.shell_viscosity) viscous = shell_viscosity(p, e, g.area, h, dt, speed, step, r);
    totals.time_step = step;
    totals.volume = g.area * h;
    totals.alive = r.alive;
    const L mid_area = g.area * (L(1.0) - L(0.5) * (e.xx + e.yy));
    totals.internal = mid_area * (r.work + viscous);
    if (p.stiffness_damping != 0)
      totals.damping = mid_area * r.alive * damp_shell(p, e, h, dt, step, r);
    corner_forces(g, r, out);
  }

  template <class L>
  struct Geometry {
    ShellAxes<L> axes;
    L x21, x31, y31;  // y21 = 0: e1 lies along side 1-2
    L area, inverse;  // A, 1/(2A)

    FABRICA_FN explicit Geometry(const Vec3<L> (&x)[3]) : axes(frame(x)) {
      const Vec3<L> r31 = x[2] - x[0];
      x21 = dot(axes.e1, x[1] - x[0]);
      x31 = dot(axes.e1, r31), y31 = dot(axes.e2, r31);
      const L twice = x21 * y31;
      area = L(0.5) * twice;
      inverse = L(1.0) / twice;
    }
    FABRICA_FN L dx(const L& u21, const L&) const { return inverse * (y31 * u21); }
    FABRICA_FN L dy(const L& u21, const L& u31) const {
      return inverse * fma(x21, u31, -(x31 * u21));
    }
    // smallest altitude
    FABRICA_FN L altitude(const Vec3<L> (&x)[3]) const {
      const Vec3<L> a = x[1] - x[0], b = x[2] - x[0], d = x[2] - x[1];
      return L(2.0) * area / sqrt(max(max(dot(a, a), dot(b, b)), dot(d, d)));
    }
  };

  template <class L>
  FABRICA_FN static void strain(const Geometry<L>& g, const Corners<L, 3>& c, const L& dt,
                                ShellStrain<L>& e) {
    const Vec3<L> v21 = g.axes.local(c.v[1] - c.v[0]), v31 = g.axes.local(c.v[2] - c.v[0]);
    const Vec3<L> w21 = g.axes.local(c.w[1] - c.w[0]), w31 = g.axes.local(c.w[2] - c.w[0]);
    const Vec3<L> mean = g.axes.local(L(1.0 / 3.0) * (c.w[0] + c.w[1] + c.w[2]));
    ShellGradient<L> d;
    for (int i = 0; i < 3; ++i) d.x[i] = g.dx(v21[i], v31[i]), d.y[i] = g.dy(v21[i], v31[i]);
    d.wx = mean.x, d.wy = mean.y;
    almansi(d, dt, e);
    // a and b of equation (4), y21 = 0
    const L sixth = L(1.0 / 6.0) * dt;
    const L a = sixth * ((g.x21 - g.x31) * w21.y - g.x21 * w31.y + g.y31 * w21.x);
    const L b = sixth * ((g.x31 - g.x21) * w31.y - g.x31 * w21.y - g.y31 * (w31.x - w21.x));
    e.zx += L(0.5) * g.inverse * (g.y31 * a);
    e.yz += L(0.5) * g.inverse * fma(g.x21, b, -(g.x31 * a));
    e.kxx = dt * g.dx(w21.y, w31.y);
    e.kyy = -(dt * g.dy(w21.x, w31.x));
    e.kxy = L(0.5) * dt * (g.dy(w21.y, w31.y) - g.dx(w21.x, w31.x));
  }

  template <class L>
  FABRICA_FN static void corner_forces(const Geometry<L>& g, const ShellResultants<L>& r,
                                       CornerForces<L, 3>& out) {
    // forces that oppose u21 and u31 of a component with resultants n1 (d/dx) and n2 (d/dy): A B .
    // n
    auto pair = [&](const L& n1, const L& n2, L& f2, L& f3) {
      f2 = L(0.5) * fma(g.y31, n1, -(g.x31 * n2));
      f3 = L(0.5) * (g.x21 * n2);
    };
    Vec3<L> f2, f3;
    pair(r.nxx, r.nxy, f2.x, f3.x);
    pair(r.nxy, r.nyy, f2.y, f3.y);
    pair(r.qx, r.qy, f2.z, f3.z);
    const Vec3<L> F2 = g.axes.global(f2), F3 = g.axes.global(f3);
    out.f[0] = F2 + F3, out.f[1] = -F2, out.f[2] = -F3;

    const L er = f2.z, es = f3.z, sixth = L(1.0 / 6.0);  // conjugate to the side shears of (2)
    L mx2, mx3, my2, my3;
    pair(-r.mxy, -r.myy, mx2, mx3);
    pair(r.mxx, r.mxy, my2, my3);
    my2 += sixth * (er * (g.x21 - g.x31) - es * g.x31);
    my3 += sixth * (es * (g.x31 - g.x21) - er * g.x21);
    mx2 += sixth * g.y31 * (er + es);
    mx3 -= sixth * g.y31 * es;
    const L third = L(1.0 / 3.0) * g.area;
    const Vec3<L> M2 = g.axes.global(mx2, my2), M3 = g.axes.global(mx3, my3);
    const Vec3<L> mean = g.axes.global(third * r.qy, -(third * r.qx));
    out.m[0] = mean + M2 + M3, out.m[1] = mean - M2, out.m[2] = mean - M3;
  }

  // output
  static Real thickness(StateView<Real> s) { return s.load(thickness_field); }
  template <class M>
  static Sym3<Real> stress(const ElementParameters&, StateView<Real> s, int layer) {
    return ShellLayers<M>::stress(layers<Real>(s), layer);
  }
  template <class M>
  static Real plastic_strain(const ElementParameters&, StateView<Real> s, int layer) {
    return ShellLayers<M>::plastic_strain(layers<Real>(s), layer);
  }
  template <class M>
  static void resultants(const ElementParameters& p, StateView<Real> s, double (&out)[8]) {
    ShellLayers<M>::resultants(p, thickness(s), layers<Real>(s), out);
  }
};

}  // namespace fabrica
