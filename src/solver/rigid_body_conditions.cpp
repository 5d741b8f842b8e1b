// What holds or drives rigid bodies: constraint codes, supports of their nodes, prescribed motions.
#include <algorithm>
#include <string>

#include "solver/motion_target.h"
#include "solver/rigid_bodies.h"

namespace fabrica {

// Constraint codes of MAT_RIGID and NRB_SPC as conditions of zero velocity.
void RigidBodies::code_conditions(int cmo, int con1, int con2, int local_system, int local,
                                  std::vector<GroundCondition>& out) const {
  int translation = 0, rotation = 0;
  Mat3d axes = identity3<double>();
  if (cmo > 0) {
    translation = constrained_axes(con1);
    rotation = constrained_axes(con2);
  } else if (cmo < 0) {
    // six decimal digits: x y z rx ry rz
    for (int k = 0, digits = con2; k < 6; ++k, digits /= 10)
      if (digits % 10) (k < 3 ? rotation : translation) |= 1 << (2 - k % 3);
    if (local_system >= 0) axes = model_.coordinate_systems[local_system].axes;
  }
  for (int k = 0; k < 3; ++k) {
    const Vec3d e{axes(k, 0), axes(k, 1), axes(k, 2)};
    if (translation >> k & 1) out.push_back({local, false, false, e, 0});
    if (rotation >> k & 1) out.push_back({local, true, false, e, 0});
  }
}

// A support of a node of a body holds the body's centre of mass, or its rotation, as LS-DYNA has
// it.
void RigidBodies::collect_supports(Diagnostics& diagnostics) {
  supports_.assign(bodies_.size(), {});
  for_each_support(model_, [&](int node, const NodeSupport& s) {
    if (node_to_body_[node] < 0) return;
    std::vector<NodeSupport>& list = supports_[node_to_body_[node]];
    const bool known = std::any_of(list.begin(), list.end(), [&](const NodeSupport& o) {
      return o.rotation == s.rotation && norm(o.direction - s.direction) == 0 &&
             o.system == s.system && o.birth == s.birth && o.death == s.death;
    });
    if (!known) list.push_back(s);
  });
  // one warning a body, at its first card; codes of nodes have none
  for (int b = 0; b < size(); ++b) {
    if (supports_[b].empty()) continue;
    const auto card = std::find_if(supports_[b].begin(), supports_[b].end(),
                                   [](const NodeSupport& s) { return s.where.line > 0; });
    const bool spc = card != supports_[b].end();
    diagnostics.warning("support-of-rigid-body", spc ? card->where : Location{},
                        spc ? "BOUNDARY_SPC" : "NODE", spc ? "NID" : "TC",
                        "supports of nodes of rigid body " + std::to_string(bodies_[b].id) +
                            " hold its centre of mass and its rotation",
                        "use the constraint codes of *MAT_RIGID (CMO, CON1, CON2)");
  }
}

void RigidBodies::support_conditions(const State& state, int body, int local,
                                     std::vector<GroundCondition>& out) const {
  for (const NodeSupport& s : supports_[body]) {
    if (!alive(s.birth, s.death, state.time, state.dt)) continue;
    const Vec3d d = carried_direction(model_, state, s.direction, s.system);
    out.push_back({local, s.rotation, false, d, 0});
  }
}

// Where a node is after the step: exactly if it belongs to a body that has been advanced, else as
// it moves now.
Vec3d RigidBodies::node_after(const State& state, int node, int body) const {
  if (node_to_body_[node] == body && advanced_[body]) {
    const RigidBody& b = bodies_[body];
    const Vec3d r = transpose(matrix_of(b.start_q)) * (model_.nodes.x[node] - b.start_x);
    return b.motion.x + matrix_of(b.motion.q) * r;
  }
  return state.nodes[node].x + state.dt * state.nodes[node].v;
}

// VAD = 4: the distance of the centres d . (x - x_lead) grows by f, along the line of the centres
// or of two nodes. The lead does not feel it.
void RigidBodies::relative_condition(const State& state, const PrescribedMotion& m,
                                     GroundCondition& g) const {
  const int lead_body = part_to_body_[m.lead];
  const RigidBody &b = bodies_[part_to_body_[m.part]], &lead = bodies_[lead_body];
  const double ahead = advanced_[lead_body] ? 0 : state.dt;
  const Vec3d lead_x = lead.motion.x + ahead * lead.motion.v;
  const Vec3d apart = b.start_x - lead.start_x;
  double start = norm(apart);
  Vec3d line = b.motion.x + state.dt * b.motion.v - lead_x;
  if (m.node[0] >= 0 && m.node[1] >= 0) {
    const Vec3d first = model_.nodes.x[m.node[1]] - model_.nodes.x[m.node[0]];
    start = dot(first, apart) / norm(first);
    line = node_after(state, m.node[1], lead_body) - node_after(state, m.node[0], lead_body);
  }
  g.direction = (1 / norm(line)) * line;
  const Curve& curve = model_.curves[m.curve];
  const double t = std::max(0.0, state.time - m.birth) + state.dt;
  const double wanted = start + m.scale * curve_value(curve.x, curve.y, t);
  g.target = (wanted - dot(g.direction, b.motion.x - lead_x)) / state.dt;
}

// The condition of a prescribed motion in this step; false while it is not alive.
bool RigidBodies::motion_condition(const State& state, int index, int local,
                                   GroundCondition& g) const {
  const PrescribedMotion& m = model_.prescribed_motions[index];
  if (!alive(m.birth, m.death, state.time, state.dt)) return false;
  const RigidBody& b = bodies_[part_to_body_[m.part]];
  g = {};
  g.body = local;
  if (m.kind == 4) {
    relative_condition(state, m, g);
    return true;
  }
  g.rotation = m.dof >= 5;
  const int axis = m.dof % 4;  // 1 2 3 and 5 6 7: axes; 4 and 8: along a vector
  if (axis == 0)
    g.direction = (1 / norm(m.direction)) * m.direction;
  else
    g.direction[axis - 1] = 1;
  if (m.local) {
    // body axes: those of the material's local system, else the principal ones
    const int system = model_.parts[m.part].material >= 0
                           ? model_.materials[model_.parts[m.part].material].local_system
                           : -1;
    if (system >= 0)
      g.direction = transpose(matrix_of(b.start_q)) *
                    (transpose(model_.coordinate_systems[system].axes) * g.direction);
    g.in_body = true;
  }
  const Vec3d d = g.in_body ? matrix_of(b.motion.q) * g.direction : g.direction;
  const double now = g.rotation || m.local ? motion_angle_[index] : dot(d, b.displacement());
  const double before = dot(d, g.rotation ? b.motion.w : b.motion.v);
  g.target = motion_velocity(model_, m, state, now, before);
  return true;
}

void RigidBodies::ground_conditions(const State& state, int body, int local,
                                    std::vector<GroundCondition>& out,
                                    std::vector<int>& motion_of) const {
  const RigidBody& b = bodies_[body];
  if (b.part >= 0 && model_.parts[b.part].material >= 0) {
    const Material& m = model_.materials[model_.parts[b.part].material];
    code_conditions(m.cmo, m.con1, m.con2, m.local_system, local, out);
  } else if (b.nodal >= 0) {
    const NodalRigidBody& m = model_.nodal_rigid_bodies[b.nodal];
    code_conditions(m.cmo, m.con1, m.con2, m.local_system, local, out);
  }
  support_conditions(state, body, local, out);
  motion_of.resize(out.size(), -1);
  for (int index : motions_[body]) {
    GroundCondition g;
    if (!motion_condition(state, index, local, g)) continue;
    out.push_back(g);
    motion_of.push_back(index);
  }
}

}  // namespace fabrica
