#include "body/surroundings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "body/cards.h"

namespace fabrica::body {
namespace {

constexpr double gravity = 9.81e-3;  // [mm/ms2]
constexpr double clearance = 0.05;   // [mm] of walls at the start

using Accept = std::function<bool(const PlacedBone&)>;

// the least of direction . x over the nodes of some bones
double support(const Body& body, const Point& direction, const Accept& accept) {
  double least = 1e30;
  for (const PlacedBone& bone : body.bones)
    if (accept(bone))
      for (const Point& x : bone.nodes) least = std::min(least, dot(direction, x));
  return least;
}

// An infinite rigid wall of normal n that just touches the accepted bones and stops only their
// nodes.
class Walls {
 public:
  Walls(const Body& body, AssembledBody& assembled, Builder& builder)
      : body_(body), assembled_(assembled), builder_(builder) {}

  void add(const std::string& name, const Point& normal, double friction, const Accept& accept) {
    const double at = support(body_, normal, accept);
    if (at > 1e29) return;
    const double set = double(++assembled_.next_set);
    Card& nodes = titled(builder_, "SET_NODE_LIST", name);
    nodes.set("sid", set);
    std::vector<std::int64_t> ids;
    for (std::size_t b = 0; b < body_.bones.size(); ++b)
      if (accept(body_.bones[b]))
        ids.insert(ids.end(), assembled_.bone_node[b].begin(), assembled_.bone_node[b].end());
    add_ids(nodes, ids.size(), [&](std::size_t i) { return ids[i]; });
    const Point tail = (at - clearance) * normal, head = tail + normal;
    Card& wall = builder_.add_card("RIGIDWALL_PLANAR");
    wall.options = {"ID"};
    wall.set("id", double(++count_)).set("heading", name).set("nsid", set);
    wall.set("xt", tail.x)
        .set("yt", tail.y)
        .set("zt", tail.z)
        .set("xh", head.x)
        .set("yh", head.y)
        .set("zh", head.z);
    wall.set("fric", friction);
  }

 private:
  const Body& body_;
  AssembledBody& assembled_;
  Builder& builder_;
  int count_ = 0;
};

void constant_curve(Builder& builder, double id) {
  Card& curve = builder.add_card("DEFINE_CURVE");
  curve.set("lcid", id);
  curve.add_row({0, 1});
  curve.add_row({1000, 1});
}

constexpr double curve_of_ones = 8000001;

void pull_down(Builder& builder) {
  constant_curve(builder, curve_of_ones);
  builder.add_card("LOAD_BODY_Z").set("lcid", curve_of_ones).set("sf", gravity);
}

bool one_of(const std::string& name, std::initializer_list<const char*> prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const char* p) { return name.starts_with(p); });
}

// planes that carry pelvis, thighs, back, head, feet and forearms of a seated body
void seat(const Body& body, AssembledBody& assembled, Builder& builder) {
  Walls walls(body, assembled, builder);
  const auto up = [](const Placement& p) { return Point{p.R(0, 2), 0, p.R(2, 2)}; };
  walls.add("seat pan", {0, 0, 1}, 0.3,
            [](const PlacedBone& b) { return b.region == Region::pelvis; });
  // thigh: square to the femur's shaft in the plane of symmetry, upward
  const Point shaft = unit(up(body.skeleton.frame("femur", Side::right)));
  walls.add("thigh support",
            shaft.x < 0 ? Point{shaft.z, 0, -shaft.x} : Point{-shaft.z, 0, shaft.x}, 0.3,
            [](const PlacedBone& b) { return b.mesh.name == "femur"; });
  const Point hip = 0.5 * (body.skeleton.joint_centre("hip", Side::right) +
                           body.skeleton.joint_centre("hip", Side::left));
  const Point trunk = unit(body.skeleton.joint_centre("C7") - hip);
  const auto back = [](const PlacedBone& b) {
    return b.region == Region::thorax || b.region == Region::abdomen || b.mesh.name == "scapula" ||
           b.mesh.name == "sacrum";
  };
  walls.add("seat back", {trunk.z, 0, -trunk.x}, 0.3, back);
  walls.add("head rest", {1, 0, 0}, 0.3,
            [](const PlacedBone& b) { return b.mesh.name == "skull"; });
  const Point sole = up(body.skeleton.frame("foot", Side::right));
  walls.add("floor", unit(sole), 0.5, [](const PlacedBone& b) { return b.frame == "foot"; });
  walls.add("arm support", {0, 0, 1}, 0.3, [](const PlacedBone& b) {
    return one_of(b.mesh.name, {"humerus", "ulna", "radius"});
  });
  pull_down(builder);
  builder.add_card("DAMPING_GLOBAL").set("valdmp", 0.05);
}

