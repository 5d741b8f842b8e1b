#pragma once
// Bones in a test rig: specimens laid into its axes, pots and fixtures as rigid bodies with their
// supports, motions and loads, the force on each.
#include <vector>

#include "body/assembly.h"
#include "body/body.h"
#include "body/rig.h"

namespace fabrica::body {

// Index of a bone that a rig names; throws BodyError where the body has none.
int need_bone(const Rig& rig, const Body& body, const BoneName& name);

// Nodes of a bone that a pot holds.
std::vector<int> potted_nodes(const RigPot& pot, const PlacedBone& bone);

// Leaves the specimens alone of all bones and lays them into the rig's axes. Throws BodyError where
// a specimen was not made or its pots overlap.
void place_specimens(const Rig& rig, Body& body);

// What a pot or a fixture became, in the order of the file, pots first: its number is that of its
// rigid body (rbdout), of a pot that of the section through the bone beside it (secforc: force of
// the bone on the pot), of a fixture that of its contact (rcforc).
struct MountedPart {
  std::int64_t id = 0;
  std::string name;  // "right.rib5 posterior", "impactor"
  Point pivot{0, 0, 0};
};
// Adds pots, fixtures, supports, motions, loads and output to the model of an assembled body.
std::vector<MountedPart> mount(const Rig& rig, const Body& body, AssembledBody& assembled,
                               Builder& builder);

}  // namespace fabrica::body
