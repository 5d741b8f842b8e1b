#pragma once
// Single point constraints and prescribed motions of nodes, at velocity level. Each condition is n
// . v+ = target for a unit vector n; several conditions of a node are made orthogonal, constraints
// before motions. With v+ known before
//   R = m (target - n . v+) / dt_v,   v+ <- v+ + (target - n . v+) n
// is the reaction on the node; its work is booked as external work. Rotations likewise with w and
// J.
#include <istream>
#include <ostream>
#include <vector>

#include "base/diagnostics.h"
#include "model/model.h"
#include "model/state.h"

namespace fabrica {

class NodeConstraints {
 public:
  // Conditions on nodes that a rigid body or a tied contact owns are left out with a warning.
  NodeConstraints(const Model& model, const State& state, Diagnostics& diagnostics);
  // Takes out of initial velocities what supports forbid: such motion carries no energy at t = 0.
  void stop_supported(State& state) const;
  // Corrects v+ and w+ of constrained nodes; state.nodes hold x(n) and v+ before correction.
  void apply(State& state);

  struct Reaction {
    int node = -1;
    Vec3d force{}, moment{};                // of supports on the node (spcforc)
    Vec3d motion_force{}, motion_moment{};  // of prescribed motions on the node (bndout)
  };
  // One entry per node with conditions, by ascending node; values of the last cycle.
  const std::vector<Reaction>& reactions() const { return reactions_; }
  int size() const { return int(reactions_.size()); }

  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  struct Condition {
    int node = -1;
    int motion = -1;  // index into Model::prescribed_motions; -1: support
    bool rotation = false;
    Vec3d direction{};  // global at the start
    int system = -1;    // moving coordinate system that carries the direction, or -1
    double birth = 0, death = 1e28;
    double angle = 0;  // accumulated, of rotations by displacement
  };
  void add_supports(const Model& model);
  void add_motions(const Model& model, Diagnostics& diagnostics);
  Vec3d direction_of(const Condition& c, const State& state) const;
  double target_of(const Condition& c, const State& state, const Vec3d& n,
                   const Vec3d& before) const;
  void apply_node(State& state, int entry, bool rotation);

  const Model& model_;
  std::vector<Condition> conditions_;  // by node, supports first
  std::vector<int> begin_;             // first condition of each entry
  std::vector<Reaction> reactions_;
  std::vector<Vec3d> last_v_, last_w_;  // velocities of the last half step, per entry
  double pending_ = 0;                  // second half of the work of the last reactions
};

}  // namespace fabrica
