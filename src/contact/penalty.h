#pragma once
// Penalty, damping and friction of one contact point.
//   stiffness, SOFT=0   solid face: k = f K A^2/V;  shell: k = f K A/longest diagonal  (f = SLSFAC
//   SFS) stiffness, SOFT=1   k = max(k0, 0.5 SOFSCL m*/dt^2),  1/m* = 1/m_s + sum phi_i^2/m_i
//   normal force        f_n = max(0, k d + c d'),  c = 2 (VDC/100) sqrt(k m*)  while d > 0
//   friction            F* = F_t - k u_t;  |F_t| <= mu f_n,  mu = FD + (FS - FD) exp(-DC |v_t|)
// d: penetration; u_t: tangential displacement over the step. Source: LS-DYNA theory manual,
// contact.
#include <algorithm>
#include <cmath>

#include "base/tensor.h"

namespace fabrica {

inline double solid_face_stiffness(double bulk, double area, double volume) {
  return volume > 0 ? bulk * area * area / volume : 0;
}
inline double shell_stiffness(double bulk, double area, double longest_diagonal) {
  return longest_diagonal > 0 ? bulk * area / longest_diagonal : 0;
}
inline double soft_stiffness(double scale, double mass, double dt) {
  return dt > 0 ? 0.5 * scale * mass / (dt * dt) : 0;
}

// depth: penetration less its baseline, rate: its time derivative; damping: fraction of critical
inline double normal_force(double k, double depth, double rate, double mass, double damping) {
  double f = k * depth;
  if (damping > 0) f += 2 * damping * std::sqrt(k * mass) * rate;
  return f > 0 ? f : 0;
}

struct Friction {
  double fs = 0, fd = 0, dc = 0;
  double stress_limit = 0;  // VC; 0: none
  double coefficient(double speed) const {
    return dc > 0 ? fd + (fs - fd) * std::exp(-dc * speed) : fs;
  }
  bool active() const { return fs > 0 || fd > 0; }
};

// Friction force on the tracked node. old_force: that of the last step; direction: unit normal;
// slip: relative tangential displacement over the step; speed: |v_t|; area: of the segment.
inline Vec3d friction_force(const Friction& law, double k, double normal, const Vec3d& direction,
                            const Vec3d& old_force, const Vec3d& slip, double speed, double area) {
  // turn the old force into the tangent plane without changing its size
  Vec3d f = old_force - dot(old_force, direction) * direction;
  const double before = norm(old_force), after = norm(f);
  if (after > 0) f = (before / after) * f;
  f -= k * slip;
  double limit = law.coefficient(speed) * normal;
  if (law.stress_limit > 0) limit = std::min(limit, law.stress_limit * area);
  const double size = norm(f);
  return size > limit ? (limit / size) * f : f;
}

}  // namespace fabrica
