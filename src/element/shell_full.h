#pragma once
// Fully integrated quadrilateral shell (ELFORM 16, -16): 2 x 2 points in the plane, layers through
// the thickness. A field of the corners is u = mean + u_xi xi + u_eta eta + u_h xi eta; at a point
//   u,xi = u_xi + eta u_h,  u,eta = u_eta + xi u_h,
//   u,x = (y,eta u,xi - y,xi u,eta)/D,  u,y = (x,xi u,eta - x,eta u,xi)/D,  D = x,xi y,eta - x,eta
//     y,xi      (1)
// Membrane: normal strains at the points, shear strain of the centre (no locking in in-plane
// bending). Curvature: at the points. Transverse shear: tied on the sides (ANS)
//   g12 = (vz2 - vz1)/2 + x21 (wy1 + wy2)/4 - y21 (wx1 + wx2)/4 on eta = -1, g43 on eta = +1,
//   g14, g23 on xi = -1, +1; linear between, and turned to x, y by the inverse Jacobian         (2)
// Rigid motion and drilling are taken out first (shell.h, 4 and 5), which makes warped elements
// invariant and finite rotations free of strain; forces pass through the transpose.
// Sources: Dvorkin and Bathe, Eng. Comput. 1 (1984) 77; Rankin and Nour-Omid 1988.
#include "element/shell.h"

namespace fabrica {

struct ShellFull {
  static constexpr int corners = 4;
  static constexpr bool rotations = true;
  static constexpr int thickness_field = 0, layers_field = 1;

  template <class M>
  static int state_fields(const ElementParameters& p) {
    return layers_field + 4 * ShellLayers<M>::fields(p);
  }
  template <class M, class L>
  FABRICA_FN static StateView<L> layers(const ElementParameters& p, StateView<L> s, int point) {
    return {s.block + (layers_field + point * ShellLayers<M>::fields(p)) * block_size};
  }
  template <class L>
  FABRICA_FN static ShellAxes<L> frame(const Vec3<L> (&x)[4]) {
    return quad_axes<ShellFrame::invariant>(x);
  }

  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters& p, const Corners<L, 4>&,
                                    const Given<L>& g, StateView<L> s) {
    s.store(thickness_field,
            L(0.25) * (g.thickness[0] + g.thickness[1] + g.thickness[2] + g.thickness[3]));
    for (int k = 0; k < 4; ++k) ShellLayers<M>::start(p, layers<M>(p, s, k));
  }

  static void lump(const ElementParameters& p, const Corners<double, 4>& c, const Given<double>& g,
                   double (&mass)[4], double (&inertia)[4]) {
    const double h = 0.25 * (g.thickness[0] + g.thickness[1] + g.thickness[2] + g.thickness[3]);
    const double area = 0.5 * norm(cross(c.x[2] - c.x[0], c.x[3] - c.x[1]));
    const double m = 0.25 * area * (double(p.density) * h + double(p.area_mass));
    for (int a = 0; a < 4; ++a) {
      mass[a] = m;
      inertia[a] = shell_inertia(m, h, area, 0.5 * h * double(p.reference_location));
    }
  }

  // coefficients of xi, eta and xi eta
  template <class L>
  struct Modes {
    L xi, eta, h;
    Modes() = default;
    FABRICA_FN Modes(const L& a, const L& b, const L& c, const L& d) {
      const L q = L(0.25);
      xi = q * ((b - a) + (c - d)), eta = q * ((c - b) + (d - a)), h = q * ((a - b) + (c - d));
    }
  };

  // one in-plane point: derivatives of the coordinates times what (1) needs
  template <class L>
  struct Place {
    L xi, eta;
    L x_xi, x_eta, y_xi, y_eta, D;
    FABRICA_FN Place(const Modes<L>& x, const Modes<L>& y, double at_xi, double at_eta)
        : xi(at_xi), eta(at_eta) {
      x_xi = fma(eta, x.h, x.xi), x_eta = fma(xi, x.h, x.eta);
      y_xi = fma(eta, y.h, y.xi), y_eta = fma(xi, y.h, y.eta);
      D = fma(x_xi, y_eta, -(x_eta * y_xi));
    }
    // D u,x and D u,y from u,xi and u,eta
    FABRICA_FN L dx(const L& a, const L& b) const { return fma(y_eta, a, -(y_xi * b)); }
    FABRICA_FN L dy(const L& a, const L& b) const { return fma(x_xi, b, -(x_eta * a)); }
    FABRICA_FN L dx(const Modes<L>& u) const {
      return dx(fma(eta, u.h, u.xi), fma(xi, u.h, u.eta));
    }
    FABRICA_FN L dy(const Modes<L>& u) const {
      return dy(fma(eta, u.h, u.xi), fma(xi, u.h, u.eta));
    }
    // adds the transpose of D (n1 u,x + n2 u,y)
    FABRICA_FN void transpose(const L& n1, const L& n2, Modes<L>& f) const {
      const L a = fma(y_eta, n1, -(x_eta * n2)), b = fma(x_xi, n2, -(y_xi * n1));
      f.xi += a, f.eta += b, f.h += fma(eta, a, xi * b);
    }
  };

