// The time step, why a run ends, and who is to blame.
#include <algorithm>
#include <cmath>

#include "solver/simulation.h"

namespace fabrica {
namespace {

const char* family_name(Family f) {
  switch (f) {
    case Family::solid:
      return "solid";
    case Family::shell:
      return "shell";
    case Family::beam:
      return "beam";
    case Family::discrete:
      return "discrete";
    default:
      return "";
  }
}

std::int64_t element_id(const Model& model, Family f, int e) {
  return f == Family::solid   ? model.solids.id[e]
         : f == Family::shell ? model.shells.id[e]
                              : model.beams.id[e];
}

}  // namespace

double Simulation::smallest_element_step() {
  double step = 1e30;
  std::vector<Real> steps;
  for (int t = 0; t < int(tiles_.tiles.size()); ++t) {
    tiles_.element_steps(state_, t, steps);
    for (Real s : steps) step = std::min(step, double(s));
  }
  return step;
}

// Smallest stable step of all elements times TSSFAC; it may drop at once but grows by at most 5 % a
// cycle, and its last tenth by 0.01 %. The step of a solid is 6 % smaller while it is pressed, for
// its bulk viscosity: a step that followed a vibrating element up and down would pump another mode
// of the same frequency, and hourglass modes have nothing to damp them.
constexpr double quick_growth = 1.05, near_enough = 1.1, slow_growth = 1.0001;

void Simulation::choose_time_step() {
  double step = 1e30;
  for (const Tile& t : tiles_.tiles) step = std::min(step, double(t.time_step));
  if (mass_scaling_.active()) step = std::max(step, mass_scaling_.step());
  step = std::min(step, discrete_->time_step(state_));
  step *= model_.controls.time_step_scale;
  if (state_.cycle == 0 && model_.controls.initial_time_step > 0)
    step = model_.controls.initial_time_step;
  if (model_.controls.time_step_curve >= 0)
    step = std::min(step, model_.curves[model_.controls.time_step_curve].at(state_.time));
  if (state_.dt_previous > 0)
    step = std::min(step, (step > near_enough * state_.dt_previous ? quick_growth : slow_growth) *
                              state_.dt_previous);
  // a model without deformable elements takes what resolves its motion
  if (step >= 1e29) step = end_time_ / 1000;
  if (state_.cycle == 0) initial_step_ = step;
  if (!(step > 0) || !std::isfinite(step)) {
    check_health();  // names the element
    if (ending_ == Ending::running) end(Ending::not_a_number, "the time step is not a number");
    return;
  }
  const double limit = model_.controls.minimum_time_step_factor * initial_step_;
  if (step < limit) {
    const TimeStepOwner o = time_step_owner();
    return end(Ending::time_step_too_small, "the time step fell below DTMIN in " + o.family + " " +
                                                std::to_string(o.element) + " of part " +
                                                std::to_string(o.part));
  }
  state_.dt = step;
}

void Simulation::end(Ending ending, std::string text) {
  ending_ = ending;
  ending_text_ = std::move(text);
}

TimeStepOwner Simulation::time_step_owner() const {
  TimeStepOwner o;
  int best = -1;
  for (int t = 0; t < int(tiles_.tiles.size()); ++t)
    if (best < 0 || tiles_.tiles[t].time_step < tiles_.tiles[best].time_step) best = t;
  if (best < 0) return o;
  const Tile& t = tiles_.tiles[best];
  const TileClass& c = tiles_.classes[t.tile_class];
  std::vector<Real> steps;
  tiles_.element_steps(state_, best, steps);
  const int i = int(std::min_element(steps.begin(), steps.end()) - steps.begin());
  o.family = family_name(c.family);
  o.element = element_id(model_, c.family, tiles_.element[t.first + i]);
  o.part = model_.parts[c.part].id;
  o.step = t.time_step;
  return o;
}

// Stops when physics broke: inverted elements, infinite or undefined motion, or the end is reached.
void Simulation::check_health() {
  for (int i = 0; i < int(tiles_.tiles.size()); ++i) {
    const Tile& t = tiles_.tiles[i];
    const TileClass& c = tiles_.classes[t.tile_class];
    const bool broken = !std::isfinite(t.internal) || !std::isfinite(t.hourglass);
    if (broken || (c.family == Family::solid && t.smallest_volume <= 0)) {
      const TimeStepOwner o = worst_element(i);
      const std::string where = o.family + " element " + std::to_string(o.element) + " of part " +
                                std::to_string(o.part) + " (" + model_.parts[c.part].title +
                                ") at t = " + std::to_string(state_.time);
      return end(broken ? Ending::not_a_number : Ending::negative_volume,
                 (broken ? "stress is not a number in " : "negative volume in ") + where);
    }
  }
  if (state_.time >= end_time_ * (1 - 1e-12)) return end(Ending::end_time, "end time reached");
  if (model_.controls.end_cycle > 0 && state_.cycle >= model_.controls.end_cycle)
    return end(Ending::end_cycle, "end cycle reached");
}

TimeStepOwner Simulation::worst_element(int tile) const {
  TimeStepOwner o;
  const Tile& t = tiles_.tiles[tile];
  const TileClass& c = tiles_.classes[t.tile_class];
  std::vector<Real> steps;
  tiles_.element_steps(state_, tile, steps);
  int worst = 0;
  for (int i = 0; i < t.count; ++i)
    if (!(steps[i] > 0) || !std::isfinite(steps[i])) {
      worst = i;
      break;
    } else if (steps[i] < steps[worst]) {
      worst = i;
    }
  o.family = family_name(c.family);
  o.element = element_id(model_, c.family, tiles_.element[t.first + worst]);
  o.part = model_.parts[c.part].id;
  o.step = steps[worst];
  return o;
}

}  // namespace fabrica
