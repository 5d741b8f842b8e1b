#pragma once
// Frame and relative rotations that all beams share.
// Frame E: e1 along the chord, e2 carried along. Over a step the frame turns by
//   theta_E = s (1 + s.s/6) + (mean theta . em) em,  s = e1(old) x e1 = dt x21 x v21 / (L(old) L),
//   em: direction half way between e1(old) and e1                                               (1)
// and the section of corner I turns relative to it by
//   d_I = theta_I - theta_E + 1/2 theta_E x (theta_I - theta_E),  theta_I = w_I dt, in E        (2)
// which is objective to second order of the step. Only the small relative rotations are kept, not
// the triads of the sections: increments far below the rounding of a triad's entries stay visible
// in single precision.
// Source: Belytschko and Schwer, Int. J. Num. Meth. Eng. 11 (1977); Crisfield, Non-linear FE, vol.
// 2, ch. 16.
#include "element/kernel.h"

namespace fabrica {

template <class L>
struct BeamFrame {
  Vec3<L> e1, e2, e3;
  L length,
      stretch;   // current length and its increment (L^2 - L(old)^2)/(L + L(old))
  L axial;       // strain increment (L^2 - L(old)^2)/(2 Lm^2)
  Vec3<L> d[2];  // relative rotation increments in E

  // axis: the old e2
  FABRICA_FN BeamFrame(const Corners<L, 2>& c, const L& dt, const Vec3<L>& axis) {
    const Vec3<L> x21 = c.x[1] - c.x[0], v21 = c.v[1] - c.v[0];
    const Vec3<L> old = x21 - dt * v21, middle = x21 - (L(0.5) * dt) * v21;
    length = norm(x21);
    const L old_length = norm(old);
    const L half_square = dt * dot(v21, middle);
    axial = half_square / dot(middle, middle);
    stretch = L(2.0) * half_square / (length + old_length);
    e1 = (L(1.0) / length) * x21;
    const Vec3<L> s = (dt / (length * old_length)) * cross(x21, v21);
    const Vec3<L> half_way = e1 + (L(1.0) / old_length) * old;
    const Vec3<L> em = (L(1.0) / norm(half_way)) * half_way;
    const Vec3<L> theta[2] = {dt * c.w[0], dt * c.w[1]};
    const L twist = L(0.5) * dot(theta[0] + theta[1], em);
    const Vec3<L> turn = (L(1.0) + L(1.0 / 6.0) * dot(s, s)) * s + twist * em;

    const Vec3<L> first = cross(turn, axis);
    Vec3<L> carried = axis + first + L(0.5) * cross(turn, first);
    carried -= dot(carried, e1) * e1;
    e2 = (L(1.0) / norm(carried)) * carried;
    e3 = cross(e1, e2);
    for (int a = 0; a < 2; ++a) {
      const Vec3<L> relative = theta[a] - turn;
      d[a] = local(relative + L(0.5) * cross(turn, relative));
    }
  }
  FABRICA_FN Vec3<L> local(const Vec3<L>& a) const { return {dot(e1, a), dot(e2, a), dot(e3, a)}; }
  FABRICA_FN Vec3<L> global(const Vec3<L>& a) const { return a.x * e1 + a.y * e2 + a.z * e3; }
};

// e2 at the start: the given vector made orthogonal to the chord; where it is missing or parallel,
// the global axis least aligned with the chord serves.
template <class L>
FABRICA_FN Vec3<L> beam_axis(const Corners<L, 2>& c, const Vec3<L>& orientation) {
  const Vec3<L> x21 = c.x[1] - c.x[0];
  const Vec3<L> e1 = (L(1.0) / norm(x21)) * x21;
  auto orthogonal = [&](const Vec3<L>& a) { return a - dot(a, e1) * e1; };
  const Vec3<L> wanted = orthogonal(orientation);
  const L zero = L(0.0), one = L(1.0);
  const auto small = (abs(e1.y) <= abs(e1.x)) & (abs(e1.y) <= abs(e1.z));
  const Vec3<L> spare = orthogonal({zero, select(small, one, zero), select(small, zero, one)});
  const auto usable = dot(wanted, wanted) > L(1e-8) * dot(orientation, orientation);
  Vec3<L> e2;
  for (int i = 0; i < 3; ++i) e2[i] = select(usable, wanted[i], spare[i]);
  return (one / norm(e2)) * e2;
}

// Lumped mass and rotary inertia of a corner: (rho L/2)(Iss + Itt + A L^2/12)
inline void lump_beam(const ElementParameters& p, const Corners<double, 2>& c, double (&mass)[2],
                      double (&inertia)[2]) {
  const double length = norm(c.x[1] - c.x[0]), half = 0.5 * double(p.density) * length;
  for (int a = 0; a < 2; ++a) {
    mass[a] = half * double(p.area);
    inertia[a] = half * (double(p.iss) + double(p.itt) + double(p.area) * length * length / 12);
  }
}

}  // namespace fabrica
