#include "solver/segment_pass.h"

#include <algorithm>
#include <cmath>

#include "contact/segment_overlap.h"
#include "solver/stream.h"

namespace fabrica {
namespace {

constexpr int chunk_size = 32;  // near pairs

Vec3d normal_of(const Vec3d* X, bool triangle) {
  return contact_detail::unit(triangle ? cross(X[1] - X[0], X[2] - X[0])
                                       : cross(X[2] - X[0], X[3] - X[1]));
}
Vec3d centre_of(const Vec3d* X, bool triangle) {
  return triangle ? (1.0 / 3) * (X[0] + X[1] + X[2]) : 0.25 * (X[0] + X[1] + X[2] + X[3]);
}
void corners(const State& state, const ContactSegment& s, Vec3d* X) {
  for (int i = 0; i < 4; ++i) X[i] = state.nodes[s.node[i]].x;
}

// velocity of the first side of a pair less that of the second
Vec3d relative_velocity(const State& state, const SegmentForce& f, const ContactSegment& a,
                        const ContactSegment& b) {
  Vec3d v{0, 0, 0};
  for (int i = 0; i < 4; ++i)
    v += f.weight_first[i] * state.nodes[a.node[i]].v -
         f.weight_second[i] * state.nodes[b.node[i]].v;
  return v;
}

// mass per area of the segments; where no element is behind one, its nodes share their mass between
// the segments around
std::vector<double> mass_per_area(const State& state, const ContactSurface& surface) {
  std::vector<int> users(state.nodes.size(), 0);
  for (const ContactSegment& s : surface.segments)
    for (int i = 0; i < (s.triangle ? 3 : 4); ++i) ++users[s.node[i]];
  std::vector<double> list;
  for (const ContactSegment& s : surface.segments) {
    double mass = s.mass_per_area * s.area;
    for (int i = 0; s.mass_per_area == 0 && i < (s.triangle ? 3 : 4); ++i)
      mass += state.nodes[s.node[i]].mass / users[s.node[i]];
    list.push_back(s.area > 0 ? mass / s.area : 0);
  }
  return list;
}

template <class T>
void read_any_size(std::istream& in, std::vector<T>& v) {
  std::int64_t n = 0;
  read_value(in, n);
  v.resize(std::size_t(n));
  read_vector(in, v);
}
template <class T>
void write_any_size(std::ostream& out, const std::vector<T>& v) {
  write_value(out, std::int64_t(v.size()));
  write_vector(out, v);
}

}  // namespace

SegmentPass::SegmentPass(const Model& model, const Contact& contact, int contact_index,
                         ContactSurface first, ContactSurface second, bool single,
                         const CarrierNodes& carriers)
    : model_(model),
      contact_(contact),
      contact_index_(contact_index),
      first_(std::move(first)),
      second_(std::move(second)),
      single_(single),
      carriers_(carriers),
      friction_(model, contact),
      has_friction_(friction_.active()),
      scale_(0.5 * model.controls.contact_scale * contact.sfs) {
  std::vector<double> sizes;
  for (const ContactSurface* surface : {&first_, &second_})
    for (const ContactSegment& s : surface->segments) {
      sizes.push_back(std::sqrt(s.area));
      nodes_.insert(nodes_.end(), s.node, s.node + 4);
    }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  first_baseline_.assign(first_.segments.size(), 0),
      second_baseline_.assign(second_.segments.size(), 0);
  if (sizes.empty()) return;
  std::nth_element(sizes.begin(), sizes.begin() + std::ptrdiff_t(sizes.size() / 2), sizes.end());
  outer_skin_ = 0.3 * sizes[sizes.size() / 2], inner_skin_ = 0.04 * sizes[sizes.size() / 2];
}

SegmentPass::Facing SegmentPass::facing(const Pair& pair, const Vec3d* X, const Vec3d* Y) const {
  const ContactSegment &a = first_.segments[pair.first], &b = second_.segments[pair.second];
  Vec3d towards_b = normal_of(X, a.triangle), towards_a = normal_of(Y, b.triangle);
  if (a.two_sided && b.two_sided) {
    const double height = dot(centre_of(X, a.triangle) - centre_of(Y, b.triangle), towards_a);
    if (pair.side != 0 ? pair.side < 0 : height < 0) towards_a = -towards_a;
  } else if (b.two_sided && dot(towards_a, towards_b) > 0) {
    towards_a = -towards_a;
  }
  if (a.two_sided && dot(towards_a, towards_b) > 0) towards_b = -towards_b;
  return {contact_detail::unit(towards_a - towards_b), facing_share(-dot(towards_a, towards_b))};
}

void SegmentPass::pair_force(State& state, Pair& pair, int chunk) {
  const ContactSegment &a = first_.segments[pair.first], &b = second_.segments[pair.second];
  Vec3d X[4], Y[4];
  corners(state, a, X), corners(state, b, Y);
  const Facing face = facing(pair, X, Y);
  const bool was_touching = pair.touching;
  pair.touching = false;
  if (face.share > 0) {
    const double thickness = a.half_thickness + b.half_thickness,
                 limit = std::max(a.limit, b.limit);
    if (!was_touching)
      pair.baseline = std::max(first_baseline_[pair.first], second_baseline_[pair.second]),
      pair.friction = {0, 0, 0};
    SegmentOverlap o = segment_overlap(X, a.triangle, Y, b.triangle, face.normal, thickness,
                                       started_ ? pair.baseline : 1e300, limit);
    if (o.depth > 0) {
      pair.touching = true, pair.depth = o.depth;
      if (!started_) {
        pair.baseline = o.depth;
        chunk_initial_[chunk].push_back({contact_index_, a.node[0], pair.second, b.part, o.depth});
      }
      pair.baseline = std::min(pair.baseline, o.depth);
      if (o.integral > 0)
        push(state, pair, o, face, chunk);
      else
        pair.friction = {0, 0, 0};
    } else if (was_touching && pair.depth - pair.baseline > 0.5 * (thickness + limit)) {
      ++chunk_penetration_[chunk].released;
    }
  }
  // while nothing touches, the pair sees on which side it is
  if (!pair.touching && a.two_sided && b.two_sided) {
    const double height =
        dot(centre_of(X, a.triangle) - centre_of(Y, b.triangle), normal_of(Y, b.triangle));
    pair.side = height > 0 ? 1 : -1;
  }
}

void SegmentPass::push(State& state, Pair& pair, const SegmentOverlap& o, const Facing& face,
                       int chunk) {
  const ContactSegment &a = first_.segments[pair.first], &b = second_.segments[pair.second];
  SegmentForce f{pair.first, pair.second, {}, {}, {}, {}};
  double inverse_mass = 0;
  for (int i = 0; i < 4; ++i) {
    f.weight_first[i] = o.first[i], f.weight_second[i] = o.second[i];
    inverse_mass += o.first[i] * o.first[i] * state.nodes[a.node[i]].inverse_mass +
                    o.second[i] * o.second[i] * state.nodes[b.node[i]].inverse_mass;
  }
  const double mu1 = first_mass_[pair.first], mu2 = second_mass_[pair.second];
  if (!(inverse_mass > 0) || !(mu1 + mu2 > 0)) return;
  const double kappa = scale_ * mu1 * mu2 / (mu1 + mu2) / (stiffness_step_ * stiffness_step_);
  const double k = face.share * kappa * o.area, mean_depth = o.integral / o.area;
  const Vec3d v = relative_velocity(state, f, a, b);
  const double rate = -dot(v, face.normal);
  const double normal = normal_force(k, mean_depth, rate, 1 / inverse_mass, contact_.vdc / 100);
  if (has_friction_) {
    const Vec3d slide = v + rate * face.normal;
    f.friction = friction_force(friction_.between(a.part, b.part), k, normal, face.normal,
                                pair.friction, state.dt * slide, norm(slide), o.area);
  }
  pair.friction = f.friction;
  PenetrationCheck& worst = chunk_penetration_[chunk];
  if (const double depth = o.depth - pair.baseline; depth > worst.depth)
    worst.depth = depth, worst.node = a.node[0], worst.part = b.part,
    worst.allowed = a.half_thickness + b.half_thickness + std::max(a.limit, b.limit);
  if (normal == 0) return;
  f.normal = normal * face.normal;
  const Vec3d total = f.normal + f.friction;
  for (int i = 0; i < 4; ++i) {
    if (f.weight_first[i] != 0) state.interaction.add(a.node[i], f.weight_first[i] * total);
    if (f.weight_second[i] != 0) state.interaction.add(b.node[i], -f.weight_second[i] * total);
  }
  chunk_power_[chunk].x += dot(f.normal, v), chunk_power_[chunk].y += dot(f.friction, v);
  chunk_forces_[chunk].push_back(f);
}

// what a segment is allowed passes on to the next pair it touches
void SegmentPass::inherit_baselines() {
  std::fill(first_baseline_.begin(), first_baseline_.end(), 0.0);
  std::fill(second_baseline_.begin(), second_baseline_.end(), 0.0);
  for (int p : active_) {
    const Pair& pair = pairs_[p];
    if (!pair.touching) continue;
    first_baseline_[pair.first] = std::max(first_baseline_[pair.first], pair.baseline);
    second_baseline_[pair.second] = std::max(second_baseline_[pair.second], pair.baseline);
  }
  if (!single_) return;
  for (std::size_t i = 0; i < first_baseline_.size(); ++i)
    first_baseline_[i] = second_baseline_[i] = std::max(first_baseline_[i], second_baseline_[i]);
}

void SegmentPass::weigh_segments(const State& state) {
  first_mass_ = mass_per_area(state, first_);
  second_mass_ = single_ ? first_mass_ : mass_per_area(state, second_);
}

void SegmentPass::forces(State& state, Team& team, double step) {
  for (auto& list : chunk_forces_) list.clear();
  if (first_.segments.empty() || second_.segments.empty()) return;
  if (state.time < contact_.birth || (contact_.death > 0 && state.time >= contact_.death)) return;
  if (first_mass_.empty()) weigh_segments(state);
  if (stiffness_step_ == 0 || step > 1.05 * stiffness_step_) stiffness_step_ = step;
  if (outer_reference_.empty() || 2 * largest_displacement(state, outer_reference_) >= outer_skin_)
    search(state), cull(state);
  else if (2 * largest_displacement(state, inner_reference_) >= inner_skin_)
    cull(state);
  const int count = int(active_.size()), chunks = (count + chunk_size - 1) / chunk_size;
  if (int(chunk_forces_.size()) < chunks) chunk_forces_.resize(chunks);
  chunk_power_.assign(chunks, Vec3d{0, 0, 0});
  chunk_penetration_.assign(chunks, PenetrationCheck{});
  chunk_initial_.resize(std::max(int(chunk_initial_.size()), chunks));
  team.for_each(chunks, [&](int chunk, int) {
    for (int i = chunk * chunk_size; i < std::min(count, (chunk + 1) * chunk_size); ++i)
      pair_force(state, pairs_[active_[i]], chunk);
  });
  inherit_baselines();
  collect(state);
}

// sums of the chunks, in their order
void SegmentPass::collect(State& state) {
  Vec3d power{0, 0, 0};
  for (const Vec3d& p : chunk_power_) power += p;
  for (const PenetrationCheck& c : chunk_penetration_) penetration_.take(c, state.time);
  if (!started_)
    for (auto& list : chunk_initial_) {
      initial_.insert(initial_.end(), list.begin(), list.end());
      list.clear();
    }
  started_ = true;
  book(state, power.x, power.y);
}

void SegmentPass::book(State& state, double normal, double friction) {
  const double work = -0.5 * state.dt * (normal + friction),
               of_friction = -0.5 * state.dt * friction;
  energy_ += work, friction_energy_ += of_friction;
  state.energy.contact += work, state.energy.contact_friction += of_friction;
}

void SegmentPass::account(State& state) {
  double normal = 0, friction = 0;
  for (const auto& list : chunk_forces_)
    for (const SegmentForce& f : list) {
      const Vec3d v =
          relative_velocity(state, f, first_.segments[f.first], second_.segments[f.second]);
      normal += dot(f.normal, v), friction += dot(f.friction, v);
    }
  book(state, normal, friction);
}

void SegmentPass::save(std::ostream& out) const {
  write_any_size(out, outer_reference_), write_any_size(out, inner_reference_),
      write_any_size(out, pairs_);
  write_any_size(out, active_), write_vector(out, first_baseline_),
      write_vector(out, second_baseline_);
  write_any_size(out, first_mass_), write_any_size(out, second_mass_);
  write_value(out, started_), write_value(out, stiffness_step_), write_value(out, energy_);
  write_value(out, friction_energy_), write_value(out, penetration_);
}

void SegmentPass::load(std::istream& in) {
  read_any_size(in, outer_reference_), read_any_size(in, inner_reference_),
      read_any_size(in, pairs_);
  read_any_size(in, active_), read_vector(in, first_baseline_), read_vector(in, second_baseline_);
  read_any_size(in, first_mass_), read_any_size(in, second_mass_);
  read_value(in, started_), read_value(in, stiffness_step_), read_value(in, energy_);
  read_value(in, friction_energy_), read_value(in, penetration_);
}

}  // namespace fabrica
