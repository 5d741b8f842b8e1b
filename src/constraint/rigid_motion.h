#pragma once
// One step of a rigid body with velocity and angular momentum at half steps:
//   V+ = V- + dt_v F/M + P/M,      x <- x + dt V+                                              (1)
//   L+ = L- + dt_v T + H,          w = R_h I^-1 R_h^T L+,  R_h = R(exp(dt w/2) q)               (2)
//   q <- exp(dt w) q                                                                            (3)
// x centre of mass, V velocity, L angular momentum about it, w angular velocity (all global), I
// principal inertias, q body -> global, P and H impulses of constraints. (2) is solved by
// fixed-point passes. Without torque |L| is conserved to rounding and the energy error is bounded.
// Source: J. C. Simo and K. K. Wong, Unconditionally stable algorithms for rigid body dynamics,
// 1991.
#include "constraint/rotation.h"

namespace fabrica {

struct RigidMotion {
  double mass = 0;
  Vec3d inertia{};  // about the principal axes
  Vec3d x{}, v{};
  Vec3d momentum{};  // angular, about x
  Vec3d w{};
  Quaternion q{};
};

// what (1)-(3) give before it is accepted
struct RigidTrial {
  Vec3d v, momentum, w, x;
  Quaternion q, q_half;
};

// R I^-1 R^T a
inline Vec3d inverse_inertia_times(const Mat3d& R, const Vec3d& inertia, const Vec3d& a) {
  const Vec3d b = transpose(R) * a;
  return R * Vec3d{b.x / inertia.x, b.y / inertia.y, b.z / inertia.z};
}
// R I R^T a
inline Vec3d inertia_times(const Mat3d& R, const Vec3d& inertia, const Vec3d& a) {
  const Vec3d b = transpose(R) * a;
  return R * Vec3d{b.x * inertia.x, b.y * inertia.y, b.z * inertia.z};
}

// Completes a trial whose v and momentum are set; w is solved from (2) starting with trial.w.
inline void advance_trial(const RigidMotion& body, double dt, RigidTrial& trial) {
  Vec3d w = trial.w;
  for (int pass = 0; pass < 20; ++pass) {
    trial.q_half = exponential((0.5 * dt) * w) * body.q;
    const Vec3d next = inverse_inertia_times(matrix_of(trial.q_half), body.inertia, trial.momentum);
    const double change = norm(next - w), size = norm(next);
    w = next;
    if (pass >= 2 && change <= 1e-15 * size) break;
  }
  trial.w = w;
  trial.q = normalised(exponential(dt * w) * body.q);
  trial.x = body.x + dt * trial.v;
}

}  // namespace fabrica
