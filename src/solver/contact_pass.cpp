#include "solver/contact_pass.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <ostream>

#include "contact/segment_overlap.h"

namespace fabrica {
namespace {

constexpr int chunk_size = 64;  // active nodes

bool holds(const ContactSegment& s, int node) {
  return s.node[0] == node || s.node[1] == node || s.node[2] == node || s.node[3] == node;
}

// nodes of the edge or corner a point lies on; second -1 for a corner
std::pair<int, int> feature_nodes(const ContactSegment& s, int feature) {
  const int corners = s.triangle ? 3 : 4;
  if (feature >= 5) return {s.node[feature - 5], -1};
  return {s.node[feature - 1], s.node[feature % corners]};
}

Vec3d centre(const State& state, const ContactSegment& s) {
  const auto& n = state.nodes;
  return 0.25 * (n[s.node[0]].x + n[s.node[1]].x + n[s.node[2]].x + n[s.node[3]].x);
}

bool holds_feature(const ContactSegment& s, std::pair<int, int> f) {
  return holds(s, f.first) && (f.second < 0 || holds(s, f.second));
}

template <class T>
void put(std::ostream& out, const std::vector<T>& v) {
  const std::size_t n = v.size();
  out.write(reinterpret_cast<const char*>(&n), sizeof n);
  out.write(reinterpret_cast<const char*>(v.data()), std::streamsize(n * sizeof(T)));
}
template <class T>
void take(std::istream& in, std::vector<T>& v) {
  std::size_t n = 0;
  in.read(reinterpret_cast<char*>(&n), sizeof n);
  v.resize(in ? n : 0);
  in.read(reinterpret_cast<char*>(v.data()), std::streamsize(v.size() * sizeof(T)));
}

}  // namespace

ContactPass::ContactPass(const Model& model, const Contact& contact, int contact_index,
                         ContactSurface tracked, ContactSurface reference,
                         const CarrierNodes& carriers)
    : contact_(contact),
      contact_index_(contact_index),
      tracked_(std::move(tracked)),
      reference_(std::move(reference)),
      carriers_(carriers),
      start_(model.nodes.x),
      friction_(model, contact),
      has_friction_(friction_.active()),
      penalty_option_(model.controls.penalty_option) {
  std::vector<double> sizes;
  for (const ContactSegment& s : reference_.segments) {
    sizes.push_back(std::sqrt(s.area));
    for (int n : s.node) nodes_.push_back(n);
  }
  for (const ContactNode& n : tracked_.nodes) {
    nodes_.push_back(n.node);
    largest_half_ = std::max(largest_half_, n.half_thickness);
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  if (sizes.empty()) tracked_.nodes.clear();
  if (!sizes.empty()) {
    std::nth_element(sizes.begin(), sizes.begin() + std::ptrdiff_t(sizes.size() / 2), sizes.end());
    size_ = sizes[sizes.size() / 2];
  }
  see_neighbours();
  outer_skin_ = 0.3 * size_, inner_skin_ = 0.04 * size_;
  slots_.resize(max_slots * tracked_.nodes.size());
  if (contact.soft == 2) find_segments_around();
}

// Whether a node beyond an edge is behind it is for both faces to say: a thin one must be seen from
// where the other could be penetrated.
void ContactPass::see_neighbours() {
  std::vector<double> of_node(start_.size(), 0);
  for (const ContactSegment& s : reference_.segments)
    for (int n : s.node) of_node[n] = std::max(of_node[n], s.limit);
  for (ContactSegment& s : reference_.segments)
    for (int n : s.node) s.reach = std::max(s.reach, of_node[n]);
}

void ContactPass::find_segments_around() {
  std::vector<std::vector<int>> of_node(start_.size());
  for (int s = 0; s < int(tracked_.segments.size()); ++s)
    for (int i = 0; i < (tracked_.segments[s].triangle ? 3 : 4); ++i)
      of_node[tracked_.segments[s].node[i]].push_back(s);
  around_first_.assign(1, 0);
  for (const ContactNode& n : tracked_.nodes) {
    around_.insert(around_.end(), of_node[n.node].begin(), of_node[n.node].end());
    around_first_.push_back(int(around_.size()));
  }
}

double ContactPass::reach(int tracked, int segment) const {
  const ContactSegment& s = reference_.segments[segment];
  return std::max(tracked_.nodes[tracked].half_thickness + s.half_thickness, s.reach);
}

// a node deeper than this is let go
double ContactPass::release_depth(int tracked, int segment) const {
  const ContactSegment& s = reference_.segments[segment];
  return tracked_.nodes[tracked].half_thickness + s.half_thickness + s.limit;
}

void ContactPass::corners(const State& state, const ContactSegment& s, Vec3d* X) const {
  for (int i = 0; i < 4; ++i) X[i] = state.nodes[s.node[i]].x;
}

SurfacePoint ContactPass::project(const State& state, int segment, const Vec3d& x, double r,
                                  double s) const {
  const ContactSegment& g = reference_.segments[segment];
  Vec3d X[4];
  corners(state, g, X);
  return g.triangle ? closest_point_triangle(X, x) : closest_point_quad(X, x, r, s);
}

bool ContactPass::shares_node(int a, int b) const {
  for (int n : reference_.segments[a].node)
    if (holds(reference_.segments[b], n)) return true;
  return false;
}

// closest points of the active pairs of a node, sorted by distance, then segment
int ContactPass::evaluate(const State& state, const ActiveNode& active, Evaluation* list) {
  const Vec3d& x = state.nodes[tracked_.nodes[active.tracked].node].x;
  int count = 0;
  for (int i = 0; i < active.count && count < max_pairs; ++i) {
    ContactCandidate& c = candidates_[active_pairs_[active.first + i]];
    Evaluation& e = list[count];
    e.point = project(state, c.segment, x, c.r, c.s);
    e.gap = x - e.point.x, e.distance = norm(e.gap), e.candidate = active_pairs_[active.first + i];
    c.r = float(e.point.r), c.s = float(e.point.s);
    for (int at = count++; at > 0 && list[at - 1].distance > list[at].distance; --at)
      std::swap(list[at - 1], list[at]);
  }
  return count;
}

// +1 or -1: side of the segment that counts as outside for this node
double ContactPass::side_of(const Evaluation& e) const {
  const ContactCandidate& c = candidates_[e.candidate];
  const ContactSegment& s = reference_.segments[c.segment];
  if (!s.two_sided) return 1;
  if (c.side != 0) return c.side;
  return dot(e.gap, e.point.normal) >= 0 ? 1 : -1;
}

// which pairs push: the closest, and others that push in another direction
int ContactPass::select(const State& state, const ActiveNode& active, const Evaluation* list,
                        int count, Accepted* accepted) {
  int used = 0;
  const double same = 1e-9 * size_;
  for (int i = 0; i < count && used < max_slots; ++i) {
    const Evaluation& e = list[i];
    const ContactSegment& s = reference_.segments[candidates_[e.candidate].segment];
    const double side = side_of(e);
    Vec3d outward = side * e.point.normal;
    bool shadowed = false;
    const int feature = e.point.feature;
    bool free_edge = false;
    if (feature > 0) {
      // an edge or corner counts only if no neighbour is closer, and once
      const auto f = feature_nodes(s, feature);
      free_edge = s.free_features >> (feature - 1) & 1;
      for (int j = 0; j < i && !shadowed; ++j)
        shadowed = holds_feature(reference_.segments[candidates_[list[j].candidate].segment], f);
      for (int j = i + 1; j < count && list[j].distance <= e.distance + same; ++j)
        if (holds_feature(reference_.segments[candidates_[list[j].candidate].segment], f))
          outward += side_of(list[j]) * list[j].point.normal;
    }
    if (shadowed) continue;
    const bool behind = !free_edge && dot(e.gap, outward) < 0;
    const double signed_distance = behind ? -e.distance : e.distance;
    const double touch = tracked_.nodes[active.tracked].half_thickness + s.half_thickness;
    const double depth = touch - signed_distance;
    if (!(depth > 0) || -signed_distance > s.limit) continue;
    // inside a convex edge the closer face pushes alone; in a groove both do
    bool convex = false;
    for (int j = 0; j < used && behind; ++j)
      convex |=
          dot(centre(state, s) - list[accepted[j].evaluation].point.x, accepted[j].direction) < 0;
    if (convex) continue;
    Vec3d direction = side * e.point.normal;
    if (feature > 0 && e.distance > 1e-12 * size_) direction = (1 / signed_distance) * e.gap;
    bool doubled = false;
    for (int j = 0; j < used; ++j) doubled |= dot(direction, accepted[j].direction) > 0.9;
    if (!doubled) accepted[used++] = {i, direction, depth};
  }
  return used;
}

// a node that touches nothing sees on which side of its segments it is
void ContactPass::remember_sides(const Evaluation* list, int count) {
  for (int i = 0; i < count; ++i) {
    const double height = dot(list[i].gap, list[i].point.normal);
    const bool clear = list[i].point.feature == 0 || std::abs(height) > 0.5 * list[i].distance;
    if (height != 0)
      candidates_[list[i].candidate].side = std::int8_t(!clear ? 0 : height > 0 ? 1 : -1);
  }
}

void ContactPass::node_forces(State& state, const ActiveNode& active, int chunk) {
  Evaluation list[max_pairs];
  Accepted accepted[max_slots];
  const int count = evaluate(state, active, list);
  ContactSlot* slots = &slots_[max_slots * active.tracked];
  // a node that slides on takes its side along
  if (in_contact(active.tracked))
    for (int i = 0; i < count; ++i) {
      ContactCandidate& c = candidates_[list[i].candidate];
      if (c.side != 0 || !reference_.segments[c.segment].two_sided) continue;
      for (int j = 0; j < count; ++j)
        if (candidates_[list[j].candidate].segment == slots[0].segment &&
            shares_node(c.segment, slots[0].segment))
          c.side = dot(list[i].point.normal, list[j].point.normal) >= 0
                       ? candidates_[list[j].candidate].side
                       : std::int8_t(-candidates_[list[j].candidate].side);
    }
  const int used = select(state, active, list, count, accepted);
  if (used == 0) {
    if (slots[0].segment >= 0 &&
        slots[0].depth - slots[0].baseline > 0.5 * release_depth(active.tracked, slots[0].segment))
      ++chunk_penetration_[chunk].released;
    remember_sides(list, count);
    for (int k = 0; k < max_slots; ++k) slots[k] = {};
    return;
  }
  ContactSlot next[max_slots];
  bool taken[max_slots] = {};
  for (int i = 0; i < used; ++i) {
    const Evaluation& e = list[accepted[i].evaluation];
    ContactCandidate& c = candidates_[e.candidate];
    if (c.side == 0) c.side = std::int8_t(side_of(e));
    // history of the same segment, else of a neighbour
    int from = -1;
    for (int k = 0; k < max_slots && from < 0; ++k)
      if (!taken[k] && slots[k].segment == c.segment) from = k;
    for (int k = 0; k < max_slots && from < 0; ++k)
      if (!taken[k] && slots[k].segment >= 0 && shares_node(slots[k].segment, c.segment)) from = k;
    if (from >= 0) next[i] = slots[from], taken[from] = true;
    next[i].segment = c.segment;
    if (!started_) {
      next[i].baseline = next[i].depth = accepted[i].depth;
      chunk_initial_[chunk].push_back({contact_index_, tracked_.nodes[active.tracked].node,
                                       c.segment, reference_.segments[c.segment].part,
                                       accepted[i].depth});
    }
    push(state, active.tracked, e, accepted[i], next[i], chunk);
  }
  std::copy(next, next + max_slots, slots);
}

void ContactPass::push(State& state, int tracked, const Evaluation& e, const Accepted& a,
                       ContactSlot& slot, int chunk) {
  const ContactNode& n = tracked_.nodes[tracked];
  const ContactSegment& s = reference_.segments[slot.segment];
  const NodeMotion& node = state.nodes[n.node];
  Vec3d v = node.v;
  double inverse_mass = node.inverse_mass;
  for (int i = 0; i < 4; ++i) {
    const NodeMotion& c = state.nodes[s.node[i]];
    v -= e.point.phi[i] * c.v;
    inverse_mass += e.point.phi[i] * e.point.phi[i] * c.inverse_mass;
  }
  const double mass = inverse_mass > 0 ? 1 / inverse_mass : 0, dt = state.dt;
  double k = penalty_option_ == 2   ? s.stiffness
             : penalty_option_ == 3 ? n.stiffness
                                    : std::min(s.stiffness, n.stiffness);
  if (contact_.soft > 0 || !std::isfinite(k)) {
    const double soft = soft_stiffness(contact_.sofscl, mass, step_);
    k = std::isfinite(k) ? std::max(k, soft) : soft;
  }
  if (!around_first_.empty()) k *= own_share(state, tracked, a.direction);
  const double rate = -dot(v, a.direction);
  // depth that appears faster than the surfaces approach comes from a change of segment or side: it
  // stores no energy, so it must not push
  const double sudden = a.depth - slot.depth - 2 * std::max(0.0, rate) * dt;
  if (started_ && sudden > 0) slot.baseline += sudden;
  slot.depth = a.depth;
  slot.baseline = std::min(slot.baseline, a.depth);
  const double depth = a.depth - slot.baseline;
  const double normal = depth > 0 ? normal_force(k, depth, rate, mass, contact_.vdc / 100) : 0.0;
  PenetrationCheck& worst = chunk_penetration_[chunk];
  if (depth > worst.depth)
    worst.depth = depth, worst.node = n.node, worst.part = s.part,
    worst.allowed = release_depth(tracked, slot.segment);
  Vec3d friction{0, 0, 0};
  if (has_friction_) {
    const Vec3d slide = v + rate * a.direction;
    friction = friction_force(friction_.between(n.part, s.part), k, normal, a.direction,
                              slot.friction, dt * slide, norm(slide), s.area);
  }
  slot.friction = friction;
  if (normal == 0) return;
  ContactForce f{n.node, slot.segment, {}, normal * a.direction, friction};
  std::copy(e.point.phi, e.point.phi + 4, f.phi);
  const Vec3d total = f.normal + f.friction;
  state.interaction.add(n.node, total);
  for (int i = 0; i < 4; ++i)
    if (f.phi[i] != 0) state.interaction.add(s.node[i], -f.phi[i] * total);
  chunk_power_[chunk].x += dot(f.normal, v), chunk_power_[chunk].y += dot(f.friction, v);
  chunk_forces_[chunk].push_back(f);
}

// SOFT=2: what pairs of facing segments do not carry (segment_pass.h)
double ContactPass::own_share(const State& state, int tracked, const Vec3d& direction) const {
  double cosine = 0;
  for (int i = around_first_[tracked]; i < around_first_[tracked + 1]; ++i) {
    const ContactSegment& s = tracked_.segments[around_[i]];
    Vec3d X[4];
    corners(state, s, X);
    const Vec3d normal = contact_detail::unit(s.triangle ? cross(X[1] - X[0], X[2] - X[0])
                                                         : cross(X[2] - X[0], X[3] - X[1]));
    cosine =
        std::max(cosine, s.two_sided ? std::abs(dot(normal, direction)) : -dot(normal, direction));
  }
  return 1 - facing_share(cosine);
}

void ContactPass::forces(State& state, Team& team, double step) {
  step_ = step;
  for (auto& list : chunk_forces_) list.clear();
  if (tracked_.nodes.empty()) return;
  if (state.time < contact_.birth || (contact_.death > 0 && state.time >= contact_.death)) return;
  if (outer_reference_.empty()) {
    search(state), cull(state, team);
  } else {
    double outer, inner;
    monitor(state, team, outer, inner);
    if (2 * outer >= outer_skin_) {
      search(state), cull(state, team);
    } else if (2 * inner >= inner_skin_) {
      cull(state, team);
    }
  }
  const int count = int(active_.size()), chunks = (count + chunk_size - 1) / chunk_size;
  if (int(chunk_forces_.size()) < chunks) chunk_forces_.resize(chunks);
  chunk_power_.assign(chunks, Vec3d{0, 0, 0});
  chunk_penetration_.assign(chunks, PenetrationCheck{});
  chunk_initial_.resize(std::max(int(chunk_initial_.size()), chunks));
  team.for_each(chunks, [&](int chunk, int) {
    for (int i = chunk * chunk_size; i < std::min(count, (chunk + 1) * chunk_size); ++i)
      node_forces(state, active_[i], chunk);
  });
  for (const PenetrationCheck& c : chunk_penetration_) penetration_.take(c, state.time);
  Vec3d power{0, 0, 0};
  for (const Vec3d& p : chunk_power_) power += p;
  if (!started_)
    for (auto& list : chunk_initial_) {
      initial_.insert(initial_.end(), list.begin(), list.end());
      list.clear();
    }
  started_ = true;
  const double work = -0.5 * state.dt * (power.x + power.y), friction = -0.5 * state.dt * power.y;
  energy_ += work, friction_energy_ += friction;
  state.energy.contact += work, state.energy.contact_friction += friction;
}

void ContactPass::account(State& state) {
  double normal = 0, friction = 0;
  for (const auto& list : chunk_forces_)
    for (const ContactForce& f : list) {
      Vec3d v = state.nodes[f.node].v;
      const ContactSegment& s = reference_.segments[f.segment];
      for (int i = 0; i < 4; ++i)
        if (f.phi[i] != 0) v -= f.phi[i] * state.nodes[s.node[i]].v;
      normal += dot(f.normal, v), friction += dot(f.friction, v);
    }
  const double work = -0.5 * state.dt * (normal + friction);
  energy_ += work, friction_energy_ += -0.5 * state.dt * friction;
  state.energy.contact += work, state.energy.contact_friction += -0.5 * state.dt * friction;
}

double ContactPass::stable_time_step(const State& state) const {
  double step = 1e30;
  if (contact_.soft > 0) return step;
  for (const ContactNode& n : tracked_.nodes)
    if (state.nodes[n.node].inverse_mass > 0 && n.stiffness > 0 && std::isfinite(n.stiffness))
      step = std::min(step, 2 * std::sqrt(state.nodes[n.node].mass / n.stiffness));
  return step;
}

void ContactPass::save(std::ostream& out) const {
  put(out, outer_reference_), put(out, inner_reference_), put(out, first_), put(out, candidates_);
  put(out, active_), put(out, active_pairs_), put(out, slots_);
  put(out, std::vector<PenetrationCheck>{penetration_});
  put(out, std::vector<double>{energy_, friction_energy_, started_ ? 1.0 : 0.0, double(searches_)});
}

void ContactPass::load(std::istream& in) {
  take(in, outer_reference_), take(in, inner_reference_), take(in, first_), take(in, candidates_);
  take(in, active_), take(in, active_pairs_), take(in, slots_);
  std::vector<PenetrationCheck> check;
  take(in, check);
  if (!check.empty()) penetration_ = check[0];
  std::vector<double> rest;
  take(in, rest);
  rest.resize(4);
  energy_ = rest[0], friction_energy_ = rest[1], started_ = rest[2] != 0, searches_ = int(rest[3]);
}

}  // namespace fabrica
