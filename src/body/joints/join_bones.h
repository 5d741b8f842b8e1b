#pragma once
// All that lies between the bones, in the order in which it depends on one another.
#include "body/joints/cartilage.h"
#include "body/joints/disc.h"
#include "body/joints/ligaments.h"
#include "body/joints/meniscus.h"

namespace fabrica::body {

struct JoinReport {
  double endplate_shift = 0;   // [mm] largest
  double symphysis_shift = 0;  // [mm] of either pubic bone
  ClearanceReport clearance;
  std::vector<DiscReport> discs;
  std::vector<ArticulationReport> articulations;
  std::vector<LigamentReport> ligaments;
  std::vector<MeniscusReport> menisci;
};

// Fits endplates and symphysis, clears the bones from one another (both move nodes of the bones),
// then adds discs, joints by surfaces, menisci and ligaments. Throws BodyError that names what does
// not fit.
BetweenBones join_bones(std::vector<PlacedBone>& bones, JoinReport& report);

// Bones and pieces that nothing connects with the rest, over shared nodes, ties, contacts,
// ligaments (names, or empty where all hang together).
std::vector<std::string> unconnected(const std::vector<PlacedBone>& bones,
                                     const BetweenBones& between);

}  // namespace fabrica::body
