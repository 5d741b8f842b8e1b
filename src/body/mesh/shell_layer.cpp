#include "body/mesh/shell_layer.h"

#include <algorithm>
#include <cmath>

#include "body/mesh/quality.h"

namespace fabrica::body {
namespace {

constexpr double least_share = 0.5;  // of the depth: where the surface bends within it
constexpr double least_cosine = 0.5;

// twice the area, as a vector along the outward normal
Point area_vector(const std::array<Point, 4>& x) { return cross(x[2] - x[0], x[3] - x[1]); }

std::array<Point, 4> corners(const BoneMesh& mesh, const Quad& quad) {
  return {mesh.nodes[std::size_t(quad[0])], mesh.nodes[std::size_t(quad[1])],
          mesh.nodes[std::size_t(quad[2])], mesh.nodes[std::size_t(quad[3])]};
}

// way of each node to the surface at depth 1: along the mean of its faces' normals, longer where
// these are oblique to it
std::vector<Point> inward(const BoneMesh& mesh) {
  std::vector<Point> normal(mesh.nodes.size(), Point{0, 0, 0});
  for (const Quad& q : mesh.surface)
    for (const int node : q)
      normal[std::size_t(node)] = normal[std::size_t(node)] + area_vector(corners(mesh, q));
  std::vector<double> cosine(mesh.nodes.size(), 0), faces(mesh.nodes.size(), 0);
  for (const Quad& q : mesh.surface) {
    const Point face = area_vector(corners(mesh, q));
    for (const int node : q) {
      const Point& n = normal[std::size_t(node)];
      cosine[std::size_t(node)] += dot(face, n) / std::max(norm(face) * norm(n), 1e-300);
      faces[std::size_t(node)] += 1;
    }
  }
  std::vector<Point> way(mesh.nodes.size(), Point{0, 0, 0});
  for (std::size_t n = 0; n < way.size(); ++n)
    if (faces[n] > 0)
      way[n] = (-1 / (std::max(cosine[n] / faces[n], least_cosine) *
                      std::max(norm(normal[n]), 1e-300))) *
               normal[n];
  return way;
}

}  // namespace

std::vector<double> shell_thickness(const BoneMesh& mesh, const std::vector<double>& depth) {
  const std::vector<Point> way = inward(mesh);
  std::vector<double> thickness(depth);
  for (std::size_t q = 0; q < mesh.surface.size(); ++q) {
    const std::array<Point, 4> outer = corners(mesh, mesh.surface[q]);
    const Point face = area_vector(outer);
    const auto area_at = [&](double z) {
      std::array<Point, 4> x = outer;
      for (std::size_t k = 0; k < 4; ++k) x[k] = x[k] + z * way[std::size_t(mesh.surface[q][k])];
      return dot(area_vector(x), face) / norm(face);
    };
    const double d = depth[q];
    const double volume = d / 6 * (area_at(0) + 4 * area_at(0.5 * d) + area_at(d));
    thickness[q] = std::max(volume / area_at(0), least_share * d);
  }
  return thickness;
}

}  // namespace fabrica::body
