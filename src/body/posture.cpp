#include "body/posture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "body/catmull_rom.h"
#include "body/tables.h"

namespace fabrica::body {
namespace {

struct Name {
  std::string joint, side, coordinate;  // side empty: midline or both
};

Name split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == '.')
      parts.emplace_back();
    else
      parts.back().push_back(c);
  }
  Name name{parts[0], "", ""};
  for (std::size_t i = 1; i < parts.size(); ++i)
    (parts[i] == "right" || parts[i] == "left" ? name.side : name.coordinate) = parts[i];
  return name;
}

Joint& joint_of_row(std::vector<Joint>& joints, const Table& table, int row) {
  const auto at = std::find_if(joints.begin(), joints.end(),
                               [&](const Joint& j) { return j.name == table.text(row, "joint"); });
  if (at == joints.end())
    table.fail(row, fmt::format("no joint '{}' in joint_tree.csv", table.text(row, "joint")));
  return *at;
}

void read_paths(std::vector<Joint>& joints) {
  const Table table("anatomy/joint_paths.csv");
  for (int r = 0; r < table.rows(); ++r) {
    std::vector<PathPoint>& path = joint_of_row(joints, table, r).path;
    const PathPoint point{table.number(r, "angle"),
                          {table.number(r, "x"), table.number(r, "y"), table.number(r, "z")},
                          table.number(r, "varus"),
                          table.number(r, "internal")};
    const double expected =
        path.size() < 2 ? (path.empty() ? 0 : point.angle) : path[1].angle * double(path.size());
    if (std::abs(point.angle - expected) > 1e-9 || (!path.empty() && point.angle <= 0))
      table.fail(r, "angles of a path start at 0 and grow by equal steps");
    path.push_back(point);
  }
}

std::vector<Joint> read_joints() {
  const Table tree("anatomy/joint_tree.csv"), axes("anatomy/joint_axes.csv");
  std::vector<Joint> joints;
  for (int r = 0; r < tree.rows(); ++r)
    joints.push_back({tree.text(r, "joint"),
                      tree.text(r, "parent"),
                      tree.text(r, "child"),
                      tree.number(r, "paired") != 0,
                      {tree.number(r, "x"), tree.number(r, "y"), tree.number(r, "z")},
                      {},
                      {}});
  for (int r = 0; r < axes.rows(); ++r) {
    Joint& joint = joint_of_row(joints, axes, r);
    Point a{axes.number(r, "ax"), axes.number(r, "ay"), axes.number(r, "az")};
    a = (1 / norm(a)) * a;
    joint.axes.push_back({joint.name, axes.text(r, "coordinate"), a, axes.number(r, "low"),
                          axes.number(r, "high"), axes.text(r, "source")});
  }
  read_paths(joints);
  return joints;
}

// the levels of a group and their shares of its angle: by the range of each in that direction
const std::vector<std::string>& levels(const std::string& group) {
  static const std::map<std::string, std::vector<std::string>> groups = {
      {"lumbar", {"L5", "L4", "L3", "L2", "L1"}},
      {"thoracic", {"T12", "T11", "T10", "T9", "T8", "T7", "T6", "T5", "T4", "T3", "T2", "T1"}},
      {"neck", {"C7", "C6", "C5", "C4", "C3", "C2", "C1", "head"}},
      {"grip",
       {"mcp2", "mcp3", "mcp4", "mcp5", "pip2", "pip3", "pip4", "pip5", "dip2", "dip3", "dip4",
        "dip5", "ip1"}}};
  static const std::vector<std::string> none;
  const auto at = groups.find(group);
  return at == groups.end() ? none : at->second;
}

[[noreturn]] void unknown(const std::string& name) {
  std::vector<std::string> known{"lumbar", "thoracic", "neck", "grip", "arm"};
  for (const Joint& j : joint_tree())
    if (!j.axes.empty()) known.push_back(j.name);
  throw BodyError(
      fmt::format("no joint angle is named '{}'; say joint.side.coordinate, such as "
                  "knee.right.flexion, with one of: {}",
                  name, fmt::join(known, " ")));
}

void check_range(const std::string& name, double value, double low, double high,
                 const std::string& source) {
  constexpr double slack = 1e-6;  // [deg] rounding of sums
  if (value >= low - slack && value <= high + slack) return;
  throw BodyError(fmt::format(
      "{} = {:g} degrees is out of its range {:g} to {:g} ({}); the nearest possible is {:g}", name,
      value, low, high, source, std::clamp(value, low, high)));
}

const JointAxis& axis_of(const Joint& joint, const std::string& coordinate,
                         const std::string& name) {
  if (joint.axes.empty()) unknown(name);
  if (coordinate.empty()) return joint.axes.front();
  std::vector<std::string> known;
  for (const JointAxis& a : joint.axes) {
    if (a.coordinate == coordinate) return a;
    known.push_back(a.coordinate);
  }
  throw BodyError(fmt::format("{}: joint {} has no coordinate '{}'; it has {}", name, joint.name,
                              coordinate, fmt::join(known, ", ")));
}

void set_one(Posture& posture, const Joint& joint, const JointAxis& axis, const std::string& side,
             double degrees) {
  if (!joint.paired) {
    posture.angle[joint.name + "." + axis.coordinate] = degrees;
    return;
  }
  for (const char* s : {"right", "left"})
    if (side.empty() || side == s)
      posture.angle[joint.name + "." + s + "." + axis.coordinate] = degrees;
}

