#include "solver/edge_pass.h"

#include <algorithm>
#include <cmath>

#include "solver/stream.h"

namespace fabrica {
namespace {

bool inside(double place) { return place > 0 && place < 1; }

bool share_node(const ContactEdge& a, const ContactEdge& b) {
  return a.node[0] == b.node[0] || a.node[0] == b.node[1] || a.node[1] == b.node[0] ||
         a.node[1] == b.node[1];
}

Vec3d velocity_at(const State& state, const ContactEdge& e, double place) {
  return (1 - place) * state.nodes[e.node[0]].v + place * state.nodes[e.node[1]].v;
}

double inverse_mass_at(const State& state, const ContactEdge& e, double place) {
  return (1 - place) * (1 - place) * state.nodes[e.node[0]].inverse_mass +
         place * place * state.nodes[e.node[1]].inverse_mass;
}

}  // namespace

EdgePass::EdgePass(const Model& model, const Contact& contact, int contact_index,
                   ContactSurface surface, const CarrierNodes& carriers)
    : contact_(contact),
      contact_index_(contact_index),
      surface_(std::move(surface)),
      carriers_(carriers),
      friction_(model, contact),
      edges_of_(model.nodes.x.size()) {
  std::vector<double> lengths;
  for (int e = 0; e < size(); ++e)
    for (int n : surface_.edges[e].node) {
      edges_of_[n].push_back(e), nodes_.push_back(n);
      lengths.push_back(norm(model.nodes.x[surface_.edges[e].node[1]] -
                             model.nodes.x[surface_.edges[e].node[0]]));
    }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  if (lengths.empty()) return;
  std::nth_element(lengths.begin(), lengths.begin() + std::ptrdiff_t(lengths.size() / 2),
                   lengths.end());
  skin_ = 0.3 * lengths[lengths.size() / 2];
}

// may two edges touch at all
bool EdgePass::wanted(int first, int second) const {
  const ContactEdge &a = surface_.edges[first], &b = surface_.edges[second];
  if (first >= second || share_node(a, b) || (a.body >= 0 && a.body == b.body)) return false;
  if (a.side >= 0 && a.side == b.side) return false;
  if (carriers_.empty()) return true;
  auto tied = [&](const ContactEdge& from, const ContactEdge& to) {
    for (int n : from.node)
      for (int c : carriers_[n])
        if (c == to.node[0] || c == to.node[1]) return true;
    return false;
  };
  return !tied(a, b) && !tied(b, a);
}

double EdgePass::largest_displacement(const State& state) const {
  double largest = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vec3d u = state.nodes[nodes_[i]].x - reference_[i];
    largest = std::max(largest, dot(u, u));
  }
  return std::sqrt(largest);
}

// pairs within reach + skin; what pairs knew of each other stays
void EdgePass::search(const State& state) {
  struct Filter : PairFilter {
    const EdgePass& pass;
    explicit Filter(const EdgePass& p) : pass(p) {}
    bool keep(int point, int box) const override { return pass.wanted(point, box); }
  };
  std::vector<Vec3d> middles;
  std::vector<BoundingBox> boxes;
  double half = 0, radius = 0;
  for (const ContactEdge& e : surface_.edges) {
    const Vec3d &a = state.nodes[e.node[0]].x, &b = state.nodes[e.node[1]].x;
    middles.push_back(0.5 * (a + b));
    half = std::max(half, 0.5 * norm(b - a)), radius = std::max(radius, e.radius);
  }
  for (const ContactEdge& e : surface_.edges) {
    const Vec3d &a = state.nodes[e.node[0]].x, &b = state.nodes[e.node[1]].x;
    const double margin = half + radius + e.radius + skin_;
    BoundingBox box;
    for (int d = 0; d < 3; ++d)
      box.low[d] = std::min(a[d], b[d]) - margin, box.high[d] = std::max(a[d], b[d]) + margin;
    boxes.push_back(box);
  }
  const PointBoxPairs found = find_pairs(middles, boxes, Filter(*this));
  pairs_ = carry_over(found, pairs_);
  reference_.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) reference_[i] = state.nodes[nodes_[i]].x;
}

EdgePoints EdgePass::closest(const State& state, int first, int second) const {
  const ContactEdge &a = surface_.edges[first], &b = surface_.edges[second];
  const Vec3d &p = state.nodes[a.node[0]].x, &q = state.nodes[b.node[0]].x;
  return closest_points_edges(p, state.nodes[a.node[1]].x - p, q, state.nodes[b.node[1]].x - q);
}

// at a node that edges share, one of them pushes
bool EdgePass::owns_place(const State& state, int edge, double place, int other) const {
  if (inside(place)) return true;
  const int node = surface_.edges[edge].node[place > 0 ? 1 : 0];
  for (int next : edges_of_[node]) {
    if (next == edge) continue;
    const double there = closest(state, next, other).a;
    const bool at_node = surface_.edges[next].node[there > 0 ? 1 : 0] == node && !inside(there);
    if (!at_node || next < edge) return false;
  }
  return true;
}

// rims of shells push out of their plane no more than 60 degrees; bars push anywhere
bool EdgePass::pushes_along(const State& state, int edge, const Vec3d& direction) const {
  const int segment = surface_.edges[edge].segment;
  if (segment < 0) return true;
  const ContactSegment& s = surface_.segments[segment];
  auto x = [&](int i) -> const Vec3d& { return state.nodes[s.node[i]].x; };
  const Vec3d normal =
      s.triangle ? cross(x(1) - x(0), x(2) - x(0)) : cross(x(2) - x(0), x(3) - x(1));
  return std::abs(dot(contact_detail::unit(normal), direction)) < std::sqrt(3.0) / 2;
}

