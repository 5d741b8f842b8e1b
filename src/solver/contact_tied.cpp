#include "solver/contact_tied.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <limits>
#include <ostream>
#include <string>

#include "contact/candidate_search.h"
#include "contact/closest_point.h"

namespace fabrica {
namespace {

// Segment as it is now: the point that carries the node, the frame that the offset turns with, and
// the exact derivative of the frame's turn by the place of each corner,
//   delta theta = sum_i W_i delta x_i,   W_i = e1 g1_i^T + e2 g2_i^T + e3 g3_i^T.
// Forces are its transpose, so that a penalty is the gradient of an energy however the segment
// distorts. e3 is normal to both diagonals; e1 halves the angle of one middle line and the other
// turned back by a right angle.
struct Segment {
  Vec3d point;          // c = sum phi x
  Vec3d axis[3];        // e1, e2, e3
  Vec3d turn_by[4][3];  // g1, g2, g3 of each corner

  Segment(const State& state, const Tie& t) {
    Vec3d x[4];
    point = {0, 0, 0};
    for (int i = 0; i < t.corners; ++i) {
      x[i] = state.nodes[t.corner[i]].x;
      point += t.phi[i] * x[i];
    }
    for (auto& corner : turn_by) corner[0] = corner[1] = corner[2] = {0, 0, 0};
    t.corners == 3 ? triangle(x) : quad(x);
  }

  Vec3d offset(const Tie& t) const {
    return t.offset[0] * axis[0] + t.offset[1] * axis[1] + t.offset[2] * axis[2];
  }
  Vec3d in_axes(const Vec3d& v) const {
    return {dot(v, axis[0]), dot(v, axis[1]), dot(v, axis[2])};
  }
  Vec3d spin(const State& state, const Tie& t) const {
    Vec3d w{0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      double rate = 0;
      for (int i = 0; i < t.corners; ++i) rate += dot(turn_by[i][k], state.nodes[t.corner[i]].v);
      w += rate * axis[k];
    }
    return w;
  }
  Vec3d velocity(const State& state, const Tie& t, const Vec3d& lever) const {
    Vec3d v{0, 0, 0};
    for (int i = 0; i < t.corners; ++i) v += t.phi[i] * state.nodes[t.corner[i]].v;
    return v + cross(spin(state, t), lever);
  }
  // share of corner i in a force f at the point and a couple, given in the axes
  Vec3d share(const Tie& t, int i, const Vec3d& f, const Vec3d& couple) const {
    return t.phi[i] * f + couple[0] * turn_by[i][0] + couple[1] * turn_by[i][1] +
           couple[2] * turn_by[i][2];
  }

