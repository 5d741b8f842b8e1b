#include "solver/simulation.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"

namespace fabrica {
namespace {

constexpr int chunk_nodes = 1024;

// What scales the fixed-point sums: the force that moves a node by a mean element length in one
// step, of the median mass. A sum resolves 2^-40 and holds 2^23 of it; where the heaviest node is
// above 4096 medians, 2^11 of what moves that one (docs/decisions/0003).
double scaling_mass(const State& state, double& median) {
  std::vector<double> masses;
  for (const auto& n : state.nodes)
    if (n.mass > 0) masses.push_back(n.mass);
  median = 0;
  if (masses.empty()) return 0;
  const auto middle = masses.begin() + std::ptrdiff_t(masses.size() / 2);
  std::nth_element(masses.begin(), middle, masses.end());
  median = *middle;
  return std::max(median, std::ldexp(*std::max_element(masses.begin(), masses.end()), -12));
}

double force_scale(const Model& model, double mass, double step) {
  Vec3d low = model.nodes.x.empty() ? Vec3d{0, 0, 0} : model.nodes.x[0], high = low;
  for (const auto& x : model.nodes.x)
    for (int d = 0; d < 3; ++d) low[d] = std::min(low[d], x[d]), high[d] = std::max(high[d], x[d]);
  const double size = norm(high - low) / std::max(1.0, std::cbrt(double(model.nodes.size())));
  return step > 0 ? mass * size / (step * step) : 1.0;
}

// one node so heavy that the sums resolve less than 1e-10 of what moves the median one
void check_masses(const Model& model, const State& state, Diagnostics& diagnostics) {
  double median = 0;
  if (!(scaling_mass(state, median) > 128 * median)) return;
  const auto heavier = [](const NodeMotion& a, const NodeMotion& b) { return a.mass < b.mass; };
  const auto heaviest = std::max_element(state.nodes.begin(), state.nodes.end(), heavier);
  const auto id = model.nodes.id[std::size_t(heaviest - state.nodes.begin())];
  diagnostics.warning("heavy-node", {}, "", "",
                      "node " + std::to_string(id) + " has " +
                          std::to_string(std::int64_t(heaviest->mass / median)) +
                          " times the median mass: small forces on light nodes may get lost",
                      "Check its mass; if it is meant, spread it over nodes or a rigid body");
}

}  // namespace

Simulation::Simulation(const Model& model, const RunOptions& options, Diagnostics& diagnostics)
    : model_(model),
      team_(options.threads),
      tiles_(model, diagnostics),
      erosion_(model, tiles_),
      mass_scaling_(model) {
  end_time_ = options.end_time > 0 ? options.end_time : model.controls.end_time;
  set_up_masses(diagnostics);
  if (diagnostics.has_errors()) return;

  state_.dt = 0, state_.dt_previous = 0;
  initial_step_ = smallest_element_step();
  mass_scaling_.start(model, state_, tiles_);
  if (mass_scaling_.active()) initial_step_ = std::max(initial_step_, mass_scaling_.step());
  rigid_bodies_ = std::make_unique<RigidBodies>(model, state_, diagnostics);
  contacts_ = std::make_unique<Contacts>(model, state_, contact_input(), diagnostics);
  add_rigid_ties(diagnostics);
  mass_scaling_.settle(state_);
  rigid_bodies_->finish(state_, diagnostics);
  joints_ = std::make_unique<Joints>(model, *rigid_bodies_, diagnostics);
  node_constraints_ = std::make_unique<NodeConstraints>(model, state_, diagnostics);
  rigid_walls_ = std::make_unique<RigidWalls>(model, state_, diagnostics, options.walls);
  loads_ = std::make_unique<Loads>(model, state_, *rigid_bodies_, diagnostics);
  damping_ = std::make_unique<MassDamping>(model, *rigid_bodies_);
  discrete_ = std::make_unique<DiscreteElements>(model, state_, diagnostics);
  discrete_->use_bodies(*rigid_bodies_);
  if (diagnostics.has_errors()) return;
  size_interaction(first_step());
  check_masses(model, state_, diagnostics);
  apply_initial_conditions(model, state_, *rigid_bodies_);
  node_constraints_->stop_supported(state_);
  part_internal_.assign(model.parts.size(), 0);
  part_hourglass_.assign(model.parts.size(), 0);
  part_eroded_internal_.assign(model.parts.size(), 0);
}

// Nodes tied to the surface of a rigid body go with it.
void Simulation::add_rigid_ties(Diagnostics& diagnostics) {
  int refused = 0;
  for (const RigidTie& t : contacts_->rigid_ties())
    refused += !rigid_bodies_->add_node(state_, t.part, t.node);
  if (refused > 0)
    diagnostics.warning(
        "untied-nodes", {}, "CONTACT_TIED", "",
        std::to_string(refused) +
            " nodes tied to a rigid body are held by something else, which keeps them",
        "Leave them out of one of the two");
}

void Simulation::set_up_masses(Diagnostics& diagnostics) {
  const int n = model_.nodes.size();
  std::vector<double> mass(n, 0), inertia(n, 0);
  tiles_.add_mass(mass, inertia);
  add_rigid_part_mass(model_, mass, inertia);
  for (const NodalMass& m : model_.masses) mass[m.node] += m.mass;
  for (const NodalInertia& m : model_.inertias) {
    mass[m.node] += m.mass;
    inertia[m.node] += (m.inertia[0] + m.inertia[3] + m.inertia[5]) / 3;
  }
  // torsional springs and discrete beams turn with their nodes, whose inertia may be that of a body
  const bool rotations =
      std::any_of(inertia.begin(), inertia.end(), [](double j) { return j > 0; }) ||
      DiscreteElements::turn_nodes(model_);
  state_.nodes.resize(n);
  state_.force.assign(n, Vec3d{0, 0, 0});
  state_.owner.assign(n, NodeOwner::free);
  state_.physical_mass = mass;
  for (int i = 0; i < n; ++i) {
    NodeMotion& node = state_.nodes[i];
    node.x = model_.nodes.x[i], node.v = {0, 0, 0};
    physical_mass_ += mass[i];
    // nodes that carry nothing get no motion of their own
    node.mass = mass[i], node.inverse_mass = mass[i] > 0 ? 1 / mass[i] : 0;
  }
  if (rotations) {
    state_.spins.resize(n);
    state_.moment.assign(n, Vec3d{0, 0, 0});
    for (int i = 0; i < n; ++i) state_.spins[i] = {{0, 0, 0}, inertia[i], {1, 0, 0, 0}};
  }
  if (physical_mass_ <= 0)
    diagnostics.error("no-mass", {}, "", "", "the model has no mass",
                      "Check densities and section properties");
}

// A step near the first one, before any force is known; models without deformable elements take
// what their springs ask for, or what resolves their motion.
double Simulation::first_step() {
  double step = initial_step_;
  if (step >= 1e29) {
    size_interaction(1);
    discrete_->forces(model_, state_,
                      team_);  // the tangents; nothing has moved, so that no memory is touched
    step = discrete_->time_step(state_);
    if (model_.controls.time_step_curve >= 0)
      step = std::min(step, model_.curves[model_.controls.time_step_curve].at(0));
    if (step >= 1e29) step = end_time_ / 1000;
  }
  return step;
}

// the sums of contacts, springs and joints, empty, in fixed point fit for forces that act within a
// step
void Simulation::size_interaction(double step) {
  const std::size_t n = state_.nodes.size();
  double median = 0;
  const double scale = force_scale(model_, scaling_mass(state_, median), step);
  state_.interaction.resize(n, FixedScale::of(scale));
  if (!state_.spins.empty())
    state_.interaction_moment.resize(n, FixedScale::of(scale * model_size()));
}

void Simulation::step(const Sampler& sampler) {
  const bool sampling = sampler.wants && sampler.wants(state_.time);
  element_forces();
  contact_forces();
  external_forces();
  choose_time_step();
  if (ending_ != Ending::running) return;
  assemble();
  if (sampling) remember_velocities();
  accelerate();
  if (sampling) {
    update_energies();
    sampler.sample();
  }
  advance_nodes();
  account_energy();
  state_.time_sum.add(state_.dt);
  state_.time = state_.time_sum.value();
  state_.dt_previous = state_.dt;
  ++state_.cycle;
  check_health();
}

// Samples the present state as it stands, without a step.
void Simulation::sample_now(const Sampler& sampler) {
  velocity_before_.clear();
  update_energies();
  if (sampler.sample) sampler.sample();
}

void Simulation::stop(std::string reason) { end(Ending::signal, std::move(reason)); }

// stress and internal force of every element
void Simulation::element_forces() {
  tiles_.forces(state_, team_);
  for (const Tile& t : tiles_.tiles) {
    const int part = tiles_.classes[t.tile_class].part;
    part_internal_[part] += t.internal;
    part_hourglass_[part] += t.hourglass;
    state_.energy.internal += t.internal;
    state_.energy.hourglass += t.hourglass;
    state_.energy.damping += t.damping;
    if (t.failed > 0) set_apart(t);
  }
  erosion_.update(tiles_);
  if (mass_scaling_.active()) mass_scaling_.update(model_, state_, tiles_);
}

// what the elements held that have failed just now
void Simulation::set_apart(const Tile& t) {
  const int part = tiles_.classes[t.tile_class].part;
  Energies& e = state_.energy;
  part_internal_[part] -= t.eroded_internal, part_hourglass_[part] -= t.eroded_hourglass;
  part_eroded_internal_[part] += t.eroded_internal;
  e.internal -= t.eroded_internal, e.hourglass -= t.eroded_hourglass;
  e.eroded_internal += t.eroded_internal, e.eroded_hourglass += t.eroded_hourglass;
}

void Simulation::contact_forces() { contacts_->forces(model_, state_, team_); }

// springs, joints by penalty, nodal loads and pressures
void Simulation::external_forces() {
  discrete_->forces(model_, state_, team_);
  loads_->forces(state_, *rigid_bodies_);
  rigid_walls_->forces(state_, team_, rigid_speed_);
}

// sums element partials in tile order and the fixed-point interaction forces
void Simulation::assemble() {
  const bool rotations = !state_.spins.empty();
  team_.for_ranges(state_.nodes.size(), chunk_nodes, [&](int, int a, int b) {
    tiles_.sum_partials(state_, a, b);
    state_.interaction.take_all(a, b, [&](std::size_t n, const Vec3d& f) { state_.force[n] += f; });
    if (rotations)
      state_.interaction_moment.take_all(
          a, b, [&](std::size_t n, const Vec3d& m) { state_.moment[n] += m; });
  });
  loads_->body_forces(state_, *rigid_bodies_, team_);
  contacts_->transfer_tied_forces(state_, team_);
  mass_scaling_.selective().correct(state_, *node_constraints_, team_);
}

// v(n+1/2) = v(n-1/2) + dt a, then everything that prescribes motion
void Simulation::accelerate() {
  const double dt = state_.mean_dt();
  rigid_bodies_->gather(state_, team_);
  const bool bound = rigid_walls_->size() > 0;
  chunk_speed_.assign(bound ? Team::ranges(state_.nodes.size(), chunk_nodes) : 0, 0);
  team_.for_ranges(state_.nodes.size(), chunk_nodes, [&](int chunk, int a, int b) {
    for (int n = a; n < b; ++n) {
      if (state_.owner[n] != NodeOwner::free) continue;
      NodeMotion& node = state_.nodes[n];
      node.v += (dt * node.inverse_mass) * state_.force[n];
      if (!state_.spins.empty() && state_.spins[n].inertia > 0)
        state_.spins[n].w += (dt / state_.spins[n].inertia) * state_.moment[n];
    }
    if (bound) chunk_speed_[chunk] = fastest_unowned(a, b);
  });
  if (damping_->active()) damping_->apply(state_, *rigid_bodies_, team_);
  node_constraints_->apply(state_);
  rigid_walls_->apply(state_, team_, damping_->active() ? -1 : speed_bound());
  rigid_bodies_->integrate(state_, joints_.get());
}

// highest |v|^2 of nodes a..b that no rigid body owns
double Simulation::fastest_unowned(int a, int b) const {
  double square = 0;
  for (int n = a; n < b; ++n)
    if (state_.owner[n] != NodeOwner::rigid)
      square = std::max(square, dot(state_.nodes[n].v, state_.nodes[n].v));
  return square;
}

// a bound of |v+| of these nodes: nodes with conditions got theirs after the others
double Simulation::speed_bound() const {
  double square = 0;
  for (const double s : chunk_speed_) square = std::max(square, s);
  for (const NodeConstraints::Reaction& r : node_constraints_->reactions())
    square = std::max(square, dot(state_.nodes[r.node].v, state_.nodes[r.node].v));
  return std::sqrt(square);
}

void Simulation::advance_nodes() {
  const double dt = state_.dt;
  team_.for_ranges(state_.nodes.size(), chunk_nodes, [&](int, int a, int b) {
    for (int n = a; n < b; ++n)
      if (state_.owner[n] == NodeOwner::free) state_.nodes[n].x += dt * state_.nodes[n].v;
  });
  rigid_speed_ = rigid_bodies_->place_nodes(state_, team_);
  contacts_->place_tied_nodes(state_, team_);
}

void Simulation::account_energy() {
  contacts_->account(state_);
  discrete_->account(state_);
}

}  // namespace fabrica
