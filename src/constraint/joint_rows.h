#pragma once
// Constraint rows between two rigid bodies A and B: C(x_A, q_A, x_B, q_B) = 0 with
//   dC/dt = a_v . V_A + a_w . w_A + b_v . V_B + b_w . w_B
// r1 = x1 - x_A, r2 = x2 - x_B, d = x2 - x1 for the joint's points x1 (fixed in A) and x2 (fixed in
// B):
//   point, n fixed in space     C = n.d            [ -n, -(r1 x n)         |  n,  r2 x n ]
//   point, p fixed in A         C = p.d            [ -p, -(r1 x p) + p x d |  p,  r2 x p ]
//   axis e_B against p of A     C = e_B.p          [  0, -(e_B x p)        |  0,  e_B x p ]
//   locked rotation about e     C = e.log(R_B R_B0^T (R_A R_A0^T)^T)   [ 0, -e | 0, e ]
// A universal joint is the axis row with p = e_A and C = e_B.e_A - (e_B.e_A)_0.
#include "constraint/rotation.h"

namespace fabrica {

struct ConstraintRow {
  Vec3d a_v{}, a_w{}, b_v{}, b_w{};
};

enum class RowKind { point_in_space, point_in_body, axis, rotation };

// One scalar condition of a joint; vectors in the components of the bodies named.
struct JointCondition {
  RowKind kind;
  Vec3d direction{};  // point_in_space, rotation: global n; point_in_body, axis: p in A
  Vec3d axis{};       // axis: e in B
  double offset = 0;  // value of C that counts as zero
};

struct JointGeometry {
  Vec3d point_a, point_b;       // body coordinates
  Quaternion start_a, start_b;  // orientations when the joint was made
};

struct BodyPose {
  Vec3d x;
  Quaternion q;
  Mat3d R;
};

// Value of the condition at the given poses.
inline double joint_error(const JointGeometry& g, const JointCondition& c, const BodyPose& a,
                          const BodyPose& b) {
  if (c.kind == RowKind::axis) return dot(b.R * c.axis, a.R * c.direction) - c.offset;
  if (c.kind == RowKind::rotation) {
    const Quaternion turn_a = a.q * g.start_a.conjugate(), turn_b = b.q * g.start_b.conjugate();
    return dot(c.direction, logarithm(turn_b * turn_a.conjugate())) - c.offset;
  }
  const Vec3d d = (b.x - a.x) + (b.R * g.point_b - a.R * g.point_a);
  return dot(c.kind == RowKind::point_in_space ? c.direction : a.R * c.direction, d) - c.offset;
}

// Row of the condition at the given poses.
inline ConstraintRow joint_row(const JointGeometry& g, const JointCondition& c, const BodyPose& a,
                               const BodyPose& b) {
  ConstraintRow row;
  if (c.kind == RowKind::rotation) {
    row.a_w = -c.direction, row.b_w = c.direction;
    return row;
  }
  if (c.kind == RowKind::axis) {
    row.b_w = cross(b.R * c.axis, a.R * c.direction);
    row.a_w = -row.b_w;
    return row;
  }
  const Vec3d r1 = a.R * g.point_a, r2 = b.R * g.point_b, d = (b.x - a.x) + (r2 - r1);
  const bool in_body = c.kind == RowKind::point_in_body;
  const Vec3d n = in_body ? a.R * c.direction : c.direction;
  row.a_v = -n, row.b_v = n;
  row.a_w = -cross(r1, n), row.b_w = cross(r2, n);
  if (in_body) row.a_w += cross(n, d);
  return row;
}

}  // namespace fabrica
