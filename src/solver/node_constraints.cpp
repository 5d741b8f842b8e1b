#include "solver/node_constraints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "load/time_curve.h"
#include "solver/stream.h"

namespace fabrica {

namespace {

// rows: local axes in global components, now
Mat3d axes_now(const CoordinateSystem& s, const State& state) {
  if (!s.moves || s.node[0] < 0 || s.node[1] < 0 || s.node[2] < 0) return s.axes;
  const Vec3d a = state.nodes[s.node[0]].x;
  Vec3d x = state.nodes[s.node[1]].x - a;
  x = (1 / norm(x)) * x;
  Vec3d z = cross(x, state.nodes[s.node[2]].x - a);
  z = (1 / norm(z)) * z;
  const Vec3d y = cross(z, x);
  return {{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
}

}  // namespace

NodeConstraints::NodeConstraints(const Model& model, const State& state, Diagnostics& diagnostics)
    : model_(model) {
  add_supports(model);
  add_motions(model, diagnostics);
  int refused = 0;
  std::erase_if(conditions_, [&](const Condition& c) {
    const bool owned = state.owner[c.node] != NodeOwner::free;
    if (owned) ++refused;
    return owned || (c.rotation && state.spins.empty());
  });
  if (refused > 0)
    diagnostics.warning(
        "constraint-on-dependent-node", {}, "BOUNDARY_SPC", "NID",
        std::to_string(refused) +
            " conditions act on nodes of rigid bodies or tied nodes and are ignored",
        "constrain the rigid body instead");
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

void NodeConstraints::add_supports(const Model& model) {
  static constexpr std::array<int, 8> masks{0, 1, 2, 4, 3, 6, 5, 7};  // none x y z xy yz zx xyz
  auto unit = [](int k) {
    Vec3d e{};
    e[k] = 1;
    return e;
  };
  for (int n = 0; n < model.nodes.size(); ++n) {
    const int t = n < int(model.nodes.translation_code.size())
                      ? masks[model.nodes.translation_code[n] & 7]
                      : 0;
    const int r =
        n < int(model.nodes.rotation_code.size()) ? masks[model.nodes.rotation_code[n] & 7] : 0;
    for (int k = 0; k < 3; ++k) {
      if (t >> k & 1) conditions_.push_back({n, -1, false, unit(k), -1, 0, 1e28, 0});
      if (r >> k & 1) conditions_.push_back({n, -1, true, unit(k), -1, 0, 1e28, 0});
    }
  }
  for (const SinglePointConstraint& s : model.constraints)
    for (int n : s.nodes)
      for (int k = 0; k < 6; ++k) {
        if (!s.fixed[k]) continue;
        const bool moves = s.local_system >= 0 && model.coordinate_systems[s.local_system].moves;
        // of a moving system the direction is kept in its components
        const Vec3d local = unit(k % 3);
        const Vec3d d = s.local_system < 0 || moves
                            ? local
                            : transpose(model.coordinate_systems[s.local_system].axes) * local;
        conditions_.push_back({n, -1, k >= 3, d, moves ? s.local_system : -1, s.birth, s.death, 0});
      }
}

void NodeConstraints::add_motions(const Model& model, Diagnostics& diagnostics) {
  for (int i = 0; i < int(model.prescribed_motions.size()); ++i) {
    const PrescribedMotion& m = model.prescribed_motions[i];
    if (m.target != PrescribedMotion::Target::nodes) continue;
    if (m.dof < 1 || m.dof > 8 || m.kind < 0 || m.kind > 2 || m.curve < 0) {
      diagnostics.error("unsupported-motion", m.where, "BOUNDARY_PRESCRIBED_MOTION", "DOF",
                        "DOF " + std::to_string(m.dof) + " with VAD " + std::to_string(m.kind) +
                            " is not supported",
                        "use DOF 1-8 and VAD 0, 1 or 2 with a curve");
      continue;
    }
    Vec3d d{};
    if (m.dof % 4 == 0)
      d = (1 / norm(m.direction)) * m.direction;
    else
      d[m.dof % 4 - 1] = 1;
    for (int n : m.nodes) conditions_.push_back({n, i, m.dof >= 5, d, -1, m.birth, m.death, 0});
  }
}

Vec3d NodeConstraints::direction_of(const Condition& c, const State& state) const {
  if (c.system < 0) return c.direction;
  return transpose(axes_now(model_.coordinate_systems[c.system], state)) * c.direction;
}

double NodeConstraints::target_of(const Condition& c, const State& state, const Vec3d& n,
                                  const Vec3d& before) const {
  if (c.motion < 0) return 0;
  const PrescribedMotion& m = model_.prescribed_motions[c.motion];
  const Curve& curve = model_.curves[m.curve];
  const double t = std::max(0.0, state.time - m.birth);
  if (m.kind == 0) return m.scale * curve_integral(curve.x, curve.y, t, t + state.dt) / state.dt;
  if (m.kind == 1) {
    const double from = std::max(0.0, t - 0.5 * state.dt_previous);
    return dot(n, before) + m.scale * curve_integral(curve.x, curve.y, from, t + 0.5 * state.dt);
  }
  const double now = c.rotation ? c.angle : dot(n, state.nodes[c.node].x - model_.nodes.x[c.node]);
  return (m.scale * curve_value(curve.x, curve.y, t + state.dt) - now) / state.dt;
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
  std::array<Vec3d, 3> base;
  std::array<double, 3> value;
  int known = 0;
  for (int i = begin_[entry]; i < begin_[entry + 1] && known < 3; ++i) {
    const Condition& c = conditions_[i];
    if (c.rotation != rotation || !alive(c.birth, c.death, state.time, state.dt)) continue;
    Vec3d n = direction_of(c, state);
    double target = target_of(c, state, n, before);
    const Vec3d whole = n;
    for (int k = 0; k < known; ++k) {
      const double along = dot(whole, base[k]);
      n -= along * base[k], target -= along * value[k];
    }
    const double rest = norm(n);
    if (rest < 1e-6) continue;
    n = (1 / rest) * n, target /= rest;
    const double change = target - dot(n, v);
    const double force = inertia * change / state.mean_dt();
    Vec3d& sum = c.motion < 0 ? (rotation ? reaction.moment : reaction.force)
                              : (rotation ? reaction.motion_moment : reaction.motion_force);
    sum += force * n;
    v += change * n;
    // exact along axes
    for (int k = 0; k < 3; ++k)
      if (std::abs(n[k]) == 1) v[k] = n[k] * target;
    state.energy.external_work += 0.5 * state.dt_previous * force * dot(n, before);
    pending_ += 0.5 * state.dt * force * target;
    base[known] = n, value[known] = target, ++known;
  }
  before = v;
  if (rotation)
    for (int i = begin_[entry]; i < begin_[entry + 1]; ++i)
      if (conditions_[i].rotation)
        conditions_[i].angle += state.dt * dot(direction_of(conditions_[i], state), v);
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
        Vec3d n = direction_of(c, state);
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
  for (const Condition& c : conditions_) write_value(out, c.angle);
  write_value(out, pending_);
}

void NodeConstraints::load(std::istream& in) {
  read_vector(in, reactions_);
  read_vector(in, last_v_);
  read_vector(in, last_w_);
  for (Condition& c : conditions_) read_value(in, c.angle);
  read_value(in, pending_);
}

}  // namespace fabrica
