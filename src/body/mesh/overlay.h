#pragma once
// Bricks of a solid cut from a background grid: a cell belongs to the solid when most of its 4^3
// samples lie inside the field grown outward by `growth` (which closes the holes that a coarse grid
// would make in thin plates). The cells are then repaired until their boundary is a manifold, so
// that no two bricks meet only along an edge or at a corner.
#include <vector>

#include "body/mesh/distance_field.h"
#include "body/mesh/quality.h"

namespace fabrica::body {

struct CellGrid {
  Axes axes;
  Point origin{0, 0, 0};  // of cell (0, 0, 0), in grid axes
  double spacing = 1;
  std::array<int, 3> count{};
  std::vector<unsigned char> inside;
  std::vector<float> fraction;  // of the cell's samples that are inside
  bool symmetric = false;       // about the middle of the second axis, which is y = 0

  int index(int i, int j, int k) const { return (k * count[1] + j) * count[0] + i; }
};

// shift: of the grid, in cells. symmetric: the field is its own mirror image y -> -y, and so shall
// the cells be: they meet in the plane y = 0, and the shift along y does not count.
CellGrid rasterise(const DistanceField& field, double spacing, double growth, const Point& shift,
                   bool symmetric = false);

// Flips the cheapest cells until around each grid vertex the cells inside and those outside are
// each connected through faces; keeps the largest piece and fills closed cavities. False when no
// repair was found.
bool repair(CellGrid& grid);

// nodes and bricks of the cells inside; of a symmetric grid nodes with their images, and quads of
// the left half that mirror those of the right one
BoneMesh bricks_of(const CellGrid& grid);

// A layer of bricks behind the whole boundary of a region of bricks (region[brick] = 1): each node
// of the boundary gets a twin inside, `depth` mm towards the centres of the region's bricks around
// it; the region's bricks take the twins, and each face of the boundary becomes a brick from its
// twins (corners 0 to 3) to itself (4 to 7). The boundary's own nodes stay shared with the bricks
// outside the region. New bricks follow the old ones; their layer is 1.
struct Twins {
  int node, twin;
};
std::vector<Twins> add_pillow(BoneMesh& mesh, const std::vector<char>& region, double depth);

}  // namespace fabrica::body
