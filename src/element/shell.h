#pragma once
// What all shell elements share: frame, layers through the thickness, resultants, rigid-body
// projection, time step.
//
// Lamina at height z over the reference surface; strain increments of a step in the element's
// frame:
//   e_ab(z) = e_ab + z k_ab,   e_az constant                                                    (1)
//   n_ab = h sum_q w_q s_ab,   m_ab = h sum_q w_q z_q s_ab,   z_q = h/2 (zeta_q - NLOC)         (2)
// Increments are Almansi's, measured in the end geometry with G = velocity gradient of the half
// step:
//   e = dt (G + G^T)/2 - dt^2/2 G^T G                                                           (3)
// so that a rigid rotation of finite size leaves no strain.
// Projection: the rigid motion (a, b) that fits the corner velocities best is taken out of (v, w):
//   b = J^-1 sum r x v,  J = sum (r.r I - r r^T),  v' = v - a - b x r,  w' = w - b              (4)
//   then the drilling rate about the corner's own normal p:  w" = w' - (w'.p) p                 (5)
// and the forces pass through the transpose: m' = m" - (m".p) p,  f = f' - mean f' - (J^-1 t) x r,
// t = sum (r x f' + m'). Facets of a curved surface can hand on only moments across their own
// normals; with (5) the corner normal, which neighbours share, takes that place.
// Sources: Belytschko, Lin, Tsay 1984; Rankin and Nour-Omid 1988 (projectors); dt: Hallquist,
// theory manual.
#include <type_traits>

#include "element/solid.h"
#include "material/plane_stress.h"

namespace fabrica {

// How the in-plane axes follow the corners: LS-DYNA's default takes e1 along side 1-2, the
// invariant choice halves the angle between the mid-lines and does not depend on where the
// numbering starts.
enum class ShellFrame { side, invariant };

// rows: the local axes
template <class L>
struct ShellAxes {
  Vec3<L> e1, e2, e3;
  FABRICA_FN Vec3<L> local(const Vec3<L>& a) const { return {dot(e1, a), dot(e2, a), dot(e3, a)}; }
  FABRICA_FN Vec3<L> global(const Vec3<L>& a) const {
    Vec3<L> r;
    for (int i = 0; i < 3; ++i) r[i] = fma(e1[i], a.x, fma(e2[i], a.y, e3[i] * a.z));
    return r;
  }
  FABRICA_FN Vec3<L> global(const L& x, const L& y) const {
    Vec3<L> r;
    for (int i = 0; i < 3; ++i) r[i] = fma(e1[i], x, e2[i] * y);
    return r;
  }
  // local to global: its columns are the axes
  FABRICA_FN Mat3<L> rotation() const {
    return {{{e1.x, e2.x, e3.x}, {e1.y, e2.y, e3.y}, {e1.z, e2.z, e3.z}}};
  }
};

// Axes from a normal of any length and the direction of e1 before projection.
template <class L>
FABRICA_FN ShellAxes<L> shell_axes(const Vec3<L>& normal, const Vec3<L>& direction) {
  ShellAxes<L> a;
  a.e3 = (L(1.0) / sqrt(dot(normal, normal))) * normal;
  const Vec3<L> s = direction - dot(direction, a.e3) * a.e3;
  a.e1 = (L(1.0) / sqrt(dot(s, s))) * s;
  a.e2 = cross(a.e3, a.e1);
  return a;
}

template <ShellFrame F, class L>
FABRICA_FN ShellAxes<L> quad_axes(const Vec3<L> (&x)[4]) {
  const Vec3<L> r31 = x[2] - x[0], r42 = x[3] - x[1];
  if constexpr (F == ShellFrame::side) {
    return shell_axes(cross(r31, r42), x[1] - x[0]);
  } else {
    // mid-lines a, b of equal length: a + b and a - b are orthogonal, e1 lies half way between them
    const Vec3<L> a = r31 - r42, b = r31 + r42;
    const Vec3<L> ua = (L(1.0) / norm(a)) * a, ub = (L(1.0) / norm(b)) * b;
    const Vec3<L> sum = ua + ub, difference = ua - ub;
    return shell_axes(cross(r31, r42),
                      (L(1.0) / norm(sum)) * sum + (L(1.0) / norm(difference)) * difference);
  }
}

// Increments of strain and curvature of one step at one in-plane point; tensor components.
template <class L>
struct ShellStrain {
  L xx, yy, xy, yz, zx;
  L kxx, kyy, kxy;
};

constexpr Real unbounded_stress = Real(1e30);

// What the layers of one in-plane point answer, per unit of area of the reference surface.
template <class L>
struct ShellResultants {
  L nxx, nyy, nxy, qy, qx;  // h sum w s; the shear factor is in the stress
  L mxx, myy, mxy;
  L work;        // h sum w (mean stress : strain)
  L thinning;    // sum w e_zz
  L stiffening;  // largest ratio of tangent to initial modulus, >= 1
  L alive;       // 0: every layer has failed
  L flow;        // von Mises stress in the plane while the layers flow, else unbounded
};

// What a point kept of its elastic trial stress, for control of hourglass modes while layers flow:
// von Mises stress squared in the plane, w times, of the new stress and of the trial stress.
template <class L>
struct KeptStress {
  L kept = L(1e-30), trial = L(1e-30);
  FABRICA_FN void add(const ElementParameters& p, const L& w, const Sym3<L>& old,
                      const Sym3<L>& now, const Sym3<L>& strain) {
    const L plane = L(p.youngs / (1 - p.poisson * p.poisson)), nu = L(p.poisson);
    const L xx = fma(plane, fma(nu, strain.yy, strain.xx), old.xx),
            yy = fma(plane, fma(nu, strain.xx, strain.yy), old.yy);
    const L xy = fma(L(2 * p.shear), strain.xy, old.xy);
    auto square = [](const L& a, const L& b, const L& c) {
      return fma(a, a, fma(b, b, fma(L(3.0) * c, c, -(a * b))));
    };
    kept = fma(w, square(now.xx, now.yy, now.xy), kept);
    trial = fma(w, square(xx, yy, xy), trial);
  }
  // ShellResultants::flow; rounding must not pass for flow
  FABRICA_FN L flow() const {
    return select(kept < L(0.9998) * trial, sqrt(kept), L(unbounded_stress));
  }
};

// History of the layers of one in-plane point: per layer xx yy xy yz zx, [alive], material state.
template <class M>
struct ShellLayers {
  static constexpr int alive = 5;
  static constexpr int material = 5 + (M::can_fail ? 1 : 0);
  static constexpr int stride = material + material_fields<M>();

