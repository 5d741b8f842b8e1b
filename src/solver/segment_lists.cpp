// Which pairs of segments are looked at: candidates within an outer skin, near pairs within an
// inner one, as for nodes (contact_pass.h).
#include <algorithm>
#include <cmath>

#include "solver/segment_pass.h"

namespace fabrica {
namespace {

BoundingBox box_of(const State& state, const ContactSegment& s, double margin) {
  Vec3d low = state.nodes[s.node[0]].x, high = low;
  for (int n : s.node)
    for (int d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], state.nodes[n].x[d]),
      high[d] = std::max(high[d], state.nodes[n].x[d]);
    }
  const Vec3d m{margin, margin, margin};
  return {low - m, high + m};
}

bool overlap(const BoundingBox& a, const BoundingBox& b) {
  for (int d = 0; d < 3; ++d)
    if (a.low[d] > b.high[d] || b.low[d] > a.high[d]) return false;
  return true;
}

double margin_of(const ContactSegment& s) { return std::max(s.half_thickness, s.limit); }

bool share_node(const ContactSegment& a, const ContactSegment& b) {
  for (int n : a.node)
    if (std::find(b.node, b.node + 4, n) != b.node + 4) return true;
  return false;
}

// which pairs may touch at all
struct Filter : PairFilter {
  const ContactSurface &first, &second;
  const std::vector<BoundingBox>&first_box, &second_box;
  bool single;
  const CarrierNodes& carriers;
  const std::vector<Vec3d>& start;

  Filter(const ContactSurface& a, const ContactSurface& b, const std::vector<BoundingBox>& box_a,
         const std::vector<BoundingBox>& box_b, bool same, const CarrierNodes& c,
         const std::vector<Vec3d>& x)
      : first(a),
        second(b),
        first_box(box_a),
        second_box(box_b),
        single(same),
        carriers(c),
        start(x) {}

  Vec3d area(const ContactSegment& s) const {
    const Vec3d &a = start[s.node[0]], &b = start[s.node[1]], &c = start[s.node[2]],
                &d = start[s.node[3]];
    return s.triangle ? cross(b - a, c - a) : cross(c - a, d - b);
  }
  // two faces of one solid, through the material
  bool opposite_faces(const ContactSegment& a, const ContactSegment& b) const {
    if (a.shell || b.shell || a.part != b.part) return false;
    const Vec3d normal = area(b);
    const Vec3d u = start[a.node[0]] - start[b.node[0]];
    const double near = 4 * b.limit + 2 * std::sqrt(b.area);
    return dot(area(a), normal) < 0 && dot(u, normal) < 0 && dot(u, u) < near * near;
  }
  bool tied(const ContactSegment& a, const ContactSegment& b) const {
    if (carriers.empty()) return false;
    for (int n : a.node)
      for (int c : carriers[n])
        if (std::find(b.node, b.node + 4, c) != b.node + 4) return true;
    return false;
  }
  bool keep(int point, int box) const override {
    if (single && point >= box) return false;
    const ContactSegment &a = first.segments[point], &b = second.segments[box];
    if (!overlap(first_box[point], second_box[box]) || share_node(a, b)) return false;
    if (a.body >= 0 && a.body == b.body) return false;
    return !opposite_faces(a, b) && !tied(a, b) && !tied(b, a);
  }
};

}  // namespace

void SegmentPass::remember(const State& state, std::vector<Vec3d>& reference) const {
  reference.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) reference[i] = state.nodes[nodes_[i]].x;
}

// since the reference was remembered, less the common translation
double SegmentPass::largest_displacement(const State& state,
                                         const std::vector<Vec3d>& reference) const {
  const std::size_t stride = nodes_.size() / 64 + 1;
  Vec3d sum{0, 0, 0};
  int count = 0;
  for (std::size_t i = 0; i < nodes_.size(); i += stride, ++count)
    sum += state.nodes[nodes_[i]].x - reference[i];
  const Vec3d shift = (1.0 / count) * sum;
  double largest = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vec3d u = state.nodes[nodes_[i]].x - reference[i] - shift;
    largest = std::max(largest, dot(u, u));
  }
  return std::sqrt(largest);
}

// all pairs within reach + skin; what pairs knew of each other stays
void SegmentPass::search(const State& state) {
  std::vector<BoundingBox> first_box, second_box, reached;
  std::vector<Vec3d> centres;
  double largest = 0;  // from the centre of a first segment to the edge of its box
  for (const ContactSegment& s : first_.segments) {
    first_box.push_back(box_of(state, s, margin_of(s) + 0.5 * outer_skin_));
    const BoundingBox& b = first_box.back();
    centres.push_back(0.5 * (b.low + b.high));
    for (int d = 0; d < 3; ++d) largest = std::max(largest, 0.5 * (b.high[d] - b.low[d]));
  }
  for (const ContactSegment& s : second_.segments) {
    second_box.push_back(box_of(state, s, margin_of(s) + 0.5 * outer_skin_));
    const Vec3d m{largest, largest, largest};
    reached.push_back({second_box.back().low - m, second_box.back().high + m});
  }
  const Filter filter(first_, second_, first_box, second_box, single_, carriers_, model_.nodes.x);
  const PointBoxPairs found = find_pairs(centres, reached, filter);
  pairs_ = carry_over(found, pairs_);
  remember(state, outer_reference_);
}

// pairs that can touch before the next cull; none goes deeper than the deepest so far without being
// seen first
void SegmentPass::cull(const State& state) {
  active_.clear();
  auto overlap_within = [&](const ContactSegment& a, const ContactSegment& b, double margin_a,
                            double margin_b) {
    return overlap(box_of(state, a, margin_a + 0.5 * inner_skin_),
                   box_of(state, b, margin_b + 0.5 * inner_skin_));
  };
  auto usual = [&](const ContactSegment& s) {
    return std::min(margin_of(s), s.half_thickness + 0.5 * penetration_.depth);
  };
  for (int p = 0; p < int(pairs_.size()); ++p) {
    const ContactSegment &a = first_.segments[pairs_[p].first],
                         &b = second_.segments[pairs_[p].second];
    const bool near = overlap_within(a, b, usual(a), usual(b)) ||
                      (pairs_[p].touching && overlap_within(a, b, margin_of(a), margin_of(b)));
    if (near) {
      active_.push_back(p);
    } else {
      pairs_[p].touching = false;
    }
  }
  remember(state, inner_reference_);
}

}  // namespace fabrica
