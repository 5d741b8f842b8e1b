// What output asks of a run at t(n): velocities between the half steps, accelerations and energies.
#include <algorithm>
#include <cmath>

#include "solver/simulation.h"

namespace fabrica {

void Simulation::remember_velocities() {
  velocity_before_.resize(state_.nodes.size());
  for (std::size_t n = 0; n < state_.nodes.size(); ++n) velocity_before_[n] = state_.nodes[n].v;
}

Vec3d Simulation::velocity(int node) const {
  const Vec3d& after = state_.nodes[node].v;
  if (velocity_before_.empty()) return after;
  // at t = 0 the velocity before is the initial one
  return state_.cycle == 0 ? velocity_before_[node] : 0.5 * (velocity_before_[node] + after);
}

Vec3d Simulation::acceleration(int node) const {
  if (velocity_before_.empty() || state_.mean_dt() <= 0) return {0, 0, 0};
  return (1 / state_.mean_dt()) * (state_.nodes[node].v - velocity_before_[node]);
}

// kinetic energy at t(n); the first call fixes the energy that the run starts with
void Simulation::update_energies() {
  double kinetic = rigid_bodies_->kinetic_energy(), eroded = 0;
  for (int n = 0; n < int(state_.nodes.size()); ++n) {
    if (state_.owner[n] == NodeOwner::rigid) continue;
    const Vec3d v = velocity(n);
    double& sum = erosion_.eroded(n) ? eroded : kinetic;
    sum += 0.5 * state_.nodes[n].mass * dot(v, v);
    if (!state_.spins.empty() && state_.spins[n].inertia > 0) {
      const Vec3d& w = state_.spins[n].w;
      sum += 0.5 * state_.spins[n].inertia * dot(w, w);
    }
  }
  kinetic += mass_scaling_.selective().kinetic_energy([&](int n) { return velocity(n); });
  state_.energy.kinetic = kinetic, state_.energy.eroded_kinetic = eroded;
  if (!energy_started_) {
    energy_started_ = true;
    state_.energy.initial = state_.energy.total() - state_.energy.external_work;
  }
}

double Simulation::model_size() const {
  if (model_.nodes.x.empty()) return 1;
  Vec3d low = model_.nodes.x[0], high = low;
  for (const Vec3d& x : model_.nodes.x)
    for (int d = 0; d < 3; ++d) low[d] = std::min(low[d], x[d]), high[d] = std::max(high[d], x[d]);
  const double size = norm(high - low);
  return size > 0 ? size / std::max(1.0, std::cbrt(double(model_.nodes.size()))) : 1;
}

// elastic constants by part, for contact stiffness
ContactInput Simulation::contact_input() const {
  ContactInput in;
  const std::size_t parts = model_.parts.size();
  in.part_bulk.assign(parts, 0), in.part_youngs.assign(parts, 0), in.part_poisson.assign(parts, 0);
  for (const TileClass& c : tiles_.classes) {
    in.part_bulk[c.part] = double(c.parameters.bulk);
    in.part_youngs[c.part] = double(c.parameters.youngs);
    in.part_poisson[c.part] = double(c.parameters.poisson);
  }
  for (std::size_t p = 0; p < parts; ++p) {
    if (in.part_bulk[p] > 0 || model_.parts[p].material < 0) continue;
    const Material& m = model_.materials[model_.parts[p].material];
    double E = m.youngs, nu = m.poisson;
    if (m.card && m.law == "MAT_NULL") E = m.card->real("ym"), nu = m.card->real("pr");
    if (m.card && E == 0 && m.card->has_field("e")) E = m.card->real("e"), nu = m.card->real("pr");
    in.part_youngs[p] = E, in.part_poisson[p] = nu;
    in.part_bulk[p] = E / (3 * (1 - 2 * std::min(nu, 0.4999)));
  }
  in.shell_thickness.resize(model_.shells.size());
  for (int e = 0; e < model_.shells.size(); ++e) {
    if (model_.parts[model_.shells.part[e]].section < 0) continue;
    const auto h = shell_thickness(model_, e);
    const bool triangle = model_.shells.node[e][3] == model_.shells.node[e][2];
    in.shell_thickness[e] = triangle ? (h[0] + h[1] + h[2]) / 3 : (h[0] + h[1] + h[2] + h[3]) / 4;
  }
  in.initial_dt = initial_step_ * model_.controls.time_step_scale;
  return in;
}

}  // namespace fabrica