 private:
  // how the normal of d1 x d2 tilts with d1 and d2: d1 runs from corner a to b, d2 from c to d
  void tilt(const Vec3d& d1, const Vec3d& d2, double area, int a, int b, int c, int d) {
    const double s = 1 / area;
    const Vec3d by_d1[2] = {s * cross(axis[1], d2), s * cross(d2, axis[0])};
    const Vec3d by_d2[2] = {s * cross(d1, axis[1]), s * cross(axis[0], d1)};
    for (int k = 0; k < 2; ++k) {
      turn_by[b][k] += by_d1[k], turn_by[a][k] += -by_d1[k];
      turn_by[d][k] += by_d2[k], turn_by[c][k] += -by_d2[k];
    }
  }
  void set_axes(const Vec3d& e3, const Vec3d& e1) {
    axis[2] = e3, axis[0] = contact_detail::unit(e1 - dot(e1, e3) * e3);
    axis[1] = cross(e3, axis[0]);
  }
  void triangle(const Vec3d* x) {
    const Vec3d d1 = x[1] - x[0], d2 = x[2] - x[0], n = cross(d1, d2);
    set_axes(contact_detail::unit(n), d1);
    tilt(d1, d2, norm(n), 0, 1, 0, 2);
    const Vec3d g = (1 / norm(d1)) * axis[1];
    turn_by[1][2] += g, turn_by[0][2] += -g;
  }
  void quad(const Vec3d* x) {
    const Vec3d d1 = x[2] - x[0], d2 = x[3] - x[1], n = cross(d1, d2);
    const Vec3d e3 = contact_detail::unit(n);
    // both lie in the plane of the diagonals
    const Vec3d a = x[1] + x[2] - x[0] - x[3], b = x[2] + x[3] - x[0] - x[1];
    const Vec3d along = contact_detail::unit(a), across = contact_detail::unit(b);
    set_axes(e3, along + cross(across, e3));
    tilt(d1, d2, norm(n), 0, 2, 1, 3);
    const Vec3d by_a = (0.5 / norm(a)) * cross(e3, along);
    const Vec3d by_b = (0.5 / norm(b)) * cross(e3, across);
    turn_by[0][2] = -by_a - by_b, turn_by[1][2] = by_a - by_b;
    turn_by[2][2] = by_a + by_b, turn_by[3][2] = by_b - by_a;
  }
};

double shortest_diagonal(const State& state, const ContactSegment& s) {
  auto x = [&](int i) { return state.nodes[s.node[i]].x; };
  if (s.triangle) return std::min({norm(x(1) - x(0)), norm(x(2) - x(1)), norm(x(0) - x(2))});
  return std::min(norm(x(2) - x(0)), norm(x(3) - x(1)));
}

struct NotItself : PairFilter {
  const ContactSurface& tracked;
  const ContactSurface& reference;
  NotItself(const ContactSurface& t, const ContactSurface& r) : tracked(t), reference(r) {}
  bool keep(int point, int box) const override {
    const auto& n = reference.segments[box].node;
    return std::find(n, n + 4, tracked.nodes[point].node) == n + 4;
  }
};

// whether the box around a segment is farther from a point than a distance
bool farther(const Vec3d (&corner)[4], const Vec3d& point, double distance) {
  for (int d = 0; d < 3; ++d) {
    const auto [low, high] = std::minmax({corner[0][d], corner[1][d], corner[2][d], corner[3][d]});
    if (low - point[d] > distance || point[d] - high > distance) return true;
  }
  return false;
}

}  // namespace

bool TiedNodes::carried_by(int node, int by) const {
  if (node == by) return true;
  if (tie_of_[node] < 0) return false;
  const Tie& t = constraints_[tie_of_[node]];
  for (int i = 0; i < t.corners; ++i)
    if (carried_by(t.corner[i], by)) return true;
  return false;
}

void TiedNodes::add(int index, const ContactSurface& tracked, const ContactSurface& reference,
                    State& state, double dt, Diagnostics& diagnostics) {
  const Contact& contact = model_.contacts[index];
  if (tie_of_.empty()) tie_of_.assign(state.nodes.size(), -1);
  const bool penalty = contact.offset || contact.beam_offset;
  const bool project = !penalty && !contact.constrained_offset && model_.controls.tied_projection;
  double largest_half = 0;
  for (const ContactNode& n : tracked.nodes)
    largest_half = std::max(largest_half, n.half_thickness);
  auto tolerance = [&](const ContactSegment& s, double half) {
    if (contact.sst < 0) return -contact.sst;
    return std::max(1.2 * (half + s.half_thickness), 0.05 * shortest_diagonal(state, s));
  };
  std::vector<Vec3d> points;
  for (const ContactNode& n : tracked.nodes) points.push_back(state.nodes[n.node].x);
  std::vector<BoundingBox> boxes;
  for (const ContactSegment& s : reference.segments) {
    const double margin = tolerance(s, largest_half);
    Vec3d low = state.nodes[s.node[0]].x, high = low;
    for (int n : s.node)
      for (int d = 0; d < 3; ++d) {
        low[d] = std::min(low[d], state.nodes[n].x[d] - margin);
        high[d] = std::max(high[d], state.nodes[n].x[d] + margin);
      }
    for (int d = 0; d < 3; ++d)
      low[d] = std::min(low[d], state.nodes[s.node[0]].x[d] - margin),
      high[d] = std::max(high[d], state.nodes[s.node[0]].x[d] + margin);
    boxes.push_back({low, high});
  }
  const PointBoxPairs pairs = find_pairs(points, boxes, NotItself(tracked, reference));
  int missed = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ContactNode& n = tracked.nodes[i];
    if (!penalty && tie_of_[n.node] >= 0) continue;
    double best = std::numeric_limits<double>::infinity();
    int segment = -1;
    SurfacePoint at;
    for (int p = pairs.first[i]; p < pairs.first[i + 1]; ++p) {
      const ContactSegment& s = reference.segments[pairs.box[p]];
      Vec3d X[4];
      for (int c = 0; c < 4; ++c) X[c] = state.nodes[s.node[c]].x;
      if (farther(X, points[i], std::min(best, tolerance(s, n.half_thickness)))) continue;
      const SurfacePoint q = s.triangle ? closest_point_triangle(X, points[i])
                                        : closest_point_quad(X, points[i], 0, 0);
      const double distance = norm(points[i] - q.x);
      if (distance <= tolerance(s, n.half_thickness) && distance < best)
        best = distance, segment = pairs.box[p], at = q;
    }
    if (segment < 0) {
      untied_.push_back(n.node), ++missed;
      continue;
    }
    const ContactSegment& s = reference.segments[segment];
    if (s.body >= 0 && s.body == n.body) continue;
    if (s.body >= 0 && n.body < 0 && s.body < int(model_.parts.size())) {
      rigid_ties_.push_back({n.node, s.body});
      continue;
    }
    Tie t{};
    t.contact = index, t.node = n.node, t.corners = s.triangle ? 3 : 4;
    std::copy(s.node, s.node + 4, t.corner);
    std::copy(at.phi, at.phi + 4, t.phi);
    // what a rigid body moves cannot be placed by a segment: penalty
    const bool soft = penalty || n.body >= 0 || s.body >= 0;
    bool circle = false;
    for (int c = 0; c < t.corners && !soft; ++c) circle |= carried_by(t.corner[c], n.node);
    if (circle) {
      untied_.push_back(n.node), ++missed;
      continue;
    }
    if (project && !soft) state.nodes[n.node].x = at.x;
    const Vec3d o = Segment(state, t).in_axes(state.nodes[n.node].x - at.x);
    for (int d = 0; d < 3; ++d) t.offset[d] = project && !soft ? 0 : o[d];
    if (soft) {
      t.stiffness = std::min(s.stiffness, n.stiffness);
      // segments on no element: as stiff as the masses allow
      if (!std::isfinite(t.stiffness) || t.stiffness <= 0)
        t.stiffness = dt > 0 ? 0.1 * state.nodes[n.node].mass / (dt * dt) : 0;
      penalties_.push_back(t);
    } else {
      tie_of_[n.node] = int(constraints_.size());
      constraints_.push_back(t);
    }
  }
  if (missed > 0)
    diagnostics.warning(
        "untied-nodes", contact.where, "CONTACT_TIED", "",
        std::to_string(missed) + " nodes of contact " + std::to_string(contact.id) +
            " are too far from every segment and stay free",
        "Check the distance between the sides, or set SST to minus the distance to tie over");
}

