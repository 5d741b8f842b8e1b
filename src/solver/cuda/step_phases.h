#pragma once
// What follows the element forces in a step: the time step, then the motion of the nodes.
//   v(n+1/2) = v(n-1/2) + (dt(n-1) + dt(n))/2 f/m,   x(n+1) = x(n) + dt(n) v(n+1/2) (1)
// All in double, with the operations of solver/simulation.cpp in the same order.
#include "solver/cuda/gpu_arrays.h"

namespace fabrica {

// Smallest step and health of some tiles.
struct StepFinding {
  double step = 1e30;
  GpuEnding ending = GpuEnding::running;
};

FABRICA_FN bool is_finite(double x) { return x - x == 0; }

FABRICA_FN void look_at(const GpuTile& t, const TileResult& r, StepFinding& f) {
  const double step = double(r.time_step);
  f.step = step < f.step ? step : f.step;
  if (!is_finite(r.internal) || !is_finite(r.hourglass))
    f.ending = GpuEnding::not_a_number;
  else if (t.solid && r.smallest_volume <= 0 && f.ending == GpuEnding::running)
    f.ending = GpuEnding::negative_volume;
}
FABRICA_FN void join(StepFinding& a, const StepFinding& b) {
  a.step = b.step < a.step ? b.step : a.step;
  if (b.ending == GpuEnding::not_a_number || a.ending == GpuEnding::running) a.ending = b.ending;
}

// Moves the clock on: dt becomes dt_previous and the new step is chosen. An ending leaves
// everything as it stands.
FABRICA_FN void choose_step(const StepFinding& f, const GpuStepping& s, GpuClock& clock) {
  if (clock.ending != GpuEnding::running) return;
  double step = s.fixed > 0 ? s.fixed : f.step * s.scale;
  if (!(s.fixed > 0) && clock.dt > 0) step = 1.05 * clock.dt < step ? 1.05 * clock.dt : step;
  clock.ending = f.ending;
  if (!(step > 0) || !is_finite(step)) clock.ending = GpuEnding::not_a_number;
  if (clock.ending != GpuEnding::running) return;
  clock.dt_previous = clock.dt, clock.dt = step;
  clock.time.add(step);
  ++clock.cycle;
}

// Sum of a node's partials in tile order.
FABRICA_FN Vec3d sum_partials(const GpuArrays& g, const ForceRecord* partials, int n) {
  Vec3d f{0, 0, 0};
  for (int k = g.partial_first[n]; k < g.partial_first[n + 1]; ++k) {
    const Real* r = partials[g.partial[k]].value;
    f += Vec3d{double(r[0]), double(r[1]), double(r[2])};
  }
  return f;
}

// Equation (1) for node n.
FABRICA_FN void advance_node(const GpuArrays& g, int n) {
  const GpuClock& clock = *g.clock;
  if (clock.ending != GpuEnding::running) return;
  const double mean = 0.5 * (clock.dt + clock.dt_previous);
  NodeMotion& node = g.nodes[n];
  node.v += (mean * node.inverse_mass) * sum_partials(g, g.force, n);
  if (g.spins && g.spins[n].inertia > 0)
    g.spins[n].w += (mean / g.spins[n].inertia) * sum_partials(g, g.moment, n);
  node.x += clock.dt * node.v;
}

}  // namespace fabrica