void set_group(Posture& posture, const Name& name, const std::string& text, double degrees) {
  double low = 0, high = 0;
  for (const std::string& level : levels(name.joint)) {
    const JointAxis& a = axis_of(*find_joint(level), name.coordinate, text);
    low += a.low, high += a.high;
  }
  check_range(text, degrees, low, high, "sum of its levels");
  const double share = degrees > 0 ? degrees / high : low < 0 ? degrees / low : 0;
  for (const std::string& level : levels(name.joint)) {
    const Joint& joint = *find_joint(level);
    const JointAxis& a = axis_of(joint, name.coordinate, text);
    set_one(posture, joint, a, name.side, share * (degrees > 0 ? a.high : a.low));
  }
}

// Elevation of the whole arm against the trunk: beyond 30 degrees the scapula takes one third
// (Inman 1944), of that two fifths through the clavicle's elevation and the rest at the
// acromioclavicular joint (estimated).
void set_arm(Posture& posture, const Name& name, const std::string& text, double degrees) {
  const std::string coordinate = name.coordinate.empty() ? "flexion" : name.coordinate;
  const Joint& shoulder = *find_joint("shoulder");
  const JointAxis& axis = axis_of(shoulder, coordinate, text);
  const double upward = coordinate == "rotation" ? 0 : std::max(0.0, (degrees - 30) / 3);
  check_range(text, degrees, axis.low, coordinate == "rotation" ? axis.high : 165,
              "arm with its shoulder blade");
  set_one(posture, shoulder, axis, name.side, degrees - upward);
  const Joint &clavicle = *find_joint("clavicle"), &scapula = *find_joint("scapula");
  set_one(posture, clavicle, axis_of(clavicle, "elevation", text), name.side, 0.4 * upward);
  set_one(posture, scapula, axis_of(scapula, "upward", text), name.side, 0.6 * upward);
}

}  // namespace

PathPoint Joint::path_at(double at) const {
  if (path.size() < 2) return {at, {0, 0, 0}, 0, 0};
  const double step = path[1].angle, place = std::clamp(at / step, 0.0, double(path.size()) - 1);
  const int i = std::min(int(place), int(path.size()) - 2);
  const auto of = [&](auto value) {
    return catmull_rom(int(path.size()), i, place - i,
                       [&](int k) { return value(path[std::size_t(k)]); });
  };
  PathPoint p{at, {0, 0, 0}, 0, 0};
  for (int k = 0; k < 3; ++k) p.shift[k] = of([k](const PathPoint& q) { return q.shift[k]; });
  p.varus = of([](const PathPoint& q) { return q.varus; });
  p.internal = of([](const PathPoint& q) { return q.internal; });
  return p;
}

const std::vector<Joint>& joint_tree() {
  static const std::vector<Joint> joints = read_joints();
  return joints;
}

const Joint* find_joint(const std::string& name) {
  for (const Joint& j : joint_tree())
    if (j.name == name) return &j;
  return nullptr;
}

double Posture::get(const std::string& joint, Side side, const std::string& coordinate) const {
  const std::string middle = side == Side::midline ? "" : side == Side::right ? ".right" : ".left";
  const auto at = angle.find(joint + middle + "." + coordinate);
  return at == angle.end() ? 0 : at->second;
}

void set_angle(Posture& posture, const std::string& text, double degrees) {
  const Name name = split(text);
  if (name.joint == "arm") return set_arm(posture, name, text, degrees);
  if (!levels(name.joint).empty()) return set_group(posture, name, text, degrees);
  const Joint* joint = find_joint(name.joint);
  if (!joint) unknown(text);
  const JointAxis& axis = axis_of(*joint, name.coordinate, text);
  check_range(text, degrees, axis.low, axis.high, axis.source);
  set_one(posture, *joint, axis, name.side, degrees);
  // the patella glides with the knee: 39 of 61 degrees in the seat assembly
  if (joint->name == "knee")
    set_angle(posture, "patella" + (name.side.empty() ? "" : "." + name.side),
              39.0 / 61.0 * degrees);
}

void set_angle(Posture& posture, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  char* end = nullptr;
  const std::string value = equals == std::string::npos ? "" : assignment.substr(equals + 1);
  const double degrees = std::strtod(value.c_str(), &end);
  if (value.empty() || *end != '\0')
    throw BodyError(fmt::format(
        "'{}' sets no angle; write joint.side.coordinate=degrees, such as knee.right=110",
        assignment));
  set_angle(posture, assignment.substr(0, equals), degrees);
}

Posture named_posture(const std::string& name) {
  Posture posture;
  posture.name = name;
  if (name == "standing") return posture;
  const Table table("anatomy/postures.csv");
  std::vector<std::string> known{"standing"};
  bool found = false;
  for (int r = 0; r < table.rows(); ++r) {
    const std::string& row = table.text(r, "posture");
    if (std::find(known.begin(), known.end(), row) == known.end()) known.push_back(row);
    if (row != name) continue;
    found = true;
    set_angle(posture, table.text(r, "angle"), table.number(r, "degrees"));
  }
  if (!found)
    throw BodyError(
        fmt::format("posture '{}' is unknown; there are {}", name, fmt::join(known, ", ")));
  return posture;
}

}  // namespace fabrica::body
