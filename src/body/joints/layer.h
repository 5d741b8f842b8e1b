#pragma once
// How thick a layer of cartilage on faces of a bone is, and which way it grows.
#include <map>
#include <vector>

#include "body/joints/bone_surface.h"

namespace fabrica::body {

struct LayerPlan {
  std::map<int, Point> normal;      // of the nodes of the faces: unit, sharp edges spread
  std::map<int, double> thickness;  // [mm]; nodes without room for a layer are not in it
};

// Normals of the nodes of the faces `quads` of a surface. Sharp edges of coarse bones spread over
// the faces around them: half of each normal is the mean of its neighbours', twice.
std::map<int, Point> layer_normals(const std::vector<Point>& nodes,
                                   const std::vector<std::array<int, 4>>& surface,
                                   const std::vector<int>& quads);

// Thickens a planned layer up to `thickest` [mm] where the other bone leaves room, so that less
// than `gap` [mm] is nowhere left between this layer and one made alike on the other bone:
//   t(p) <= (d(p) - gap) / 2                                                                   (1)
// at the nodes and at points between them (t as the faces interpolate it, d the distance to the
// other bone). Tops p + t n and q + s m cannot meet: |p - q| is at least the larger of d(p) and
// d(q). Nowhere thinner than before.
void fill_room(const std::vector<Point>& nodes, const std::vector<std::array<int, 4>>& surface,
               const std::vector<int>& quads, const BoneSurface& other, double gap, double thickest,
               LayerPlan& plan);

// Takes out the faces that share no edge with another where most of the others hang together: what
// slides over the rest of such a layer would tear a brick that stands alone off its side.
void leave_out_tiles(const std::vector<std::array<int, 4>>& surface, std::vector<int>& quads);

}  // namespace fabrica::body
