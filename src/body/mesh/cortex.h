#pragma once
// The thickness of cortical bone at a place of a bone's surface, from
// data/anatomy/bones/cortical_thickness.csv: a profile along the length of long bones, ribs and
// rays, a region of cortex_regions.csv elsewhere.
#include <string>
#include <vector>

#include "body/mesh/bone_tables.h"

namespace fabrica::body {

// [mm] of a region in cortical_thickness.csv; half of it where the row gives the total of both
// faces
double table_thickness(const std::string& region);

class CortexTable {
 public:
  // shape: of the bone of this name; both must outlive the table
  CortexTable(const std::string& bone, const BoneShape& shape);
  // [mm] at a point of the surface with this outward normal; throws BodyError naming bone and place
  // without a row
  double at(const Point& place, const Point& outward) const;

 private:
  struct Region {
    Point low, high;
    std::string facing;
    double thickness;
  };
  double fraction(const Point& place) const;

  std::string bone_;
  const BoneShape& shape_;
  std::vector<std::array<double, 2>> profile_;  // fraction of the length, thickness
  std::vector<Region> regions_;
  bool from_far_end_ = false;  // the profile starts at the last section of the loft
};

// [mm] for each boundary quad; at most 0.45 of the bone's own thickness there, so that two shells
// leave a core
std::vector<double> cortex_of(const BoneMesh& mesh, const std::string& bone,
                              const BoneShape& shape);

}  // namespace fabrica::body
