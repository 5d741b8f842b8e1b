#pragma once
// The list of places where bones meet (data/anatomy/joints/articulations.csv), resolved for the
// bones and sides at hand, and the clearing of their surfaces from one another.
#include <string>
#include <vector>

#include "body/piece.h"

namespace fabrica::body {

// meniscal: sliding, with menisci between that the second bone carries; pivot: sliding, the head of
// the first bone turns in a notch of the second and slides all around; grown: one layer that both
// bones have grown to
enum class ArticulationKind { sliding, pivot, meniscal, facet, arch, joined, grown, symphysis };

// quarter of the bone's length, in its frame
enum class BoneEnd { any, upper, lower };

struct Articulation {
  std::string name;  // of the row
  Side side;         // midline when both bones are
  int a, b;          // indices of the bones
  ArticulationKind kind;
  double cartilage_a, cartilage_b;  // [mm]
  double thickest;                  // [mm] of a layer that fills the space of the joint; 0: none
  double reach;                     // [mm] faces this near the other bone belong to the joint
  // of bone a that the joint is in: two bones may meet at both
  BoneEnd end;
  int strands;       // of the capsule
  double stiffness;  // [kN/mm] of the capsule
  std::string source;
};

// All rows whose bones are both there: right and left of a paired row, both sides of a midline row
// that says facet.
std::vector<Articulation> articulations(const std::vector<PlacedBone>& bones);

// Gap [mm] that the bones of an articulation shall have where they are nearest: room for cartilage.
double wanted_gap(const Articulation& joint);

// The same of a meniscal joint on its plateau, all the room of its cartilage: the path of the joint
// leaves it, and what coarse faces lack of it is what they are off.
double plateau_gap(const Articulation& joint);

struct ClearanceReport {
  double whole_shift = 0;  // [mm] largest by which a bone was moved as a whole
  std::string whole_shift_bone;
  double largest_shift = 0;  // [mm] of a node, after that
  std::string largest_shift_bone;
  double least_gap = 0;  // [mm] that is left between any two bones
  std::string least_gap_pair;
  std::vector<std::string> left;     // pairs that still overlap
  double least_scaled_jacobian = 1;  // of the bricks of the bones that moved
  std::string least_scaled_jacobian_bone;
};

// Clears bones that stand nearer to each other than the wanted gap (0.2 mm where no joint is, 0.05
// where they are tied): first groups of them move whole (shift_bones.h), then they are pressed
// apart as elastic bodies (elastic.h), then the worst bricks are mended (mesh/polish.h). Changes
// nodes, placements and mesh.nodes; what is left is reported. Bones of the two sides that mirror
// each other before do so exactly after.
ClearanceReport clear_bones(std::vector<PlacedBone>& bones);

}  // namespace fabrica::body
