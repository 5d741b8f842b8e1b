// What others want to know of the elements of tiles: stress, corner forces, time steps.
#include "solver/tiles.h"

namespace fabrica {

const std::vector<ElementPlace>& Tiles::places(Family family) const {
  return family == Family::solid   ? place_of_solid
         : family == Family::shell ? place_of_shell
                                   : place_of_beam;
}

int Tiles::corner_forces(const State& state, Family family, int e, int* global, Vec3d* f,
                         Vec3d* m) const {
  const ElementPlace place = places(family)[e];
  if (place.tile < 0) return 0;
  const Tile& t = tiles[place.tile];
  const TileClass& c = classes[t.tile_class];
  const int N = c.kernel->corners(), block = place.slot / block_size,
            lane = place.slot % block_size;
  // a tile of one element: its history and connectivity in the first lane, repeated
  AlignedVector<Real> history(std::size_t(c.fields) * block_size);
  for (int k = 0; k < c.fields; ++k)
    for (int i = 0; i < block_size; ++i)
      history[std::size_t(k) * block_size + i] =
          state_[t.state + (std::size_t(block) * c.fields + k) * block_size + lane];
  std::vector<std::uint16_t> local(std::size_t(N) * block_size);
  for (int a = 0; a < N; ++a) {
    const int l = connectivity[t.connectivity + (std::size_t(block) * N + a) * block_size + lane];
    std::fill_n(local.begin() + a * block_size, block_size, std::uint16_t(l));
    global[a] = node[t.node_first + l];
  }
  AlignedVector<NodeRecord> nodes(t.node_count);
  AlignedVector<SpinRecord> spins(t.node_count);
  AlignedVector<ForceRecord> force_sum(t.node_count), moment_sum(t.node_count);
  fill_nodes(state, t, nodes.data(), c.kernel->rotations() ? spins.data() : nullptr);
  TileView view;
  view.count = 1;
  view.connectivity = local.data(), view.state = history.data();
  view.nodes = nodes.data(), view.spins = spins.data();
  view.force = force_sum.data(), view.moment = moment_sum.data();
  if (c.kernel->nodal_pressure()) {
    view.node_rate = nodal_pressure_.rate(t.node_first);
    view.node_pressure = nodal_pressure_.pressure(t.node_first);
  }
  c.kernel->forces(c.parameters, Real(0), view);
  for (int a = 0; a < N; ++a) {
    const Real* r = force_sum[local[std::size_t(a) * block_size]].value;
    const Real* q = moment_sum[local[std::size_t(a) * block_size]].value;
    f[a] = {double(r[0]), double(r[1]), double(r[2])};
    m[a] = {double(q[0]), double(q[1]), double(q[2])};
  }
  return N;
}

ElementReadout Tiles::read(const Model&, const State& state, Family family, int e) const {
  const auto& places = this->places(family);
  ElementReadout out;
  if (e >= int(places.size()) || places[e].tile < 0) return out;
  const Tile& t = tiles[places[e].tile];
  const TileClass& c = classes[t.tile_class];
  const int N = c.kernel->corners(), slot = places[e].slot, block = slot / block_size,
            lane = slot % block_size;
  Vec3d x[8];
  for (int a = 0; a < N; ++a) {
    const int l = connectivity[t.connectivity + (std::size_t(block) * N + a) * block_size + lane];
    x[a] = state.nodes[node[t.node_first + l]].x;
  }
  c.kernel->read(c.parameters, state_.data() + t.state + std::size_t(block) * c.fields * block_size,
                 lane, x, out);
  return out;
}

void Tiles::element_steps(const State& state, int tile, std::vector<Real>& steps) const {
  const Tile& t = tiles[tile];
  const TileClass& c = classes[t.tile_class];
  const int blocks = (t.count + block_size - 1) / block_size;
  AlignedVector<Real> history(
      state_.begin() + t.state,
      state_.begin() + t.state + std::size_t(blocks) * c.fields * block_size);
  AlignedVector<NodeRecord> nodes(t.node_count);
  AlignedVector<SpinRecord> spins(t.node_count);
  AlignedVector<ForceRecord> f(t.node_count), m(t.node_count);
  AlignedVector<Real> out(std::size_t(blocks) * block_size);
  fill_nodes(state, t, nodes.data(), c.kernel->rotations() ? spins.data() : nullptr);
  TileView view;
  view.count = t.count;
  view.connectivity = connectivity.data() + t.connectivity;
  view.state = history.data();
  view.nodes = nodes.data(), view.spins = spins.data(), view.force = f.data(),
  view.moment = m.data();
  view.element_time_step = out.data();
  c.kernel->forces(c.parameters, Real(0), view);
  steps.assign(out.begin(), out.begin() + t.count);
}

}  // namespace fabrica
