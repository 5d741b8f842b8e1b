#pragma once
// Every row of data/anatomy/joints/ligaments.csv as tension-only strands between surface nodes of
// two bones. One that winds around a head and glides on it (attach around) ends instead in a hub, a
// node on the axis of the head that spokes hold in the bone: it does not wind up when the head
// turns.
//
// A ligament is free of force in the posture the body is made in: discs and capsules are too, and
// what a posture does to each is not measured. It is slack by s = max(reference length - distance
// in the posture, 0), so that one that a posture relaxes takes up no force before the reference
// length is reached again.
#include "body/joints/ligament_law.h"
#include "body/piece.h"

namespace fabrica::body {

struct LigamentReport {
  std::string name;
  int strands = 0;
  double length = 0;     // [mm] between the bones, as posed
  double reference = 0;  // [mm] of the table, scaled as the bones
  double slack = 0;      // [mm]
  double stiffness = 0;  // [kN/mm] of the whole ligament, first slope
  double distance = 0;   // [mm] from a table point to the surface node that stands for it, largest
};

// Adds one piece for each row and side whose bones are there. Throws BodyError naming row and
// figure when an end lies more than 25 mm from its bone.
std::vector<LigamentReport> add_ligaments(const std::vector<PlacedBone>& bones,
                                          BetweenBones& between);

// The law of the facet capsule between two vertebrae ("L3", "L4"); that of the level above where
// the table has none.
struct CapsuleLaw {
  LigamentStiffness stiffness;
  int strands = 4;
  std::string source, flag;
};
CapsuleLaw facet_capsule(const std::string& upper, const std::string& lower);

}  // namespace fabrica::body
