#include "solver/node_constraints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "load/time_curve.h"
#include "solver/motion_target.h"
#include "solver/stream.h"
#include "solver/supports.h"

namespace fabrica {

NodeConstraints::NodeConstraints(const Model& model, const State& state, Diagnostics& diagnostics)
    : model_(model) {
  for_each_support(model, [&](int node, const NodeSupport& c) {
    Condition condition;
    static_cast<NodeSupport&>(condition) = c;
    condition.node = node;
    conditions_.push_back(condition);
  });
  add_motions(diagnostics);
  leave_out_dependent(state, diagnostics);
  // supports come before motions, and stay in the order of the deck within each
  std::stable_sort(conditions_.begin(), conditions_.end(),
                   [](const Condition& a, const Condition& b) {
                     if (a.node != b.node) return a.node < b.node;
                     return (a.motion < 0) > (b.motion < 0);
                   });
  for (int i = 0; i < int(conditions_.size()); ++i)
    if (i == 0 || conditions_[i].node != conditions_[i - 1].node) {
      begin_.push_back(i);
      reactions_.push_back({conditions_[i].node, {}, {}, {}, {}});
    }
  begin_.push_back(int(conditions_.size()));
  for (const Reaction& r : reactions_) {
    last_v_.push_back(state.nodes[r.node].v);
    last_w_.push_back(state.spins.empty() ? Vec3d{} : state.spins[r.node].w);
  }
}

namespace {

// nodes on which a condition has no effect
struct Idle {
  int count = 0, first = -1, last = -1;
  void add(int node) {
    if (node == last) return;  // another direction of the same
    if (count++ == 0) first = node;
    last = node;
  }
};

}  // namespace

// Supports of nodes of rigid bodies are the body's business (rigid_bodies.h).
void NodeConstraints::leave_out_dependent(const State& state, Diagnostics& diagnostics) {
  Idle held;
  std::vector<Idle> of_body(model_.prescribed_motions.size()), of_tie = of_body, still = of_body;
  std::erase_if(conditions_, [&](const Condition& c) {
    const NodeOwner owner = state.owner[c.node];
    const bool turns = !state.spins.empty() && state.spins[c.node].inertia > 0;
    if (c.motion < 0) {
      if (owner == NodeOwner::tied && (!c.rotation || turns)) held.add(c.node);
    } else if (owner != NodeOwner::free) {
      (owner == NodeOwner::rigid ? of_body : of_tie)[c.motion].add(c.node);
    } else if (c.rotation && !turns) {
      still[c.motion].add(c.node);
    }
    return owner != NodeOwner::free || (c.rotation && state.spins.empty());
  });

  const auto report = [&](const Idle& idle, const char* name, Location where, const char* keyword,
                          const char* what, const char* remedy) {
    if (idle.count > 0)
      diagnostics.add({Severity::unsupported, name, where, keyword, "nid",
                       std::to_string(idle.count) + " nodes " + what + ", node " +
                           std::to_string(model_.nodes.id[idle.first]) + " first",
                       remedy});
  };
  Location where;
  for (const SinglePointConstraint& c : model_.constraints)
    if (std::find(c.nodes.begin(), c.nodes.end(), held.first) != c.nodes.end()) {
      where = c.where;
      break;
    }
  report(held, "support-of-tied-node", where, "BOUNDARY_SPC",
         "are tied by a contact and cannot be held as well",
         "Hold what they are tied to, or take them out of the tied side");
  constexpr const char* motion = "BOUNDARY_PRESCRIBED_MOTION";
  for (std::size_t i = 0; i < of_body.size(); ++i) {
    const Location at = model_.prescribed_motions[i].where;
    // all but those that the deck names, which are known: nodes that ties put on a body
    if (of_body[i].count > model_.prescribed_motions[i].rigid_nodes)
      report(of_body[i], "motion-of-rigid-node", at, motion,
             "belong to rigid bodies and cannot be moved alone",
             "Move the body by *BOUNDARY_PRESCRIBED_MOTION_RIGID");
    report(of_tie[i], "motion-of-tied-node", at, motion,
           "are tied by a contact and cannot be moved as well",
           "Move what they are tied to, or take them out of the tied side");
    report(still[i], "rotation-of-node-without", at, motion,
           "have no rotation that could be prescribed",
           "Move the nodes on a circle by DOF 9 to 11, or make them a rigid body");
  }
}

void NodeConstraints::add_motions(Diagnostics& diagnostics) {
  for (int i = 0; i < int(model_.prescribed_motions.size()); ++i) {
    const PrescribedMotion& m = model_.prescribed_motions[i];
    if (m.target != PrescribedMotion::Target::nodes) continue;
    const int dof = std::abs(m.dof), kinds = dof >= 9 ? 2 : 3;
    const bool known = dof >= 1 && dof <= 11 && (m.dof > 0 || dof % 4 == 0 || dof >= 9);
    if (!known || m.kind < 0 || m.kind > kinds || m.curve < 0) {
      diagnostics.error("unsupported-motion", m.where, "BOUNDARY_PRESCRIBED_MOTION", "DOF",
                        "DOF " + std::to_string(m.dof) + " with VAD " + std::to_string(m.kind) +
                            " is not supported",
                        "use DOF 1-11, -4, -8 to -11 and VAD 0, 1, 2, 3 (DOF 1-8) with a curve");
      continue;
    }
    for (int n : m.nodes) add_motion(n, i);
  }
}

void NodeConstraints::add_motion(int node, int motion) {
  const PrescribedMotion& m = model_.prescribed_motions[motion];
  const int dof = std::abs(m.dof);
  Condition c;
  c.node = node, c.motion = motion, c.birth = m.birth, c.death = m.death;
  const auto add = [&](Aim aim, const Vec3d& direction) {
    c.aim = aim, c.direction = direction;
    conditions_.push_back(c);
  };
  const auto unit = [](int k) {
    Vec3d e{};
    e[k % 3] = 1;
    return e;
  };
  if (dof >= 9) {
    // the plane of the rotation about x, y or z
    if (m.dof < 0) return add(Aim::ray, unit(dof - 9));
    add(Aim::circle_a, unit(dof - 9 + 1));
    return add(Aim::circle_b, unit(dof - 9 + 2));
  }
  c.rotation = dof >= 5;
  if (dof % 4 != 0) return add(Aim::along, unit(dof % 4 - 1));
  const Vec3d d = (1 / norm(m.direction)) * m.direction;
  add(Aim::along, d);
  if (m.dof > 0) return;
  // held across the direction
  Vec3d e = cross(d, std::abs(d.x) < 0.9 ? unit(0) : unit(1));
  e = (1 / norm(e)) * e;
  add(Aim::held, e);
  add(Aim::held, cross(d, e));
}

// Place of the node in the plane of its rotation, from the axis.
std::array<double, 2> NodeConstraints::arm_of(const Condition& c, const Vec3d& x) const {
  const PrescribedMotion& m = model_.prescribed_motions[c.motion];
  const int axis = std::abs(m.dof) - 9;
  return {x[(axis + 1) % 3] - m.offset[0], x[(axis + 2) % 3] - m.offset[1]};
}

// n and the target of n . v+. With the angle turned in the step, phi, a node on a circle ends at
// R(phi) r. One that may leave the circle is pushed across its ray as it stands, and ends on the
// ray through R(phi) r whatever its radial velocity.
NodeConstraints::Goal NodeConstraints::goal_of(const Condition& c, const State& state,
                                               const Vec3d& before) const {
  const Vec3d n = carried_direction(model_, state, c.direction, c.system);
  if (c.motion < 0 || c.aim == Aim::held) return {n, 0};
  const PrescribedMotion& m = model_.prescribed_motions[c.motion];
  const NodeMotion& node = state.nodes[c.node];
  if (c.aim == Aim::along) {
    const double now = c.rotation ? c.angle : dot(n, node.x - model_.nodes.x[c.node]);
    return {n, motion_velocity(model_, m, state, now, dot(n, before))};
  }
  const auto r = arm_of(c, node.x);
  const int axis = std::abs(m.dof) - 9;
  const double length = std::hypot(r[0], r[1]);
  if (!(length > 0)) return {n, 0};
  const Vec3d& v = before;
  const double start = r[0] * v[(axis + 2) % 3] - r[1] * v[(axis + 1) % 3];
  const double rate = state.cycle == 0 ? start / (length * length) : c.rate;
  const double phi = state.dt * motion_velocity(model_, m, state, c.angle, rate);
  const double co = std::cos(phi), si = std::sin(phi);
  const std::array<double, 2> turned{co * r[0] - si * r[1], si * r[0] + co * r[1]};
  if (c.aim == Aim::circle_a) return {n, (turned[0] - r[0]) / state.dt};
  if (c.aim == Aim::circle_b) return {n, (turned[1] - r[1]) / state.dt};
  Vec3d radial{}, across{};
  radial[(axis + 1) % 3] = across[(axis + 2) % 3] = r[0] / length;
  radial[(axis + 2) % 3] = r[1] / length, across[(axis + 1) % 3] = -r[1] / length;
  return {across, si / co * (length / state.dt + dot(radial, node.v))};
}

// Angles that the node has turned about its directions and axes after this step.
void NodeConstraints::turn_on(Condition& c, const State& state) const {
  if (c.rotation) {
    const Vec3d n = carried_direction(model_, state, c.direction, c.system);
    c.angle += state.dt * dot(n, state.spins[c.node].w);
    return;
  }
  if (c.aim == Aim::along || c.aim == Aim::held) return;
  const NodeMotion& node = state.nodes[c.node];
  const auto r = arm_of(c, node.x), end = arm_of(c, node.x + state.dt * node.v);
  const double turn = std::atan2(r[0] * end[1] - r[1] * end[0], r[0] * end[0] + r[1] * end[1]);
  c.angle += turn, c.rate = turn / state.dt;
}

int NodeConstraints::targets(const State& state, int entry, bool rotation, const Vec3d& before,
                             std::array<Target, 3>& out) const {
  int known = 0;
  for (int i = begin_[entry]; i < begin_[entry + 1] && known < 3; ++i) {
    const Condition& c = conditions_[i];
    if (c.rotation != rotation || !alive(c.birth, c.death, state.time, state.dt)) continue;
    auto [n, target] = goal_of(c, state, before);
    const Vec3d whole = n;
    for (int k = 0; k < known; ++k) {
      const double along = dot(whole, out[k].direction);
      n -= along * out[k].direction, target -= along * out[k].velocity;
    }
    const double rest = norm(n);
    if (rest < 1e-6) continue;
    out[known++] = {(1 / rest) * n, target / rest, c.motion < 0};
  }
  return known;
}

void NodeConstraints::apply_node(State& state, int entry, bool rotation) {
  Reaction& reaction = reactions_[entry];
  const int node = reaction.node;
  const double inertia = rotation ? state.spins[node].inertia : state.nodes[node].mass;
  Vec3d& v = rotation ? state.spins[node].w : state.nodes[node].v;
  Vec3d& before = rotation ? last_w_[entry] : last_v_[entry];
  // initial velocities may have been set after this object was made
  if (state.cycle == 0)
    before = v - (state.mean_dt() / inertia) * (rotation ? state.moment : state.force)[node];
  std::array<Target, 3> list;
  const int known = targets(state, entry, rotation, before, list);
  for (int i = 0; i < known; ++i) {
    const Vec3d n = list[i].direction;
    const double target = list[i].velocity;
    const double change = target - dot(n, v);
    const double force = inertia * change / state.mean_dt();
    Vec3d& sum = list[i].support ? (rotation ? reaction.moment : reaction.force)
                                 : (rotation ? reaction.motion_moment : reaction.motion_force);
    sum += force * n;
    v += change * n;
    // exact along axes
    for (int k = 0; k < 3; ++k)
      if (std::abs(n[k]) == 1) v[k] = n[k] * target;
    state.energy.external_work += 0.5 * state.dt_previous * force * dot(n, before);
    pending_ += 0.5 * state.dt * force * target;
  }
  before = v;
  for (int i = begin_[entry]; i < begin_[entry + 1]; ++i)
    if (conditions_[i].rotation == rotation) turn_on(conditions_[i], state);
}

void NodeConstraints::stop_supported(State& state) const {
  for (int e = 0; e < size(); ++e)
    for (const bool rotation : {false, true}) {
      if (rotation && state.spins.empty()) continue;
      Vec3d& v = rotation ? state.spins[reactions_[e].node].w : state.nodes[reactions_[e].node].v;
      std::array<Vec3d, 3> base;
      int known = 0;
      for (int i = begin_[e]; i < begin_[e + 1] && known < 3; ++i) {
        const Condition& c = conditions_[i];
        if (c.motion >= 0 || c.rotation != rotation || !alive(c.birth, c.death, 0, 0)) continue;
        Vec3d n = carried_direction(model_, state, c.direction, c.system);
        for (int k = 0; k < known; ++k) n -= dot(n, base[k]) * base[k];
        const double rest = norm(n);
        if (rest < 1e-6) continue;
        base[known++] = n = (1 / rest) * n;
        v -= dot(n, v) * n;
      }
    }
}

void NodeConstraints::apply(State& state) {
  state.energy.external_work += pending_;
  pending_ = 0;
  for (int e = 0; e < size(); ++e) {
    Reaction& r = reactions_[e];
    r = {r.node, {}, {}, {}, {}};
    if (state.owner[r.node] != NodeOwner::free) continue;
    apply_node(state, e, false);
    if (!state.spins.empty() && state.spins[r.node].inertia > 0) apply_node(state, e, true);
  }
}

void NodeConstraints::save(std::ostream& out) const {
  write_vector(out, reactions_);
  write_vector(out, last_v_);
  write_vector(out, last_w_);
  for (const Condition& c : conditions_) write_value(out, c.angle), write_value(out, c.rate);
  write_value(out, pending_);
}

void NodeConstraints::load(std::istream& in) {
  read_vector(in, reactions_);
  read_vector(in, last_v_);
  read_vector(in, last_w_);
  for (Condition& c : conditions_) read_value(in, c.angle), read_value(in, c.rate);
  read_value(in, pending_);
}

}  // namespace fabrica
