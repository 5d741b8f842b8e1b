#pragma once
// The whole body, from a wish to its parts: subject, skeleton, meshed bones in their places, and
// what joins them.
#include <functional>
#include <string>
#include <vector>

#include "body/joints/join_bones.h"
#include "body/piece.h"
#include "body/placed_bone.h"
#include "body/scapulae.h"
#include "body/skeleton.h"

namespace fabrica::body {

struct BodyOptions {
  Subject subject = make_subject("male", 1750, 77);
  Posture posture = named_posture("standing");
  Resolution resolution = Resolution::coarse;
  bool joints = true;                                // false: bones alone
  std::vector<std::string> only;                     // bones to make, see bone_named; empty: all
  std::function<void(const std::string&)> progress;  // called with the name of each bone
};

struct Body {
  Subject subject;
  Posture posture;
  Skeleton skeleton;
  Resolution resolution;
  std::vector<PlacedBone> bones;  // head to foot; of pairs right before left
  ScapulaRest scapulae;           // how far shoulder blades turned to lie on the ribs
  BetweenBones between;
  JoinReport joined;  // what was moved and made between the bones
};

// Meshes and places all bones and makes what lies between them. Throws BodyError (bone, stage,
// figure).
Body build_body(const BodyOptions& options);

// "coarse", "standard", "fine"; throws BodyError that lists them
Resolution resolution_named(const std::string& name);
const char* name_of(Resolution resolution);
// the region of a bone by its frame
Region region_of_frame(const std::string& frame);

}  // namespace fabrica::body
