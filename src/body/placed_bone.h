#pragma once
// A meshed bone of one side in its place in the posed body.
#include <string>
#include <vector>

#include "body/mesh/bone_mesh.h"
#include "body/placement.h"

namespace fabrica::body {

class Skeleton;

enum class Region { head = 1, neck, thorax, abdomen, pelvis, arm, leg };

struct PlacedBone {
  BoneMesh mesh;  // bone frame; of the left side already mirrored()
  Side side = Side::midline;
  Region region = Region::thorax;
  std::string frame;         // carrier frame, "femur", "C3", "thorax", without side
  Placement placement;       // of this bone: the ribs' own, see skeleton.h
  std::vector<Point> nodes;  // [mm] global: placement(mesh.nodes[i])
  double faster = 1;         // of a test that is run so many times faster than it was done
};

// puts a bone where the skeleton has its frame
void place(PlacedBone& bone, const Skeleton& skeleton);

// "head", "neck", "thorax", "abdomen", "pelvis", "arm", "leg"
const char* name_of(Region region);
// "right", "left", "mid"
const char* name_of(Side side);
// A bone by its name, "right.rib5", "left.hip_bone", "sacrum"; without a side on the midline or, of
// a pair, both.
struct BoneName {
  std::string bone;
  Side side = Side::midline;
  std::string text;  // as written
};
BoneName bone_named(const std::string& text);
// the first index of a bone of that name and side, or -1
int find_bone(const std::vector<PlacedBone>& bones, const std::string& name, Side side);
// name of a part, region.side.tissue, e.g. "thorax.left.rib05.cortical" (numbers of ribs and rays
// have two digits)
std::string part_name(const PlacedBone& bone, const std::string& tissue);

}  // namespace fabrica::body
