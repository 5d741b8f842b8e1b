#pragma once
// Velocity over the step from t to t + dt that a prescribed motion asks for. f: scaled curve, t
// counted from birth, u displacement (or angle) at t:
//   velocity               mean of f over the step            -> u is the integral of f, exactly
//   acceleration           v- + integral of f over the step   -> v is the integral of f, exactly
//   displacement           (f(t + dt) - u) / dt               -> no drift
//   velocity of u (VAD 3)  f(u + dt/2 f(u)), the midpoint rule
#include <algorithm>

#include "load/time_curve.h"
#include "model/model.h"
#include "model/state.h"

namespace fabrica {

inline double motion_velocity(const Model& model, const PrescribedMotion& m, const State& state,
                              double u, double before) {
  const Curve& curve = model.curves[m.curve];
  const double t = std::max(0.0, state.time - m.birth), dt = state.dt;
  const auto f = [&](double x) { return m.scale * curve_value(curve.x, curve.y, x); };
  if (m.kind == 0) return m.scale * curve_integral(curve.x, curve.y, t, t + dt) / dt;
  if (m.kind == 1) {
    const double from = std::max(0.0, t - 0.5 * state.dt_previous);
    return before + m.scale * curve_integral(curve.x, curve.y, from, t + 0.5 * dt);
  }
  if (m.kind == 3) return f(u + 0.5 * dt * f(u));
  return (f(t + dt) - u) / dt;
}

}  // namespace fabrica