  static int fields(const ElementParameters& p) { return stride * p.layers; }

  template <class L>
  FABRICA_FN static void start(const ElementParameters& p, StateView<L> s) {
    if constexpr (M::can_fail)
      for (int q = 0; q < p.layers; ++q) s.store(q * stride + alive, L(1.0));
  }

  template <class L>
  FABRICA_FN static Sym3<L> stress(StateView<L> s, int layer) {
    const int at = layer * stride;
    return {s.load(at), s.load(at + 1), L(0.0), s.load(at + 2), s.load(at + 3), s.load(at + 4)};
  }

  static Real plastic_strain(StateView<Real> s, int layer) {
    auto state = s.template get<typename M::template State<Real>>(layer * stride + material);
    if constexpr (requires { state.plastic_strain; })
      return state.plastic_strain;
    else
      return 0;
  }

  // Advances all layers and integrates them, equations (1) and (2). start: the point as elastic;
  // the laws of the layers each see a copy.
  template <class L>
  FABRICA_FN static ShellResultants<L> advance(const M& law, const ElementParameters& p,
                                               const ShellStrain<L>& e, const L& h,
                                               const Point<L>& start, StateView<L> s) {
    using MaterialState = typename M::template State<L>;
    const L zero = L(0.0), half_h = L(0.5) * h;
    ShellResultants<L> r{zero, zero, zero, zero,   zero, zero,  zero,
                         zero, zero, zero, L(1.0), zero, L(1.0)};
    L modulus = start.modulus, failed = zero;
    KeptStress<L> share;
    const StateView<L> first = s;
    for (int q = 0; q < p.layers; ++q, s.block += stride * block_size) {
      const L z = half_h * L(p.layer_z[q] - p.reference_location), w = L(p.layer_weight[q]);
      const Sym3<L> strain{
          fma(z, e.kxx, e.xx), fma(z, e.kyy, e.yy), zero, fma(z, e.kxy, e.xy), e.yz, e.zx};
      Sym3<L> old = stress(s, 0);
      MaterialState state = s.template get<MaterialState>(material);
      Point<L> point = start;
      L dzz = zero;
      const L two = L(2.0);
      Sym3<L> now = plane_stress(law, old, strain.xx, strain.yy, two * strain.xy, two * strain.yz,
                                 two * strain.zx, L(p.shear_factor), point, state, dzz);
      if constexpr (M::can_fail) {
        const L live = min(s.load(alive), point.alive);
        s.store(alive, live);
        r.alive = max(r.alive, live);
        failed += L(1.0) - live;
        now = live * now;
      }
      s.store(0, now.xx), s.store(1, now.yy), s.store(2, now.xy), s.store(3, now.yz),
          s.store(4, now.zx);
      s.put(material, state);
      add(r, w, z, old, now, strain);
      share.add(p, w, old, now, strain);
      r.thinning = fma(w, dzz, r.thinning);
      modulus = max(modulus, point.modulus);
    }
    if constexpr (requires { law.layers_to_fail(); })
      if (law.layers_to_fail() > 0) fail_together(p, law.layers_to_fail(), failed, first, r);
    finish(r, h);
    r.flow = share.flow();
    r.stiffening = modulus / start.modulus;
    if constexpr (!M::can_fail) r.alive = L(1.0);
    return r;
  }

