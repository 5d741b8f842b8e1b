#pragma once
// The local stage (mesh/polish.h) for a bone whose nodes were moved after it was meshed.
#include <vector>

#include "body/joints/touch.h"
#include "body/mesh/untangle.h"

namespace fabrica::body {

// Moves `nodes` of a mesh: bricks and shells get back the quality that their maker asked for, as
// far as they can while the surface stays where it is and the nodes of `planes` stay in front of
// them. `own`: the nodes mirror themselves about y = 0 and stay so.
void mend(const BoneMesh& mesh, std::vector<Point>& nodes, bool own, const BoneSurface& surface,
          const std::vector<PlaneNode>& planes);

// Other bones that a bone or its mirror image `twin` (-1: none) touches, as planes that its nodes
// stay in front of: the image gets its nodes, and warped faces of the midline may lie otherwise on
// its side.
std::vector<PlaneNode> planes_of(const std::vector<Touch>& touches, int bone, int twin,
                                 const std::vector<PlacedBone>& bones);

}  // namespace fabrica::body