void TiedNodes::finish(State& state) {
  if (tie_of_.empty()) return;
  // levels: a node tied to tied nodes comes after them
  for (bool changed = true; changed;) {
    changed = false;
    for (Tie& t : constraints_) {
      int level = 1;
      for (int i = 0; i < t.corners; ++i)
        if (tie_of_[t.corner[i]] >= 0)
          level = std::max(level, 1 + constraints_[tie_of_[t.corner[i]]].level);
      changed |= level != t.level;
      t.level = level;
    }
  }
  std::stable_sort(constraints_.begin(), constraints_.end(),
                   [](const Tie& a, const Tie& b) { return a.level < b.level; });
  for (std::size_t i = constraints_.size(); i-- > 0;) {
    const Tie& t = constraints_[i];
    NodeMotion& node = state.nodes[t.node];
    for (int c = 0; c < t.corners; ++c) {
      NodeMotion& corner = state.nodes[t.corner[c]];
      corner.mass += t.phi[c] * node.mass;
      if (corner.mass > 0) corner.inverse_mass = 1 / corner.mass;
      if (!state.physical_mass.empty())
        state.physical_mass[t.corner[c]] += t.phi[c] * state.physical_mass[t.node];
    }
    node.mass = 0, node.inverse_mass = 0;
    if (!state.physical_mass.empty()) state.physical_mass[t.node] = 0;
    state.owner[t.node] = NodeOwner::tied;
  }
  constraint_force_.assign(constraints_.size(), Vec3d{0, 0, 0});
  penalty_force_.assign(penalties_.size(), Vec3d{0, 0, 0});
}

