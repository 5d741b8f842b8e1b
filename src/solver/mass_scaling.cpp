#include "solver/mass_scaling.h"

#include <algorithm>
#include <istream>
#include <ostream>

#include "solver/stream.h"

namespace fabrica {

MassScaling::MassScaling(const Model& model)
    : step_(std::max(0.0, -model.controls.mass_scaling_time_step)),
      first_cycle_only_(model.controls.mass_scaling_first_cycle_only),
      part_selective_(model.parts.size(), model.controls.selective_mass_all) {
  for (const int part : model.controls.selective_mass_parts) part_selective_[part] = 1;
}

void MassScaling::start(const Model& model, State& state, Tiles& tiles) {
  if (!active()) return;
  smallest_.assign(tiles.steps.size(), Real(step_));
  part_added_.assign(model.parts.size(), 0);
  selective_of_.assign(tiles.steps.size(), conventional);
  tiles.record_steps = !first_cycle_only_;
  std::vector<Real> steps;
  for (int t = 0; t < int(tiles.tiles.size()); ++t) {
    tiles.element_steps(state, t, steps);
    add(model, state, tiles, t, steps.data());
  }
}

void MassScaling::settle(State& state) {
  for (int e = 0; e < selective_.elements(); ++e) {
    if (selective_.all_free(state, e) || selective_.mass(e) == 0) continue;
    const int N = selective_.corners(e);
    double mass[8], none[8] = {};
    for (int a = 0; a < N; ++a) mass[a] = selective_.corner_mass(e, a);
    const double factor = selective_.scale(e);
    set_selective(state, e, part_of_[e], 0);
    add_to_nodes(state, selective_.nodes(e), mass, none, N, factor, part_of_[e], true);
  }
}

void MassScaling::update(const Model& model, State& state, const Tiles& tiles) {
  if (!active()) return;
  if (selective_.active())
    for (int t = 0; t < int(tiles.tiles.size()); ++t)
      if (tiles.tiles[t].failed > 0) let_go(state, tiles, t);
  if (first_cycle_only_) return;
  for (int t = 0; t < int(tiles.tiles.size()); ++t)
    if (tiles.tiles[t].time_step < Real(step_))
      add(model, state, tiles, t, tiles.steps.data() + tiles.tiles[t].step);
}

void MassScaling::add(const Model& model, State& state, const Tiles& tiles, int index,
                      const Real* steps) {
  const Tile& t = tiles.tiles[index];
  const TileClass& c = tiles.classes[t.tile_class];
  const int N = c.kernel->corners();
  for (int i = 0; i < t.count; ++i) {
    Real& floor = smallest_[t.step + i];
    if (!(steps[i] < floor) || !(steps[i] > 0)) continue;
    // mass of the element from its initial geometry
    const std::uint16_t* local =
        &tiles.connectivity[t.connectivity + std::size_t(i / block_size) * N * block_size +
                            i % block_size];
    int node[8];
    Vec3d x[8];
    double m[8] = {}, inertia[8] = {}, h[4] = {0, 0, 0, 0};
    for (int a = 0; a < N; ++a) {
      node[a] = tiles.node[t.node_first + local[a * block_size]];
      x[a] = model.nodes.x[node[a]];
    }
    const int e = tiles.element[t.first + i];
    if (c.family == Family::shell) {
      const auto thickness = shell_thickness(model, e);
      std::copy(thickness.begin(), thickness.end(), h);
    }
    c.kernel->lump(c.parameters, x, h, Vec3d{0, 0, 0}, m, inertia);
    const double before = step_ / double(floor), now = step_ / double(steps[i]);
    const double factor = now * now - before * before;
    floor = steps[i];
    if (!part_selective_[c.part]) {
      add_to_nodes(state, node, m, inertia, N, factor, c.part, false);
      continue;
    }
    int& element = selective_of_[t.step + i];
    if (element < 0) element = selective_.add(node, m, N, 0), part_of_.push_back(c.part);
    const bool free = selective_.all_free(state, element);
    if (free)
      set_selective(state, element, c.part, now * now - 1);
    else
      add_to_nodes(state, node, m, inertia, N, factor, c.part, true);
    // rotary inertia is a number of each node
    if (free && !state.spins.empty())
      for (int a = 0; a < N; ++a) state.spins[node[a]].inertia += factor * inertia[a];
  }
}

void MassScaling::add_to_nodes(State& state, const int* node, const double* mass,
                               const double* inertia, int N, double factor, int part,
                               bool free_only) {
  for (int a = 0; a < N; ++a) {
    if (free_only && state.owner[node[a]] != NodeOwner::free) continue;
    NodeMotion& n = state.nodes[node[a]];
    const double dm = factor * mass[a];
    n.mass += dm, n.inverse_mass = 1 / n.mass;
    state.energy.added_mass += 0.5 * dm * dot(n.v, n.v);
    added_ += dm, part_added_[part] += dm;
    if (!state.spins.empty()) state.spins[node[a]].inertia += factor * inertia[a];
  }
}

void MassScaling::set_selective(State& state, int element, int part, double scale) {
  const double before = selective_.mass(element);
  state.energy.added_mass += selective_.set_scale(state, element, scale);
  const double dm = selective_.mass(element) - before;
  selective_added_ += dm, part_added_[part] += dm;
}

// what failed couples its nodes no more
void MassScaling::let_go(State& state, const Tiles& tiles, int index) {
  const Tile& t = tiles.tiles[index];
  for (int i = 0; i < t.count; ++i) {
    const int element = selective_of_[t.step + i];
    if (element < 0 || !tiles.has_failed(index, i) || selective_.mass(element) == 0) continue;
    set_selective(state, element, part_of_[element], 0);
  }
}

void MassScaling::save(std::ostream& out) const {
  out.write(reinterpret_cast<const char*>(&added_), sizeof added_);
  out.write(reinterpret_cast<const char*>(smallest_.data()),
            std::streamsize(smallest_.size() * sizeof(Real)));
  out.write(reinterpret_cast<const char*>(part_added_.data()),
            std::streamsize(part_added_.size() * sizeof(double)));
  write_value(out, selective_added_);
  write_vector(out, selective_of_);
  write_value(out, std::int64_t(part_of_.size()));
  write_vector(out, part_of_);
  selective_.save(out);
}

void MassScaling::load(std::istream& in) {
  in.read(reinterpret_cast<char*>(&added_), sizeof added_);
  in.read(reinterpret_cast<char*>(smallest_.data()),
          std::streamsize(smallest_.size() * sizeof(Real)));
  in.read(reinterpret_cast<char*>(part_added_.data()),
          std::streamsize(part_added_.size() * sizeof(double)));
  read_value(in, selective_added_);
  read_vector(in, selective_of_);
  std::int64_t count = 0;
  read_value(in, count);
  part_of_.resize(count);
  read_vector(in, part_of_);
  selective_.load(in);
}

}  // namespace fabrica
