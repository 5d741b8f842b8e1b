#pragma once
// Joints between rigid bodies, solved with the bodies at position level (constraint/component.h):
// no penalty stiffness, no limit on the time step. LMF and RPS of the deck therefore make no
// difference. See docs/theory/joints.md.
#include <istream>
#include <ostream>
#include <vector>

#include "base/diagnostics.h"
#include "constraint/joint_rows.h"
#include "model/model.h"
#include "solver/rigid_bodies.h"

namespace fabrica {

class Joints {
 public:
  // bodies: finished. Joints whose nodes are in no rigid body, or far apart at the start, are
  // errors.
  Joints(const Model& model, const RigidBodies& bodies, Diagnostics& diagnostics);

  int size() const { return int(joints_.size()); }
  int body_a(int joint) const { return joints_[joint].a; }
  int body_b(int joint) const { return joints_[joint].b; }
  // Reaction on body B at the joint's point, global components.
  const Vec3d& force(int joint) const { return joints_[joint].force; }
  const Vec3d& moment(int joint) const { return joints_[joint].moment; }
  // Largest |C| of the conditions of length or angle at the current poses.
  double gap(int joint, const RigidBodies& bodies) const;
  double largest_gap(const RigidBodies& bodies) const;

  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  friend class RigidBodies;
  struct Item {
    int a = -1, b = -1;
    JointGeometry geometry;
    std::vector<JointCondition> conditions;
    Vec3d force{}, moment{};
  };
  void define(const Joint& joint, Item& item, const RigidBodies& bodies,
              Diagnostics& diagnostics) const;
  const Model& model_;
  std::vector<Item> joints_;
};

}  // namespace fabrica
