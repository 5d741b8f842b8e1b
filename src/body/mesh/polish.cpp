#include "body/mesh/polish.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/lane_math.h"
#include "body/placement.h"

namespace fabrica::body {
namespace {

struct Random {  // splitmix64
  std::uint64_t state;
  double next() {  // in [-1, 1)
    std::uint64_t z = (state += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return double((z ^ (z >> 31)) >> 11) * (2.0 / 9007199254740992.0) - 1;
  }
};

// [mm] how far a node is off its plane, of a one-sided plane behind it
double behind(const PlaneNode& plane, const Point& p) {
  const double d = dot(p - plane.point, plane.normal);
  return plane.one_sided ? std::min(d, 0.0) : d;
}

// the terms of (1) around one node
class Neighbourhood {
 public:
  Neighbourhood(const UntangleProblem& problem, const PolishOptions& options, std::size_t nodes)
      : problem_(problem),
        options_(options),
        bricks_of_node_(nodes),
        shells_of_node_(nodes),
        surfaces_of_node_(nodes),
        planes_of_node_(nodes) {
    for (std::size_t e = 0; e < problem.bricks.size(); ++e)
      for (const int n : problem.bricks[e]) bricks_of_node_[n].push_back(int(e));
    if (options.shell_size > 0)
      for (std::size_t q = 0; q < problem.shells.size(); ++q)
        for (const int n : problem.shells[q]) shells_of_node_[n].push_back(int(q));
    for (const SurfaceNode& s : problem.surface) surfaces_of_node_[s.node].push_back(s);
    for (const PlaneNode& p : problem.planes) planes_of_node_[p.node].push_back(p);
  }
  double cost(const std::vector<Point>& nodes, int node) const {
    double sum = 0;
    for (const int e : bricks_of_node_[node]) {
      const Corners corners = corners_of(nodes, problem_.bricks[e]);
      sum += exp(-14 * (scaled_jacobian(corners) - options_.jacobian));
      sum += exp(-14 * (size_of(corners) / options_.size - 1));
    }
    for (const int q : shells_of_node_[node])
      sum += exp(-14 * (shell_size(nodes, problem_.shells[q]) / options_.shell_size - 1));
    for (const SurfaceNode& s : surfaces_of_node_[node]) {
      const double phi = (s.field->value(nodes[node]) + s.depth) / problem_.spacing;
      sum += options_.weight * phi * phi;
    }
    for (const PlaneNode& p : planes_of_node_[node]) {
      const double off = behind(p, nodes[node]) / problem_.spacing;
      sum += p.weight * off * off;
    }
    return sum;
  }

 private:
  const UntangleProblem& problem_;
  const PolishOptions& options_;
  std::vector<std::vector<int>> bricks_of_node_;
  std::vector<std::vector<int>> shells_of_node_;
  std::vector<std::vector<SurfaceNode>> surfaces_of_node_;
  std::vector<std::vector<PlaneNode>> planes_of_node_;
};

std::vector<int> nodes_of_worst(const UntangleProblem& problem, const std::vector<Point>& nodes,
                                const PolishOptions& options) {
  std::vector<int> list;
  for (const Brick& brick : problem.bricks) {
    const Corners corners = corners_of(nodes, brick);
    if (scaled_jacobian(corners) < options.jacobian || size_of(corners) < options.size)
      list.insert(list.end(), brick.begin(), brick.end());
  }
  for (const Quad& quad : problem.shells)
    if (options.shell_size > 0 && shell_size(nodes, quad) < options.shell_size)
      list.insert(list.end(), quad.begin(), quad.end());
  for (const PlaneNode& p : problem.planes)
    if (p.one_sided && behind(p, nodes[p.node]) < -0.01) list.push_back(p.node);
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

}  // namespace

void polish(const UntangleProblem& problem, std::vector<Point>& nodes,
            const PolishOptions& options) {
  const Neighbourhood around(problem, options, nodes.size());
  std::vector<double> reach(nodes.size(), 0.15 * problem.spacing);
  Random random{nodes.size()};
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    const std::vector<int> list = nodes_of_worst(problem, nodes, options);
    if (list.empty()) return;
    for (const int node : list) {
      const int image = problem.image.empty() ? -1 : problem.image[node];
      if (image >= 0 && image < node) continue;
      double best = around.cost(nodes, node);
      bool moved = false;
      for (int trial = 0; trial < 8; ++trial) {
        const Point before = nodes[node];
        nodes[node] += reach[node] * Point{random.next(), random.next(), random.next()};
        if (image == node) nodes[node].y = before.y;
        if (image > node) nodes[image] = mirror(nodes[node]);
        const double cost = around.cost(nodes, node);
        if (cost < best) {
          best = cost, moved = true;
        } else {
          nodes[node] = before;
          if (image > node) nodes[image] = mirror(before);
        }
      }
      reach[node] = std::clamp(reach[node] * (moved ? 1.2 : 0.6), 0.002 * problem.spacing,
                               0.2 * problem.spacing);
    }
  }
}

}  // namespace fabrica::body
