#pragma once
// Where a disc lies in the posed spine, and the section it fills.
#include <optional>
#include <string>
#include <vector>

#include "body/joints/bone_surface.h"
#include "body/piece.h"

namespace fabrica::body {

// a row of discs.csv with its bones
struct DiscRow {
  std::string name;
  int upper, lower;                           // bones
  double width, depth, area, height, wanted;  // [mm], [mm2], scaled as the upper vertebra
};
std::vector<DiscRow> disc_rows(const std::vector<PlacedBone>& bones);

struct DiscFrame {
  Point centre, forward, left, normal;  // unit vectors, normal towards the upper vertebra
};
// from the attachments of the longitudinal ligaments in ligaments.csv
DiscFrame disc_frame(const std::vector<PlacedBone>& bones, const DiscRow& row);

// the ends of the disc on a line along the normal through a point of the plane
struct DiscLine {
  SurfacePoint upper, lower;
  double height = 0;
};
class DiscSpace {
 public:
  DiscSpace(const std::vector<PlacedBone>& bones, const DiscRow& row);
  // nothing where a ray misses an endplate or meets a wall
  std::optional<DiscLine> line(double forward, double left) const;
  // [mm] of the section's edge in direction phi, from forward towards left
  double radius(double phi) const;
  const DiscFrame& frame() const { return frame_; }
  // [mm] mean over the section
  double mean_height() const;

 private:
  static constexpr int directions = 48;
  DiscFrame frame_;
  DiscRow row_;
  BoneSurface upper_, lower_;
  std::vector<double> radius_;
};

}  // namespace fabrica::body
