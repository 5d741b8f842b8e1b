#pragma once
// Where the body is to be, rather than its joint angles, and the posture that brings it there.
//
//   h_point = [0, 0, 0]            # mm; mid-point of the hip joint centres
//   torso_angle = 23               # degrees rearward of the vertical, from the H-point to the
//   C7/T1 disc head_level = true              # Frankfurt plane level [wheel] # hands grip its rim
//   centre = [420, 0, 330]
//   diameter = 370
//   tilt = 25                      # degrees of the rim's plane from the vertical, top away from
//   the driver hands = [60, -60]              # degrees from the top: right, left; positive
//   clockwise for the driver [foot.right]                   # also foot.left; either point may be
//   left out heel = [760, -120, -200]       # skin under the heel ball = [870, -130, -70]        #
//   head of the first metatarsal
#include <optional>
#include <string>
#include <vector>

#include "body/posture.h"
#include "body/subject.h"

namespace fabrica::body {

struct Reach {
  std::string name;   // "right hand"
  std::string frame;  // carrier of the point
  Side side = Side::right;
  Point standing;  // the point in the standing man of the tables [mm, right side]
  Point target;    // [mm]
};
struct Goals {
  std::string name;  // file
  std::optional<Point> h_point;
  std::optional<double> torso_angle;  // [deg]
  bool head_level = false;
  bool grip = false;
  std::vector<Reach> hands, feet;
};

// Reads a goals file. Throws BodyError naming file, line, key and remedy.
Goals read_goals(const std::string& path);

// Turns joints within their ranges until the goals are met, from the angles of `posture` and near
// to them. Throws BodyError that names the goal that cannot be reached, by how much it fails and
// the nearest point that can.
void solve(Posture& posture, const Subject& subject, const Goals& goals);

}  // namespace fabrica::body
