#include "solver/erosion.h"

#include <set>

namespace fabrica {
namespace {

// one for every distinct corner of an element
template <class Corners>
void hold(const Corners& corners, int count, std::vector<int>& holders) {
  for (int a = 0; a < count; ++a) {
    bool seen = corners[a] < 0;
    for (int b = 0; b < a; ++b) seen |= corners[b] == corners[a];
    if (!seen) ++holders[corners[a]];
  }
}

}  // namespace

Erosion::Erosion(const Model& model, const Tiles& tiles) {
  if (tiles.energies.empty()) return;
  counted_.assign(tiles.energies.size(), 0);
  holders_.assign(model.nodes.size(), 0);
  for (int e = 0; e < model.solids.size(); ++e) hold(model.solids.node[e], 10, holders_);
  for (int e = 0; e < model.shells.size(); ++e) hold(model.shells.node[e], 4, holders_);
  for (int e = 0; e < model.beams.size(); ++e) hold(model.beams.node[e], 2, holders_);
  for (int e = 0; e < model.discretes.size(); ++e) hold(model.discretes.node[e], 2, holders_);
  for (const NodalMass& m : model.masses) ++holders_[m.node];
  for (const NodalInertia& m : model.inertias) ++holders_[m.node];
  held_.resize(holders_.size());
  for (std::size_t n = 0; n < held_.size(); ++n) held_[n] = holders_[n] > 0;
}

void Erosion::let_go(const Tiles& tiles, int index) {
  const Tile& t = tiles.tiles[index];
  const int N = tiles.classes[t.tile_class].kernel->corners();
  for (int i = 0; i < t.count; ++i) {
    if (counted_[t.step + i] || !tiles.has_failed(index, i)) continue;
    counted_[t.step + i] = 1;
    const std::uint16_t* local =
        &tiles.connectivity[t.connectivity + std::size_t(i / block_size) * N * block_size +
                            i % block_size];
    // corners may coincide
    std::set<int> nodes;
    for (int a = 0; a < N; ++a) nodes.insert(tiles.node[t.node_first + local[a * block_size]]);
    for (const int n : nodes) --holders_[n];
  }
}

void Erosion::update(const Tiles& tiles) {
  if (holders_.empty()) return;
  for (int t = 0; t < int(tiles.tiles.size()); ++t)
    if (tiles.tiles[t].failed > 0) let_go(tiles, t);
}

void Erosion::restore(const Tiles& tiles) {
  if (holders_.empty()) return;
  for (int t = 0; t < int(tiles.tiles.size()); ++t) let_go(tiles, t);
}

}  // namespace fabrica
