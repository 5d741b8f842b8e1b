#include "body/mesh/quality.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace fabrica::body {

Corners corners_of(const std::vector<Point>& nodes, const Brick& brick) {
  Corners corners;
  for (int c = 0; c < 8; ++c) corners[c] = nodes[brick[c]];
  return corners;
}

std::array<float, 3> edge_lengths(const Corners& x) {
  const int low[3][4] = {{0, 3, 4, 7}, {0, 1, 4, 5}, {0, 1, 2, 3}},
            high[3][4] = {{1, 2, 5, 6}, {3, 2, 7, 6}, {4, 5, 6, 7}};
  std::array<float, 3> lengths{};
  for (int d = 0; d < 3; ++d)
    for (int e = 0; e < 4; ++e) lengths[d] += float(0.25 * norm(x[high[d][e]] - x[low[d][e]]));
  return lengths;
}

double scaled_jacobian(const Corners& corners) {
  double least = 1;
  for (int c = 0; c < 8; ++c) {
    const auto& next = corner_neighbours[c];
    const Point a = corners[next[0]] - corners[c], b = corners[next[1]] - corners[c],
                d = corners[next[2]] - corners[c];
    const double lengths = std::sqrt(dot(a, a) * dot(b, b) * dot(d, d));
    least = std::min(least, lengths > 0 ? dot(a, cross(b, d)) / lengths : -1.0);
  }
  return least;
}

double volume_of(const Corners& corners) {
  // the divergence theorem over bilinear faces, each exactly the mean of its two triangulations
  double six_times = 0;
  for (const auto& face : brick_faces) {
    const Point &a = corners[face[0]], &b = corners[face[1]], &c = corners[face[2]],
                &d = corners[face[3]];
    six_times += 0.5 * (dot(a, cross(b, c)) + dot(a, cross(c, d)) + dot(a, cross(b, d)) +
                        dot(b, cross(c, d)));
  }
  return six_times / 6;
}

double size_of(const Corners& corners) {
  double largest = 0;
  for (const auto& face : brick_faces) {
    const Point diagonals =
        cross(corners[face[2]] - corners[face[0]], corners[face[3]] - corners[face[1]]);
    largest = std::max(largest, 0.5 * norm(diagonals));
  }
  return largest > 0 ? volume_of(corners) / largest : 0;
}

Quad sorted(Quad quad) {
  std::sort(quad.begin(), quad.end());
  return quad;
}

std::vector<Quad> boundary_quads(const std::vector<Brick>& bricks) {
  struct Face {
    Quad key, quad;
    int order;
  };
  std::vector<Face> faces;
  faces.reserve(bricks.size() * 6);
  for (const Brick& brick : bricks)
    for (const auto& f : brick_faces) {
      const Quad quad{brick[f[0]], brick[f[1]], brick[f[2]], brick[f[3]]};
      faces.push_back({sorted(quad), quad, int(faces.size())});
    }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return std::tie(a.key, a.order) < std::tie(b.key, b.order);
  });
  std::vector<Face> single;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i + 1;
    while (j < faces.size() && faces[j].key == faces[i].key) ++j;
    if (j == i + 1) single.push_back(faces[i]);
    i = j;
  }
  std::sort(single.begin(), single.end(),
            [](const Face& a, const Face& b) { return a.order < b.order; });
  std::vector<Quad> quads;
  for (const Face& face : single) quads.push_back(face.quad);
  return quads;
}

int euler_number(const std::vector<Quad>& quads) {
  std::vector<int> nodes;
  std::vector<std::array<int, 2>> edges;
  for (const Quad& quad : quads)
    for (int a = 0; a < 4; ++a) {
      nodes.push_back(quad[a]);
      edges.push_back({std::min(quad[a], quad[(a + 1) % 4]), std::max(quad[a], quad[(a + 1) % 4])});
    }
  const auto count = [](auto& list) {
    std::sort(list.begin(), list.end());
    return int(std::unique(list.begin(), list.end()) - list.begin());
  };
  return count(nodes) - count(edges) + int(quads.size());
}

SurfaceError surface_error(const BoneMesh& mesh, const DistanceField& field) {
  std::vector<std::pair<double, double>> samples;  // error, area
  const double places[3] = {1.0 / 6, 0.5, 5.0 / 6};
  for (const Quad& quad : mesh.surface) {
    const Point &a = mesh.nodes[quad[0]], &b = mesh.nodes[quad[1]], &c = mesh.nodes[quad[2]],
                &d = mesh.nodes[quad[3]];
    const double area = 0.5 * norm(cross(c - a, d - b)) / 9;
    for (const double u : places)
      for (const double v : places) {
        const Point p =
            ((1 - u) * (1 - v)) * a + (u * (1 - v)) * b + (u * v) * c + ((1 - u) * v) * d;
        samples.push_back({std::abs(field.value(p) + field.offset), area});
      }
  }
  std::sort(samples.begin(), samples.end());
  double total = 0, sum = 0;
  for (const auto& [error, area] : samples) total += area, sum += error * area;
  SurfaceError result{sum / total, 0};
  double below = 0;
  for (const auto& [error, area] : samples) {
    below += area;
    result.p95 = error;
    if (below >= 0.95 * total) break;
  }
  return result;
}

