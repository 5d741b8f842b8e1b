#pragma once
// Orientation of shell segments of the old contact kinds, which touch only on the side their normal
// points to
// (*CONTROL_CONTACT ORIEN: 1 surfaces given by parts, 2 all, 3 none).
// Segments that share an edge get the same sense; each connected patch then turns to face the other
// surface: with x the node of the other surface next to the centre c of a segment, the patch faces
// it where sum A n . (x - c)/|x - c| > 0.
#include "solver/contact_surface.h"

namespace fabrica {

// Turns shell segments of a surface so that they face another. start: positions of the nodes of the
// model. Solids stay: their outside is known.
void face_each_other(ContactSurface& surface, const ContactSurface& other,
                     const std::vector<Vec3d>& start);

}  // namespace fabrica
