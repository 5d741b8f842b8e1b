// The conditions of each kind of joint.
#include "solver/joints.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "solver/stream.h"

namespace fabrica {

Joints::Joints(const Model& model, const RigidBodies& bodies, Diagnostics& diagnostics)
    : model_(model) {
  for (const Joint& joint : model.joints) {
    Item item;
    const int a = joint.node[0] >= 0 ? bodies.body_of_node(joint.node[0]) : -1;
    const int b = joint.node[1] >= 0 ? bodies.body_of_node(joint.node[1]) : -1;
    if (a < 0 || b < 0 || a == b) {
      diagnostics.error("joint-without-rigid-bodies", {}, "CONSTRAINED_JOINT", a < 0 ? "N1" : "N2",
                        "joint " + std::to_string(joint.id) + " does not connect two rigid bodies",
                        "put its nodes into two rigid bodies by *CONSTRAINED_EXTRA_NODES");
      joints_.push_back(std::move(item));
      continue;
    }
    item.a = a, item.b = b;
    define(joint, item, bodies, diagnostics);
    joints_.push_back(std::move(item));
  }
  // a joint that was refused must not take part; the caller stops on the error
  std::erase_if(joints_, [](const Item& i) { return i.a < 0; });
}

void Joints::define(const Joint& joint, Item& item, const RigidBodies& bodies,
                    Diagnostics& diagnostics) const {
  const RigidBody &A = bodies[item.a], &B = bodies[item.b];
  const Mat3d Ra = matrix_of(A.motion.q), Rb = matrix_of(B.motion.q);
  auto x = [&](int i) { return model_.nodes.x[joint.node[i]]; };
  const Vec3d middle = 0.5 * (x(0) + x(1));
  // both bodies hold the middle of a pair that is slightly apart
  double size = 0;
  for (const RigidBody* body : {&A, &B})
    for (const Vec3d& r : body->r) size = std::max(size, norm(r));
  const double apart = norm(x(1) - x(0));
  const bool has_axis = joint.kind != JointKind::spherical && joint.kind != JointKind::locking;
  if (apart > 0.05 * size &&
      (joint.kind == JointKind::spherical || joint.kind == JointKind::revolute ||
       joint.kind == JointKind::universal || joint.kind == JointKind::locking))
    diagnostics.error("joint-nodes-apart", {}, "CONSTRAINED_JOINT", "N2",
                      "the first two nodes of joint " + std::to_string(joint.id) + " are " +
                          std::to_string(apart) + " apart",
                      "make them coincide");
  else if (apart > 1e-3 * size && !has_axis)
    diagnostics.warning("joint-nodes-apart", {}, "CONSTRAINED_JOINT", "N2",
                        "the first two nodes of joint " + std::to_string(joint.id) + " are " +
                            std::to_string(apart) + " apart; the joint is placed half way");
  JointGeometry& g = item.geometry;
  g = {transpose(Ra) * (middle - A.motion.x), transpose(Rb) * (middle - B.motion.x), A.motion.q,
       B.motion.q};
  const Vec3d unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  auto spherical = [&] {
    for (const Vec3d& n : unit) item.conditions.push_back({RowKind::point_in_space, n, {}, 0});
  };
  if (joint.kind == JointKind::spherical) return spherical();
  if (joint.kind == JointKind::locking) {
    spherical();
    for (const Vec3d& n : unit) item.conditions.push_back({RowKind::rotation, n, {}, 0});
    return;
  }
  if (joint.node[2] < 0 || joint.node[3] < 0 || norm(x(2) - x(0)) == 0 || norm(x(3) - x(1)) == 0) {
    diagnostics.error("joint-without-axis", {}, "CONSTRAINED_JOINT", "N3",
                      "joint " + std::to_string(joint.id) + " needs an axis by nodes 3 and 4",
                      "give two nodes off the joint's centre");
    return;
  }
  const Vec3d ea = (1 / norm(x(2) - x(0))) * (x(2) - x(0));
  const Vec3d eb = (1 / norm(x(3) - x(1))) * (x(3) - x(1));
  if (joint.kind == JointKind::universal) {
    spherical();
    item.conditions.push_back({RowKind::axis, transpose(Ra) * ea, transpose(Rb) * eb, dot(ea, eb)});
    return;
  }
  // A's axis rules; small misalignment of B's at the start is taken as zero
  const auto [p, q] = normal_pair(ea);
  const Vec3d pa = transpose(Ra) * p, qa = transpose(Ra) * q, na = transpose(Ra) * ea,
              axis_b = transpose(Rb) * ea;
  if (joint.kind == JointKind::revolute) spherical();
  if (joint.kind == JointKind::cylindrical || joint.kind == JointKind::translational)
    for (const Vec3d& n : {pa, qa}) item.conditions.push_back({RowKind::point_in_body, n, {}, 0});
  if (joint.kind == JointKind::planar)
    item.conditions.push_back({RowKind::point_in_body, na, {}, 0});
  for (const Vec3d& n : {pa, qa}) item.conditions.push_back({RowKind::axis, n, axis_b, 0});
  if (joint.kind == JointKind::translational)
    item.conditions.push_back({RowKind::axis, pa, transpose(Rb) * q, 0});
}

double Joints::gap(int joint, const RigidBodies& bodies) const {
  const Item& item = joints_[joint];
  const RigidMotion &a = bodies[item.a].motion, &b = bodies[item.b].motion;
  double largest = 0;
  for (const JointCondition& c : item.conditions)
    largest = std::max(largest, std::abs(joint_error(item.geometry, c, {a.x, a.q, matrix_of(a.q)},
                                                     {b.x, b.q, matrix_of(b.q)})));
  return largest;
}

double Joints::largest_gap(const RigidBodies& bodies) const {
  double largest = 0;
  for (int j = 0; j < size(); ++j) largest = std::max(largest, gap(j, bodies));
  return largest;
}

void Joints::save(std::ostream& out) const {
  for (const Item& i : joints_) write_value(out, i.force), write_value(out, i.moment);
}

void Joints::load(std::istream& in) {
  for (Item& i : joints_) read_value(in, i.force), read_value(in, i.moment);
}

}  // namespace fabrica