CarrierNodes TiedNodes::carriers() const {
  CarrierNodes result;
  if (constraints_.empty() && penalties_.empty()) return result;
  result.resize(model_.nodes.size());
  for (const auto* list : {&constraints_, &penalties_})
    for (const Tie& t : *list)
      result[t.node].insert(result[t.node].end(), t.corner, t.corner + t.corners);
  return result;
}

void TiedNodes::transfer_forces(State& state) const {
  const bool rotations = !state.spins.empty();
  for (std::size_t i = constraints_.size(); i-- > 0;) {
    const Tie& t = constraints_[i];
    const Segment s(state, t);
    const Vec3d f = state.force[t.node];
    Vec3d couple = cross(s.offset(t), f);
    if (rotations) couple += state.moment[t.node], state.moment[t.node] = {0, 0, 0};
    const Vec3d in_axes = s.in_axes(couple);
    for (int c = 0; c < t.corners; ++c) state.force[t.corner[c]] += s.share(t, c, f, in_axes);
    state.force[t.node] = {0, 0, 0};
    constraint_force_[i] = -f;
  }
}

void TiedNodes::place_nodes(State& state) const {
  for (const Tie& t : constraints_) {
    const Segment s(state, t);
    const Vec3d o = s.offset(t);
    state.nodes[t.node].v = s.velocity(state, t, o);
    state.nodes[t.node].x = s.point + o;
    if (!state.spins.empty()) state.spins[t.node].w = s.spin(state, t);
  }
}

void TiedNodes::forces(State& state) {
  double power = 0;
  for (std::size_t i = 0; i < penalties_.size(); ++i) {
    const Tie& t = penalties_[i];
    const Segment s(state, t);
    const NodeMotion& node = state.nodes[t.node];
    const Vec3d lever = node.x - s.point, u = lever - s.offset(t);
    const Vec3d f = -t.stiffness * u;
    const Vec3d couple = s.in_axes(cross(lever, f));
    state.interaction.add(t.node, f);
    for (int c = 0; c < t.corners; ++c)
      state.interaction.add(t.corner[c], -s.share(t, c, f, couple));
    penalty_force_[i] = f;
    power += dot(f, node.v - s.velocity(state, t, lever));
  }
  energy_ -= 0.5 * state.dt * power, state.energy.contact -= 0.5 * state.dt * power;
}

void TiedNodes::account(State& state) {
  double power = 0;
  for (std::size_t i = 0; i < penalties_.size(); ++i) {
    const Tie& t = penalties_[i];
    const Segment s(state, t);
    const NodeMotion& node = state.nodes[t.node];
    power += dot(penalty_force_[i], node.v - s.velocity(state, t, node.x - s.point));
  }
  energy_ -= 0.5 * state.dt * power, state.energy.contact -= 0.5 * state.dt * power;
}

bool TiedNodes::has_ties(int contact) const {
  auto of = [&](const Tie& t) { return t.contact == contact; };
  return std::any_of(constraints_.begin(), constraints_.end(), of) ||
         std::any_of(penalties_.begin(), penalties_.end(), of);
}

Vec3d TiedNodes::force_of(int contact) const {
  Vec3d sum{0, 0, 0};
  for (std::size_t i = 0; i < constraints_.size(); ++i)
    if (constraints_[i].contact == contact) sum += constraint_force_[i];
  for (std::size_t i = 0; i < penalties_.size(); ++i)
    if (penalties_[i].contact == contact) sum += penalty_force_[i];
  return sum;
}

void TiedNodes::save(std::ostream& out) const {
  out.write(reinterpret_cast<const char*>(&energy_), sizeof energy_);
}
void TiedNodes::load(std::istream& in) {
  in.read(reinterpret_cast<char*>(&energy_), sizeof energy_);
}

}  // namespace fabrica