void EdgePass::pair_force(State& state, Pair& pair) {
  const ContactEdge &a = surface_.edges[pair.first], &b = surface_.edges[pair.second];
  const EdgePoints c = closest(state, pair.first, pair.second);
  const double distance = norm(c.gap), touch = a.radius + b.radius;
  const bool was_touching = pair.touching;
  pair.touching = false;
  if (!(distance < touch) || !(distance > 0)) return;
  Vec3d direction = (1 / distance) * c.gap;
  double depth = touch - distance;
  // crossed since the last cycle: still pushed to where it came from
  if (was_touching && dot(direction, pair.direction) < 0)
    direction = -direction, depth = touch + distance;
  if (!pushes_along(state, pair.first, direction) || !pushes_along(state, pair.second, direction))
    return;
  pair.touching = true, pair.direction = direction;
  if (!was_touching) pair.baseline = 0, pair.friction = {0, 0, 0};
  if (!started_) {
    pair.baseline = depth;
    initial_.push_back({contact_index_, a.node[0], pair.second, b.part, depth});
  }
  pair.baseline = std::min(pair.baseline, depth);
  const bool owned = owns_place(state, pair.first, c.a, pair.second) &&
                     owns_place(state, pair.second, c.b, pair.first);
  if (owned && depth > pair.baseline) push(state, pair, c, depth);
}

void EdgePass::push(State& state, Pair& pair, const EdgePoints& c, double depth) {
  const ContactEdge &a = surface_.edges[pair.first], &b = surface_.edges[pair.second];
  const double inverse_mass = inverse_mass_at(state, a, c.a) + inverse_mass_at(state, b, c.b);
  if (!(inverse_mass > 0)) return;
  const double mass = 1 / inverse_mass, k = soft_stiffness(contact_.sofscl, mass, stiffness_step_);
  const Vec3d v = velocity_at(state, a, c.a) - velocity_at(state, b, c.b);
  const double rate = -dot(v, pair.direction);
  const double normal = normal_force(k, depth - pair.baseline, rate, mass, contact_.vdc / 100);
  EdgeForce f{pair.first, pair.second, c.a, c.b, normal * pair.direction, {0, 0, 0}};
  if (friction_.active()) {
    const Vec3d slide = v + rate * pair.direction;
    const double length = norm(state.nodes[a.node[1]].x - state.nodes[a.node[0]].x);
    f.friction =
        friction_force(friction_.between(a.part, b.part), k, normal, pair.direction, pair.friction,
                       state.dt * slide, norm(slide), 2 * a.radius * length);
  }
  pair.friction = f.friction;
  PenetrationCheck seen;
  seen.depth = depth - pair.baseline, seen.node = a.node[0], seen.part = b.part;
  seen.allowed = 2 * (a.radius + b.radius);
  penetration_.take(seen, state.time);
  const Vec3d total = f.normal + f.friction;
  const int nodes[4] = {a.node[0], a.node[1], b.node[0], b.node[1]};
  const double share[4] = {1 - c.a, c.a, c.b - 1, -c.b};
  for (int i = 0; i < 4; ++i)
    if (share[i] != 0) state.interaction.add(nodes[i], share[i] * total);
  power_ += Vec3d{dot(f.normal, v), dot(f.friction, v), 0};
  forces_.push_back(f);
}

void EdgePass::forces(State& state, double step) {
  forces_.clear(), power_ = {0, 0, 0};
  if (size() < 2) return;
  if (state.time < contact_.birth || (contact_.death > 0 && state.time >= contact_.death)) return;
  if (stiffness_step_ == 0 || step > 1.05 * stiffness_step_) stiffness_step_ = step;
  if (reference_.empty() || 2 * largest_displacement(state) >= skin_) search(state);
  for (Pair& pair : pairs_) pair_force(state, pair);
  started_ = true;
  book(state, power_.x, power_.y);
}

void EdgePass::book(State& state, double normal, double friction) {
  const double work = -0.5 * state.dt * (normal + friction),
               of_friction = -0.5 * state.dt * friction;
  energy_ += work, friction_energy_ += of_friction;
  state.energy.contact += work, state.energy.contact_friction += of_friction;
}

void EdgePass::account(State& state) {
  double normal = 0, friction = 0;
  for (const EdgeForce& f : forces_) {
    const Vec3d v = velocity_at(state, surface_.edges[f.first], f.a) -
                    velocity_at(state, surface_.edges[f.second], f.b);
    normal += dot(f.normal, v), friction += dot(f.friction, v);
  }
  book(state, normal, friction);
}

void EdgePass::save(std::ostream& out) const {
  write_value(out, std::int64_t(pairs_.size())), write_value(out, std::int64_t(reference_.size()));
  write_vector(out, pairs_), write_vector(out, reference_);
  write_value(out, started_), write_value(out, stiffness_step_), write_value(out, energy_);
  write_value(out, friction_energy_), write_value(out, penetration_);
}

void EdgePass::load(std::istream& in) {
  std::int64_t pairs = 0, references = 0;
  read_value(in, pairs), read_value(in, references);
  pairs_.resize(std::size_t(pairs)), reference_.resize(std::size_t(references));
  read_vector(in, pairs_), read_vector(in, reference_);
  read_value(in, started_), read_value(in, stiffness_step_), read_value(in, energy_);
  read_value(in, friction_energy_), read_value(in, penetration_);
}

}  // namespace fabrica
