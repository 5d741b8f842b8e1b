// The motion of rigid bodies in a cycle.
#include "solver/rigid_bodies.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "solver/joints.h"
#include "solver/stream.h"

namespace fabrica {

void RigidBodies::add_force(int body, const Vec3d& force, const Vec3d& moment) {
  bodies_[body].force += force;
  bodies_[body].moment += moment;
}

void RigidBodies::set_velocity(int body, const Vec3d& v, const Vec3d& w) {
  RigidMotion& m = bodies_[body].motion;
  m.v = v, m.w = w;
  m.momentum = inertia_times(matrix_of(m.q), m.inertia, w);
}

void RigidBodies::velocity_from_nodes(int body, const State& state) {
  const RigidBody& b = bodies_[body];
  double mass = 0;
  Vec3d p{}, l{};
  for (int n : b.nodes) mass += state.nodes[n].mass, p += state.nodes[n].mass * state.nodes[n].v;
  const Vec3d v = mass > 0 ? (1 / mass) * p : Vec3d{};
  // inertia of the nodes about the body's centre, which differs from the body's where the deck
  // overrides it
  Mat3d inertia{};
  for (int n : b.nodes) {
    const NodeMotion& node = state.nodes[n];
    const Vec3d r = node.x - b.motion.x;
    l += node.mass * cross(r, node.v - v);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        inertia(i, j) += node.mass * ((i == j ? dot(r, r) : 0) - r[i] * r[j]);
    if (state.spins.empty()) continue;
    l += state.spins[n].inertia * state.spins[n].w;
    for (int i = 0; i < 3; ++i) inertia(i, i) += state.spins[n].inertia;
  }
  const PrincipalAxes p_axes = principal_axes(inertia);
  const double largest = std::max({p_axes.value.x, p_axes.value.y, p_axes.value.z});
  Vec3d local = transpose(p_axes.axes) * l;
  for (int k = 0; k < 3; ++k)
    local[k] = largest > 0 && p_axes.value[k] > 1e-9 * largest ? local[k] / p_axes.value[k] : 0.0;
  set_velocity(body, v, p_axes.axes * local);
}

void RigidBodies::give_velocity_to_nodes(State& state) const {
  for (const RigidBody& b : bodies_)
    for (int n : b.nodes) {
      state.nodes[n].v = b.motion.v + cross(b.motion.w, state.nodes[n].x - b.motion.x);
      if (!state.spins.empty()) state.spins[n].w = b.motion.w;
    }
}

double RigidBodies::kinetic_energy() const {
  double e = 0;
  for (const RigidBody& b : bodies_)
    if (b.active)
      e += 0.5 * (b.motion.mass * dot(b.motion.v, b.motion.v) + dot(b.motion.w, b.motion.momentum));
  return e;
}

void RigidBodies::gather(State& state, Team& team) {
  team.for_each_own(int(chunks_.size()), [&](int c, int) {
    const Chunk& chunk = chunks_[c];
    const RigidBody& b = bodies_[chunk.body];
    Vec3d force{}, moment{};
    for (int i = chunk.begin; i < chunk.end; ++i) {
      const int n = b.nodes[i];
      force += state.force[n];
      moment += cross(state.nodes[n].x - b.motion.x, state.force[n]);
      if (!state.spins.empty()) moment += state.moment[n];
    }
    partial_[2 * c] = force, partial_[2 * c + 1] = moment;
  });
  for (std::size_t c = 0; c < chunks_.size(); ++c)
    add_force(chunks_[c].body, partial_[2 * c], partial_[2 * c + 1]);
  break_welds(state);
}

// The force that the weld carries at a node is m a - f; its part along the weld pulls, the rest
// shears.
void RigidBodies::break_welds(State& state) {
  for (RigidBody& b : bodies_) {
    if (!b.active || b.nodal < 0 || b.nodes.size() < 2) continue;
    const NodalRigidBody& weld = model_.nodal_rigid_bodies[b.nodal];
    bool fails = state.time >= weld.failure_time;
    if (!fails && (weld.normal_force > 0 || weld.shear_force > 0)) {
      const RigidMotion& m = b.motion;
      const Mat3d R = matrix_of(m.q);
      const Vec3d a = (1 / m.mass) * b.force;
      const Vec3d alpha = inverse_inertia_times(R, m.inertia, b.moment - cross(m.w, m.momentum));
      const Vec3d first = state.nodes[b.nodes[0]].x;
      for (std::size_t i = 1; i < b.nodes.size() && !fails; ++i) {
        const NodeMotion& node = state.nodes[b.nodes[i]];
        const Vec3d r = node.x - m.x, axis = node.x - first;
        const Vec3d f =
            state.force[b.nodes[i]] - node.mass * (a + cross(alpha, r) + cross(m.w, cross(m.w, r)));
        const double length = norm(axis), total = norm(f);
        // coincident nodes have no axis: the whole force counts as normal
        const double pull = length > 0 ? dot(f, axis) / length : total;
        const double shear =
            length > 0 ? std::sqrt(std::max(0.0, total * total - pull * pull)) : 0.0;
        double sum = 0;
        if (weld.normal_force > 0)
          sum += std::pow(std::max(pull, 0.0) / weld.normal_force, weld.normal_exponent);
        if (weld.shear_force > 0) sum += std::pow(shear / weld.shear_force, weld.shear_exponent);
        fails = sum >= 1;
      }
    }
    if (!fails) continue;
    b.active = false;
    for (int n : b.nodes) state.owner[n] = NodeOwner::free, node_to_body_[n] = -1;
  }
}

double RigidBodies::place_nodes(State& state, Team& team) {
  std::vector<Mat3d> R(bodies_.size());
  std::vector<Quaternion> turn(bodies_.size());
  for (int b = 0; b < size(); ++b) {
    R[b] = matrix_of(bodies_[b].motion.q);
    turn[b] = normalised(bodies_[b].motion.q * bodies_[b].start_q.conjugate());
  }
  const double rate = state.dt > 0 ? 1 / state.dt : 0;
  std::vector<double> fastest(chunks_.size(), 0);
  team.for_each_own(int(chunks_.size()), [&](int c, int) {
    const Chunk& chunk = chunks_[c];
    const RigidBody& b = bodies_[chunk.body];
    if (!b.active) return;
    double square = 0;
    for (int i = chunk.begin; i < chunk.end; ++i) {
      NodeMotion& node = state.nodes[b.nodes[i]];
      const Vec3d x = b.motion.x + R[chunk.body] * b.r[i];
      node.v = rate * (x - node.x);
      node.x = x;
      square = std::max(square, dot(node.v, node.v));
      if (state.spins.empty()) continue;
      NodeSpin& spin = state.spins[b.nodes[i]];
      const Quaternion& q = turn[chunk.body];
      spin.w = b.motion.w;
      spin.q[0] = q.w, spin.q[1] = q.x, spin.q[2] = q.y, spin.q[3] = q.z;
    }
    fastest[c] = square;
  });
  double square = 0;
  for (const double s : fastest) square = std::max(square, s);
  return std::sqrt(square);
}

// Bodies that joints connect are solved together.
void RigidBodies::build_components(const Joints* joints) {
  std::vector<int> parent(size());
  std::iota(parent.begin(), parent.end(), 0);
  auto root = [&](int i) {
    while (parent[i] != i) i = parent[i];
    return i;
  };
  for (int j = 0; joints && j < joints->size(); ++j) {
    const int a = root(joints->joints_[j].a), b = root(joints->joints_[j].b);
    parent[std::max(a, b)] = std::min(a, b);
  }
  components_.clear(), component_links_.clear();
  std::vector<int> index(size(), -1);
  for (int b = 0; b < size(); ++b) {
    const int r = root(b);
    if (r == b)
      index[b] = int(components_.size()), components_.push_back({}), component_links_.push_back({});
    components_[index[r]].push_back(b);
  }
  for (int j = 0; joints && j < joints->size(); ++j)
    component_links_[index[root(joints->joints_[j].a)]].push_back(j);
  plain_.clear();
  for (std::size_t c = 0; c < components_.size(); ++c) {
    const RigidBody& b = bodies_[components_[c][0]];
    const int material = b.part >= 0 ? model_.parts[b.part].material : -1;
    const int cmo = b.part < 0      ? model_.nodal_rigid_bodies[b.nodal].cmo
                    : material >= 0 ? model_.materials[material].cmo
                                    : 0;
    plain_.push_back(component_links_[c].empty() && cmo == 0 &&
                     motions_[components_[c][0]].empty() && supports_[components_[c][0]].empty());
  }
  order_components();
  components_known_ = true;
}

// Leads of relative motions before those that follow them; otherwise in the order of the bodies.
void RigidBodies::order_components() {
  std::vector<int> component_of(size());
  for (std::size_t c = 0; c < components_.size(); ++c)
    for (int b : components_[c]) component_of[b] = int(c);
  order_.clear();
  std::vector<unsigned char> seen(components_.size(), 0);
  const auto visit = [&](const auto& self, int c) -> void {
    if (seen[c]) return;
    seen[c] = 1;
    for (int b : components_[c])
      for (int i : motions_[b])
        if (const PrescribedMotion& m = model_.prescribed_motions[i]; m.kind == 4)
          self(self, component_of[part_to_body_[m.lead]]);
    order_.push_back(c);
  };
  for (int c = 0; c < int(components_.size()); ++c) visit(visit, c);
}

void RigidBodies::accept(State& state, int body, const RigidTrial& trial) {
  RigidBody& b = bodies_[body];
  const double rate = 1 / state.mean_dt();
  b.acceleration = rate * (trial.v - b.motion.v);
  b.angular_acceleration = rate * (trial.w - b.motion.w);
  b.rotation += state.dt * trial.w;
  b.motion.v = trial.v, b.motion.w = trial.w, b.motion.momentum = trial.momentum;
  b.motion.x = trial.x, b.motion.q = trial.q;
  b.applied_force = b.force, b.applied_moment = b.moment;
  b.force = b.moment = {};
  advanced_[body] = 1;
}

void RigidBodies::integrate(State& state, Joints* joints) {
  if (!components_known_) build_components(joints);
  std::fill(motion_reaction_.begin(), motion_reaction_.end(), 0.0);
  state.energy.external_work += pending_external_;
  state.energy.joint += pending_joint_;
  pending_external_ = pending_joint_ = 0;
  for (RigidBody& b : bodies_) b.constraint_force = b.constraint_moment = {};
  advanced_.assign(bodies_.size(), 0);
  for (const int c : order_) {
    if (!plain_[c]) {
      solve_component(state, components_[c], joints, component_links_[c]);
      continue;
    }
    // most bodies: nothing holds them
    const RigidBody& b = bodies_[components_[c][0]];
    RigidTrial t{};
    t.v = b.motion.v + (state.mean_dt() / b.motion.mass) * b.force;
    t.momentum = b.motion.momentum + state.mean_dt() * b.moment;
    t.w = b.motion.w;
    advance_trial(b.motion, state.dt, t);
    accept(state, components_[c][0], t);
  }
}

// A component's bodies and conditions, numbered locally.
struct RigidBodies::Problem {
  std::vector<RigidMotion> before;
  std::vector<RigidTrial> trials;
  std::vector<GroundCondition> grounds;
  std::vector<int> motion_of;  // prescribed motion of each ground condition, -1: constraint code
  std::vector<LinkCondition> links;
  std::vector<int> joint_of;  // of each link condition
};

RigidBodies::Problem RigidBodies::pose(const State& state, const std::vector<int>& members,
                                       Joints* joints, const std::vector<int>& links) const {
  Problem p;
  const double dt_v = state.mean_dt();
  for (int member : members) {
    const RigidBody& b = bodies_[member];
    RigidTrial t{};
    t.v = b.motion.v + (dt_v / b.motion.mass) * b.force;
    t.momentum = b.motion.momentum + dt_v * b.moment;
    t.w = b.motion.w;
    if (b.active) ground_conditions(state, member, int(p.before.size()), p.grounds, p.motion_of);
    p.before.push_back(b.motion);
    p.trials.push_back(t);
  }
  auto local_of = [&](int body) {
    return int(std::lower_bound(members.begin(), members.end(), body) - members.begin());
  };
  for (int j : links) {
    const Joints::Item& item = joints->joints_[j];
    for (const JointCondition& c : item.conditions) {
      p.links.push_back({local_of(item.a), local_of(item.b), &item.geometry, &c});
      p.joint_of.push_back(j);
    }
  }
  return p;
}

// Reactions and their work: half with the velocity before, half with the one after.
void RigidBodies::book(State& state, const std::vector<int>& members, Joints* joints,
                       const Problem& p, const Component& component) {
  for (std::size_t i = 0; i < component.rows().size(); ++i) {
    const Component::Row& row = component.rows()[i];
    const double reaction = component.impulse[i] / state.mean_dt();
    double speed_before = dot(row.j.b_v, p.before[row.b].v) + dot(row.j.b_w, p.before[row.b].w);
    double speed_after = dot(row.j.b_v, p.trials[row.b].v) + dot(row.j.b_w, p.trials[row.b].w);
    RigidBody& b = bodies_[members[row.b]];
    b.constraint_force += reaction * row.j.b_v;
    b.constraint_moment += reaction * row.j.b_w;
    if (row.a >= 0) {
      speed_before += dot(row.j.a_v, p.before[row.a].v) + dot(row.j.a_w, p.before[row.a].w);
      speed_after += dot(row.j.a_v, p.trials[row.a].v) + dot(row.j.a_w, p.trials[row.a].w);
      RigidBody& a = bodies_[members[row.a]];
      a.constraint_force += reaction * row.j.a_v;
      a.constraint_moment += reaction * row.j.a_w;
    }
    const double first = 0.5 * state.dt_previous * speed_before * reaction;
    const double second = 0.5 * state.dt * speed_after * reaction;
    if (i < p.grounds.size()) {
      state.energy.external_work += first, pending_external_ += second;
      if (p.motion_of[i] >= 0) motion_reaction_[p.motion_of[i]] = reaction;
      continue;
    }
    state.energy.joint -= first, pending_joint_ -= second;
    Joints::Item& item = joints->joints_[p.joint_of[i - p.grounds.size()]];
    const Vec3d arm = matrix_of(p.before[row.b].q) * item.geometry.point_b;
    item.force += reaction * row.j.b_v;
    item.moment += reaction * (row.j.b_w - cross(arm, row.j.b_v));
  }
}

void RigidBodies::solve_component(State& state, const std::vector<int>& members, Joints* joints,
                                  const std::vector<int>& links) {
  Problem p = pose(state, members, joints, links);
  for (int j : links) joints->joints_[j].force = joints->joints_[j].moment = {};
  if (p.grounds.empty() && p.links.empty()) {
    for (std::size_t i = 0; i < members.size(); ++i)
      advance_trial(p.before[i], state.dt, p.trials[i]);
  } else {
    Component component;
    component.solve(p.before, p.trials, state.dt, p.grounds, p.links);
    book(state, members, joints, p, component);
  }
  for (std::size_t i = 0; i < p.motion_of.size(); ++i) {
    if (p.motion_of[i] < 0) continue;
    const GroundCondition& g = p.grounds[i];
    const RigidTrial& t = p.trials[g.body];
    const Vec3d d = g.in_body ? matrix_of(t.q_half) * g.direction : g.direction;
    motion_angle_[p.motion_of[i]] += state.dt * dot(d, g.rotation ? t.w : t.v);
  }
  for (std::size_t i = 0; i < members.size(); ++i) accept(state, members[i], p.trials[i]);
}

void RigidBodies::save(std::ostream& out) const {
  for (const RigidBody& b : bodies_) {
    write_value(out, b.active);
    write_value(out, b.motion);
    for (const Vec3d* v :
         {&b.force, &b.moment, &b.applied_force, &b.applied_moment, &b.constraint_force,
          &b.constraint_moment, &b.acceleration, &b.angular_acceleration, &b.rotation})
      write_value(out, *v);
  }
  write_vector(out, motion_angle_);
  write_vector(out, motion_reaction_);
  write_value(out, pending_external_);
  write_value(out, pending_joint_);
}

void RigidBodies::load(std::istream& in) {
  for (RigidBody& b : bodies_) {
    read_value(in, b.active);
    read_value(in, b.motion);
    for (Vec3d* v : {&b.force, &b.moment, &b.applied_force, &b.applied_moment, &b.constraint_force,
                     &b.constraint_moment, &b.acceleration, &b.angular_acceleration, &b.rotation})
      read_value(in, *v);
    if (!b.active)
      for (int n : b.nodes) node_to_body_[n] = -1;
  }
  read_vector(in, motion_angle_);
  read_vector(in, motion_reaction_);
  read_value(in, pending_external_);
  read_value(in, pending_joint_);
}

}  // namespace fabrica
