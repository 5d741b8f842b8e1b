#pragma once
// The test rig of bones, read from a file: which bones are tested, where they stand, which ends are
// potted, what touches them, how all this moves. docs/manual/rig.md describes every key.
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "body/placed_bone.h"

namespace fabrica::body {

// A curve over time: displacement [mm], velocity [mm/ms] or force [kN]; of rotations [rad],
// [rad/ms], [kN mm].
struct RigCurve {
  int dof = 0;  // 0 to 5: x y z rx ry rz
  enum Kind { displacement, velocity, force } kind = displacement;
  std::vector<std::pair<double, double>> points;  // [ms], value
};

// How a rigid part of the rig moves: its degrees of freedom are held unless they are free, moved
// or loaded.
struct RigSupport {
  std::array<bool, 6> free{};     // x y z rx ry rz
  std::vector<RigCurve> motions;  // one a degree of freedom
  std::vector<RigCurve> loads;    // at the pivot
  Point velocity{0, 0, 0};        // [mm/ms] at the start

  bool moves(int dof) const;  // by a motion
  bool holds(std::size_t dof) const;
};

// A bone that is taken out of the body and laid into the rig: the pivot of pot `from` at `at`, that
// of pot `to` on the x axis through it; z is the direction `up` of the bone's frame made square to
// x or, without it, the direction square to x in which the specimen is flattest, towards the
// frame's +Z. With an `offset` the whole is turned about z until `to` stands beside x. Without pots
// the bone's frame is the rig's, its origin at `at`. The bones `with` it keep their places beside
// it and what joins them to it.
struct RigSpecimen {
  BoneName bone;
  std::vector<BoneName> with;
  std::string from, to;  // both empty: by the frame
  double offset = 0;     // [mm] of the pivot of `to` along y
  Point at{0, 0, 0};
  std::optional<Point> up;
  double faster = 1;  // than the test it stands for: rates of the bones' laws are as much higher

  std::vector<BoneName> bones() const;  // the bone and those with it
};

// The end of a bone that is potted: all nodes within `depth` of the farthest node in direction
// `toward` of the bone's frame become one rigid body. The pivot, about which it turns, is the mean
// of these nodes or, with `pivot`, a point that far behind the open face of the pot, amid the nodes
// there, or `pivot_at`, a point of the bone's frame.
struct RigPot {
  std::string name;
  std::vector<BoneName> bones;
  Point toward{0, 0, 1};
  double depth = 0;               // [mm]
  std::optional<double> pivot;    // [mm]
  std::optional<Point> pivot_at;  // [mm] in the bone's frame, instead
  double mass = 0;                // [kg] of the cup, beside that of the bone in it
  // [kN/mm2] of the resin between bone and cup: force across by length and displacement; 0: the
  // bone is held rigidly
  double foundation = 0;
  RigSupport support;
};

// A rigid part of the test machine that touches bones: impactor, plate, roller. It is moved from
// `at` against `toward` until it stands clear of the bones by `gap`.
struct RigFixture {
  enum Shape { ball, cylinder, box };
  // Deformable layer on the face of a box that looks toward the bones: low-density foam.
  struct Pad {
    double thickness = 0;                                // [mm]
    double density = 0;                                  // [kg/mm3]
    double modulus = 0;                                  // [GPa] in tension
    std::vector<std::pair<double, double>> compression;  // nominal strain, stress [GPa]
  };
  std::string name;
  Shape shape = ball;
  double radius = 0;    // [mm] of ball and cylinder
  double length = 0;    // [mm] of the cylinder along its axis
  Point size{0, 0, 0};  // [mm] of the box: along axis, across, along toward
  Point axis{0, 1, 0};  // of the cylinder, first edge of the box
  Point at{0, 0, 0}, toward{0, 0, -1};
  double gap = 0.1;    // [mm]
  double element = 5;  // [mm] edge
  double mass = 0;     // [kg]
  double friction = 0.3;
  std::vector<BoneName> touches;
  std::optional<Pad> pad;
  RigSupport support;
};

// does the pot hold an end of this bone?
bool holds(const RigPot& pot, const BoneName& bone);

struct Rig {
  std::string path;
  double end_time = 0;        // [ms]
  double output_every = 0.1;  // [ms] of histories
  double states_every = 0;    // [ms] of the animation; 0: a twentieth of the end time
  double damping = 0;         // [1/ms] of all motion
  std::vector<RigSpecimen> specimens;
  std::vector<RigPot> pots;
  std::vector<RigFixture> fixtures;

  // are bones joined in it?
  bool joined() const;
  // the bones to make, each once, as BodyOptions::only takes them
  std::vector<std::string> bones() const;
  // is this bone part of the rig?
  bool tests(const PlacedBone& bone) const;
  bool has(const BoneName& name) const;
};

// Throws BodyError with file, line, key and what may be written.
Rig read_rig(const std::string& path);

}  // namespace fabrica::body
