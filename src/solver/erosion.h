#pragma once
// Nodes that have lost all their elements. A node is eroded when every element that held it has
// failed; nodes that rigid parts, springs, null shells or masses hold as well are not.
#include <vector>

#include "model/model.h"
#include "solver/tiles.h"

namespace fabrica {

class Erosion {
 public:
  Erosion(const Model& model, const Tiles& tiles);
  // takes note of the elements that failed in the last pass
  void update(const Tiles& tiles);
  // after a restart, from all elements that have failed
  void restore(const Tiles& tiles);
  bool eroded(int node) const { return !holders_.empty() && holders_[node] == 0 && held_[node]; }

 private:
  void let_go(const Tiles& tiles, int tile);
  std::vector<int> holders_;   // live elements and masses of each node; empty if nothing may fail
  std::vector<char> held_;     // nodes that had any at the start
  std::vector<char> counted_;  // elements already let go, by tile.step + slot
};

}  // namespace fabrica
