#pragma once
// Who the body is: sex, stature and mass give the factors by which each frame's bones are larger
// than those of the 1750 mm, 77 kg man of the tables.
#include <map>
#include <string>

#include "body/placement.h"

namespace fabrica::body {

struct Subject {
  std::string sex = "male";
  double stature = 1750;               // [mm]
  double mass = 77;                    // [kg]
  std::map<std::string, Point> scale;  // frame ("femur", "C3") -> factors along its axes
  // factors of a frame; 1 where the table has none
  Point scale_of(const std::string& frame) const;
};

// Throws BodyError, naming the nearest possible value, outside 1500..2000 mm and 45..120 kg or for
// a sex without tables.
Subject make_subject(const std::string& sex, double stature, double mass);

}  // namespace fabrica::body
