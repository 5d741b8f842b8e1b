#pragma once
// Belytschko-Tsay shell (ELFORM 2; 10 or BWC = 1 with warping correction and projection): four
// corners, one point in the plane, layers through the thickness, velocity strain in a frame that
// turns with the corners.
//   B1 = (y24, y31, y42, y13)/2A,   B2 = (x42, x13, x24, x31)/2A                                (1)
//   dxx = B1.vx + z B1.wy,  dyy = B2.vy - z B2.wx,  2dxy = B2.vx + B1.vy + z (B2.wy - B1.wx)
//   2dxz = B1.vz + mean wy,  2dyz = B2.vz - mean wx                                             (2)
// Only differences over the diagonals enter: B1.v = (y42 v31 - y31 v42)/2A, B2.v = (x31 v42 - x42
// v31)/2A.
// Hourglass: h = (1,-1,1,-1), gamma = h - (h.x) B1 - (h.y) B2, rates gamma.w, gamma.vz, gamma.v
// with stiffnesses
// The membrane rates are taken relative to the frame's rotation, which a warped element (h.z != 0)
// would feel:
//   q_x = gamma.vx + (h.z) vz,x,  q_y = gamma.vy + (h.z) vz,y
//   C1 = QB E h^3 A BB/192,  C2 = QW k G h^3 BB/12,  C3 = QM E h A BB/8,  BB = B1.B1 + B2.B2    (3)
// IHQ 4, 5: Q <- Q + C q dt. While the layers flow, at the stress s, Q is held at what the mode
// could carry if all of its stress were s:
//   |Q| <= s h sqrt(A)/4  (forces),  s h^2 sqrt(A)/16  (moments)                                (4)
// IHQ 1-3 (viscous): Q = C q sqrt(A)/c. Warping (Belytschko, Wong, Chiang): zg = (h.z)/4, s = 2
// zg/A^2
//   kxx += s (x31 vx31 - x42 vx42),  kyy += s (y31 vy31 - y42 vy42),
//   2kxy += s (y31 vx31 - y42 vx42 + x31 vy31 - x42 vy42)                                       (5)
// Forces are the transposes of (2), (3) and (5).
// Sources: Belytschko, Lin, Tsay, CMAME 42 (1984) 225; Belytschko, Wong, Chiang, CMAME 96 (1992)
// 93.
#include "element/shell.h"

namespace fabrica {

template <ShellFrame F>
struct ShellBTOf {
  static constexpr int corners = 4;
  static constexpr bool rotations = true;
  // (3) in amplitudes: gamma.v is four times the amplitude of an hourglass mode, and so is its
  // force
  static constexpr double stiffness_share = 1.0 / 16;
  // history: thickness, hourglass forces (moments x, y; force z; forces x, y), layers
  static constexpr int thickness_field = 0, hourglass_field = 1, layers_field = 6;

  template <class M>
  static int state_fields(const ElementParameters& p) {
    return layers_field + ShellLayers<M>::fields(p);
  }

