#pragma once
// The menisci in plan, from data/anatomy/joints/menisci.csv: seen along the tibia, with s from the
// anterior end (0) to the posterior one (1) and r from the inner edge (0) to the rim (1),
//   p(s, r) = (1 - r) a(s) + r b(s),   h(s, r) = e + r (H(s) - e)                              (1)
// a, b, H: curves of Catmull and Rom through the stations of the table; e the height of the inner
// edge. As the knee bends the stations travel backwards with the femur, to their places at 120
// degrees by the share of its own way there (s_x of docs/theory/knee.md),
//   share = s_x(f) / s_x(120) = q (1.814 - 0.814 q),   q = min(f / 120, 1).                   (2)
#include <array>
#include <string>
#include <vector>

#include "body/placed_bone.h"

namespace fabrica::body {

struct PlanPoint {
  double x = 0, y = 0;  // [mm] frame of the tibia, right side, scaled as the bone
};

class MeniscusPlan {
 public:
  static constexpr double edge_height = 0.8;  // [mm] e; the true edge is sharp
  // "medial" or "lateral", the knee bent by an angle [deg]; throws BodyError where the table has
  // fewer than four stations of it
  MeniscusPlan(const std::string& name, const Point& scale, double flexion);

  PlanPoint at(double s, double r) const;   // (1)
  double height(double s, double r) const;  // [mm] (1)
  // [mm] wanted at a place: 0 outside of the meniscus
  double height_at(const PlanPoint& p) const;
  double rim_length() const { return length(1); }    // [mm]
  double inner_length() const { return length(0); }  // [mm]
  const std::string& name() const { return name_; }

 private:
  struct Station {
    PlanPoint inner, outer;
    double rim;
  };
  Station station(double s) const;
  double length(double r) const;

  std::string name_;
  std::vector<Station> stations_;
};

}  // namespace fabrica::body
