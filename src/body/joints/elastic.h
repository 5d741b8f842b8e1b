#pragma once
// Bones as elastic bodies that are pressed apart where they are too near. Per corner of a brick,
// F the three edges times the inverse of the three edges at rest, D = det F:
//   E = f^3 - 1 + b (g - 1),  f = |F|^2 / (3 D^(2/3)),  g = (D^2 + 1) / (2 D)          (1)
// f measures the change of shape, g that of volume; both are 1 at rest, and grow without bounds as
// a corner is pressed flat. A touch adds w (max(0, gap - d) / h)^2, d its distance with the normal
// and the place on the face kept, every node k |u|^2 (u its shift) against drifting.   (2)
#include "body/joints/mirror.h"
#include "body/joints/touch.h"

namespace fabrica::body {

class ElasticBones {
 public:
  static constexpr double influence = 30;  // [mm] from a touch, beyond which bones stay as they are
  // Takes the bones as they are for the state at rest. Nodes of the left move as one with those of
  // the right that they mirror, nodes in the plane of symmetry stay in it.
  ElasticBones(const std::vector<PlacedBone>& bones, const Mirror& mirror);
  // moves the nodes of all bones that touches name towards the minimum of (1) and (2)
  void press(std::vector<PlacedBone>& bones, const std::vector<Touch>& touches, double weight,
             int iterations) const;

 private:
  // (1) and the anchor of (2) of one bone, `times` over; near: the bricks that can move
  double own_energy(std::size_t bone, const std::vector<std::array<int, 8>>& bricks,
                    const std::vector<std::size_t>& near, double times, const Point* x,
                    Point* gradient) const;
  // inverse of the edges of the eight corners: row and column, then corner
  struct alignas(64) Rest {
    std::array<double, 72> m;
  };
  std::vector<std::vector<Rest>> rest_;
  std::vector<std::vector<Point>> start_;
  const Mirror& mirror_;
};

}  // namespace fabrica::body
