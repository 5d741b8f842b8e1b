#pragma once
// External loads: gravity (base accelerations), nodal forces and moments, forces on rigid bodies,
// pressure. Their work up to t(n) is booked when the forces of t(n) are known:  dW = dt_(n-1)/2
// v(n-1/2) . (f(n-1) + f(n)).
#include <istream>
#include <ostream>
#include <vector>

#include "base/diagnostics.h"
#include "base/team.h"
#include "model/model.h"
#include "model/state.h"
#include "solver/rigid_bodies.h"

namespace fabrica {

class Loads {
 public:
  Loads(const Model& model, const State& state, const RigidBodies& bodies,
        Diagnostics& diagnostics);
  // Nodal loads and pressures at state.time into state.interaction (and _moment), loads of rigid
  // bodies into the bodies; before assembly. state.nodes hold v(n-1/2).
  void forces(State& state, RigidBodies& bodies);
  // Gravity into state.force of nodes that no rigid body owns, and into the bodies; after assembly,
  // before forces of tied nodes are handed on. Acts on state.physical_mass, and on the full mass of
  // bodies.
  void body_forces(State& state, RigidBodies& bodies, Team& team);
  // Acceleration by all body loads that act on all parts, or on this part.
  Vec3d acceleration(int part, double time) const;

  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  struct Gravity {
    std::vector<unsigned char> on_node;  // empty: all nodes
    std::vector<int> bodies;
    double last = 0;
  };
  void check_moment(const NodalLoad& load, const State& state, const RigidBodies& bodies,
                    Diagnostics& diagnostics) const;
  double value(int curve, double scale, double time) const;
  Vec3d nodal_direction(const NodalLoad& load, const State& state) const;

  const Model& model_;
  std::vector<Gravity> gravity_;
  std::vector<std::vector<Vec3d>> last_nodal_;     // per load, per node (one for rigid bodies)
  std::vector<std::vector<Vec3d>> last_pressure_;  // per load, per segment: corner force
  std::vector<double> partial_;
};

}  // namespace fabrica
