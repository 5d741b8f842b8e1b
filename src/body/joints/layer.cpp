#include "body/joints/layer.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fabrica::body {

std::map<int, Point> layer_normals(const std::vector<Point>& nodes,
                                   const std::vector<std::array<int, 4>>& surface,
                                   const std::vector<int>& quads) {
  std::map<int, Point> normals;
  for (int q : quads) {
    const auto& s = surface[std::size_t(q)];
    const Point n = quad_normal(nodes[std::size_t(s[0])], nodes[std::size_t(s[1])],
                                nodes[std::size_t(s[2])], nodes[std::size_t(s[3])]);
    for (int corner : s) normals.try_emplace(corner, Point{0, 0, 0}).first->second += n;
  }
  for (int pass = 0; pass < 2; ++pass) {
    std::map<int, Point> sums;
    for (int q : quads) {
      const auto& s = surface[std::size_t(q)];
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k : {(i + 1) % 4, (i + 3) % 4}) {
          const Point& n = normals.at(s[k]);
          sums.try_emplace(s[i], Point{0, 0, 0}).first->second += (1 / norm(n)) * n;
        }
    }
    for (auto& [node, normal] : normals) {
      const Point& sum = sums.at(node);
      if (norm(sum) > 1e-6) normal = (1 / norm(normal)) * normal + (1 / norm(sum)) * sum;
    }
  }
  for (auto& [node, normal] : normals) normal = (1 / norm(normal)) * normal;
  return normals;
}

void fill_room(const std::vector<Point>& nodes, const std::vector<std::array<int, 4>>& surface,
               const std::vector<int>& quads, const BoneSurface& other, double gap, double thickest,
               LayerPlan& plan) {
  constexpr int parts = 4;  // of a face's edge, between points where (1) is asked for
  const auto room = [&](const Point& p) {
    const SurfacePoint there = other.nearest(p, 2 * thickest + gap);
    return there.quad < 0 ? thickest : 0.5 * (there.distance - gap);
  };
  std::map<int, double> raise;
  for (const auto& [node, thickness] : plan.thickness) {
    const double t = std::min(room(nodes[std::size_t(node)]), thickest);
    raise[node] = std::max(0.0, t - thickness);
  }
  // less is raised where a point between the nodes asks for it, which no other point can mind
  for (int q : quads) {
    const auto& s = surface[std::size_t(q)];
    if (std::any_of(s.begin(), s.end(), [&](int n) { return !raise.count(n); })) continue;
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; j <= parts; ++j) {
        const double x = double(i) / parts, y = double(j) / parts;
        const double weight[4] = {(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
        Point p{0, 0, 0};
        double before = 0, more = 0;
        for (std::size_t k = 0; k < 4; ++k) {
          p += weight[k] * nodes[std::size_t(s[k])];
          before += weight[k] * plan.thickness.at(s[k]);
          more += weight[k] * raise.at(s[k]);
        }
        const double most = std::max(0.0, room(p) - before);
        if (more <= most) continue;
        for (std::size_t k = 0; k < 4; ++k)
          if (weight[k] > 0) raise.at(s[k]) *= most / more;
      }
  }
  for (auto& [node, thickness] : plan.thickness) thickness += raise.at(node);
}

void leave_out_tiles(const std::vector<std::array<int, 4>>& surface, std::vector<int>& quads) {
  std::map<std::pair<int, int>, int> faces;  // of an edge
  const auto edge = [&](int q, std::size_t i) {
    const auto& s = surface[std::size_t(q)];
    return std::pair<int, int>(std::minmax(s[i], s[(i + 1) % 4]));
  };
  for (int q : quads)
    for (std::size_t i = 0; i < 4; ++i) ++faces[edge(q, i)];
  std::vector<int> joined;
  for (int q : quads) {
    bool alone = true;
    for (std::size_t i = 0; i < 4; ++i) alone = alone && faces.at(edge(q, i)) == 1;
    if (!alone) joined.push_back(q);
  }
  if (2 * joined.size() > quads.size()) quads = std::move(joined);
}

}  // namespace fabrica::body
