#pragma once
// Where a disc lies in the posed spine, and the section it fills.
#include <array>
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
  double lower = 0, upper = 0;  // [mm] along the normal, from the plane
  double height() const { return upper - lower; }
};

// The room between two endplates. Their heights are taken on rays, smoothed over the section (the
// faces of coarse bones are steps) and carried on where a rim is missing.
class DiscSpace {
 public:
  // the section of the table's area, or as much of it as lies between both endplates
  enum class Section { table, between_endplates };
  DiscSpace(const std::vector<PlacedBone>& bones, const DiscRow& row, Section section);
  // [mm] of the section's edge in direction phi, from forward towards left
  double radius(double phi) const;
  // lower and upper end of the disc at a place of the section [mm]
  std::array<Point, 2> ends(double forward, double left) const;
  const DiscFrame& frame() const { return frame_; }
  // [mm] mean over the section
  double mean_height() const;
  // Lowers the highest places alike, as at the rounded rims of bones, until the mean is at most
  // this [mm]: there the disc ends before the bone that the mesh lacks.
  void limit_mean_height(double most);

 private:
  static constexpr int directions = 48, rings = 8;
  // nothing where a ray misses an endplate or meets a wall
  std::optional<DiscLine> ray(double forward, double left) const;
  void draw_outline(const DiscRow& row, Section section);
  void take_heights();
  DiscLine& at(int ring, int direction) {
    return heights_[std::size_t(ring * directions + (direction + directions) % directions)];
  }
  const DiscLine& at(int ring, int direction) const {
    return heights_[std::size_t(ring * directions + (direction + directions) % directions)];
  }

  DiscFrame frame_;
  BoneSurface upper_, lower_;
  std::vector<double> radius_;
  std::vector<DiscLine> heights_;  // ring 0 is the middle
};

}  // namespace fabrica::body
