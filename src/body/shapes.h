#pragma once
// Simple solids of bricks: ball, cylinder, box. Of one edge length, about the origin.
#include <array>
#include <vector>

#include "body/placement.h"

namespace fabrica::body {

struct ShapeMesh {
  std::vector<Point> nodes;                // [mm]
  std::vector<std::array<int, 8>> bricks;  // LS-DYNA order
  std::size_t pad_bricks = 0;              // the last of them are those of a pad

  double volume() const;  // [mm3] without the pad
};

// A box, edges along x, y, z [mm]; below it a pad of that thickness [mm], of two layers of bricks
// or more, that share the nodes of the face.
ShapeMesh box_mesh(const Point& size, double edge, double pad = 0);
// a cylinder along x
ShapeMesh cylinder_mesh(double radius, double length, double edge);
ShapeMesh ball_mesh(double radius, double edge);

}  // namespace fabrica::body
