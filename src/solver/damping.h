#pragma once
// Mass damping f = -D(t) m v, global with a factor per direction and by parts, semi-implicit and
// stable for any D:
//   v+ = [ (1 - D dt/2) v- + dt a ] / (1 + D dt/2)
// A node shared by damped and other parts takes D in proportion to its element corners.
#include <istream>
#include <ostream>
#include <vector>

#include "base/team.h"
#include "model/model.h"
#include "model/state.h"
#include "solver/rigid_bodies.h"

namespace fabrica {

class MassDamping {
 public:
  MassDamping(const Model& model, const RigidBodies& bodies);
  bool active() const { return active_; }
  // Corrects v+ and w+ of free nodes (state.force still at t(n)) and adds forces to gathered
  // bodies; books the energy.
  void apply(State& state, RigidBodies& bodies, Team& team);

  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  struct PartRate {
    int index;                   // into Model::part_damping
    std::vector<double> weight;  // per node
    std::vector<int> bodies;
  };
  void global_rates(double time, double (&rate)[6]) const;
  const Model& model_;
  bool active_ = false;
  std::vector<PartRate> parts_;
  std::vector<Vec3d> last_force_, last_moment_, last_body_force_, last_body_moment_;
  std::vector<double> partial_;
};

}  // namespace fabrica