  // Resultants of the stored stress: mxx myy mxy qx qy nxx nyy nxy (the order of the output files).
  static void resultants(const ElementParameters& p, Real h, StateView<Real> s, double (&out)[8]) {
    for (double& o : out) o = 0;
    for (int q = 0; q < p.layers; ++q) {
      const Sym3<Real> t = stress(s, q);
      const double w = double(h) * p.layer_weight[q];
      const double wz = w * 0.5 * h * (p.layer_z[q] - p.reference_location);
      out[0] += wz * t.xx, out[1] += wz * t.yy, out[2] += wz * t.xy;
      out[3] += w * t.zx, out[4] += w * t.yz;
      out[5] += w * t.xx, out[6] += w * t.yy, out[7] += w * t.xy;
    }
  }

 private:
  // Where so many layers have failed all do, and carry nothing.
  template <class L>
  FABRICA_FN static void fail_together(const ElementParameters& p, int count, const L& failed,
                                       StateView<L> s, ShellResultants<L>& r) {
    const L live = select(failed < L(Real(count) - Real(0.5)), L(1.0), L(0.0));
    for (int q = 0; q < p.layers; ++q, s.block += stride * block_size)
      s.store(alive, live * s.load(alive));
    r.alive = live * r.alive;
    for (L* part : {&r.nxx, &r.nyy, &r.nxy, &r.mxx, &r.myy, &r.mxy, &r.qx, &r.qy}) *part *= live;
  }
  template <class L>
  FABRICA_FN static void add(ShellResultants<L>& r, const L& w, const L& z, const Sym3<L>& old,
                             const Sym3<L>& now, const Sym3<L>& strain) {
    r.nxx = fma(w, now.xx, r.nxx), r.nyy = fma(w, now.yy, r.nyy), r.nxy = fma(w, now.xy, r.nxy);
    r.qy = fma(w, now.yz, r.qy), r.qx = fma(w, now.zx, r.qx);
    const L wz = w * z;
    r.mxx = fma(wz, now.xx, r.mxx), r.myy = fma(wz, now.yy, r.myy), r.mxy = fma(wz, now.xy, r.mxy);
    const L across = fma(old.yz + now.yz, strain.yz, (old.zx + now.zx) * strain.zx);
    const L twice = fma(old.xy + now.xy, strain.xy, across);
    const L normal = fma(old.xx + now.xx, strain.xx, (old.yy + now.yy) * strain.yy);
    r.work = fma(w, fma(L(2.0), twice, normal), r.work);
  }
  template <class L>
  FABRICA_FN static void finish(ShellResultants<L>& r, const L& h) {
    r.nxx *= h, r.nyy *= h, r.nxy *= h;
    r.mxx *= h, r.myy *= h, r.mxy *= h;
    r.qx *= h, r.qy *= h;
    r.work *= L(0.5) * h;
  }
};

// Velocity gradient of the reference surface in the frame: columns d/dx, d/dy, and the mean angular
// velocity.
template <class L>
struct ShellGradient {
  Vec3<L> x, y;  // v,x and v,y
  L wx, wy;
};

// Almansi increments, equation (3), with v,z = w x e3 - dt/2 w x (w x e3) of the turning normal.
template <class L>
FABRICA_FN void almansi(const ShellGradient<L>& g, const L& dt, ShellStrain<L>& e) {
  const L half = L(0.5) * dt;
  const L spin = L(0.5) * (g.x.y - g.y.x);
  e.xx = dt * (g.x.x - half * dot(g.x, g.x));
  e.yy = dt * (g.y.y - half * dot(g.y, g.y));
  e.xy = half * (g.x.y + g.y.x - dt * dot(g.x, g.y));
  e.zx = half * (g.x.z + g.wy - dt * (fma(g.x.x, g.wy, -(g.x.y * g.wx)) + L(0.5) * g.wx * spin));
  e.yz = half * (g.y.z - g.wx - dt * (fma(g.y.x, g.wy, -(g.y.y * g.wx)) + L(0.5) * g.wy * spin));
}

// Stiffness damping of the part, beta C : D, added to the resultants; returns the energy it takes
// per area.
template <class L>
FABRICA_FN L damp_shell(const ElementParameters& p, const ShellStrain<L>& e, const L& h,
                        const L& dt, const L& step, ShellResultants<L>& r) {
  const L beta = p.stiffness_damping > 0 ? L(p.stiffness_damping) * step : L(-p.stiffness_damping);
  const L rate = select(dt > L(0.0), beta / max(dt, L(1e-30)), L(0.0));
  const L direct = rate * h * L(p.youngs / (1 - p.poisson * p.poisson)),
          cross = L(p.poisson) * direct;
  const L twice = rate * h * L(2 * p.shear), shear = L(p.shear_factor) * twice,
          bend = h * h * L(1.0 / 12.0);
  const L nxx = direct * e.xx + cross * e.yy, nyy = direct * e.yy + cross * e.xx,
          nxy = twice * e.xy;
  const L mxx = bend * (direct * e.kxx + cross * e.kyy),
          myy = bend * (direct * e.kyy + cross * e.kxx);
  const L mxy = bend * twice * e.kxy;
  r.nxx += nxx, r.nyy += nyy, r.nxy += nxy;
  r.mxx += mxx, r.myy += myy, r.mxy += mxy;
  r.qx += shear * e.zx, r.qy += shear * e.yz;
  const L membrane = nxx * e.xx + nyy * e.yy + L(2.0) * nxy * e.xy;
  const L bending = mxx * e.kxx + myy * e.kyy + L(2.0) * mxy * e.kxy;
  return membrane + bending + L(2.0) * shear * (e.zx * e.zx + e.yz * e.yz);
}

// Bulk viscosity of shells (*CONTROL_BULK_VISCOSITY, TYPE -1 and -2): the pressure q of solid.h,
// equation (3), with D_kk = (e_xx + e_yy)/dt of the reference surface, l = sqrt(A) and the plate's
// wave speed, on the membrane forces n_xx and n_yy; the step follows (4) there. Returns the energy
// it takes per area, 0 where it is not to be counted.
template <class L>
FABRICA_FN L shell_viscosity(const ElementParameters& p, const ShellStrain<L>& e, const L& area,
                             const L& h, const L& dt, const L& speed, L& step,
                             ShellResultants<L>& r) {
  const L strain = e.xx + e.yy, rate = strain / max(dt, L(1e-30));
  const L size = step * speed;
  const L q = (r.alive * h) * bulk_viscosity(p, L(p.density), speed, rate, size, sqrt(area));
  r.nxx -= q, r.nyy -= q;
  step = min(step, stable_step(p, speed, rate, size));
  return p.shell_viscosity == 2 ? -(q * strain) : L(0.0);
}

// Initial plate and bar wave speeds.
FABRICA_FN Real plate_speed(const ElementParameters& p) {
  return sqrt(p.youngs / ((1 - p.poisson * p.poisson) * p.density));
}
FABRICA_FN Real bar_speed(const ElementParameters& p) { return sqrt(p.youngs / p.density); }

// Stable step of a quadrilateral by ISDO; faster: ratio of the sound speed to the initial one.
template <class L>
FABRICA_FN L quad_step(const ElementParameters& p, const Vec3<L> (&x)[4], const L& area,
                       const L& faster) {
  L longest = L(0.0), shortest = L(1e30);
  for (int a = 0; a < 4; ++a) {
    const Vec3<L> side = x[(a + 1) & 3] - x[a];
    const L square = dot(side, side);
    longest = max(longest, square), shortest = min(shortest, square);
  }
  if (p.time_step_option == 1) {
    const Vec3<L> r31 = x[2] - x[0], r42 = x[3] - x[1];
    longest = max(dot(r31, r31), dot(r42, r42));
  }
  L length = area / sqrt(longest);
  if (p.time_step_option == 2) length = max(length, sqrt(shortest));
  return length / (L(p.time_step_option == 2 ? bar_speed(p) : plate_speed(p)) * faster);
}

// Lumped rotary inertia of a corner of mass m: the bending frequency stays below the membrane
// frequency.
inline double shell_inertia(double m, double h, double area, double offset) {
  const double own = h * h / 12 + offset * offset;
  return m * (own > area / 8 ? own : area / 8);
}

// Rigid motion of corners and its removal, equation (4). Everything in the frame, about the mean
// corner.
template <class L, int N>
struct RigidProjection {
  Vec3<L> r[N];
  Mat3<L> inverse;  // J^-1

