#include "body/skeleton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "body/tables.h"

namespace fabrica::body {
namespace {

constexpr double degree = std::numbers::pi / 180;

// frames that share the axes and origin of another in the tables
std::string carrier_of(const std::string& frame) {
  if (frame == "talus") return "foot";
  if (frame.starts_with("hand_phalanx") || frame == "metacarpal1") return "hand";
  return frame;
}

// The nearest rotation: the tables give six digits (Gram-Schmidt on the columns).
Mat3d orthonormal(const Mat3d& m) {
  Point x{m(0, 0), m(1, 0), m(2, 0)}, z{m(0, 2), m(1, 2), m(2, 2)};
  x = (1 / norm(x)) * x;
  z = z - dot(x, z) * x;
  z = (1 / norm(z)) * z;
  const Point y = cross(z, x);
  return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
}

// the standing placements of the tables, right side and midline
const std::map<std::string, Placement>& standing() {
  static const std::map<std::string, Placement> frames = [] {
    std::map<std::string, Placement> list;
    const Table table("anatomy/assembly.csv");
    for (int r = 0; r < table.rows(); ++r) {
      if (table.text(r, "posture") != "stand") continue;
      Placement p;
      p.t = {table.number(r, "tx"), table.number(r, "ty"), table.number(r, "tz")};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) p.R(i, j) = table.number(r, fmt::format("r{}{}", i + 1, j + 1));
      p.R = orthonormal(p.R);
      list[table.text(r, "frame")] = p;
    }
    return list;
  }();
  return frames;
}

Placement standing_frame(const std::string& frame, Side side) {
  const auto at = standing().find(carrier_of(frame));
  if (at == standing().end())
    throw BodyError(fmt::format("anatomy/assembly.csv has no standing frame '{}'", frame));
  return side == Side::left ? mirror(at->second) : at->second;
}

// how a joint moves its child in the axes of the standing body
struct Motion {
  Mat3d turn;   // Q of (1)
  Point shift;  // d of (1) [mm]
};

// A mirrored joint turns about the mirrored axis, a pseudovector.
Motion motion(const Joint& joint, Side side, const Posture& posture) {
  const auto turned = [side](const Point& a, double degrees) {
    return rotation_about(side == Side::left ? Point{-a.x, a.y, -a.z} : a, degrees * degree);
  };
  Mat3d q{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (const JointAxis& axis : joint.axes) {
    const double angle =
        posture.get(joint.name, joint.paired ? side : Side::midline, axis.coordinate);
    if (angle < axis.low - 1e-6 || angle > axis.high + 1e-6)
      throw BodyError(fmt::format(
          "{}.{} = {:g} degrees is out of its range {:g} to {:g}; the nearest possible is {:g}",
          joint.name, axis.coordinate, angle, axis.low, axis.high,
          std::clamp(angle, axis.low, axis.high)));
    q = q * turned(axis.axis, angle);
  }
  if (joint.path.empty()) return {q, {0, 0, 0}};
  const PathPoint at = joint.path_at(
      posture.get(joint.name, joint.paired ? side : Side::midline, joint.axes.front().coordinate));
  return {q * turned({1, 0, 0}, at.varus) * turned({0, 0, 1}, at.internal),
          side == Side::left ? mirror(at.shift) : at.shift};
}

Point scaled(const Point& p, const Point& s) { return {s.x * p.x, s.y * p.y, s.z * p.z}; }

// shortest rotation that turns direction a into direction b
Mat3d between(const Point& a, const Point& b) {
  const Point axis = cross(a, b);
  const double s = norm(axis), c = dot(a, b);
  if (s < 1e-12) return identity3<double>();
  return rotation_about((1 / s) * axis, std::atan2(s, c));
}

// The front end of a rib follows the sternum and its head follows its vertebra.
Placement between_two(const Placement& carrier, const Point& fixed, const Point& fixed_target,
                      const Point& free_end, const Point& free_target) {
  const Mat3d r = between(free_end - fixed, free_target - fixed_target) * carrier.R;
  return {r, fixed_target - r * carrier.inverse(fixed)};
}

}  // namespace

Skeleton::Skeleton(const Subject& subject, const Posture& posture) : subject_(subject) {
  for (const Joint& joint : joint_tree()) {
    for (const Side side : {Side::right, Side::left}) {
      if (!joint.paired && side == Side::left) continue;
      const Side key = joint.paired ? side : Side::midline;
      const Placement child0 = standing_frame(joint.child, key);
      const Point centre0 = key == Side::left ? mirror(joint.centre) : joint.centre;
      const Motion moved = motion(joint, key, posture);
      Placement child;
      Point centre = posture.pelvis.t + centre0, shift = posture.pelvis.R * moved.shift;
      Mat3d carried = posture.pelvis.R;
      if (joint.parent != "ground") {
        const bool parent_paired = has_frame(joint.parent, key) && key != Side::midline;
        const Side parent_side = parent_paired ? key : Side::midline;
        const Placement parent0 = standing_frame(joint.parent, parent_side),
                        &parent = frame(joint.parent, parent_side);
        centre =
            parent(scaled(parent0.inverse(centre0), subject.scale_of(carrier_of(joint.parent))));
        carried = parent.R * transpose(parent0.R);
        shift = parent.R * scaled(transpose(parent0.R) * moved.shift,
                                  subject.scale_of(carrier_of(joint.parent)));
      }
      child.R = carried * moved.turn * child0.R;
      child.t =
          centre + shift -
          child.R * scaled(child0.inverse(centre0), subject.scale_of(carrier_of(joint.child)));
      frames_[{joint.child, key}] = child;
      centres_[{joint.name, key}] = centre;
    }
  }
}

bool Skeleton::has_frame(const std::string& name, Side side) const {
  return frames_.count({name, side}) > 0;
}

const Placement& Skeleton::frame(const std::string& name, Side side) const {
  const auto at = frames_.find({name, side});
  if (at == frames_.end()) throw BodyError(fmt::format("the skeleton has no frame '{}'", name));
  return at->second;
}

Point Skeleton::joint_centre(const std::string& joint, Side side) const {
  const auto at = centres_.find({joint, side});
  if (at == centres_.end()) throw BodyError(fmt::format("the skeleton has no joint '{}'", joint));
  return at->second;
}

void Skeleton::carry(const std::string& name, Side side, const Placement& motion) {
  for (const Joint& joint : joint_tree()) {
    if (joint.child == name) {
      Placement& place = frames_.at({name, side});
      place = {motion.R * place.R, motion(place.t)};
      centres_.at({joint.name, side}) = motion(centres_.at({joint.name, side}));
    } else if (joint.parent == name) {
      carry(joint.child, side, motion);
    }
  }
}

Point Skeleton::carried(const std::string& name, Side side, const Point& standing) const {
  const Side key = has_frame(name, side) ? side : Side::midline;
  return frame(name, key)(
      scaled(standing_frame(name, key).inverse(standing), subject_.scale_of(carrier_of(name))));
}

Placement Skeleton::bone(const std::string& bone, const std::string& carrier, Side side) const {
  if (has_frame(bone, side)) return frame(bone, side);  // fingers, talus
  const Placement& place = has_frame(carrier, side) ? frame(carrier, side) : frame(carrier);
  if (!bone.starts_with("rib")) return place;
  // head of the rib in the thorax and where the vertebra carries it; front end with the sternum
  static const Table marks("anatomy/landmarks.csv");
  const std::string vertebra = "T" + bone.substr(3);
  Point head{0, 0, 0}, front{0, 0, 0};
  for (int r = 0; r < marks.rows(); ++r) {
    const std::string& mark = marks.text(r, "name");
    if (mark != bone + "_head" && mark != bone + "_anterior_end") continue;
    const Point p{marks.number(r, "x_stand"), marks.number(r, "y_stand"),
                  marks.number(r, "z_stand")};
    (mark == bone + "_head" ? head : front) = side == Side::left ? mirror(p) : p;
  }
  const Point at_vertebra = carried(vertebra, Side::midline, head),
              front_now = carried("thorax", Side::midline, front);
  return between_two(place, carried("thorax", Side::midline, head), at_vertebra, front_now,
                     front_now);
}

}  // namespace fabrica::body
