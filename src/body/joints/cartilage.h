#pragma once
// Joints by surfaces: cartilage as a layer of bricks on both bones with contact between them,
// capsules of strands around them, ties where bone has grown into cartilage, the disc of the
// symphysis.
#include "body/joints/articulation.h"

namespace fabrica::body {

struct ArticulationReport {
  std::string name;  // region.side.joint
  int faces_a = 0, faces_b = 0;
  double gap = 0;          // [mm] least between the bones, before cartilage
  double contact_gap = 0;  // [mm] least between the two layers
  double reach = 0;        // [mm] that was needed to find faces
  std::string omitted;     // why nothing was made; empty: made
};

// Adds the pieces, contacts and ties of all articulations of the bones.
std::vector<ArticulationReport> add_articulations(const std::vector<PlacedBone>& bones,
                                                  BetweenBones& between);

}  // namespace fabrica::body
