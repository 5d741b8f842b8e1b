#include "solver/nodal_pressure.h"

#include <algorithm>
#include <istream>
#include <ostream>
#include <tuple>

#include "solver/tiles.h"

namespace fabrica {

void NodalPressure::build(const Tiles& tiles) {
  // all (part, node, place) of nodal tiles, in that order
  std::vector<std::tuple<int, int, int>> all;
  for (const Tile& t : tiles.tiles) {
    const TileClass& c = tiles.classes[t.tile_class];
    if (!c.kernel->nodal_pressure()) continue;
    for (int k = t.node_first; k < t.node_first + t.node_count; ++k)
      all.emplace_back(c.part, tiles.node[k], k);
  }
  std::sort(all.begin(), all.end());
  std::vector<double> bulk_of_part;
  for (const TileClass& c : tiles.classes) {
    if (int(bulk_of_part.size()) <= c.part) bulk_of_part.resize(c.part + 1, 0);
    bulk_of_part[c.part] = double(c.parameters.bulk);
  }
  first_.assign(1, 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    place_.push_back(std::get<2>(all[i]));
    const bool last = i + 1 == all.size() || std::get<0>(all[i + 1]) != std::get<0>(all[i]) ||
                      std::get<1>(all[i + 1]) != std::get<1>(all[i]);
    if (last) first_.push_back(int(i) + 1), bulk_.push_back(bulk_of_part[std::get<0>(all[i])]);
  }
  value_.assign(bulk_.size(), 0);
  if (!all.empty()) rate_.assign(tiles.node.size(), 0), pressure_.assign(tiles.node.size(), 0);
}

void NodalPressure::advance(const Tiles& tiles, double dt, Team& team) {
  const int n = int(value_.size()), chunk = 512;
  team.for_each((n + chunk - 1) / chunk, [&](int c, int) {
    for (int i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i) {
      double volume = 0, weighted = 0;
      for (int k = first_[i]; k < first_[i + 1]; ++k) {
        volume += double(tiles.force[place_[k]].value[0]);
        weighted += double(tiles.force[place_[k]].value[1]);
      }
      const double rate = volume > 0 ? weighted / volume : 0;
      value_[i] += bulk_[i] * rate * dt;
      for (int k = first_[i]; k < first_[i + 1]; ++k)
        rate_[place_[k]] = Real(rate), pressure_[place_[k]] = Real(value_[i]);
    }
  });
}

void NodalPressure::save(std::ostream& out) const {
  out.write(reinterpret_cast<const char*>(value_.data()),
            std::streamsize(value_.size() * sizeof(double)));
}
void NodalPressure::load(std::istream& in) {
  in.read(reinterpret_cast<char*>(value_.data()), std::streamsize(value_.size() * sizeof(double)));
}

}  // namespace fabrica
