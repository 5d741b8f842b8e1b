#include "solver/mass_scaling.h"

#include <algorithm>
#include <istream>
#include <ostream>

namespace fabrica {

void MassScaling::start(const Model& model, State& state, Tiles& tiles) {
  if (!active()) return;
  smallest_.assign(tiles.steps.size(), Real(step_));
  part_added_.assign(model.parts.size(), 0);
  tiles.record_steps = !first_cycle_only_;
  std::vector<Real> steps;
  for (int t = 0; t < int(tiles.tiles.size()); ++t) {
    tiles.element_steps(state, t, steps);
    add(model, state, tiles, t, steps.data());
  }
}

void MassScaling::update(const Model& model, State& state, const Tiles& tiles) {
  if (!active() || first_cycle_only_) return;
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
    for (int a = 0; a < N; ++a) {
      NodeMotion& n = state.nodes[node[a]];
      const double dm = factor * m[a];
      n.mass += dm, n.inverse_mass = 1 / n.mass;
      state.energy.added_mass += 0.5 * dm * dot(n.v, n.v);
      added_ += dm, part_added_[c.part] += dm;
      if (!state.spins.empty()) state.spins[node[a]].inertia += factor * inertia[a];
    }
    floor = steps[i];
  }
}

void MassScaling::save(std::ostream& out) const {
  out.write(reinterpret_cast<const char*>(&added_), sizeof added_);
  out.write(reinterpret_cast<const char*>(smallest_.data()),
            std::streamsize(smallest_.size() * sizeof(Real)));
  out.write(reinterpret_cast<const char*>(part_added_.data()),
            std::streamsize(part_added_.size() * sizeof(double)));
}

void MassScaling::load(std::istream& in) {
  in.read(reinterpret_cast<char*>(&added_), sizeof added_);
  in.read(reinterpret_cast<char*>(smallest_.data()),
          std::streamsize(smallest_.size() * sizeof(Real)));
  in.read(reinterpret_cast<char*>(part_added_.data()),
          std::streamsize(part_added_.size() * sizeof(double)));
}

}  // namespace fabrica
