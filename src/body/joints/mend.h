#pragma once
// The local stage (mesh/polish.h) for a bone whose nodes were moved after it was meshed.
#include <vector>

#include "body/joints/bone_surface.h"
#include "body/mesh/untangle.h"

namespace fabrica::body {

// Moves `nodes` of a mesh: bricks and shells get back the quality that their maker asked for, as
// far as they can while the surface stays where it is and the nodes of `planes` stay in front of
// them. `own`: the nodes mirror themselves about y = 0 and stay so.
void mend(const BoneMesh& mesh, std::vector<Point>& nodes, bool own, const BoneSurface& surface,
          const std::vector<PlaneNode>& planes);

}  // namespace fabrica::body
