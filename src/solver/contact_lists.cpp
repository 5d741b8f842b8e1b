// The two lists of a contact pass: which pairs are looked at, and how long a list stays complete.
#include <algorithm>
#include <cmath>

#include "solver/contact_pass.h"

namespace fabrica {
namespace {

constexpr int cull_chunk_size = 512;  // tracked nodes
constexpr int monitor_chunk_size = 4096;

bool holds(const ContactSegment& s, int node) {
  return s.node[0] == node || s.node[1] == node || s.node[2] == node || s.node[3] == node;
}

// which pairs may touch at all
struct Filter : PairFilter {
  const ContactSurface& tracked;
  const ContactSurface& reference;
  const CarrierNodes& carriers;
  const std::vector<Vec3d>& start;  // positions
  Filter(const ContactSurface& t, const ContactSurface& r, const CarrierNodes& c,
         const std::vector<Vec3d>& x)
      : tracked(t), reference(r), carriers(c), start(x) {}
  // the other face of the same thin solid, through the material
  bool opposite_face(const ContactNode& n, const ContactSegment& s) const {
    if (s.shell || n.part != s.part) return false;
    const Vec3d &a = start[s.node[0]], &b = start[s.node[1]], &c = start[s.node[2]],
                &d = start[s.node[3]];
    const Vec3d normal =
        contact_detail::unit(s.triangle ? cross(b - a, c - a) : cross(c - a, d - b));
    const Vec3d u = start[n.node] - 0.25 * (a + b + c + d);
    const double near = 4 * s.limit + 2 * std::sqrt(s.area);
    return dot(u, normal) < 0 && dot(n.normal, normal) < 0 && dot(u, u) < near * near;
  }
  bool keep(int point, int box) const override {
    const ContactNode& n = tracked.nodes[point];
    const ContactSegment& s = reference.segments[box];
    if (holds(s, n.node)) return false;
    if (n.body >= 0 && n.body == s.body) return false;
    if (opposite_face(n, s)) return false;
    if (carriers.empty()) return true;
    for (int c : carriers[n.node])
      if (holds(s, c)) return false;
    for (int corner : s.node)
      for (int c : carriers[corner])
        if (c == n.node) return false;
    return true;
  }
};

}  // namespace

void ContactPass::remember_positions(const State& state, std::vector<Vec3d>& reference) const {
  reference.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) reference[i] = state.nodes[nodes_[i]].x;
}

// mean displacement of some nodes; any translation leaves the argument for the lists valid
Vec3d ContactPass::translation(const State& state, const std::vector<Vec3d>& reference) const {
  const std::size_t step = nodes_.size() / 64 + 1;
  Vec3d sum{0, 0, 0};
  int count = 0;
  for (std::size_t i = 0; i < nodes_.size(); i += step, ++count)
    sum += state.nodes[nodes_[i]].x - reference[i];
  return (1.0 / count) * sum;
}

// largest displacement since the candidates and since the active list were made
void ContactPass::monitor(const State& state, Team& team, double& outer, double& inner) const {
  const Vec3d shift_outer = translation(state, outer_reference_);
  const Vec3d shift_inner = translation(state, inner_reference_);
  const int chunks = int((nodes_.size() + monitor_chunk_size - 1) / monitor_chunk_size);
  std::vector<double> worst(2 * chunks, 0.0);
  team.for_each(chunks, [&](int chunk, int) {
    const std::size_t end = std::min(nodes_.size(), std::size_t(chunk + 1) * monitor_chunk_size);
    double a = 0, b = 0;
    for (std::size_t i = std::size_t(chunk) * monitor_chunk_size; i < end; ++i) {
      const Vec3d& x = state.nodes[nodes_[i]].x;
      const Vec3d u = x - outer_reference_[i] - shift_outer,
                  w = x - inner_reference_[i] - shift_inner;
      a = std::max(a, dot(u, u)), b = std::max(b, dot(w, w));
    }
    worst[2 * chunk] = a, worst[2 * chunk + 1] = b;
  });
  outer = inner = 0;
  for (int c = 0; c < chunks; ++c)
    outer = std::max(outer, worst[2 * c]), inner = std::max(inner, worst[2 * c + 1]);
  outer = std::sqrt(outer), inner = std::sqrt(inner);
}

