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

// segment as it is now: frame, point that carries the node, rotation operator
struct Segment {
  Vec3d r[4];     // corners from their mean
  Vec3d point;    // c = sum phi x
  Mat3d axes;     // columns of the frame in rows: e1, e2, e3
  Mat3d inverse;  // T^-1
  double weight;  // 1/corners

  Segment(const State& state, const Tie& t) {
    Vec3d mean{0, 0, 0};
    point = {0, 0, 0};
    weight = 1.0 / t.corners;
    for (int i = 0; i < t.corners; ++i) {
      mean += weight * state.nodes[t.corner[i]].x;
      point += t.phi[i] * state.nodes[t.corner[i]].x;
    }
    Mat3d T{};
    for (int i = 0; i < t.corners; ++i) {
      r[i] = state.nodes[t.corner[i]].x - mean;
      const double r2 = dot(r[i], r[i]);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) T(a, b) += weight * ((a == b ? r2 : 0) - r[i][a] * r[i][b]);
    }
    inverse = fabrica::inverse(T);
    const Vec3d e3 = contact_detail::unit(t.corners == 3 ? cross(r[1] - r[0], r[2] - r[0])
                                                         : cross(r[2] - r[0], r[3] - r[1]));
    Vec3d e1 = t.corners == 3 ? r[1] - r[0] : r[1] + r[2] - r[0] - r[3];
    e1 = contact_detail::unit(e1 - dot(e1, e3) * e3);
    const Vec3d e2 = cross(e3, e1);
    axes = {{{e1.x, e1.y, e1.z}, {e2.x, e2.y, e2.z}, {e3.x, e3.y, e3.z}}};
  }
  Vec3d offset(const Tie& t) const {
    return transpose(axes) * Vec3d{t.offset[0], t.offset[1], t.offset[2]};
  }
  Vec3d spin(const State& state, const Tie& t) const {
    Vec3d momentum{0, 0, 0};
    for (int i = 0; i < t.corners; ++i)
      momentum += weight * cross(r[i], state.nodes[t.corner[i]].v);
    return inverse * momentum;
  }
  Vec3d velocity(const State& state, const Tie& t, const Vec3d& lever) const {
    Vec3d v{0, 0, 0};
    for (int i = 0; i < t.corners; ++i) v += t.phi[i] * state.nodes[t.corner[i]].v;
    return v + cross(spin(state, t), lever);
  }
  // share of corner i in a force f at the point and a couple
  Vec3d share(const Tie& t, int i, const Vec3d& f, const Vec3d& turn) const {
    return t.phi[i] * f + weight * cross(turn, r[i]);
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
      rigid_ties_.push_back({n.node, s.part});
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
    const Vec3d o = Segment(state, t).axes * (state.nodes[n.node].x - at.x);
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
    const Vec3d turn = s.inverse * couple;
    for (int c = 0; c < t.corners; ++c) state.force[t.corner[c]] += s.share(t, c, f, turn);
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
    const Vec3d turn = s.inverse * cross(lever, f);
    state.interaction.add(t.node, f);
    for (int c = 0; c < t.corners; ++c) state.interaction.add(t.corner[c], -s.share(t, c, f, turn));
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
