#pragma once
// A run: the model, its state and the passes of one step in the order of the physics
// (docs/step.md).
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>

#include "base/team.h"
#include "model/model.h"
#include "model/state.h"
#include "solver/contact.h"
#include "solver/damping.h"
#include "solver/discrete_elements.h"
#include "solver/erosion.h"
#include "solver/initial_conditions.h"
#include "solver/joints.h"
#include "solver/loads.h"
#include "solver/mass_scaling.h"
#include "solver/node_constraints.h"
#include "solver/rigid_bodies.h"
#include "solver/rigid_walls.h"
#include "solver/tiles.h"

namespace fabrica {

struct RunOptions {
  int threads = 1;
  double end_time = 0;  // 0: the deck's
  bool energy_audit = false;
  WallMethod walls = WallMethod::impulse;  // a restart keeps that of its file
};

// Asked at t(n) of every step; when wants() says yes, sample() is called once forces, energies,
// x(n), v(n+1/2) and the remembered v(n-1/2) are all there.
struct Sampler {
  std::function<bool(double time)> wants;
  std::function<void()> sample;
};

// why a run ended
enum class Ending {
  running,
  end_time,
  end_cycle,
  signal,
  time_step_too_small,
  negative_volume,
  not_a_number
};

// who sets the time step
struct TimeStepOwner {
  std::string family;  // "solid", "shell", "beam", "discrete", "contact", "limit"
  std::int64_t element = 0, part = 0;
  double step = 0;
};

class Simulation {
 public:
  // Sets the run up to t = 0; the model must be free of errors. Problems go to diagnostics.
  Simulation(const Model& model, const RunOptions& options, Diagnostics& diagnostics);

  // Advances one step. After it, x is at t(n+1), v at t(n+1/2) and forces belong to t(n).
  void step(const Sampler& sampler = {});

  // Lets the sampler write the state as it stands, after the last step.
  void sample_now(const Sampler& sampler);
  // Ends the run from outside.
  void stop(std::string reason);

  const Model& model() const { return model_; }
  const State& state() const { return state_; }
  Ending ending() const { return ending_; }
  std::string ending_text() const { return ending_text_; }
  double end_time() const { return end_time_; }
  TimeStepOwner time_step_owner() const;
  int elements() const { return tiles_.elements(); }
  double added_mass() const { return mass_scaling_.added_mass(); }
  double physical_mass() const { return physical_mass_; }
  // a hash of position and velocity of every node
  std::uint64_t state_hash() const;

  void save(const std::string& path) const;
  void load(const std::string& path);

  // parts of the run, for output
  Team& team() { return team_; }
  const Tiles& tiles() const { return tiles_; }
  const Contacts& contacts() const { return *contacts_; }
  const RigidBodies& rigid_bodies() const { return *rigid_bodies_; }
  const Joints& joints() const { return *joints_; }
  const RigidWalls& rigid_walls() const { return *rigid_walls_; }
  const NodeConstraints& node_constraints() const { return *node_constraints_; }
  const DiscreteElements& discrete_elements() const { return *discrete_; }
  const std::vector<double>& part_internal() const { return part_internal_; }
  const std::vector<double>& part_hourglass() const { return part_hourglass_; }
  // internal energy that failed elements of a part held
  const std::vector<double>& part_eroded_internal() const { return part_eroded_internal_; }
  const Erosion& erosion() const { return erosion_; }
  const MassScaling& mass_scaling() const { return mass_scaling_; }
  // of a node at t(n), while sampling: mean of the two half-step velocities, and their difference
  // over the step
  Vec3d velocity(int node) const;
  Vec3d acceleration(int node) const;

 private:
  void element_forces();
  void set_apart(const Tile& tile);
  void contact_forces();
  void external_forces();
  void assemble();
  void accelerate();
  void advance_nodes();
  double fastest_unowned(int a, int b) const;
  double speed_bound() const;
  void account_energy();
  void choose_time_step();
  void check_health();
  void remember_velocities();
  void update_energies();
  void add_rigid_ties(Diagnostics& diagnostics);
  void set_up_masses(Diagnostics& diagnostics);
  double smallest_element_step();
  double first_step();
  void size_interaction(double step);
  TimeStepOwner worst_element(int tile) const;
  double model_size() const;
  ContactInput contact_input() const;
  void end(Ending ending, std::string text);

  const Model& model_;
  Team team_;
  State state_;
  Tiles tiles_;
  Erosion erosion_;
  MassScaling mass_scaling_;
  std::unique_ptr<RigidBodies> rigid_bodies_;
  std::unique_ptr<Joints> joints_;
  std::unique_ptr<NodeConstraints> node_constraints_;
  std::unique_ptr<RigidWalls> rigid_walls_;
  std::unique_ptr<Loads> loads_;
  std::unique_ptr<MassDamping> damping_;
  std::unique_ptr<DiscreteElements> discrete_;
  std::unique_ptr<Contacts> contacts_;
  std::vector<double> part_internal_, part_hourglass_, part_eroded_internal_;
  std::vector<Vec3d> velocity_before_;  // v(n-1/2), while sampling
  double end_time_ = 0, physical_mass_ = 0, initial_step_ = 0;
  std::vector<double> chunk_speed_;  // highest |v|^2 of chunks of nodes, where walls ask for it
  double rigid_speed_ = -1;          // highest |v| of nodes of rigid bodies; negative: unknown
  bool energy_started_ = false;
  Ending ending_ = Ending::running;
  std::string ending_text_;
};

}  // namespace fabrica
