#pragma once
// What all solid elements share: one material point in the rate or the total form, bulk viscosity,
// stable step.
//
// Rate form:   s <- R s R^T + stress increment(D dt),  R the rotation of the step (Jaumann,
// midpoint)       (1) Mid-step velocity gradient from the end geometry: L_mid = L (1 - dt/2 L)^-1 =
// L + dt/2 L L + ...           (2)
//   so that a rigid rotation leaves no strain of second order in the step.
// Bulk viscosity: q = rho l (Q1^2 l D_kk^2 - Q2 c D_kk) for D_kk < 0, in the force only (3) Stable
// step:    dt = l / (Q + sqrt(Q^2 + c^2)),  Q = Q2 c + Q1 l |D_kk| for D_kk < 0, else 0 (4) Source:
// von Neumann and Richtmyer 1950; Hallquist, LS-DYNA theory manual (public), time step control.
#include "element/kernel.h"

namespace fabrica {

// Velocity gradient at mid step from the gradient in the end geometry, equation (2).
template <class L>
FABRICA_FN Mat3<L> mid_step_gradient(const Mat3<L>& l, const L& dt) {
  const Mat3<L> squared = l * l;
  const L half = L(0.5) * dt;
  Mat3<L> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.a[i][j] = fma(half, squared.a[i][j], l.a[i][j]);
  return r;
}

// Rotation increments about x, y, z: half the curl of the velocity times dt.
template <class L>
FABRICA_FN Vec3<L> spin_increment(const Mat3<L>& l, const L& dt) {
  const L half = L(0.5) * dt;
  return {half * (l.a[2][1] - l.a[1][2]), half * (l.a[0][2] - l.a[2][0]),
          half * (l.a[1][0] - l.a[0][1])};
}

// History of one integration point, in this order: Cauchy stress, [ln J for total laws], material
// state.
template <class M>
struct SolidPoint {
  static constexpr int stress = 0;
  static constexpr int log_volume = 6;
  static constexpr int alive = 6 + (M::total ? 1 : 0);
  static constexpr int material = alive + (M::can_fail ? 1 : 0);
  static constexpr int fields = material + material_fields<M>();
};

template <class L>
struct PointResult {
  Sym3<L> old_stress;   // as it was stored, not turned
  Sym3<L> mean_stress;  // average of the rotated old and the new stress, for the energy
  Sym3<L> stress;
  Sym3<L> strain;  // D dt
};

// Failed points stay failed; a law may only switch `alive` off.
template <class L, class M>
FABRICA_FN void start_point(StateView<L> s) {
  if constexpr (M::can_fail) s.store(SolidPoint<M>::alive, L(1.0));
}

// Advances one point from t(n-1) to t(n).
//   gradient: velocity gradient at mid step; F: deformation gradient (total laws; ignored
//   otherwise) pull: how fast ln J follows det F; 1 replaces it (double), small values keep float
//   noise out of stiff volumes
template <class L, class M>
FABRICA_FN PointResult<L> advance_point(const M& material, const Mat3<L>& gradient,
                                        const Mat3<L>& F, const L& dt, Point<L>& point,
                                        StateView<L> s) {
  using P = SolidPoint<M>;
  using MaterialState = typename M::template State<L>;
  PointResult<L> r;
  r.strain = dt * sym(gradient);
  const Vec3<L> w = spin_increment(gradient, dt);
  r.old_stress = s.template get<Sym3<L>>(P::stress);
  Sym3<L> old = turn(r.old_stress, w);
  MaterialState state = s.template get<MaterialState>(P::material);
  if constexpr (M::rotated > 0) {
    Sym3<L>* tensors = reinterpret_cast<Sym3<L>*>(&state);
    for (int i = 0; i < M::rotated; ++i) tensors[i] = turn(tensors[i], w);
  }
  if constexpr (M::total) {
    r.stress = material.stress(F, point, state);
  } else {
    r.stress = material.stress(old, r.strain, point, state);
  }
  if constexpr (M::can_fail) {
    const L alive = min(s.load(P::alive), point.alive);
    point.alive = alive;
    s.store(P::alive, alive);
    r.stress = alive * r.stress;
  }
  r.mean_stress = L(0.5) * (old + r.stress);
  s.put(P::stress, r.stress);
  s.put(P::material, state);
  return r;
}

// Work that the stresses of both ends of a step do in it, per volume at its end, each in its own
// geometry:
//   2 w V = V s : A + V_old s_old : A_old,   A = dt L,
//   V_old A_old = V det(I - A) A (I - A)^-1 = V ((1 - tr A) A + A A + det(A) I),
//   A A = 2 dt (L_mid - L)                                                                     (5)
// This is dt/2 (f(n) + f(n+1)) . v of forces that follow one gradient, to rounding.
template <class L>
FABRICA_FN L work_of_step(const PointResult<L>& r, const Mat3<L>& gradient, const L& dt) {
  Mat3<L> a;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a.a[i][j] = dt * gradient.a[i][j];
  const Sym3<L> e = sym(a);
  const Sym3<L> before = plus_sphere(L(2.0) * r.strain - (L(1.0) + trace(e)) * e, det(a));
  return L(0.5) * (ddot(r.stress, e) + ddot(r.old_stress, before));
}

// The point with the elastic moduli filled in.
template <class L>
FABRICA_FN Point<L> elastic_point(const ElementParameters& p, const L& dt, const L& volume_ratio,
                                  const L& length) {
  return {dt, volume_ratio, length, L(p.bulk + Real(4.0 / 3.0) * p.shear), L(p.shear), L(1.0)};
}

// Bulk viscosity pressure, equation (3), and the stable step, equation (4).
//   rate: D_kk; size: length of the step estimate; length: cube root of the volume
// In a flat element the damper over its thin side has the damping ratio 1/2 Q2 length/size, of
// which (4) knows nothing: beyond length/size = 2.5 (a flat box 4 times as wide as high) the length
// is cut, so that the step of (4) stays stable.
template <class L>
FABRICA_FN L bulk_viscosity(const ElementParameters& p, const L& density, const L& c, const L& rate,
                            const L& size, const L& cube_root) {
  const L length = min(cube_root, L(2.5) * size);
  const L q1 = L(p.quadratic_viscosity), q2 = L(p.linear_viscosity);
  const L q = density * length * rate * (q1 * q1 * length * rate - q2 * c);
  return select(rate < L(0.0), q, L(0.0));
}
template <class L>
FABRICA_FN L stable_step(const ElementParameters& p, const L& c, const L& rate, const L& size) {
  const L Q = select(rate < L(0.0),
                     L(p.linear_viscosity) * c - L(p.quadratic_viscosity) * size * rate, L(0.0));
  return size / (Q + sqrt(fma(Q, Q, c * c)));
}

// Deviatoric (and, unless nearly incompressible, volumetric) part stiffness damping: beta C : D.
template <class L>
FABRICA_FN Sym3<L> damping_stress(const ElementParameters& p, const Mat3<L>& gradient,
                                  const L& step) {
  const L beta = p.stiffness_damping > 0 ? L(p.stiffness_damping) * step : L(-p.stiffness_damping);
  const Sym3<L> d = sym(gradient);
  const L volumetric = p.bulk > 50 * p.shear ? L(0.0) : beta * L(p.bulk) * trace(d);
  return plus_sphere(beta * L(2 * p.shear) * deviator(d), volumetric);
}

}  // namespace fabrica
