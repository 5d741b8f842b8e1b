#include "body/joints/shift_bones.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace fabrica::body {

namespace {

constexpr double most = 2;        // [mm] shift of a bone against what it hangs on
constexpr double most_free = 4;   // [mm] of the scapula, which muscle alone parts from the ribs
constexpr double ray_reach = 8;   // [mm] deeper is no overlap of two ends
constexpr double most_gap = 0.1;  // [mm] that is asked for here: the rest gives way elastically
constexpr double softness = 0.1;  // s of (1)
constexpr int sweeps = 8;

// what a bone hangs on; empty: it stays where the posture has it
std::string carrier(const std::string& bone) {
  const auto ray = [&](const std::string& name) { return name[name.find("phalanx") + 7]; };
  if (bone.find("phalanx") != std::string::npos) {
    const std::string limb = bone.substr(0, 4);
    const char n = ray(bone);
    if (bone.ends_with("_proximal"))
      return (limb == "hand" ? "metacarpal" : "metatarsal") + std::string(1, n);
    const bool short_ray = n == '1';
    return limb + "_phalanx" + n +
           (bone.ends_with("_distal") && !short_ray ? "_middle" : "_proximal");
  }
  static const std::map<std::string, std::string> list{{"metacarpal1", "trapezium"},
                                                       {"metacarpal2", "trapezoid"},
                                                       {"metacarpal3", "capitate"},
                                                       {"metacarpal4", "hamate"},
                                                       {"metacarpal5", "hamate"},
                                                       {"trapezium", "scaphoid"},
                                                       {"trapezoid", "scaphoid"},
                                                       {"capitate", "lunate"},
                                                       {"hamate", "lunate"},
                                                       {"pisiform", "triquetrum"},
                                                       {"triquetrum", "lunate"},
                                                       {"scaphoid", "lunate"},
                                                       {"lunate", "radius"},
                                                       {"radius", "ulna"},
                                                       {"ulna", "humerus"},
                                                       {"humerus", "scapula"},
                                                       {"scapula", "thorax"},
                                                       {"mandible", "skull"},
                                                       {"skull", "C1"},
                                                       {"hyoid", "C3"},
                                                       {"metatarsal1", "cuneiform_med"},
                                                       {"metatarsal2", "cuneiform_int"},
                                                       {"metatarsal3", "cuneiform_lat"},
                                                       {"metatarsal4", "cuboid"},
                                                       {"metatarsal5", "cuboid"},
                                                       {"cuneiform_med", "navicular"},
                                                       {"cuneiform_int", "navicular"},
                                                       {"cuneiform_lat", "navicular"},
                                                       {"cuboid", "calcaneus"},
                                                       {"navicular", "talus"},
                                                       {"calcaneus", "talus"},
                                                       {"talus", "tibia"},
                                                       {"fibula", "tibia"},
                                                       {"patella", "femur"},
                                                       {"clavicle", "thorax"}};
  const auto at = list.find(bone);
  return at == list.end() ? "" : at->second;
}

bool hangs_on(std::string bone, const std::string& root) {
  for (; !bone.empty(); bone = carrier(bone))
    if (bone == root) return true;
  return false;
}

int depth_of(std::string bone) {
  int depth = 0;
  for (; !bone.empty(); bone = carrier(bone)) ++depth;
  return depth;
}

// a bone and all that hangs on it
struct Group {
  int root;
  int ray_from;  // of a phalanx: the bone before it; else -1
  std::vector<int> bones;
  std::vector<char> member;
};

std::vector<Group> groups_of(const std::vector<PlacedBone>& bones) {
  std::vector<Group> groups;
  for (int i = 0; i < int(bones.size()); ++i) {
    const PlacedBone& root = bones[std::size_t(i)];
    if (carrier(root.mesh.name).empty()) continue;
    Group group{i, -1, {}, std::vector<char>(bones.size(), 0)};
    const bool ray = root.mesh.name.find("phalanx") != std::string::npos;
    for (int k = 0; k < int(bones.size()); ++k) {
      const PlacedBone& other = bones[std::size_t(k)];
      if (other.side != root.side) continue;
      if (hangs_on(other.mesh.name, root.mesh.name))
        group.bones.push_back(k), group.member[std::size_t(k)] = 1;
      if (ray && other.mesh.name == carrier(root.mesh.name)) group.ray_from = k;
    }
    groups.push_back(group);
  }
  // from the trunk outwards
  std::stable_sort(groups.begin(), groups.end(), [&](const Group& a, const Group& b) {
    return depth_of(bones[std::size_t(a.root)].mesh.name) <
           depth_of(bones[std::size_t(b.root)].mesh.name);
  });
  return groups;
}

// A phalanx moves along itself alone, from where it meets the bone before it, until no node of
// either is in the other. The ends of two bones lean against each other: free to choose one would
// slip off the other sideways, and what is past the middle of a narrow head would leave by its far
// side.
Point along_ray(const Group& group, const std::vector<PlacedBone>& bones,
                const Surfaces& surfaces) {
  const std::vector<Touch> overlapping =
      surfaces.overlapping(group.root, group.ray_from, ray_reach);
  if (overlapping.empty()) return {0, 0, 0};
  std::vector<Point> meeting;
  for (const Touch& t : overlapping)
    meeting.push_back(bones[std::size_t(t.a)].nodes[std::size_t(t.node)]);
  const Point out = unit(middle_of(bones[std::size_t(group.root)].nodes) - middle_of(meeting));
  return (surfaces.way_out(group.root, overlapping, out, ray_reach) + most_gap) * out;
}

// (1) for one group
Point wish_of(const Group& group, const std::vector<PlacedBone>& bones, const Surfaces& surfaces,
              const std::vector<NearPair>& pairs) {
  if (group.ray_from >= 0) return along_ray(group, bones, surfaces);
  Mat3d m{};
  Point rhs{0, 0, 0};
  int count = 0;
  for (const NearPair& pair : pairs) {
    if (group.member[std::size_t(pair.a)] == group.member[std::size_t(pair.b)]) continue;
    for (const Touch& t :
         surfaces.touches({pair.a, pair.b, std::min(pair.gap, most_gap), pair.tied}, 0, 8)) {
      const Point n = (group.member[std::size_t(t.a)] ? 1.0 : -1.0) * t.normal;
      ++count;
      rhs += (t.gap - t.distance) * n;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m(i, j) += n[i] * n[j];
    }
  }
  if (count == 0) return {0, 0, 0};
  for (int i = 0; i < 3; ++i) m(i, i) += softness * count;
  if (bones[std::size_t(group.root)].side == Side::midline) {  // stays in the plane of symmetry
    for (int i = 0; i < 3; ++i)
      if (i != 1) m(1, i) = m(i, 1) = 0;
    rhs.y = 0;
  }
  return inverse(m) * rhs;
}

void move_bone(PlacedBone& bone, const Point& shift) {
  for (Point& p : bone.nodes) p += shift;
  bone.placement.t += shift;
}

}  // namespace

