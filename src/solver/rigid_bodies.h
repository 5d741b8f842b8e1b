#pragma once
// Rigid bodies: rigid parts, merged parts, extra nodes, nodal rigid bodies and welds. Bodies own
// their nodes' motion; forces on the nodes are summed, the bodies are advanced
// (constraint/rigid_motion.h) and the nodes placed. Per cycle: gather, integrate, place_nodes. See
// docs/theory/rigid_bodies.md.
#include <cstdint>
#include <istream>
#include <ostream>
#include <vector>

#include "base/diagnostics.h"
#include "base/team.h"
#include "constraint/component.h"
#include "constraint/rigid_motion.h"
#include "model/model.h"
#include "model/state.h"
#include "solver/supports.h"

namespace fabrica {

class Joints;

struct RigidBody {
  std::int64_t id = 0;      // of the part or the nodal rigid body
  int part = -1;            // lead part, or -1
  int nodal = -1;           // index into Model::nodal_rigid_bodies, or -1
  bool active = true;       // false after a weld has failed
  bool overridden = false;  // mass properties given by the deck
  std::vector<int> nodes;
  std::vector<Vec3d> r;  // body coordinates of the nodes
  RigidMotion motion;
  Vec3d start_x{};
  Quaternion start_q{};
  Vec3d force{}, moment{};                        // being gathered for this cycle
  Vec3d applied_force{}, applied_moment{};        // of the last cycle
  Vec3d constraint_force{}, constraint_moment{};  // on the body, by joints, constraints and motions
  Vec3d acceleration{}, angular_acceleration{};
  Vec3d rotation{};  // integral of w

  Vec3d displacement() const { return motion.x - start_x; }
  // rows: directions of the principal axes at the start, turned with the body
  Mat3d turn() const { return matrix_of(motion.q * start_q.conjugate()); }
};

class RigidBodies {
 public:
  // Collects the bodies of the model and takes ownership of their nodes in state.owner.
  RigidBodies(const Model& model, State& state, Diagnostics& diagnostics);
  // Adds a node to the body of a rigid part; false if the part is not rigid or the node has another
  // owner.
  bool add_node(State& state, int part, int node);
  // Computes mass, centre and inertia from state.nodes[].mass and state.spins[].inertia; velocities
  // of PART_INERTIA are set. Call once all nodes and masses are known.
  void finish(const State& state, Diagnostics& diagnostics);

  // Adds a force and a moment about the centre to a body for this cycle.
  void add_force(int body, const Vec3d& force, const Vec3d& moment);
  // Sums nodal forces and moments into the bodies; welds that fail let go of their nodes here.
  void gather(State& state, Team& team);
  // Advances all bodies by state.dt; books work of constraints (external) and joints.
  void integrate(State& state, Joints* joints = nullptr);
  // Sets position, velocity and spin of all nodes of bodies; returns the highest speed of any.
  double place_nodes(State& state, Team& team);

  int size() const { return int(bodies_.size()); }
  const RigidBody& operator[](int body) const { return bodies_[body]; }
  int body_of_node(int node) const { return node_to_body_[node]; }
  int body_of_part(int part) const { return part_to_body_[part]; }
  // Velocity and angular velocity (global) of a body, for initial conditions.
  void set_velocity(int body, const Vec3d& v, const Vec3d& w);
  // V and w from the momentum of the nodes in the state.
  void velocity_from_nodes(int body, const State& state);
  // Sets nodal velocities and spins of all bodies from V and w.
  void give_velocity_to_nodes(State& state) const;
  // Kinetic energy at half steps, 1/2 M V.V + 1/2 w.L, of all active bodies.
  double kinetic_energy() const;
  // Reaction (force or moment along its direction) of a prescribed rigid motion, by index in the
  // model; 0 if idle.
  double motion_reaction(int motion) const { return motion_reaction_[motion]; }

  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  struct Seed {  // a part or a nodal rigid body before merging
    int part = -1, nodal = -1;
    std::vector<int> nodes;
  };
  struct Chunk {
    int body, begin, end;
  };
  struct Mass {
    double mass = 0;
    Vec3d center{};
    Mat3d inertia{};
  };
  void collect_parts(std::vector<Seed>& seeds);
  void collect_nodal(std::vector<Seed>& seeds, Diagnostics& diagnostics);
  void merge(std::vector<Seed>& seeds, State& state, Diagnostics& diagnostics);
  void check_motions(Diagnostics& diagnostics);
  Mass mass_of(const State& state, const Seed& seed) const;
  Mass given_mass(const InertiaOverride& given) const;
  const InertiaOverride* override_of(const Seed& seed) const;
  void set_principal(RigidBody& body, const Mass& mass, Diagnostics& diagnostics);
  void make_chunks();
  void break_welds(State& state);
  void build_components(const Joints* joints);
  void ground_conditions(const State& state, int body, int local, std::vector<GroundCondition>& out,
                         std::vector<int>& motion_of) const;
  void code_conditions(int cmo, int con1, int con2, int local_system, int local,
                       std::vector<GroundCondition>& out) const;
  void collect_supports(Diagnostics& diagnostics);
  void support_conditions(const State& state, int body, int local,
                          std::vector<GroundCondition>& out) const;
  Vec3d node_after(const State& state, int node, int body) const;
  void relative_condition(const State& state, const PrescribedMotion& m, GroundCondition& g) const;
  void order_components();
  bool motion_condition(const State& state, int index, int local, GroundCondition& g) const;
  struct Problem;
  Problem pose(const State& state, const std::vector<int>& members, Joints* joints,
               const std::vector<int>& links) const;
  void book(State& state, const std::vector<int>& members, Joints* joints, const Problem& problem,
            const Component& component);
  void solve_component(State& state, const std::vector<int>& members, Joints* joints,
                       const std::vector<int>& links);
  void accept(State& state, int body, const RigidTrial& trial);

  const Model& model_;
  std::vector<RigidBody> bodies_;
  std::vector<std::vector<Seed>> seeds_;  // of each body, lead first
  std::vector<int> node_to_body_, part_to_body_;
  std::vector<std::vector<int>> motions_;           // of each body
  std::vector<std::vector<NodeSupport>> supports_;  // of each body: those of its nodes
  std::vector<double> motion_angle_, motion_reaction_;
  std::vector<Chunk> chunks_;
  std::vector<Vec3d> partial_;
  std::vector<std::vector<int>> components_, component_links_;
  std::vector<int> order_;               // of the components: leads before those that follow them
  std::vector<unsigned char> plain_;     // component of one body without conditions
  std::vector<unsigned char> advanced_;  // body, in this cycle
  bool components_known_ = false;
  double pending_external_ = 0, pending_joint_ = 0;  // second halves of the work of the last forces
};

}  // namespace fabrica