  FABRICA_FN explicit RigidProjection(const Vec3<L> (&x)[N]) {
    Vec3<L> centre = x[0];
    for (int a = 1; a < N; ++a) centre += x[a];
    for (int a = 0; a < N; ++a) r[a] = x[a] - L(1.0 / N) * centre;
    Mat3<L> J{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) J.a[i][j] = L(0.0);
    for (int a = 0; a < N; ++a) {
      const L rr = dot(r[a], r[a]);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) J.a[i][j] += (i == j ? rr : L(0.0)) - r[a][i] * r[a][j];
    }
    inverse = fabrica::inverse(J);
  }
  FABRICA_FN void remove(Vec3<L> (&v)[N], Vec3<L> (&w)[N]) const {
    Vec3<L> mean = v[0], moment = cross(r[0], v[0]);
    for (int a = 1; a < N; ++a) mean += v[a], moment += cross(r[a], v[a]);
    const Vec3<L> b = inverse * moment;
    for (int a = 0; a < N; ++a) v[a] -= L(1.0 / N) * mean + cross(b, r[a]), w[a] -= b;
  }
  FABRICA_FN void transpose(Vec3<L> (&f)[N], const Vec3<L> (&m)[N]) const {
    Vec3<L> mean = f[0], moment = cross(r[0], f[0]) + m[0];
    for (int a = 1; a < N; ++a) mean += f[a], moment += cross(r[a], f[a]) + m[a];
    const Vec3<L> b = inverse * moment;
    for (int a = 0; a < N; ++a) f[a] -= L(1.0 / N) * mean + cross(b, r[a]);
  }
};

