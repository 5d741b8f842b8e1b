#include "body/joints/surface_gap.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace fabrica::body {

namespace {

constexpr double farthest = 1e4;  // [mm] of two surfaces that are compared

// |distance| of p to a surface: the reach doubles until something is found
double distance_to(const BoneSurface& surface, const Point& p, double reach = 4) {
  for (; reach < farthest; reach *= 2) {
    const SurfacePoint at = surface.nearest(p, reach);
    if (at.quad >= 0) return std::abs(at.distance);
  }
  return farthest;
}

struct Edge {
  Point from, to;
};

// edges of the triangles of a surface that come within reach of a box
std::vector<Edge> edges_near(const std::vector<Point>& nodes,
                             const std::vector<std::array<int, 4>>& quads, const BoneSurface& box,
                             double reach) {
  std::set<std::pair<int, int>> pairs;
  for (const auto& q : quads)
    for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}})
      pairs.insert(std::minmax(q[std::size_t(i)], q[std::size_t(j)]));
  std::vector<Edge> edges;
  for (const auto& [i, j] : pairs) {
    const Point &p = nodes[std::size_t(i)], &q = nodes[std::size_t(j)];
    bool near = i != j;
    for (int k = 0; k < 3; ++k)
      near = near && std::min(p[k], q[k]) <= box.high[k] + reach &&
             std::max(p[k], q[k]) >= box.low[k] - reach;
    if (near) edges.push_back({p, q});
  }
  return edges;
}

bool pass_through(const std::vector<Edge>& edges, const BoneSurface& surface) {
  return std::any_of(edges.begin(), edges.end(), [&](const Edge& e) {
    const Point along = e.to - e.from;
    const double length = norm(along);
    return length > 0 && surface.hit(e.from, (1 / length) * along, length).quad >= 0;
  });
}

}  // namespace

double segment_distance(const Point& a, const Point& b, const Point& c, const Point& d) {
  // points a + s u and c + t v, both parameters clipped to 0..1 (Ericson, Real-Time Collision
  // Detection, 5.1.9)
  const Point u = b - a, v = d - c, w = a - c;
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
  const double det = uu * vv - uv * uv;
  double s = det > 1e-12 * uu * vv ? std::clamp((uv * vw - uw * vv) / det, 0.0, 1.0) : 0;
  double t = vv > 0 ? (uv * s + vw) / vv : 0;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = uu > 0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0;
  }
  return norm(w + s * u - t * v);
}

double SurfaceGap::to_b(int node) const { return distance_to(b_, nodes_[std::size_t(node)]); }

std::vector<int> SurfaceGap::facing(double reach) const {
  std::vector<int> found;
  for (const int n : a_.nodes())
    if (b_.nearest(nodes_[std::size_t(n)], reach).quad >= 0) found.push_back(n);
  return found;
}

double SurfaceGap::least() const {
  double best = farthest;
  const auto corners = [&](const BoneSurface& from, const BoneSurface& to) {
    for (const int n : from.nodes()) {
      const Point& p = nodes_[std::size_t(n)];
      if (best == farthest) best = distance_to(to, p);
      const SurfacePoint at = to.nearest(p, best);
      if (at.quad >= 0) best = std::min(best, std::abs(at.distance));
    }
  };
  corners(a_, b_), corners(b_, a_);
  const std::vector<Edge> of_a = edges_near(nodes_, quads_a_, b_, best),
                          of_b = edges_near(nodes_, quads_b_, a_, best);
  if (pass_through(of_a, b_) || pass_through(of_b, a_)) return 0;
  for (const Edge& e : of_a) {
    for (const Edge& f : of_b) {
      bool near = true;
      for (int k = 0; k < 3; ++k)
        near = near && std::min(e.from[k], e.to[k]) <= std::max(f.from[k], f.to[k]) + best &&
               std::min(f.from[k], f.to[k]) <= std::max(e.from[k], e.to[k]) + best;
      if (near) best = std::min(best, segment_distance(e.from, e.to, f.from, f.to));
    }
  }
  return best;
}

}  // namespace fabrica::body
