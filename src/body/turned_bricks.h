#pragma once
// Bricks of a run that turned over. A corner with edges a, b, d to its three neighbours
// (right-handed) has turned over where a . (b x d) < 0: the map of the brick is not one to one
// there, though its volume may still be positive. Corners of wedges, whose edges may have no
// length, count as sound.
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "body/mesh/quality.h"

namespace fabrica::body {

// Whether a corner of a brick has turned over.
bool turned_over(const Corners& corners);

// The kind of a part by its title in the deck of a body: "joint cartilage", "disc" (of the spine
// and the symphysis), "meniscus", "costal cartilage", "bone" or "other".
std::string kind_of_part(const std::string& title);

struct TurnedBricks {
  int bricks = 0;                    // of the kind
  int ever = 0;                      // turned over in any state
  int most = 0;                      // turned over in one state, the most
  double most_time = 0;              // of the first state with the most
  int last = 0;                      // turned over in the last state
  std::map<std::string, int> parts;  // turned over in any state, by title of the part
};

// Counts them over states, by kind of part.
class TurnedBrickCounter {
 public:
  // title: of the part of each brick
  TurnedBrickCounter(std::vector<Brick> bricks, std::vector<std::string> title);
  TurnedBrickCounter(TurnedBrickCounter&&) = default;  // kinds are pointed to: no copy
  // alive: one for each brick, or empty where all are
  void take(double time, const std::vector<Point>& nodes, const std::vector<std::uint8_t>& alive);
  const std::map<std::string, TurnedBricks>& kinds() const { return kinds_; }

 private:
  std::vector<Brick> bricks_;
  std::vector<std::string> title_;
  std::map<std::string, TurnedBricks> kinds_;
  std::vector<TurnedBricks*> kind_;  // of each brick
  std::vector<bool> ever_;
};

}  // namespace fabrica::body
