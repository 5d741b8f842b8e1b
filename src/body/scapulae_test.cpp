#include "body/scapulae.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "body/mesh/quality.h"

using namespace fabrica::body;
using doctest::Approx;

namespace {

// a box of one brick that spans `low` to `high` [mm, global], of a bone that the skeleton carries
PlacedBone box(const std::string& name, Side side, const Skeleton& skeleton, Point low,
               Point high) {
  if (side == Side::left) {
    low.y = -low.y, high.y = -high.y;
    std::swap(low.y, high.y);
  }
  PlacedBone bone;
  bone.mesh.name = name, bone.side = side;
  const bool rib = name.starts_with("rib");
  bone.frame = rib ? "thorax" : name, bone.region = rib ? Region::thorax : Region::arm;
  for (const double z : {low.z, high.z})
    for (const auto& [x, y] : {std::pair{low.x, low.y}, std::pair{high.x, low.y},
                               std::pair{high.x, high.y}, std::pair{low.x, high.y}})
      bone.mesh.nodes.push_back({x, y, z});
  bone.mesh.bricks = {{0, 1, 2, 3, 4, 5, 6, 7}};
  bone.mesh.surface = boundary_quads(bone.mesh.bricks);
  if (side == Side::left) {  // nodes in the order of the right bone's
    std::swap(bone.mesh.nodes[0], bone.mesh.nodes[3]),
        std::swap(bone.mesh.nodes[1], bone.mesh.nodes[2]);
    std::swap(bone.mesh.nodes[4], bone.mesh.nodes[7]),
        std::swap(bone.mesh.nodes[5], bone.mesh.nodes[6]);
  }
  const Placement there = skeleton.bone(name, bone.frame, side);
  for (Point& p : bone.mesh.nodes) p = there.inverse(p);
  place(bone, skeleton);
  return bone;
}

// ribs as a box about the midline whose back stands at x = `back`, blades 60 mm below their joints
std::vector<PlacedBone> shoulders(const Skeleton& skeleton, double back) {
  std::vector<PlacedBone> bones;
  const Point joint = skeleton.joint_centre("scapula", Side::right);
  for (const Side side : {Side::right, Side::left}) {
    bones.push_back(box("rib5", side, skeleton, {back, -100, 300}, {back + 200, -0.5, 520}));
    bones.push_back(box("clavicle", side, skeleton, {0, -140, 520}, {10, -60, 530}));
    bones.push_back(box("scapula", side, skeleton, {joint.x - 50, -120, joint.z - 130},
                        {joint.x - 45, -60, joint.z - 60}));
  }
  return bones;
}

// [mm] before the box of the ribs: their back is the nearest face
double least_room(const std::vector<PlacedBone>& bones, double back) {
  double room = 1e30;
  for (const PlacedBone& bone : bones)
    if (bone.mesh.name == "scapula")
      for (const Point& p : bone.nodes)
        room = std::min(room, std::max({back - p.x, -100 - p.y, p.y - 100}));
  return room;
}

}  // namespace

// The hull of a box is the box. Directions lie less than 2 degrees apart, and a box of 200 mm seems
// larger by at most 200 sin(2 degrees) = 7 mm for it.
TEST_CASE("shoulder blades turn about the clavicle until they lie on the ribs") {
  Skeleton skeleton(make_subject("male", 1750, 77), named_posture("standing"));
  const Skeleton before = skeleton;
  const Point joint = skeleton.joint_centre("scapula", Side::right);
  const double back = joint.x - 62;  // 12 to 17 mm behind the blade
  std::vector<PlacedBone> bones = shoulders(skeleton, back);
  CHECK(least_room(bones, back) == Approx(-17));
  const ScapulaRest rest = rest_scapulae(skeleton, bones);
  CHECK(rest.depth >= 17);
  CHECK(rest.left <= 0.3);
  CHECK(least_room(bones, back) >= -0.3);
  CHECK(least_room(bones, back) < 7);
  for (const Side side : {Side::right, Side::left}) {
    // the joint of clavicle and blade stays together, the arm keeps its direction
    const Point c = skeleton.joint_centre("scapula", side),
                c0 = before.joint_centre("scapula", side);
    for (const char* bone : {"clavicle", "scapula"}) {
      const Point own = before.frame(bone, side).inverse(c0);
      CHECK(norm(skeleton.frame(bone, side)(own) - c) < 1e-9);
    }
    for (const char* bone : {"humerus", "ulna", "hand", "hand_phalanx2_distal"})
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          CHECK(skeleton.frame(bone, side).R(i, j) ==
                Approx(before.frame(bone, side).R(i, j)).epsilon(1e-9));
  }
  // mirror images to the bit
  const PlacedBone &right = bones[std::size_t(find_bone(bones, "scapula", Side::right))],
                   &left = bones[std::size_t(find_bone(bones, "scapula", Side::left))];
  for (std::size_t n = 0; n < right.nodes.size(); ++n) {
    const Point p = mirror(left.nodes[n]);
    CHECK((right.nodes[n].x == p.x && right.nodes[n].y == p.y && right.nodes[n].z == p.z));
  }
}

TEST_CASE("shoulder blades off the ribs stay where the posture has them") {
  Skeleton skeleton(make_subject("male", 1750, 77), named_posture("standing"));
  const double back = skeleton.joint_centre("scapula", Side::right).x - 30;
  std::vector<PlacedBone> bones = shoulders(skeleton, back);
  const std::vector<Point> start = bones[2].nodes;
  const ScapulaRest rest = rest_scapulae(skeleton, bones);
  CHECK(rest.turn == 0);
  CHECK(rest.arm == 0);
  for (std::size_t n = 0; n < start.size(); ++n) CHECK(norm(bones[2].nodes[n] - start[n]) < 1e-9);
}
