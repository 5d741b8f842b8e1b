#pragma once
// Moves all nodes of a brick mesh at once so that every brick takes its target shape and every
// surface node lies on its surface. The start may be tangled. Per corner of a brick, with the
// matrix J whose columns are the three edges divided by their target lengths, D = det J:
//   E   = f^3 + 0.1 g,   f = |J|^2 / (3 chi^(2/3)),   g = (D^2 + 1) / (2 chi), (1) chi = (D +
//   sqrt(D^2 + eps^2)) / 2 (2)
// f measures shape (1 for a box of the target's proportions), g size; chi keeps both finite where a
// corner is turned over (Garanzha, Kaporin 1999; Escobar et al. 2003). A surface node adds w (phi /
// h)^2.                          (3) Minimised by L-BFGS (Nocedal 1980) for rising w; the result
// depends on the input alone.
#include <vector>

#include "body/mesh/distance_field.h"
#include "body/mesh/quality.h"

namespace fabrica::body {

// the surface that a node must lie on: the zero level of `field` moved inward by `depth`
struct SurfaceNode {
  int node = 0;
  const DistanceField* field = nullptr;
  double depth = 0;
};

// A plane that a node must lie on or, one-sided, in front of: (x - point) . normal >= 0. For the
// local stage.
struct PlaneNode {
  int node = 0;
  Point point{0, 0, 0}, normal{0, 0, 1};
  double weight = 1;
  bool one_sided = false;
};

struct UntangleProblem {
  std::vector<Brick> bricks;
  std::vector<std::array<float, 3>>
      target;  // [mm] edge lengths of each brick along its own three directions
  std::vector<SurfaceNode> surface;
  std::vector<Quad> shells;       // faces that carry a shell, for the local stage
  std::vector<PlaneNode> planes;  // for the local stage
  // of a mesh that is its own mirror image, the node on the other side; empty: it is not
  std::vector<int> image;
  double spacing = 1;  // [mm] h of (3)
};

// Mean of each node and the mirror image of its partner: the mesh mirrors itself to the bit.
void restore_symmetry(const std::vector<int>& image, std::vector<Point>& nodes);

// one minimisation with weight w of (3); moves `nodes`
void untangle(const UntangleProblem& problem, std::vector<Point>& nodes, double weight,
              int iterations);

}  // namespace fabrica::body
