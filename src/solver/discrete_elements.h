#pragma once
// Springs and dampers (*ELEMENT_DISCRETE) and discrete beams (ELFORM 6): forces, work, time step,
// memory.
//
// All in double. Elements are handled in fixed chunks and add to fixed-point sums: the same bits
// for any number of threads. forces() is called with x at t(n) and v, w at t(n-1/2);
// State::dt_previous is the step between.
//
// Work is taken exactly for the central difference scheme (docs/theory/discrete.md), one half of a
// step with the forces at its start and one half with those at its end:
//   forces()   dE = -dt(n-1,n)/2 sum over nodes f(n).v(n-1/2) + m(n).w(n-1/2)
//   account()  dE = -dt(n,n+1)/2 sum over nodes f(n).v(n+1/2) + m(n).w(n+1/2)
#include <array>
#include <iosfwd>
#include <optional>
#include <vector>

#include "base/diagnostics.h"
#include "base/team.h"
#include "material/discrete/six_dof.h"
#include "material/discrete/springs.h"
#include "model/model.h"
#include "model/state.h"

namespace fabrica {

class RigidBodies;

class DiscreteElements {
 public:
  // Takes the elements of the model at the state's positions. Parts with a law or an option that is
  // not supported become errors in the diagnostics; elements with a free direction become warnings.
  DiscreteElements(const Model& model, const State& state, Diagnostics& diagnostics);

  // whether the model has torsional springs or discrete beams, which need State::spins
  static bool turn_nodes(const Model& model);

  int springs() const { return int(spring_.size()); }
  int beams() const { return int(beam_.size()); }

  // Adds all forces and moments at t(n) to state.interaction and state.interaction_moment, and half
  // of the last step's work to state.energy.discrete, which then belongs to t(n). Once per step.
  void forces(const Model& model, State& state, Team& team);
  // Adds the first half of the next step's work. Once per step, with v and w at t(n+1/2) and
  // State::dt the step from t(n) to t(n+1).
  void account(State& state) const;
  // Largest stable step [time], from the tangents of the last forces() call; infinity without
  // elements.
  double time_step(const State& state) const;
  // Tells the time step and DAMPF what a rigid body puts against a pull at one of its nodes,
  // instead of the node's own mass: for bodies call it once masses are known. Nodes of one body
  // number count together.
  void use_mass(int node, int body, double mass, double inertia);
  // The same for all nodes of all bodies: 1/m = 1/M + r^2/I with r from the centre and I the
  // smallest inertia.
  void use_bodies(const RigidBodies& bodies);

  // By index into Model::discretes: force or moment (tension positive), elongation or twist,
  // whether it still acts.
  double force(int discrete) const { return spring_[std::size_t(discrete)].force; }
  double elongation(int discrete) const { return spring_[std::size_t(discrete)].elongation; }
  bool alive(int discrete) const { return spring_[std::size_t(discrete)].alive != 0; }
  // force on node 1 in global components
  Vec3d force_vector(int discrete) const { return spring_[std::size_t(discrete)].pull.force; }
  // of the torsional kind: force() is a moment
  bool torsional(int discrete) const { return spring_[std::size_t(discrete)].torsional; }

  // By position 0 .. beams(): index into Model::beams, resultants and relative motion in the local
  // triad (r s t, then rotations), the triad's rows.
  int beam_index(int i) const { return beam_[std::size_t(i)].index; }
  const std::array<double, 6>& beam_resultants(int i) const {
    return beam_[std::size_t(i)].resultant;
  }
  const std::array<double, 6>& beam_displacements(int i) const { return beam_[std::size_t(i)].u; }
  const Mat3d& beam_triad(int i) const { return beam_[std::size_t(i)].triad; }
  bool beam_alive(int i) const { return beam_[std::size_t(i)].alive != 0; }

  // Everything that a restart needs, bit for bit. load() throws std::runtime_error if the sizes do
  // not match.
  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  // what one element does to its two nodes: `force` and `moment` on node 1; the other node gets the
  // opposite force and its own moment
  struct Pull {
    Vec3d force{}, moment1{}, moment2{};
  };
  struct Spring {
    int node1 = -1, node2 = -1, law = -1;
    int local1 = -1, local2 = -1;  // into nodes_
    bool torsional = false;
    int orientation = -1;
    Vec3d ground{};   // fixed end if node2 is -1
    double rest = 0;  // length at the start, less the initial offset
    double scale = 1;
    double dynamic_factor = 0, test_velocity = 0, clearance = 0, failure = 0, shortest = 0,
           longest = 0;
    // memory
    int alive = 1;
    double elongation = 0, force = 0, stiffness = 0, damping = 0;
    SpringState state;
    Pull pull;
  };
  struct Beam {
    int index = -1, node1 = -1, node2 = -1, law = -1;
    int local1 = -1, local2 = -1;
    int tracking = 0;  // SCOOR
    std::array<bool, 3> frozen{};
    double length = 0;
    Vec3d rest{};  // local components of node 2 - node 1 at the start, less the offset
    // memory
    int alive = 1;
    Mat3d triad{};
    std::array<double, 6> u{}, resultant{}, stiffness{}, damping{};
    BeamLawState state;
    Pull pull;
  };
  struct Node {
    int node = -1;
    int body = -1;
    double mass = 0, inertia = 0;  // at a node of a body
  };

  // of a node: sums of stiffness and damping over mass, for translation and rotation
  struct Rate {
    double k = 0, c = 0, kr = 0, cr = 0;
  };

  void add_springs(const Model& model, const State& state, Diagnostics& diagnostics);
  void add_beams(const Model& model, const State& state, Diagnostics& diagnostics);
  void check_spring(const Model& model, const State& state, int i, Diagnostics& diagnostics) const;
  int local_node(int node);
  double mass_of(const State& state, int local) const;
  double inertia_of(const State& state, int local) const;
  void pull_spring(const Model& model, const State& state, Spring& s) const;
  double spring_law_force(const State& state, Spring& s, double rate) const;
  double stop_force(const State& state, const Spring& s, double rate) const;
  void pull_beam(const State& state, Beam& b) const;
  void move_triad(const State& state, Beam& b) const;
  Vec3d spin(const State& state, int node) const;
  double power(const State& state) const;
  std::vector<Rate> rates(const State& state) const;
  template <class Io>
  void stream(Io&& io);

  std::vector<std::optional<SpringLaw>> spring_law_;  // by part
  std::vector<std::optional<BeamLaw>> beam_law_;      // by part
  std::vector<Spring> spring_;                        // by Model::discretes
  std::vector<Beam> beam_;
  std::vector<Node> nodes_;
  std::vector<int> node_to_local_;
};

}  // namespace fabrica
