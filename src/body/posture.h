#pragma once
// Joint angles by name. "knee.right.flexion" = 110 [deg]; the side is left out at midline joints
// ("L4.flexion") and the coordinate where a joint has but one or its first is meant ("knee.right").
// Groups spread over their chain: "lumbar.flexion", "thoracic.rotation", "neck.flexion". Without a
// side, a paired joint sets both sides.
#include <map>
#include <string>
#include <vector>

#include "body/placement.h"

namespace fabrica::body {

// One rotation of a joint, a row of data/anatomy/joint_axes.csv.
struct JointAxis {
  std::string joint, coordinate;
  Point axis;        // unit, right side or midline, standing body
  double low, high;  // [deg] range from the standing posture
  std::string source;
};
// What the bones of a joint do beside its turn by the first of its angles, a row of
// data/anatomy/joint_paths.csv. Rows of a joint follow one another in equal steps from angle 0.
struct PathPoint {
  double angle;            // [deg] the first of the joint
  Point shift;             // [mm] of the child with the centre, standing body, right side
  double varus, internal;  // [deg] turns of the child about x and z, standing body, right side
};
// One joint, a row of data/anatomy/joint_tree.csv, with its axes in order of (1) of skeleton.h.
struct Joint {
  std::string name, parent, child;
  bool paired;
  Point centre;  // [mm] standing, right side or midline
  std::vector<JointAxis> axes;
  std::vector<PathPoint> path;  // empty: it turns about its centre
  // at an angle [deg]: curve of Catmull and Rom through the rows; zero without a path
  PathPoint path_at(double angle) const;
};
// all joints, parents before children
const std::vector<Joint>& joint_tree();
// the one of that name, nullptr if there is none
const Joint* find_joint(const std::string& name);

struct Posture {
  std::string name = "standing";
  std::map<std::string, double> angle;  // [deg] by full name; absent: 0
  Placement pelvis;                     // moves the whole body; its translation is the H-point
  std::string goals;                    // name of the goals that it was solved for
  double get(const std::string& joint, Side side, const std::string& coordinate) const;
};

// "standing", "driver", "passenger", "supine"; throws BodyError that lists them
Posture named_posture(const std::string& name);
// Sets an angle from "knee.right=110". Throws BodyError for an unknown name (nearest names) or a
// value out of range (the range and its source).
void set_angle(Posture& posture, const std::string& assignment);
void set_angle(Posture& posture, const std::string& name, double degrees);

}  // namespace fabrica::body
