#pragma once
// Nodal pressures of the parts that are meshed with nodal-pressure tetrahedra: one pressure per
// node and part.
//   dp_A = K dt sum_e V_e tr(D_e) / sum_e V_e   (tension positive) (1)
#include <iosfwd>
#include <vector>

#include "base/real.h"
#include "base/team.h"

namespace fabrica {

class Tiles;
struct State;

class NodalPressure {
 public:
  void build(const Tiles& tiles);
  bool empty() const { return first_.size() <= 1; }
  // sums the tiles' rate partials (tile order), advances the pressures and spreads rate and
  // pressure to the tiles
  void advance(const Tiles& tiles, double dt, Team& team);
  const Real* rate(int tile_node) const { return rate_.data() + tile_node; }
  const Real* pressure(int tile_node) const { return pressure_.data() + tile_node; }

  void save(std::ostream&) const;
  void load(std::istream&);

 private:
  std::vector<int> first_, place_;     // (node, part) -> places in Tiles::force
  std::vector<double> bulk_;           // per (node, part)
  std::vector<double> value_;          // p_A
  std::vector<Real> rate_, pressure_;  // parallel to Tiles::node
};

}  // namespace fabrica