  // corner motion relative to the rigid motion, in the frame
  template <class L>
  struct Motion {
    Modes<L> vx, vy, wx, wy;
    L g12, g43, g14, g23;
  };

  template <class L>
  struct Geometry {
    ShellAxes<L> axes;
    L x[4], y[4];
    Modes<L> mx, my;
    FABRICA_FN explicit Geometry(const Vec3<L> (&c)[4]) : axes(frame(c)) {
      for (int a = 0; a < 4; ++a)
        x[a] = dot(axes.e1, c[a] - c[0]), y[a] = dot(axes.e2, c[a] - c[0]);
      mx = Modes<L>(x[0], x[1], x[2], x[3]), my = Modes<L>(y[0], y[1], y[2], y[3]);
    }
  };

  template <class L>
  FABRICA_FN static Motion<L> motion(const Geometry<L>& g, const Corners<L, 4>& c, const L& dt) {
    Vec3<L> v[4], w[4];
    project_motion(c, dt, v, w);
    for (int a = 0; a < 4; ++a) v[a] = g.axes.local(v[a]), w[a] = g.axes.local(w[a]);
    Motion<L> u;
    u.vx = Modes<L>(v[0].x, v[1].x, v[2].x, v[3].x),
    u.vy = Modes<L>(v[0].y, v[1].y, v[2].y, v[3].y);
    u.wx = Modes<L>(w[0].x, w[1].x, w[2].x, w[3].x),
    u.wy = Modes<L>(w[0].y, w[1].y, w[2].y, w[3].y);
    auto side = [&](int i, int j) {
      const L turn =
          fma(g.x[j] - g.x[i], w[i].y + w[j].y, -((g.y[j] - g.y[i]) * (w[i].x + w[j].x)));
      return fma(L(0.25), turn, L(0.5) * (v[j].z - v[i].z));
    };
    u.g12 = side(0, 1), u.g43 = side(3, 2), u.g14 = side(0, 3), u.g23 = side(1, 2);
    return u;
  }

  // forces conjugate to Motion
  template <class L>
  struct Conjugate {
    Modes<L> fx{L(0.0), L(0.0), L(0.0), L(0.0)}, fy = fx, mx = fx, my = fx;
    L g12 = L(0.0), g43 = g12, g14 = g12, g23 = g12, nxy = g12;
  };

  template <class L>
  FABRICA_FN static void point_strain(const Place<L>& at, const Motion<L>& u, const L& shear,
                                      const L& dt, ShellStrain<L>& e) {
    const L one = L(1.0), half = L(0.5), scale = dt / at.D, half_scale = half * scale;
    e.xx = scale * at.dx(u.vx), e.yy = scale * at.dy(u.vy), e.xy = shear;
    const L g_xi = half * fma(one - at.eta, u.g12, (one + at.eta) * u.g43);
    const L g_eta = half * fma(one - at.xi, u.g14, (one + at.xi) * u.g23);
    e.zx = half_scale * at.dx(g_xi, g_eta), e.yz = half_scale * at.dy(g_xi, g_eta);
    e.kxx = scale * at.dx(u.wy), e.kyy = -(scale * at.dy(u.wx));
    e.kxy = half_scale * (at.dy(u.wy) - at.dx(u.wx));
  }

