#pragma once
// Single point constraints and prescribed motions of nodes, at velocity level. Each condition is n
// . v+ = target for a unit vector n; several conditions of a node are made orthogonal, constraints
// before motions. With v+ known before
//   R = m (target - n . v+) / dt_v,   v+ <- v+ + (target - n . v+) n
// is the reaction on the node; its work is booked as external work. Rotations likewise with w and
// J.
#include <array>
#include <istream>
#include <ostream>
#include <vector>

#include "base/diagnostics.h"
#include "model/model.h"
#include "model/state.h"
#include "solver/supports.h"

namespace fabrica {

class NodeConstraints {
 public:
  // Conditions on tied nodes and motions of nodes of rigid bodies are left out with a warning;
  // supports of nodes of rigid bodies act on the body (rigid_bodies.h).
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
  // A condition that acts now: direction . v+ = velocity.
  struct Target {
    Vec3d direction{};
    double velocity = 0;
    bool support = false;
  };
  // The conditions of an entry on translation or rotation, directions made orthonormal; returns how
  // many. before: velocity at t(n-1/2).
  int targets(const State& state, int entry, bool rotation, const Vec3d& before,
              std::array<Target, 3>& out) const;

  // One entry per node with conditions, by ascending node; values of the last cycle.
  const std::vector<Reaction>& reactions() const { return reactions_; }
  int size() const { return int(reactions_.size()); }

  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  // what n . v+ of a condition is: n kept, or by the rotation about an axis (DOF 9 to 11)
  enum class Aim {
    along,     // a velocity along the direction, 0 for supports
    held,      // zero across the direction of a motion
    circle_a,  // on its circle, first and second axis of the plane
    circle_b,
    ray  // at an angle, at any distance from the axis
  };
  struct Condition : NodeSupport {
    int node = -1;
    int motion = -1;  // index into Model::prescribed_motions; -1: support
    Aim aim = Aim::along;
    double angle = 0, rate = 0;  // turned so far, and its rate in the last step
  };
  struct Goal {
    Vec3d n;
    double target;
  };
  void add_motions(Diagnostics& diagnostics);
  void add_motion(int node, int motion);
  void leave_out_dependent(const State& state, Diagnostics& diagnostics);
  std::array<double, 2> arm_of(const Condition& c, const Vec3d& x) const;
  Goal goal_of(const Condition& c, const State& state, const Vec3d& before) const;
  void turn_on(Condition& c, const State& state) const;
  void apply_node(State& state, int entry, bool rotation);

  const Model& model_;
  std::vector<Condition> conditions_;  // by node, supports first
  std::vector<int> begin_;             // first condition of each entry
  std::vector<Reaction> reactions_;
  std::vector<Vec3d> last_v_, last_w_;  // velocities of the last half step, per entry
  double pending_ = 0;                  // second half of the work of the last reactions
};

}  // namespace fabrica