// Drilling of the corners of a quadrilateral and its removal, equation (5).
template <class L>
struct DrillProjection {
  Vec3<L> p[4];

  FABRICA_FN explicit DrillProjection(const Vec3<L> (&x)[4]) {
    Vec3<L> side[4];
    for (int a = 0; a < 4; ++a) side[a] = x[(a + 1) & 3] - x[a];
    for (int a = 0; a < 4; ++a) {
      const Vec3<L> n = cross(side[(a + 3) & 3], side[a]);
      p[a] = (L(1.0) / sqrt(max(dot(n, n), L(1e-30)))) * n;
    }
  }
  FABRICA_FN void remove(Vec3<L> (&w)[4]) const {
    for (int a = 0; a < 4; ++a) w[a] -= dot(w[a], p[a]) * p[a];
  }
};

// Corner motion without rigid motion and drilling. It is taken out about the mid-step corners,
// where a finite rotation is exactly v = b x r.
template <class L>
FABRICA_FN void project_motion(const Corners<L, 4>& c, const L& dt, Vec3<L> (&v)[4],
                               Vec3<L> (&w)[4]) {
  Vec3<L> x[4];
  for (int a = 0; a < 4; ++a) v[a] = c.v[a], w[a] = c.w[a], x[a] = c.x[a] - (L(0.5) * dt) * c.v[a];
  RigidProjection<L, 4>(x).remove(v, w);
  DrillProjection<L>(c.x).remove(w);
}
template <class L>
FABRICA_FN void project_forces(const Corners<L, 4>& c, CornerForces<L, 4>& out) {
  DrillProjection<L>(c.x).remove(out.m);
  RigidProjection<L, 4>(c.x).transpose(out.f, out.m);
}

}  // namespace fabrica
