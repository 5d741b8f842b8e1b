#pragma once
// Conventional mass scaling (*CONTROL_TIMESTEP, DT2MS < 0): elements whose own step is below
// |DT2MS| get heavier,
//   dm = m ((|DT2MS| / dt_e)^2 - 1) (1)
// spread to their nodes like their mass. Mass is only ever added. Added mass brings kinetic energy
// into a moving node; it is booked as such. Parts that IMSCL names get selective mass
// (selective_mass.h) instead; of these, elements with a corner that a rigid body owns or a tied
// contact places are scaled by (1) on their free corners. Source: LS-DYNA keyword manual (public),
// *CONTROL_TIMESTEP.
#include <iosfwd>
#include <vector>

#include "model/model.h"
#include "model/state.h"
#include "solver/selective_mass.h"
#include "solver/tiles.h"

namespace fabrica {

class MassScaling {
 public:
  explicit MassScaling(const Model& model);

  bool active() const { return step_ > 0; }
  // step that every element may take at least
  double step() const { return step_; }
  // at set-up: adds mass to state for every element below the step
  void start(const Model& model, State& state, Tiles& tiles);
  // once the owners of nodes are known
  void settle(State& state);
  // each cycle: adds mass for elements that became smaller since, and lets failed ones go
  void update(const Model& model, State& state, const Tiles& tiles);
  // selective mass included
  double added_mass() const { return added_ + selective_added_; }
  double selective_added_mass() const { return selective_added_; }
  SelectiveMass& selective() { return selective_; }
  const SelectiveMass& selective() const { return selective_; }
  const std::vector<double>& part_added_mass() const { return part_added_; }

  void save(std::ostream&) const;
  void load(std::istream&);

 private:
  static constexpr int conventional = -1;
  void add(const Model& model, State& state, const Tiles& tiles, int tile, const Real* steps);
  void add_to_nodes(State& state, const int* node, const double* mass, const double* inertia, int N,
                    double factor, int part, bool free_only);
  void set_selective(State& state, int element, int part, double scale);
  void let_go(State& state, const Tiles& tiles, int tile);
  double step_;
  bool first_cycle_only_;
  std::vector<Real> smallest_;  // smallest step that mass was added for, by tile.step + slot
  std::vector<double> part_added_;
  double added_ = 0, selective_added_ = 0;
  std::vector<char> part_selective_;
  SelectiveMass selective_;
  std::vector<int> selective_of_;  // element of selective_ by tile.step + slot, or conventional
  std::vector<int> part_of_;       // part of each element of selective_
};

}  // namespace fabrica
