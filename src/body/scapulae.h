#pragma once
// Shoulder blades ride on the rib cage. Joint angles alone let a blade sink between the ribs; here
// the clavicle turns about the sternum and the blade about the clavicle, as little as it takes,
// until no node of the blade lies under the convex hull of the ribs. A stiff blade bridges what is
// hollow between them, and muscle fills it. The hull is its support function over many directions,
//   h_k = max over nodes y of ribs of d_k . y,   depth of x: min_k h_k - d_k . x,        (1)
// over the d_k that point to the side of the blade. The turns u (two vectors) minimise
//   sum_i max(0, depth_i(u))^2 + s N l^2 (|u_blade|^2 + w |u_clavicle|^2)                (2)
// over the N nodes under the hull, a step of Gauss-Newton at a time. The arm keeps its directions
// and follows the shoulder joint.
#include <vector>

#include "body/placed_bone.h"
#include "body/skeleton.h"

namespace fabrica::body {

struct ScapulaRest {
  double depth = 0;  // [mm] of the deepest node of either blade under the hull, before
  double left = 0;   // [mm] the same after
  double turn = 0;   // [deg] largest turn of a blade in space
  double arm = 0;    // [mm] largest way of a shoulder joint
};

// Moves frames of the skeleton and the bones that they carry. Blades without clavicle or ribs stay;
// bones that mirror each other before do so after.
ScapulaRest rest_scapulae(Skeleton& skeleton, std::vector<PlacedBone>& bones);

}  // namespace fabrica::body