// all pairs within reach + skin; what pairs knew of each other stays
void ContactPass::search(const State& state) {
  std::vector<Vec3d> points(tracked_.nodes.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = state.nodes[tracked_.nodes[i].node].x;
  std::vector<BoundingBox> boxes(reference_.segments.size());
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    const ContactSegment& s = reference_.segments[b];
    const double margin = std::max(s.half_thickness + largest_half_, s.reach) + outer_skin_;
    Vec3d low = state.nodes[s.node[0]].x, high = low;
    for (int n : s.node) {
      const Vec3d& x = state.nodes[n].x;
      for (int d = 0; d < 3; ++d)
        low[d] = std::min(low[d], x[d]), high[d] = std::max(high[d], x[d]);
    }
    const Vec3d m{margin, margin, margin};
    boxes[b] = {low - m, high + m};
  }
  const PointBoxPairs pairs =
      find_pairs(points, boxes, Filter(tracked_, reference_, carriers_, start_));
  std::vector<ContactCandidate> next(pairs.box.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool had = !first_.empty();
    int old = had ? first_[i] : 0;
    const int old_end = had ? first_[i + 1] : 0;
    for (int p = pairs.first[i]; p < pairs.first[i + 1]; ++p) {
      next[p].segment = pairs.box[p];
      while (old < old_end && candidates_[old].segment < pairs.box[p]) ++old;
      if (old < old_end && candidates_[old].segment == pairs.box[p]) next[p] = candidates_[old];
    }
  }
  candidates_ = std::move(next);
  first_ = pairs.first;
  remember_positions(state, outer_reference_);
  ++searches_;
}

// candidates of one node that can touch or be its closest before the next cull
void ContactPass::cull_node(const State& state, int node, std::vector<int>& pairs) const {
  struct Near {
    int candidate;
    double distance, touch;
    bool inside;
  };
  Near near[128];
  int count = 0;
  const ContactNode& tracked = tracked_.nodes[node];
  const Vec3d& x = state.nodes[tracked.node].x;
  double best = 1e300;
  for (int c = first_[node]; c < first_[node + 1] && count < 128; ++c) {
    const ContactSegment& s = reference_.segments[candidates_[c].segment];
    const double margin = reach(node, candidates_[c].segment) + 2 * inner_skin_;
    // boxes first
    bool far = false;
    Vec3d X[4];
    corners(state, s, X);
    for (int d = 0; d < 3; ++d) {
      const double low = std::min(std::min(X[0][d], X[1][d]), std::min(X[2][d], X[3][d]));
      const double high = std::max(std::max(X[0][d], X[1][d]), std::max(X[2][d], X[3][d]));
      far |= x[d] < low - margin || x[d] > high + margin;
    }
    if (far) continue;
    const SurfacePoint p = s.triangle
                               ? closest_point_triangle(X, x)
                               : closest_point_quad(X, x, candidates_[c].r, candidates_[c].s);
    const double distance = norm(x - p.x);
    if (distance > margin) continue;
    const bool inside = p.feature == 0;
    near[count++] = {c, distance, tracked.half_thickness + s.half_thickness, inside};
    best = std::min(best, distance);
  }
  // more than a node can hold: the nearest
  if (count > max_pairs) {
    std::stable_sort(near, near + count,
                     [](const Near& a, const Near& b) { return a.distance < b.distance; });
    count = max_pairs;
  }
  for (int i = 0; i < count; ++i)
    if (near[i].inside || near[i].distance < near[i].touch + inner_skin_ ||
        near[i].distance < best + 2 * inner_skin_)
      pairs.push_back(near[i].candidate);
}

void ContactPass::cull(const State& state, Team& team) {
  const int nodes = int(tracked_.nodes.size());
  const int chunks = (nodes + cull_chunk_size - 1) / cull_chunk_size;
  std::vector<std::vector<ActiveNode>> active(chunks);
  std::vector<std::vector<int>> pairs(chunks);
  team.for_each(chunks, [&](int chunk, int) {
    for (int i = chunk * cull_chunk_size; i < std::min(nodes, (chunk + 1) * cull_chunk_size); ++i) {
      if (first_[i] == first_[i + 1] && !in_contact(i)) continue;
      const int first = int(pairs[chunk].size());
      cull_node(state, i, pairs[chunk]);
      const int count = int(pairs[chunk].size()) - first;
      if (count > 0 || in_contact(i)) active[chunk].push_back({i, first, count});
    }
  });
  active_.clear(), active_pairs_.clear();
  for (int c = 0; c < chunks; ++c) {
    const int offset = int(active_pairs_.size());
    for (ActiveNode a : active[c]) a.first += offset, active_.push_back(a);
    active_pairs_.insert(active_pairs_.end(), pairs[c].begin(), pairs[c].end());
  }
  remember_positions(state, inner_reference_);
}

std::vector<std::pair<int, int>> ContactPass::candidate_pairs() const {
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i + 1 < first_.size(); ++i)
    for (int c = first_[i]; c < first_[i + 1]; ++c)
      pairs.push_back({tracked_.nodes[i].node, candidates_[c].segment});
  return pairs;
}

}  // namespace fabrica
