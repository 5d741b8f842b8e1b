#pragma once
// The menisci of both knees: wedges of bricks swept along the plan of meniscus_plan.h, in the room
// between the cartilage of femur and tibia as the knee stands. Along the tibia's axis, over a place
// of the plan with the tibia's cartilage at t and the femur's at f:
//   bottom = t + g,   top = min(bottom + h, f - g),   g = 0.1 mm                               (1)
// Where f - t leaves less than the inner edge's height the inner edge is drawn out to the rim.
// Fibres run along the sweep: springs without compression on its edges, each for a quarter of the
// bricks that share it,
//   k = (E_fibre - E) V / (4 L^2).                                                             (2)
// Horns are tied to the tibia by strands, rims by those of the coronary ligaments
// (data/anatomy/joints/meniscus_ligaments.csv). Contact above with the femur, below with the tibia.
#include "body/joints/meniscus_plan.h"
#include "body/piece.h"

namespace fabrica::body {

struct MeniscusReport {
  std::string name;  // "leg.right.medial_meniscus"
  int bricks = 0, without_room = 0;
  double volume = 0;                        // [mm3]
  double rim_length = 0, inner_length = 0;  // [mm] as meshed
  double rim_height = 0;                    // [mm] mean
  double drawn_in = 0;                      // [mm] largest by which the inner edge gave way
  double least_scaled_jacobian = 1;
};

// Adds the menisci of every articulation of the kind meniscal. Its cartilage must have been made
// before. Throws BodyError that names a meniscus without any room.
std::vector<MeniscusReport> add_menisci(const std::vector<PlacedBone>& bones,
                                        BetweenBones& between);

// What the menisci of a knee want over its plateau.
class MeniscusRoom {
 public:
  MeniscusRoom(const PlacedBone& femur, const PlacedBone& tibia);
  double height(const Point& p) const;  // [mm] over a place (global); 0 beside them

 private:
  const PlacedBone& tibia_;
  std::vector<MeniscusPlan> plans_;
};

}  // namespace fabrica::body