LargestShift shift_bones(std::vector<PlacedBone>& bones, const std::vector<Articulation>& joints,
                         const std::vector<int>& twins) {
  Surfaces surfaces(bones);
  const std::vector<Group> groups = groups_of(bones);
  std::vector<Point> total(bones.size(), Point{0, 0, 0}), own = total;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    double largest = 0;
    for (const Group& group : groups) {
      const PlacedBone& root = bones[std::size_t(group.root)];
      const bool paired = twins[std::size_t(group.root)] >= 0;
      if (paired && root.side == Side::left) continue;
      const Point wish = wish_of(group, bones, surfaces, surfaces.near(joints));
      const double limit = root.mesh.name == "scapula" ? most_free : most;
      const double room = std::max(limit - norm(own[std::size_t(group.root)]), 0.0),
                   length = norm(wish);
      if (length < 0.01 || room == 0) continue;
      const Point shift = std::min({1.0, room / length, 1.5 / length}) * wish;
      largest = std::max(largest, norm(shift));
      own[std::size_t(group.root)] += shift;
      for (const int b : group.bones) {
        move_bone(bones[std::size_t(b)], shift), total[std::size_t(b)] += shift;
        surfaces.renew(b);
        const int twin = twins[std::size_t(b)];
        if (!paired || twin < 0) continue;
        move_bone(bones[std::size_t(twin)], mirror(shift));
        total[std::size_t(twin)] += mirror(shift);
        surfaces.renew(twin);
      }
    }
    if (largest < 0.02) break;
  }
  LargestShift found;
  for (int i = 0; i < int(bones.size()); ++i)
    if (norm(total[std::size_t(i)]) > found.shift) found = {norm(total[std::size_t(i)]), i};
  return found;
}

}  // namespace fabrica::body
