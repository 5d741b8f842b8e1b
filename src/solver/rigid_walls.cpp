#include "solver/rigid_walls.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "load/time_curve.h"
#include "solver/stream.h"

namespace fabrica {

namespace {

constexpr int chunk_nodes = 1024;

int chunk_count(int nodes) { return (nodes + chunk_nodes - 1) / chunk_nodes; }

Vec3d unit(const Vec3d& a) { return norm(a) > 0 ? (1 / norm(a)) * a : Vec3d{0, 0, 1}; }

WallGeometry geometry_of(const RigidWall& w) {
  WallGeometry g;
  using Shape = RigidWall::Shape;
  g.shape = w.shape == Shape::sphere     ? WallShape::sphere
            : w.shape == Shape::cylinder ? WallShape::cylinder
            : w.shape == Shape::prism    ? WallShape::prism
                                         : WallShape::plane;
  g.origin = w.tail;
  g.normal = unit(w.head - w.tail);
  g.radius = w.radius, g.length = w.length;
  g.length_l = w.length_l, g.length_m = w.length_m;
  // edge l in the plane of the wall; m completes the triad
  Vec3d l = w.edge - w.tail;
  l -= dot(l, g.normal) * g.normal;
  const bool given = norm(l) > 1e-12 * (norm(w.edge) + norm(w.tail)) && norm(l) > 0;
  const Vec3d other = std::abs(g.normal.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  g.edge_l = given ? unit(l) : unit(cross(cross(g.normal, other), g.normal));
  g.edge_m = cross(g.normal, g.edge_l);
  return g;
}

// v(n-1/2)
Vec3d velocity_before(const State& state, int node) {
  const NodeMotion& a = state.nodes[node];
  return a.v - (state.mean_dt() * a.inverse_mass) * state.force[node];
}

}  // namespace

RigidWalls::RigidWalls(const Model& model, const State& state, Diagnostics& diagnostics,
                       WallMethod method)
    : model_(model), method_(method) {
  std::size_t most = 0;
  for (int i = 0; i < int(model.rigid_walls.size()); ++i) {
    const RigidWall& w = model.rigid_walls[i];
    Wall wall;
    wall.index = i;
    wall.geometry = geometry_of(w);
    set_friction_axes(w, wall);
    // with OFFSET only the nodes that are near the plane at the start
    auto add = [&](int n) {
      const double distance = dot(state.nodes[n].x - wall.geometry.origin, wall.geometry.normal);
      if (w.offset > 0 && std::abs(distance) > w.offset) return;
      (state.owner[n] == NodeOwner::rigid ? wall.rigid : wall.free).nodes.push_back(n);
    };
    if (w.all_nodes && w.nodes.empty())
      for (int n = 0; n < model.nodes.size(); ++n) add(n);
    for (int n : w.nodes) add(n);
    if (w.moving && !(w.mass > 0))
      diagnostics.error("rigid-wall-without-mass", {}, "RIGIDWALL_PLANAR_MOVING", "MASS",
                        "a moving wall needs a mass",
                        "give a positive mass, or prescribe its motion");
    if (w.moving) wall.velocity = w.velocity * wall.geometry.normal;
    wall.free.clearance.assign(chunk_count(int(wall.free.nodes.size())), 0);
    wall.rigid.clearance.assign(chunk_count(int(wall.rigid.nodes.size())), 0);
    wall.last.assign(wall.rigid.nodes.size(), {});
    if (w.friction == 2 || w.friction == 3) wall.welded.assign(wall.free.nodes.size(), 0);
    most = std::max({most, wall.free.clearance.size(), wall.rigid.clearance.size()});
    walls_.push_back(std::move(wall));
  }
  hits_.resize(most);
  sums_.resize(most);
}

// The axes a and b = n x a of orthotropic friction, in the plane of the wall.
void RigidWalls::set_friction_axes(const RigidWall& w, Wall& wall) const {
  if (!w.ortho) return;
  Vec3d d = w.ortho->direction;
  const auto& ends = w.ortho->node;
  if (ends[0] >= 0 && ends[1] >= 0) d = model_.nodes.x[ends[1]] - model_.nodes.x[ends[0]];
  wall.axis_b = unit(cross(wall.geometry.normal, d));
  wall.axis_a = cross(wall.axis_b, wall.geometry.normal);
}

// What friction takes from the sliding velocity of a node that the wall changed by dvn along its
// normal.
Vec3d RigidWalls::friction_cut(const Wall& wall, const Vec3d& slip, double dvn) const {
  const RigidWall& w = model_.rigid_walls[wall.index];
  const double size = norm(slip);
  if (!(size > 0)) return {};
  if (w.ortho) {
    const RigidWall::Ortho& o = *w.ortho;
    const auto along = [&](const Vec3d& axis, double fs, double fd, double decay) {
      const double s = dot(slip, axis), mu = fd + (fs - fd) * std::exp(-decay * std::abs(s));
      return std::min(1.0, mu * dvn / size) * s * axis;
    };
    return along(wall.axis_a, o.fs_a, o.fd_a, o.decay_a) +
           along(wall.axis_b, o.fs_b, o.fd_b, o.decay_b);
  }
  if (w.friction == 2) return {};
  return (w.friction >= 1 ? 1 : std::min(1.0, w.friction * dvn / size)) * slip;
}

// Keeps a welded node at the wall's normal velocity, or welds one that comes fast enough.
void RigidWalls::weld(Wall& wall, const WallGeometry& g, const State& state, int i,
                      Hit& hit) const {
  const RigidWall& w = model_.rigid_walls[wall.index];
  if (wall.welded[i] == 0) {
    wall.welded[i] = -dot(state.nodes[hit.node].v - wall.velocity, hit.normal) > w.velocity_limit;
    return;
  }
  const NodeMotion& a = state.nodes[hit.node];
  hit.normal = wall_point(g, a.x).normal;
  hit.v_before = velocity_before(state, hit.node);
  hit.added = -dot(a.v - wall.velocity, hit.normal), hit.deep = false;
}

double RigidWalls::highest_speed(const State& state, Team& team) {
  const std::size_t n = state.nodes.size();
  std::vector<double> highest(Team::ranges(n, chunk_nodes), 0);
  team.for_ranges(n, chunk_nodes, [&](int chunk, int first, int last) {
    double h = 0;
    for (int i = first; i < last; ++i) h = std::max(h, dot(state.nodes[i].v, state.nodes[i].v));
    highest[chunk] = h;
  });
  double h = 0;
  for (double x : highest) h = std::max(h, x);
  return std::sqrt(h);
}

WallGeometry RigidWalls::now(const Wall& wall) const {
  WallGeometry g = wall.geometry;
  g.origin += wall.displacement;
  return g;
}

// Mean velocity over the step of a wall that a curve drives.
Vec3d RigidWalls::driven_velocity(const Wall& wall, const State& state) const {
  const RigidWall& w = model_.rigid_walls[wall.index];
  const Curve& c = model_.curves[w.motion_curve];
  const Vec3d n = norm(w.motion_direction) > 0 ? unit(w.motion_direction) : wall.geometry.normal;
  const double t = state.time, end = t + state.dt;
  if (w.motion_option == 0) return (curve_integral(c.x, c.y, t, end) / state.dt) * n;
  return ((curve_value(c.x, c.y, end) - dot(wall.displacement, n)) / state.dt) * n;
}

// Whether the wall acts on the node; clearance: lower bound of its distance at t(n).
bool RigidWalls::find(const Wall& wall, const WallGeometry& g, const State& state, int node,
                      double& clearance, Hit& hit) const {
  clearance = std::min(clearance, wall_clearance(g, state.nodes[node].x));
  const bool back = method_ == WallMethod::constraint && g.shape == WallShape::plane;
  return back ? find_behind(wall, g, state, node, hit) : find_ahead(wall, g, state, node, hit);
}

// Whether the node is behind the wall after the step.
bool RigidWalls::find_ahead(const Wall& wall, const WallGeometry& g, const State& state, int node,
                            Hit& hit) const {
  const NodeMotion& a = state.nodes[node];
  const Vec3d move = state.dt * (a.v - wall.velocity);
  const WallPoint next = wall_point(g, a.x + move);
  if (next.distance >= 0 || !next.on_wall) return false;
  const WallPoint start = wall_point(g, a.x);
  const bool deep = start.distance < 0;
  // a finite plane does not catch what came from behind
  const bool finite = g.shape == WallShape::plane && (g.length_l > 0 || g.length_m > 0);
  if (finite && start.distance < -(norm(move) + 1e-9 * norm(a.x - g.origin))) return false;
  const double vn = dot(a.v - wall.velocity, next.normal);
  const double added = std::max(-vn, deep ? 0.0 : -next.distance / state.dt);
  if (added <= 0) return false;
  const Vec3d before = velocity_before(state, node);
  hit = {node, next.normal, before, added, deep};
  return true;
}

// Whether the node came behind the plane, or farther behind it, in the last step.
bool RigidWalls::find_behind(const Wall& wall, const WallGeometry& g, const State& state, int node,
                             Hit& hit) const {
  const NodeMotion& a = state.nodes[node];
  const WallPoint now = wall_point(g, a.x);
  if (now.distance >= 0 || !now.on_wall) return false;
  const Vec3d before = velocity_before(state, node);
  const double came = -dot(before - wall.velocity, now.normal);
  if (came <= 0) return false;
  const double way = came * state.dt_previous;
  // a finite plane does not catch what came from behind
  const bool deep = now.distance < -way * (1 + 1e-9) - 1e-9 * norm(a.x - g.origin);
  if (deep && (g.length_l > 0 || g.length_m > 0)) return false;
  const double added = -dot(a.v - wall.velocity, now.normal);
  hit = {node, now.normal, before, added, deep, came, std::min(-now.distance, way)};
  return true;
}

// Chunks of nodes that may have come to the wall after a way of `reach`: what is far costs one
// subtraction, and a loop over what is near is none for other threads where that is one chunk.
void RigidWalls::find_near(Side& side, double reach) {
  near_.clear();
  for (std::size_t c = 0; c < side.clearance.size(); ++c)
    if (!((side.clearance[c] -= reach) > 0)) near_.push_back(int(c));
}

template <class Visit>
void RigidWalls::for_near(Team& team, const Visit& visit) const {
  team.for_each(int(near_.size()), [&](int k, int) { visit(near_[std::size_t(k)]); });
}

void RigidWalls::detect(Wall& wall, const WallGeometry& g, State& state, Team& team, double speed) {
  const double reach = state.dt * (speed + norm(wall.velocity));
  Side& side = wall.free;
  find_near(side, reach);
  for_near(team, [&](int c) {
    hits_[c].clear();
    sums_[c] = {};
    double clearance = 1e300;
    const int end = std::min(int(side.nodes.size()), (c + 1) * chunk_nodes);
    for (int i = c * chunk_nodes; i < end; ++i) {
      const int node = side.nodes[i];
      Hit hit;
      if (state.owner[node] == NodeOwner::rigid) continue;
      const bool welded = !wall.welded.empty() && wall.welded[i] != 0;
      if (welded) clearance = std::min(clearance, 0.0), hit.node = node;
      if ((!welded && !find(wall, g, state, node, clearance, hit)) ||
          state.owner[node] != NodeOwner::free)
        continue;
      if (!wall.welded.empty()) weld(wall, g, state, i, hit);
      hits_[c].push_back(hit);
      sums_[c].mass += state.nodes[node].mass;
      sums_[c].momentum += state.nodes[node].mass * dot(state.nodes[node].v, g.normal);
    }
    // a margin for rounding
    side.clearance[c] = clearance - reach - 1e-9 * std::abs(clearance);
  });
}

void RigidWalls::push(Wall& wall, State& state, Team& team, double old_speed) {
  const RigidWall& w = model_.rigid_walls[wall.index];
  // a heavy wall took up momentum: all touching nodes get its new velocity
  const double gain = dot(wall.velocity, wall.geometry.normal) - old_speed;
  for_near(team, [&](int c) {
    Sums& s = sums_[c];
    for (const Hit& h : hits_[c]) {
      NodeMotion& node = state.nodes[h.node];
      const double dvn = w.moving ? h.added + gain * dot(wall.geometry.normal, h.normal) : h.added;
      Vec3d dv = dvn * h.normal;
      const Vec3d rel = node.v - wall.velocity;
      const Vec3d slip = rel - dot(rel, h.normal) * h.normal;
      dv -= friction_cut(wall, slip, std::clamp(dvn, 0.0, h.braked));
      node.v += dv;
      node.x += h.back * h.normal;
      s.impulse -= node.mass * dv;
      s.before += node.mass * dot(dv, h.v_before);
      s.after += node.mass * dot(dv, node.v);
    }
  });
  const double rate = 1 / state.mean_dt();
  for (const int c : near_) {
    wall.force += rate * sums_[c].impulse;
    state.energy.rigid_wall -= 0.5 * state.dt_previous * rate * sums_[c].before;
    wall.pending -= 0.5 * state.dt * rate * sums_[c].after;
  }
}

void RigidWalls::apply(State& state, Team& team, double max_speed) {
  if (walls_.empty()) return;
  const double speed = max_speed >= 0 ? max_speed : highest_speed(state, team);
  for (Wall& wall : walls_) {
    const RigidWall& w = model_.rigid_walls[wall.index];
    state.energy.rigid_wall += wall.pending;
    wall.pending = 0;
    wall.force = wall.penalty;
    const Vec3d n = wall.geometry.normal;
    if (w.motion_curve >= 0) wall.velocity = driven_velocity(wall, state);
    if (w.moving) wall.velocity += (state.mean_dt() * dot(wall.penalty, n) / w.mass) * n;
    const WallGeometry g = now(wall);
    const bool alive = state.time >= w.birth && state.time < w.death;
    if (alive) {
      detect(wall, g, state, team, speed);
      const double old_speed = dot(wall.velocity, n);
      if (w.moving) {
        double mass = w.mass, momentum = w.mass * old_speed;
        for (const int c : near_) mass += sums_[c].mass, momentum += sums_[c].momentum;
        wall.velocity = (momentum / mass) * n;
        // every touching node takes exactly the common velocity
        for (const int c : near_)
          for (Hit& h : hits_[c]) h.added = old_speed - dot(state.nodes[h.node].v, n);
      }
      push(wall, state, team, old_speed);
    }
    wall.displacement += state.dt * wall.velocity;
  }
}

void RigidWalls::penalty(Wall& wall, State& state, Team& team, double speed) {
  const double scale =
      model_.controls.rigid_wall_penalty > 0 ? model_.controls.rigid_wall_penalty : 1;
  const double dt = state.dt > 0 ? state.dt : state.dt_previous;
  // the stiffness follows the step only when it must, so that stored energy is given back
  if (dt < 0.95 * wall.stiffness_dt || dt > 1.5 * wall.stiffness_dt) wall.stiffness_dt = dt;
  const double factor = dt > 0 ? 0.1 * scale / (wall.stiffness_dt * wall.stiffness_dt) : 0;
  const double reach = state.dt_previous * (speed + norm(wall.velocity));
  const WallGeometry g = now(wall);
  Side& side = wall.rigid;
  find_near(side, reach);
  for_near(team, [&](int c) {
    Sums& s = sums_[c];
    s = {};
    double clearance = 1e300;
    const int end = std::min(int(side.nodes.size()), (c + 1) * chunk_nodes);
    for (int i = c * chunk_nodes; i < end; ++i) {
      const NodeMotion& node = state.nodes[side.nodes[i]];
      clearance = std::min(clearance, wall_clearance(g, node.x));
      const WallPoint p = wall_point(g, node.x);
      Vec3d f{};
      if (p.distance < 0 && p.on_wall) {
        const double normal = -factor * node.mass * p.distance;
        f = normal * p.normal;
        const Vec3d rel = node.v - wall.velocity, slip = rel - dot(rel, p.normal) * p.normal;
        // sticking is a damper of a tenth of the mass per step
        const double damper = 0.1 * node.mass / wall.stiffness_dt;
        f -= damper * friction_cut(wall, slip, normal / damper);
        state.interaction.add(std::size_t(side.nodes[i]), f);
      }
      s.before += dot(wall.last[i] + f, node.v);
      s.impulse -= f;
      wall.last[i] = f;
    }
    side.clearance[c] = clearance - 1e-9 * std::abs(clearance);
  });
  wall.penalty = {};
  for (const int c : near_) {
    wall.penalty += sums_[c].impulse;
    state.energy.rigid_wall -= 0.5 * state.dt_previous * sums_[c].before;
  }
}

void RigidWalls::forces(State& state, Team& team, double max_speed) {
  double speed = max_speed;
  for (Wall& wall : walls_) {
    const RigidWall& w = model_.rigid_walls[wall.index];
    wall.penalty = {};
    if (wall.rigid.nodes.empty() || state.time < w.birth || state.time >= w.death) continue;
    if (speed < 0) speed = highest_speed(state, team);
    penalty(wall, state, team, speed);
  }
}

void RigidWalls::save(std::ostream& out) const {
  write_value(out, method_);
  for (const Wall& w : walls_) {
    for (const Vec3d* v : {&w.displacement, &w.velocity, &w.force, &w.penalty})
      write_value(out, *v);
    write_vector(out, w.free.clearance);
    write_vector(out, w.rigid.clearance);
    write_vector(out, w.last);
    write_vector(out, w.welded);
    write_value(out, w.stiffness_dt);
    write_value(out, w.pending);
  }
}

void RigidWalls::load(std::istream& in) {
  read_value(in, method_);
  for (Wall& w : walls_) {
    for (Vec3d* v : {&w.displacement, &w.velocity, &w.force, &w.penalty}) read_value(in, *v);
    read_vector(in, w.free.clearance);
    read_vector(in, w.rigid.clearance);
    read_vector(in, w.last);
    read_vector(in, w.welded);
    read_value(in, w.stiffness_dt);
    read_value(in, w.pending);
  }
}

}  // namespace fabrica
