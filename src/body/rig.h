#pragma once
// The test rig of a bone, read from a file: which bones are tested, where they stand, which ends
// are potted, how the pots move. docs/manual/rig.md describes every key.
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "body/placed_bone.h"

namespace fabrica::body {

// "right.rib5", "left.hip_bone", "sacrum"
struct BoneName {
  std::string bone;
  Side side = Side::midline;
  std::string text;  // as written
};

// A curve of a motion over time: displacement [mm] or velocity [mm/ms]; of rotations [rad].
struct RigMotion {
  int dof = 0;  // 0 to 5: x y z rx ry rz
  bool velocity = false;
  std::vector<std::pair<double, double>> points;  // [ms], value
};

// A bone that is taken out of the body and laid into the rig: the pivot of pot `from` at `at`, that
// of pot `to` on the x axis through it; z is the direction `up` of the bone's frame made square to
// x or, without it, the direction square to x in which the bone is flattest, towards the frame's
// +Z.
struct RigSpecimen {
  BoneName bone;
  std::string from, to;
  Point at{0, 0, 0};
  std::optional<Point> up;
};

// The end of a bone that is potted: all nodes within `depth` of the farthest node in direction
// `toward` of the bone's frame become one rigid body. Its degrees of freedom are held unless they
// are free or moved. The pivot, about which it turns, is its centre of mass.
struct RigPot {
  std::string name;
  std::vector<BoneName> bones;
  Point toward{0, 0, 1};
  double depth = 0;            // [mm]
  std::array<bool, 6> free{};  // x y z rx ry rz
  std::optional<RigMotion> motion;
};

struct Rig {
  std::string path;
  double end_time = 0;        // [ms]
  double output_every = 0.1;  // [ms] of histories
  double states_every = 0;    // [ms] of the animation; 0: a twentieth of the end time
  std::vector<RigSpecimen> specimens;
  std::vector<RigPot> pots;

  // names of the bones to make, each once
  std::vector<std::string> bones() const;
  // is this bone part of the rig?
  bool tests(const PlacedBone& bone) const;
};

// Throws BodyError with file, line, key and what may be written.
Rig read_rig(const std::string& path);

}  // namespace fabrica::body
