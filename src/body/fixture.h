#pragma once
// Rigid parts of a test machine: impactor, plate, roller.
#include "body/mount.h"
#include "body/rig_cards.h"

namespace fabrica::body {

// Moves a fixture from its place against its direction until it stands clear of the bones that it
// touches, adds it with its contact. Throws BodyError where it passes them by.
MountedPart add_fixture(const Rig& rig, const RigFixture& fixture, const Body& body,
                        AssembledBody& assembled, Builder& builder, RigCards& cards);

}  // namespace fabrica::body