  template <class L, class M>
  FABRICA_FN static void initialise(const M&, const ElementParameters& p, const Corners<L, 4>&,
                                    const Given<L>& g, StateView<L> s) {
    s.store(thickness_field,
            L(0.25) * (g.thickness[0] + g.thickness[1] + g.thickness[2] + g.thickness[3]));
    ShellLayers<M>::start(p, layers<L>(s));
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

  // the local axes of the stored stress
  template <class L>
  FABRICA_FN static ShellAxes<L> frame(const Vec3<L> (&x)[4]) {
    return quad_axes<F>(x);
  }
  template <class L>
  FABRICA_FN static StateView<L> layers(StateView<L> s) {
    return {s.block + layers_field * block_size};
  }

  template <class L, class M>
  FABRICA_FN static void forces(const M& material, const ElementParameters& p, Real dt_previous,
                                const Corners<L, 4>& c, StateView<L> s, CornerForces<L, 4>& out,
                                Totals<L>& totals) {
    const L dt = L(dt_previous);
    const Geometry<L> g(c.x);
    const bool project = p.projection || warped(p);
    const Motion<L> motion = project ? projected_motion(g, c, dt) : Motion<L>(g.axes, c.v, c.w);
    const ShellGradient<L> gradient = gradient_of(g, motion);
    ShellStrain<L> e;
    almansi(gradient, dt, e);
    curvature(p, g, motion, dt, e);

    L h = s.load(thickness_field);
    const L root_area = sqrt(g.area);
    const Point<L> point{dt,         L(1.0), root_area, L(p.bulk + Real(4.0 / 3.0) * p.shear),
                         L(p.shear), L(1.0)};
    ShellResultants<L> r = ShellLayers<M>::advance(material, p, e, h, point, layers<L>(s));
    if (p.thickness_update) h *= L(1.0) + r.thinning;
    s.store(thickness_field, h);

    const L faster = sqrt(r.stiffening);
    L step = quad_step(p, c.x, g.area, faster), viscous = L(0.0);
    if (p.shell_viscosity)
      viscous = shell_viscosity(p, e, g.area, h, dt, L(plate_speed(p)) * faster, step, r);
    totals.time_step = step;
    totals.volume = g.area * h;
    totals.alive = r.alive;
    const L mid_area = g.area * (L(1.0) - L(0.5) * (e.xx + e.yy));
    totals.internal = mid_area * (r.work + viscous);
    if (p.stiffness_damping != 0)
      totals.damping = mid_area * r.alive * damp_shell(p, e, h, dt, step, r);

    Hourglass<L> q;
    totals.hourglass = hourglass(p, g, motion, gradient, h, root_area, dt, r, s, q);
    corner_forces(p, g, r, q, out);
    if (project) project_forces(c, out);
  }

  // Geometry in the frame; the diagonals lie in the plane, so their z vanish.
  template <class L>
  struct Geometry {
    ShellAxes<L> axes;
    L x31, y31, x42, y42;
    L hx, hy, hz;          // h . x
    L area, half_inverse;  // A, 1/(2A)

    FABRICA_FN explicit Geometry(const Vec3<L> (&x)[4]) : axes(quad_axes<F>(x)) {
      const Vec3<L> r31 = x[2] - x[0], r42 = x[3] - x[1];
      x31 = dot(axes.e1, r31), y31 = dot(axes.e2, r31);
      x42 = dot(axes.e1, r42), y42 = dot(axes.e2, r42);
      const Vec3<L> hh = axes.local((x[0] - x[1]) + (x[2] - x[3]));
      hx = hh.x, hy = hh.y, hz = hh.z;
      const L twice = fma(x31, y42, -(x42 * y31));
      area = L(0.5) * twice;
      half_inverse = L(1.0) / twice;
    }
    // B1 . u and B2 . u from the differences over the diagonals
    FABRICA_FN L dx(const L& u31, const L& u42) const {
      return half_inverse * fma(y42, u31, -(y31 * u42));
    }
    FABRICA_FN L dy(const L& u31, const L& u42) const {
      return half_inverse * fma(x31, u42, -(x42 * u31));
    }
    FABRICA_FN L warp() const { return hz * L(2.0) * half_inverse * half_inverse; }  // s of (5)
  };

  // Corner motion in the frame as differences over the diagonals, hourglass combinations and means.
  template <class L>
  struct Motion {
    Vec3<L> v31, v42, hv;
    L wx31, wy31, wx42, wy42, hwx, hwy, wx, wy;

    Motion() = default;
    FABRICA_FN Motion(const ShellAxes<L>& q, const Vec3<L> (&v)[4], const Vec3<L> (&w)[4]) {
      v31 = q.local(v[2] - v[0]), v42 = q.local(v[3] - v[1]);
      hv = q.local((v[0] - v[1]) + (v[2] - v[3]));
      const Vec3<L> w31 = w[2] - w[0], w42 = w[3] - w[1], even = w[0] + w[2], odd = w[1] + w[3];
      wx31 = dot(q.e1, w31), wy31 = dot(q.e2, w31);
      wx42 = dot(q.e1, w42), wy42 = dot(q.e2, w42);
      const Vec3<L> hw = even - odd, mean = L(0.25) * (even + odd);
      hwx = dot(q.e1, hw), hwy = dot(q.e2, hw);
      wx = dot(q.e1, mean), wy = dot(q.e2, mean);
    }
  };

  template <class L>
  FABRICA_FN static Motion<L> projected_motion(const Geometry<L>& g, const Corners<L, 4>& c,
                                               const L& dt) {
    Vec3<L> v[4], w[4];
    project_motion(c, dt, v, w);
    return Motion<L>(g.axes, v, w);
  }

  template <class L>
  FABRICA_FN static ShellGradient<L> gradient_of(const Geometry<L>& g, const Motion<L>& u) {
    ShellGradient<L> d;
    for (int i = 0; i < 3; ++i)
      d.x[i] = g.dx(u.v31[i], u.v42[i]), d.y[i] = g.dy(u.v31[i], u.v42[i]);
    d.wx = u.wx, d.wy = u.wy;
    return d;
  }

  template <class L>
  FABRICA_FN static void curvature(const ElementParameters& p, const Geometry<L>& g,
                                   const Motion<L>& u, const L& dt, ShellStrain<L>& e) {
    e.kxx = g.dx(u.wy31, u.wy42);
    e.kyy = -g.dy(u.wx31, u.wx42);
    e.kxy = g.dy(u.wy31, u.wy42) - g.dx(u.wx31, u.wx42);
    if (warped(p)) {
      const L s = g.warp();
      e.kxx += s * fma(g.x31, u.v31.x, -(g.x42 * u.v42.x));
      e.kyy += s * fma(g.y31, u.v31.y, -(g.y42 * u.v42.y));
      e.kxy +=
          s * (fma(g.y31, u.v31.x, -(g.y42 * u.v42.x)) + fma(g.x31, u.v31.y, -(g.x42 * u.v42.y)));
    }
    e.kxx *= dt, e.kyy *= dt, e.kxy *= L(0.5) * dt;
  }
  FABRICA_FN static bool warped(const ElementParameters& p) {
    return p.warping || p.formulation == 10;
  }

  template <class L>
  struct Hourglass {
    L mx, my, fz, fx, fy;
  };

  // Equation (3); returns the energy increment.
  template <class L>
  FABRICA_FN static L hourglass(const ElementParameters& p, const Geometry<L>& g,
                                const Motion<L>& u, const ShellGradient<L>& d, const L& h,
                                const L& root_area, const L& dt, const ShellResultants<L>& r,
                                StateView<L> s, Hourglass<L>& out) {
    const L alive = r.alive;
    const L bb = L(2.0) * g.half_inverse * g.half_inverse *
                 (fma(g.x31, g.x31, g.y31 * g.y31) + fma(g.x42, g.x42, g.y42 * g.y42));
    const Real qm = p.hourglass_coefficient;
    const Real qb = p.hourglass_bending != 0 ? p.hourglass_bending : qm;
    const Real qw = p.hourglass_warping != 0 ? p.hourglass_warping : qm;
    const L cube = h * h * h * bb;
    const L stiffness[3] = {L(qb * p.youngs / 192) * g.area * cube,
                            L(qw * p.shear_factor * p.shear / 12) * cube,
                            L(qm * p.youngs / 8) * h * g.area * bb};
    const L wxx = g.dx(u.wx31, u.wx42), wxy = g.dy(u.wx31, u.wx42);
    const L wyx = g.dx(u.wy31, u.wy42), wyy = g.dy(u.wy31, u.wy42);
    const L rate[5] = {u.hwx - fma(g.hx, wxx, g.hy * wxy), u.hwy - fma(g.hx, wyx, g.hy * wyy),
                       u.hv.z - fma(g.hx, d.x.z, g.hy * d.y.z),
                       u.hv.x - fma(g.hx, d.x.x, g.hy * d.y.x) + g.hz * d.x.z,
                       u.hv.y - fma(g.hx, d.x.y, g.hy * d.y.y) + g.hz * d.y.z};
    L* const q = &out.mx;
    L energy = L(0.0);
    const bool stiff = p.hourglass >= 4;
    const L viscous = root_area * L(1 / plate_speed(p));
    const L force = L(0.25) * h * root_area * r.flow, moment = L(0.25) * h * force;
    for (int k = 0; k < 5; ++k) {
      const L c = stiffness[k < 2 ? 0 : k == 2 ? 1 : 2];
      if (stiff) {
        const L old = s.load(hourglass_field + k);
        const L bound = k < 2 ? moment : force;
        q[k] = alive * clamp(fma(c * L(stiffness_share) * dt, rate[k], old), -bound, bound);
        s.store(hourglass_field + k, q[k]);
        energy = fma(L(0.5) * (old + q[k]), rate[k], energy);
      } else {
        q[k] = alive * (c * viscous * rate[k]);
        energy = fma(q[k], rate[k], energy);
      }
    }
    return dt * energy;
  }

  // On the nodes: f1 = P - Q, f2 = Q - R, f3 = -P - Q, f4 = R + Q for every component, with
  //   P = (y42 N1 - x42 N2)/2A,  R = (y31 N1 - x31 N2)/2A,  N1 = A n_x - Q hx,  N2 = A n_y - Q hy
  template <class L>
  FABRICA_FN static void corner_forces(const ElementParameters& p, const Geometry<L>& g,
                                       const ShellResultants<L>& r, const Hourglass<L>& q,
                                       CornerForces<L, 4>& out) {
    auto pair = [&](const L& nx, const L& ny, const L& Q, L& P, L& R, const L& x = L(0.0),
                    const L& y = L(0.0)) {
      const L a = g.half_inverse * (fma(g.area, nx, -(Q * g.hx)) + x),
              b = g.half_inverse * (fma(g.area, ny, -(Q * g.hy)) + y);
      P = fma(g.y42, a, -(g.x42 * b));
      R = fma(g.y31, a, -(g.x31 * b));
    };
    Vec3<L> P, R;
    pair(r.nxx, r.nxy, q.fx, P.x, R.x);
    pair(r.nxy, r.nyy, q.fy, P.y, R.y);
    // the share of the membrane modes that undoes the rotation of a warped element
    pair(r.qx, r.qy, q.fz, P.z, R.z, q.fx * g.hz, q.fy * g.hz);
    if (warped(p)) {
      const L s = g.area * g.warp();
      P.x += s * fma(g.x31, r.mxx, g.y31 * r.mxy), R.x += s * fma(g.x42, r.mxx, g.y42 * r.mxy);
      P.y += s * fma(g.y31, r.myy, g.x31 * r.mxy), R.y += s * fma(g.y42, r.myy, g.x42 * r.mxy);
    }
    L mpx, mrx, mpy, mry;
    pair(-r.mxy, -r.myy, q.mx, mpx, mrx);
    pair(r.mxx, r.mxy, q.my, mpy, mry);

    const Vec3<L> Pg = g.axes.global(P), Rg = g.axes.global(R),
                  Qg = g.axes.global({q.fx, q.fy, q.fz});
    out.f[0] = Pg - Qg, out.f[2] = -(Pg + Qg), out.f[1] = Qg - Rg, out.f[3] = Rg + Qg;
    const L quarter = L(0.25) * g.area;
    const Vec3<L> mp = g.axes.global(mpx, mpy), mr = g.axes.global(mrx, mry),
                  mq = g.axes.global(q.mx, q.my);
    const Vec3<L> even = g.axes.global(quarter * r.qy, -(quarter * r.qx)) - mq;
    const Vec3<L> odd = even + L(2.0) * mq;
    out.m[0] = even + mp, out.m[2] = even - mp, out.m[1] = odd - mr, out.m[3] = odd + mr;
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

using ShellBT = ShellBTOf<ShellFrame::side>;
using ShellBTInvariant = ShellBTOf<ShellFrame::invariant>;

}  // namespace fabrica