namespace {

// boundary quads sorted into cubes, to find the nearest one
class QuadBins {
 public:
  explicit QuadBins(const BoneMesh& mesh) : mesh_(mesh) {
    for (std::size_t q = 0; q < mesh.surface.size(); ++q) {
      std::array<int, 3> low{1 << 20, 1 << 20, 1 << 20}, high{-(1 << 20), -(1 << 20), -(1 << 20)};
      for (const int n : mesh.surface[q]) {
        const auto bin = bin_of(mesh.nodes[n]);
        for (int a = 0; a < 3; ++a)
          low[a] = std::min(low[a], bin[a]), high[a] = std::max(high[a], bin[a]);
      }
      for (int i = low[0]; i <= high[0]; ++i)
        for (int j = low[1]; j <= high[1]; ++j)
          for (int k = low[2]; k <= high[2]; ++k) bins_[{i, j, k}].push_back(int(q));
    }
  }
  // [mm] at most `reach` cubes away
  double distance(const Point& p) const {
    constexpr int reach = 5;
    const auto bin = bin_of(p);
    double nearest = reach * width;
    for (int ring = 0; ring <= reach && (ring - 1) * width < nearest; ++ring)
      for (int i = -ring; i <= ring; ++i)
        for (int j = -ring; j <= ring; ++j)
          for (int k = -ring; k <= ring; ++k) {
            if (std::max({std::abs(i), std::abs(j), std::abs(k)}) != ring) continue;
            const auto at = bins_.find({bin[0] + i, bin[1] + j, bin[2] + k});
            if (at == bins_.end()) continue;
            for (const int q : at->second)
              nearest = std::min(nearest, distance(p, mesh_.surface[q]));
          }
    return nearest;
  }

 private:
  static constexpr double width = 4;  // [mm]
  static std::array<int, 3> bin_of(const Point& p) {
    return {int(std::floor(p.x / width)), int(std::floor(p.y / width)),
            int(std::floor(p.z / width))};
  }
  double distance(const Point& p, const Quad& q) const {
    const Point &a = mesh_.nodes[q[0]], &b = mesh_.nodes[q[1]], &c = mesh_.nodes[q[2]],
                &d = mesh_.nodes[q[3]];
    return std::min(norm(p - closest_on_triangle(p, a, b, c)),
                    norm(p - closest_on_triangle(p, a, c, d)));
  }
  const BoneMesh& mesh_;
  std::map<std::array<int, 3>, std::vector<int>> bins_;
};

}  // namespace

double missing_p95(const BoneMesh& mesh, const DistanceField& field) {
  const QuadBins bins(mesh);
  std::vector<double> distances;
  for (const Point& p : field.surface_points(2)) distances.push_back(bins.distance(p));
  if (distances.empty()) return 0;
  std::sort(distances.begin(), distances.end());
  return distances[distances.size() * 95 / 100];
}

double shell_size(const std::vector<Point>& nodes, const Quad& quad) {
  const Point &a = nodes[quad[0]], &b = nodes[quad[1]], &c = nodes[quad[2]], &d = nodes[quad[3]];
  const double longest = std::max({norm(b - a), norm(c - b), norm(d - c), norm(a - d)});
  return 0.5 * norm(cross(c - a, d - b)) / longest;
}

namespace {

double least_cortex_size(const BoneMesh& mesh) {
  double least = 1e9;
  for (std::size_t e = 0; e < mesh.bricks.size(); ++e)
    if (mesh.brick_layer[e] == 1 || mesh.brick_layer[e] == 3)
      least = std::min(least, size_of(corners_of(mesh.nodes, mesh.bricks[e])));
  for (std::size_t q = 0; q < mesh.cortex.size(); ++q)
    if (mesh.cortex[q] > 0) least = std::min(least, shell_size(mesh.nodes, mesh.surface[q]));
  return least;
}

}  // namespace

MeshReport measure(const BoneMesh& mesh) {
  MeshReport report;
  report.name = mesh.name;
  report.nodes = int(mesh.nodes.size());
  report.bricks = int(mesh.bricks.size());
  report.euler = euler_number(mesh.surface);
  std::vector<double> jacobians;
  report.min_size = 1e9;
  for (const Brick& brick : mesh.bricks) {
    const Corners corners = corners_of(mesh.nodes, brick);
    jacobians.push_back(scaled_jacobian(corners));
    report.min_size = std::min(report.min_size, size_of(corners));
    report.volume += volume_of(corners);
  }
  report.min_cortex_size = least_cortex_size(mesh);
  std::sort(jacobians.begin(), jacobians.end());
  report.min_scaled_jacobian = jacobians.front();
  report.p1_scaled_jacobian = jacobians[jacobians.size() / 100];
  return report;
}

}  // namespace fabrica::body
