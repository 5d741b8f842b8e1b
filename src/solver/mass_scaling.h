#pragma once
// Conventional mass scaling (*CONTROL_TIMESTEP, DT2MS < 0): elements whose own step is below
// |DT2MS| get heavier,
//   dm = m ((|DT2MS| / dt_e)^2 - 1) (1)
// spread to their nodes like their mass. Mass is only ever added. Added mass brings kinetic energy
// into a moving node; it is booked as such. Source: LS-DYNA keyword manual (public),
// *CONTROL_TIMESTEP.
#include <iosfwd>
#include <vector>

#include "model/model.h"
#include "model/state.h"
#include "solver/tiles.h"

namespace fabrica {

class MassScaling {
 public:
  explicit MassScaling(const Controls& controls)
      : step_(controls.mass_scaling_time_step < 0 ? -controls.mass_scaling_time_step : 0),
        first_cycle_only_(controls.mass_scaling_first_cycle_only) {}

  bool active() const { return step_ > 0; }
  // step that every element may take at least
  double step() const { return step_; }
  // at set-up: adds mass to state for every element below the step
  void start(const Model& model, State& state, Tiles& tiles);
  // each cycle: adds mass for elements that became smaller since
  void update(const Model& model, State& state, const Tiles& tiles);
  double added_mass() const { return added_; }
  const std::vector<double>& part_added_mass() const { return part_added_; }

  void save(std::ostream&) const;
  void load(std::istream&);

 private:
  void add(const Model& model, State& state, const Tiles& tiles, int tile, const Real* steps);
  double step_;
  bool first_cycle_only_;
  std::vector<Real> smallest_;  // smallest step that mass was added for, by tile.step + slot
  std::vector<double> part_added_;
  double added_ = 0;
};

}  // namespace fabrica
