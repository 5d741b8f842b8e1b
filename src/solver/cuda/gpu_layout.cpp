// Corner lists of the tiles, in the order in which the CPU driver adds corner forces.
#include "solver/cuda/gpu_arrays.h"
#include "solver/tiles.h"

namespace fabrica {
namespace {

// Calls visit(local node, corner, element) for every corner of a tile in the order of the sum: half
// block by half block, corner by corner, lane by lane; padding left out, it adds zeros.
template <class Visit>
void for_corners(const Tiles& tiles, const Tile& t, int corners, Visit visit) {
  constexpr int half = block_size / 2;
  for (int first = 0; first < t.count; first += half)
    for (int a = 0; a < corners; ++a)
      for (int e = first; e < first + half && e < t.count; ++e) {
        const std::size_t row = std::size_t(e / block_size) * corners + a;
        visit(tiles.connectivity[t.connectivity + row * block_size + e % block_size], a, e);
      }
}

}  // namespace

GpuLayout::GpuLayout(const Tiles& tiles) {
  corner_first.assign(1, 0);
  for (const Tile& t : tiles.tiles) {
    const TileClass& c = tiles.classes[t.tile_class];
    const int corners = c.kernel->corners();
    const int capacity = corners == 4 && !c.kernel->rotations() ? 512 : 256;
    tile.push_back({t.count, t.node_first, t.node_count, t.anchor, t.connectivity, t.state,
                    c.family == Family::solid});
    std::vector<std::vector<std::uint16_t>> lists(t.node_count);
    for_corners(tiles, t, corners, [&](int node, int a, int e) {
      lists[node].push_back(std::uint16_t(a * capacity + e));
    });
    for (const auto& list : lists) {
      corner.insert(corner.end(), list.begin(), list.end());
      corner_first.push_back(int(corner.size()));
    }
  }
}

}  // namespace fabrica
