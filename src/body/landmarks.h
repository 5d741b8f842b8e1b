#pragma once
// The landmarks of data/anatomy/landmarks.csv, carried by the frames of a posed skeleton.
#include <string>
#include <vector>

#include "body/skeleton.h"

namespace fabrica::body {

struct Landmark {
  std::string name, kind, frame;
  Side side = Side::midline;
  Point x{0, 0, 0};  // [mm] global
  // where the standing or seat column has it, mirrored for the left; absent: not given
  bool in_table = false;
  Point table{0, 0, 0};
};

// All landmarks of both sides. `column`: "stand" or "seat", the column to compare with.
std::vector<Landmark> landmarks(const Skeleton& skeleton, const std::string& column = "stand");
// name,side,frame,x,y,z of all landmarks [mm]
std::string landmarks_csv(const Skeleton& skeleton);

}  // namespace fabrica::body
