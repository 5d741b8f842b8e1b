#include "solver/loads.h"

#include <algorithm>
#include <string>

#include "load/pressure.h"
#include "load/time_curve.h"
#include "solver/stream.h"

namespace fabrica {

namespace {

constexpr int chunk_nodes = 4096;

// 1 for nodes of elements of the parts
std::vector<unsigned char> nodes_of_parts(const Model& model, const std::vector<int>& parts) {
  std::vector<unsigned char> part(model.parts.size(), 0), node(model.nodes.size(), 0);
  for (int p : parts) part[p] = 1;
  auto mark = [&](const auto& family) {
    for (int e = 0; e < family.size(); ++e)
      if (part[family.part[e]])
        for (int n : family.node[e])
          if (n >= 0) node[n] = 1;
  };
  mark(model.solids), mark(model.shells), mark(model.beams), mark(model.discretes);
  return node;
}

}  // namespace

Loads::Loads(const Model& model, const State& state, const RigidBodies& bodies,
             Diagnostics& diagnostics)
    : model_(model) {
  for (const BodyLoad& b : model.body_loads) {
    Gravity g;
    std::vector<unsigned char> with(bodies.size(), b.parts.empty());
    if (!b.parts.empty()) {
      g.on_node = nodes_of_parts(model, b.parts);
      for (int p : b.parts)
        if (bodies.body_of_part(p) >= 0) with[bodies.body_of_part(p)] = 1;
    }
    for (int i = 0; i < bodies.size(); ++i)
      if (with[i]) g.bodies.push_back(i);
    gravity_.push_back(std::move(g));
  }
  for (const NodalLoad& l : model.nodal_loads) {
    if (l.part >= 0 && bodies.body_of_part(l.part) < 0)
      diagnostics.error("load-of-deformable-part", {}, "LOAD_RIGID_BODY", "PID",
                        "the part is not rigid", "use *LOAD_NODE_SET");
    if (l.dof < 1 || l.dof > 8 ||
        (l.dof % 4 == 0 && (l.follower[0] < 0 || l.follower[1] < 0 || l.follower[2] < 0)))
      diagnostics.error(
          "unsupported-load", {}, "LOAD_NODE", "DOF",
          "DOF " + std::to_string(l.dof) + " is not supported or lacks its three nodes",
          "use 1-3, 5-7, or 4 and 8 with M1, M2, M3");
    check_moment(l, state, bodies, diagnostics);
    last_nodal_.emplace_back(l.part >= 0 ? 1 : l.nodes.size(), Vec3d{});
  }
  for (const PressureLoad& p : model.pressure_loads)
    last_pressure_.emplace_back(p.segments.size(), Vec3d{});
}

// a moment turns bodies and nodes with an inertia, and nothing else
void Loads::check_moment(const NodalLoad& load, const State& state, const RigidBodies& bodies,
                         Diagnostics& diagnostics) const {
  if (load.dof <= 4) return;
  const auto turns = [&](int n) {
    return bodies.body_of_node(n) >= 0 || (!state.spins.empty() && state.spins[n].inertia > 0);
  };
  const auto idle = std::find_if_not(load.nodes.begin(), load.nodes.end(), turns);
  if (idle == load.nodes.end()) return;
  const auto count = std::count_if(idle, load.nodes.end(), [&](int n) { return !turns(n); });
  diagnostics.add({Severity::unsupported, "moment-without-rotation", load.where, "LOAD_NODE", "dof",
                   "the moment acts on " + std::to_string(count) +
                       " nodes that have no rotation, node " +
                       std::to_string(model_.nodes.id[*idle]) + " first",
                   "Apply it as a couple of forces, or to a rigid body"});
}

double Loads::value(int curve, double scale, double time) const {
  if (curve < 0) return scale;
  const Curve& c = model_.curves[curve];
  return scale * curve_value(c.x, c.y, time);
}

// Unit vector of the load: an axis, or the normal of the plane of three nodes.
Vec3d Loads::nodal_direction(const NodalLoad& load, const State& state) const {
  if (load.dof % 4 == 0) {
    const Vec3d a = state.nodes[load.follower[0]].x;
    const Vec3d n = cross(state.nodes[load.follower[1]].x - a, state.nodes[load.follower[2]].x - a);
    const double size = norm(n);
    return size > 0 ? (1 / size) * n : Vec3d{};
  }
  Vec3d e{};
  e[load.dof % 4 - 1] = 1;
  return load.local_system >= 0 ? transpose(model_.coordinate_systems[load.local_system].axes) * e
                                : e;
}

void Loads::forces(State& state, RigidBodies& bodies) {
  double work = 0;
  for (std::size_t i = 0; i < model_.nodal_loads.size(); ++i) {
    const NodalLoad& l = model_.nodal_loads[i];
    const Vec3d f = value(l.curve, l.scale, state.time) * nodal_direction(l, state);
    const bool moment = l.dof > 4;
    if (l.part >= 0) {
      const int b = bodies.body_of_part(l.part);
      bodies.add_force(b, moment ? Vec3d{} : f, moment ? f : Vec3d{});
      work += dot(last_nodal_[i][0] + f, moment ? bodies[b].motion.w : bodies[b].motion.v);
      last_nodal_[i][0] = f;
      continue;
    }
    for (std::size_t k = 0; k < l.nodes.size(); ++k) {
      const int n = l.nodes[k];
      // where no element has rotations, those of bodies are with the bodies alone
      if (moment && state.spins.empty()) {
        const int b = bodies.body_of_node(n);
        if (b < 0) continue;
        bodies.add_force(b, Vec3d{}, f);
        work += dot(last_nodal_[i][k] + f, bodies[b].motion.w);
        last_nodal_[i][k] = f;
        continue;
      }
      (moment ? state.interaction_moment : state.interaction).add(std::size_t(n), f);
      work += dot(last_nodal_[i][k] + f, moment ? state.spins[n].w : state.nodes[n].v);
      last_nodal_[i][k] = f;
    }
  }
  for (std::size_t i = 0; i < model_.pressure_loads.size(); ++i) {
    const PressureLoad& load = model_.pressure_loads[i];
    const double p =
        state.time < load.arrival ? 0 : value(load.curve, load.scale, state.time - load.arrival);
    for (std::size_t s = 0; s < load.segments.size(); ++s) {
      const auto& n = load.segments[s];
      const bool triangle = n[3] < 0 || n[3] == n[2];
      const Vec3d x[4] = {state.nodes[n[0]].x, state.nodes[n[1]].x, state.nodes[n[2]].x,
                          state.nodes[triangle ? n[2] : n[3]].x};
      const Vec3d f = pressure_corner_force(x, triangle, p);
      for (int k = 0; k < (triangle ? 3 : 4); ++k) {
        state.interaction.add(std::size_t(n[k]), f);
        work += dot(last_pressure_[i][s] + f, state.nodes[n[k]].v);
      }
      last_pressure_[i][s] = f;
    }
  }
  state.energy.external_work += 0.5 * state.dt_previous * work;
}

void Loads::body_forces(State& state, RigidBodies& bodies, Team& team) {
  const std::size_t n = state.nodes.size();
  for (std::size_t i = 0; i < gravity_.size(); ++i) {
    Gravity& g = gravity_[i];
    const BodyLoad& load = model_.body_loads[i];
    const double a = -value(load.curve, load.scale, state.time);
    if (a == 0 && g.last == 0) continue;
    partial_.assign(Team::ranges(n, chunk_nodes), 0);
    team.for_ranges(n, chunk_nodes, [&](int chunk, int first, int last) {
      double power = 0;
      for (int k = first; k < last; ++k) {
        if (state.owner[k] == NodeOwner::rigid || (!g.on_node.empty() && !g.on_node[k])) continue;
        const double m = state.physical_mass[k];
        state.force[k] += (m * a) * load.direction;
        power += m * dot(load.direction, state.nodes[k].v);
      }
      partial_[chunk] = power;
    });
    double power = 0;
    for (double p : partial_) power += p;
    for (int b : g.bodies) {
      if (!bodies[b].active) continue;
      bodies.add_force(b, (bodies[b].motion.mass * a) * load.direction, {});
      power += bodies[b].motion.mass * dot(load.direction, bodies[b].motion.v);
    }
    state.energy.external_work += 0.5 * state.dt_previous * (g.last + a) * power;
    g.last = a;
  }
}

Vec3d Loads::acceleration(int part, double time) const {
  Vec3d sum{};
  for (const BodyLoad& b : model_.body_loads)
    if (b.parts.empty() || std::find(b.parts.begin(), b.parts.end(), part) != b.parts.end())
      sum -= value(b.curve, b.scale, time) * b.direction;
  return sum;
}

void Loads::save(std::ostream& out) const {
  for (const Gravity& g : gravity_) write_value(out, g.last);
  for (const auto& v : last_nodal_) write_vector(out, v);
  for (const auto& v : last_pressure_) write_vector(out, v);
}

void Loads::load(std::istream& in) {
  for (Gravity& g : gravity_) read_value(in, g.last);
  for (auto& v : last_nodal_) read_vector(in, v);
  for (auto& v : last_pressure_) read_vector(in, v);
}

}  // namespace fabrica
