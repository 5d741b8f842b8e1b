#pragma once
// Intervertebral discs, lofted between the endplates of two vertebrae.
//
//   x(rho, phi) = c + rho R(phi) (cos phi e1 + sin phi e2),   0 <= rho <= 1                     (1)
//
// c, e1 (forward), e2 (left) and the normal n of the disc's plane follow from where the anterior
// and posterior longitudinal ligaments meet the two vertebrae; R(phi) is the ellipse of the table
// (width, depth, scaled to its area), drawn in by up to 5 % where a ray along n from the plane
// misses an endplate. Along each ray the disc spans from endplate to endplate, but its mean height
// is at most that of the table: coarse bones have rounded rims, where it ends before them. Nucleus:
// an O-grid over rho <= 0.65 (42 % of the area; 40-45 % in the table); annulus: rings of bricks
// around it, each with two families of tension-only fibres between nodes of its outer face, from
// level to level, at 30 (rim) to 45 degrees to the disc's plane, with a toe (VIVA+ 0.2.5). As many
// columns are around as give the diagonals of those faces these angles. The nodes of the faces are
// tied to the vertebrae.
#include "body/piece.h"

namespace fabrica::body {

struct DiscReport {
  std::string name;
  double height = 0;      // [mm] volume / area of the section
  double wanted = 0;      // [mm] of the table for the mid-size man, scaled
  double area = 0;        // [mm2]
  double volume = 0;      // [mm3]
  double table_area = 0;  // [mm2] scaled
  double least_scaled_jacobian = 0;
  int bricks = 0;
};

// Lowers and raises the endplates towards the disc heights that literature gives, at most 3.5 mm
// each: bodies behind are untouched. In frame C* to L*; changes nodes and mesh.nodes. Gives the
// largest shift [mm].
double fit_endplates(std::vector<PlacedBone>& bones);

// Adds nucleus, annulus rings, fibres and ties of every disc whose two bones are there.
std::vector<DiscReport> add_discs(const std::vector<PlacedBone>& bones, BetweenBones& between);

}  // namespace fabrica::body