void drop(const Body& body, AssembledBody& assembled, Builder& builder) {
  constexpr double height = 500;  // [mm]
  Walls(body, assembled, builder).add("plane", {0, 0, 1}, 0.3, [](const PlacedBone&) {
    return true;
  });
  pull_down(builder);
  builder.add_card("INITIAL_VELOCITY").set("nsid", 0).set("vz", -std::sqrt(2 * gravity * height));
}

// a rigid ball flies at the breastbone
void ball(const Body& body, AssembledBody& assembled, Builder& builder) {
  constexpr double radius = 75, mass = 5, speed = 3;
  const double volume = 4.0 / 3 * 3.14159265358979 * radius * radius * radius;
  const Placement& thorax = body.skeleton.frame("thorax");
  const Point forward{thorax.R(0, 0), 0, thorax.R(2, 0)};
  const int target = find_bone(body.bones, "sternum_body", Side::midline);
  if (target < 0) throw BodyError("trial sternum: the body has no sternum_body to hit");
  Point middle{0, 0, 0};
  for (const Point& x : body.bones[std::size_t(target)].nodes) middle += x;
  middle = (1.0 / double(body.bones[std::size_t(target)].nodes.size())) * middle;
  // just clear of everything in front of the ball
  double front = -1e30;
  for (const PlacedBone& bone : body.bones) {
    if (bone.region != Region::thorax) continue;
    for (const Point& x : bone.nodes) {
      const double along = dot(x - middle, forward);
      const double aside2 = dot(x - middle, x - middle) - along * along;
      if (aside2 < radius * radius)
        front = std::max(front, along + std::sqrt(radius * radius - aside2));
    }
  }
  const Point centre = middle + (front + 0.5) * forward;
  const ShapeMesh mesh = ball_mesh(radius, 25);
  const std::int64_t part = assembled.next_part++;
  add_shape(mesh, part, part, {identity3<double>(), centre}, assembled, builder);
  builder.add_card("SECTION_SOLID").set("secid", 8000001).set("elform", 1);
  builder.add_card("MAT_RIGID")
      .set("mid", 8000001)
      .set("ro", mass / volume)
      .set("e", 70)
      .set("pr", 0.3);
  Card& p = builder.add_card("PART");
  p.title = "surroundings.ball";
  p.set("pid", double(part)).set("secid", 8000001).set("mid", 8000001);
  Card& v = builder.add_card("INITIAL_VELOCITY_GENERATION");
  v.set("id", double(part))
      .set("styp", 2)
      .set("vx", -speed * forward.x)
      .set("vy", 0)
      .set("vz", -speed * forward.z);
  Card& set = builder.add_card("SET_PART_LIST");
  const double thorax_set = double(++assembled.next_set);
  set.set("sid", thorax_set);
  std::vector<std::int64_t> ids;
  for (const PartEntry& e : assembled.parts) {
    if (e.bone < 0 || body.bones[std::size_t(e.bone)].region != Region::thorax) continue;
    if (!one_of(body.bones[std::size_t(e.bone)].mesh.name,
                {"rib", "costal", "sternum", "manubrium", "xiphoid"}))
      continue;
    ids.push_back(e.id);
  }
  add_ids(set, ids.size(), [&](std::size_t i) { return ids[i]; });
  Card& c = builder.add_card("CONTACT_AUTOMATIC_SURFACE_TO_SURFACE");
  c.options = {"ID"};
  c.set("cid", 8000001).set("heading", "ball on the breastbone");
  c.set("ssid", thorax_set)
      .set("msid", double(part))
      .set("sstyp", 2)
      .set("mstyp", 3)
      .set("fs", 0.2)
      .set("fd", 0.2)
      .set("soft", 1);
}

}  // namespace

double trial_time(const std::string& trial) {
  if (trial == "none" || trial == "seat") return 100;
  if (trial == "drop" || trial == "sternum") return 50;
  throw BodyError(fmt::format("trial '{}' is unknown; there are none, seat, drop, sternum", trial));
}

void surround(const std::string& trial, const Body& body, AssembledBody& assembled,
              Builder& builder) {
  trial_time(trial);
  if (trial == "seat") seat(body, assembled, builder);
  if (trial == "drop") drop(body, assembled, builder);
  if (trial == "sternum") ball(body, assembled, builder);
}

}  // namespace fabrica::body