  template <class L>
  FABRICA_FN static void point_forces(const Place<L>& at, const ShellResultants<L>& r,
                                      Conjugate<L>& f) {
    const L zero = L(0.0), half = L(0.5), one = L(1.0);
    at.transpose(r.nxx, zero, f.fx), at.transpose(zero, r.nyy, f.fy);
    f.nxy = fma(at.D, r.nxy, f.nxy);
    at.transpose(-r.mxy, -r.myy, f.mx), at.transpose(r.mxx, r.mxy, f.my);
    const L a = half * fma(at.y_eta, r.qx, -(at.x_eta * r.qy)),
            b = half * fma(at.x_xi, r.qy, -(at.y_xi * r.qx));
    f.g12 += (one - at.eta) * a, f.g43 += (one + at.eta) * a;
    f.g14 += (one - at.xi) * b, f.g23 += (one + at.xi) * b;
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M& material, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 4>& c, StateView<L> s, CornerForces<L, 4>& out,
                                Totals<L>& totals) {
    const L dt = L(dt_previous);
    const Geometry<L> g(c.x);
    const Motion<L> u = motion(g, c, dt);
    const Place<L> centre(g.mx, g.my, 0, 0);
    const L area = L(4.0) * centre.D;
    const L shear = L(0.5) * dt / centre.D * (centre.dy(u.vx) + centre.dx(u.vy));
    L h = s.load(thickness_field);
    const Point<L> point{dt,         L(1.0), sqrt(area), L(p.bulk + Real(4.0 / 3.0) * p.shear),
                         L(p.shear), L(1.0)};
    Conjugate<L> f;
    const L initial_step = quad_step(p, c.x, area, L(1.0));
    L thinning = L(0.0), stiffening = L(1.0), viscous_step = L(1e30);
    totals.alive = L(0.0), totals.internal = L(0.0);
    for (int k = 0; k < 4; ++k) {
      constexpr double a = 0.5773502691896257;
      const Place<L> at(g.mx, g.my, k == 1 || k == 2 ? a : -a, k > 1 ? a : -a);
      ShellStrain<L> e;
      point_strain(at, u, shear, dt, e);
      ShellResultants<L> r = ShellLayers<M>::advance(material, p, e, h, point, layers<M>(p, s, k));
      const L mid_area = at.D * (L(1.0) - L(0.5) * (e.xx + e.yy));
      L work = r.work;
      if (p.shell_viscosity) {
        const L faster = sqrt(r.stiffening);
        L step = initial_step / faster;
        work += shell_viscosity(p, e, area, h, dt, L(plate_speed(p)) * faster, step, r);
        viscous_step = min(viscous_step, step);
      }
      totals.internal = fma(mid_area, work, totals.internal);
      if (p.stiffness_damping != 0)
        totals.damping += mid_area * r.alive * damp_shell(p, e, h, dt, initial_step, r);
      point_forces(at, r, f);
      thinning = fma(L(0.25), r.thinning, thinning);
      stiffening = max(stiffening, r.stiffening);
      totals.alive = max(totals.alive, r.alive);
    }
    if (p.thickness_update) h *= L(1.0) + thinning;
    s.store(thickness_field, h);
    totals.time_step = min(initial_step / sqrt(stiffening), viscous_step);
    totals.volume = area * h;
    // the centre's shear strain takes the sum of the points: transpose of (D vx,y + D vy,x)/D at
    // the centre
    const L nxy = f.nxy / centre.D;
    centre.transpose(L(0.0), nxy, f.fx), centre.transpose(nxy, L(0.0), f.fy);
    corner_forces(g, f, out);
    project_forces(c, out);
  }

  template <class L>
  FABRICA_FN static void corner_forces(const Geometry<L>& g, const Conjugate<L>& f,
                                       CornerForces<L, 4>& out) {
    constexpr double sign_xi[4] = {-1, 1, 1, -1}, sign_eta[4] = {-1, -1, 1, 1},
                     sign_h[4] = {1, -1, 1, -1};
    Vec3<L> F[4], W[4];
    for (int a = 0; a < 4; ++a) {
      auto corner = [&](const Modes<L>& m) {
        const L sum = fma(L(sign_xi[a]), m.xi, fma(L(sign_eta[a]), m.eta, L(sign_h[a]) * m.h));
        return L(-0.25) * sum;
      };
      F[a] = {corner(f.fx), corner(f.fy), L(0.0)};
      W[a] = {corner(f.mx), corner(f.my), L(0.0)};
    }
    auto side = [&](int i, int j, const L& force) {
      const L half = L(0.5) * force, quarter = L(0.25) * force;
      F[i].z += half, F[j].z -= half;
      const L my = quarter * (g.x[j] - g.x[i]), mx = quarter * (g.y[j] - g.y[i]);
      W[i].y -= my, W[j].y -= my, W[i].x += mx, W[j].x += mx;
    };
    side(0, 1, f.g12), side(3, 2, f.g43), side(0, 3, f.g14), side(1, 2, f.g23);
    for (int a = 0; a < 4; ++a) {
      out.f[a] = g.axes.global(F[a]);
      out.m[a] = g.axes.global(W[a].x, W[a].y);
    }
  }

  // output: means of the four points
  static Real thickness(StateView<Real> s) { return s.load(thickness_field); }
  template <class M>
  static Sym3<Real> stress(const ElementParameters& p, StateView<Real> s, int layer) {
    Sym3<Real> sum{};
    for (int k = 0; k < 4; ++k)
      sum += Real(0.25) * ShellLayers<M>::stress(layers<M>(p, s, k), layer);
    return sum;
  }
  template <class M>
  static Real plastic_strain(const ElementParameters& p, StateView<Real> s, int layer) {
    Real sum = 0;
    for (int k = 0; k < 4; ++k)
      sum += Real(0.25) * ShellLayers<M>::plastic_strain(layers<M>(p, s, k), layer);
    return sum;
  }
  template <class M>
  static void resultants(const ElementParameters& p, StateView<Real> s, double (&out)[8]) {
    for (double& o : out) o = 0;
    for (int k = 0; k < 4; ++k) {
      double one[8];
      ShellLayers<M>::resultants(p, thickness(s), layers<M>(p, s, k), one);
      for (int i = 0; i < 8; ++i) out[i] += 0.25 * one[i];
    }
  }
};

}  // namespace fabrica
