#include "body/shapes.h"

#include <algorithm>
#include <cmath>

#include "body/mesh/quality.h"

namespace fabrica::body {
namespace {

int cells(double length, double edge, int least) {
  return std::max(least, int(std::lround(length / edge)));
}

// n bricks along each axis; `place` maps indices to points
template <class Place>
ShapeMesh grid(std::array<int, 3> n, Place place) {
  ShapeMesh mesh;
  const auto id = [&](int i, int j, int k) { return (k * (n[1] + 1) + j) * (n[0] + 1) + i; };
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i) mesh.nodes.push_back(place(i, j, k));
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        mesh.bricks.push_back({id(i, j, k), id(i + 1, j, k), id(i + 1, j + 1, k), id(i, j + 1, k),
                               id(i, j, k + 1), id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1),
                               id(i, j + 1, k + 1)});
  return mesh;
}

double share(int i, int n) { return 2.0 * i / n - 1; }

}  // namespace

double ShapeMesh::volume() const {
  double sum = 0;
  for (std::size_t e = 0; e < bricks.size() - pad_bricks; ++e) {
    Corners corners;
    for (std::size_t k = 0; k < 8; ++k) corners[k] = nodes[std::size_t(bricks[e][k])];
    sum += volume_of(corners);
  }
  return sum;
}

ShapeMesh box_mesh(const Point& size, double edge, double pad) {
  const int nz = cells(size.z, edge, 1), pad_layers = pad > 0 ? cells(pad, edge, 2) : 0;
  const std::array<int, 3> n{cells(size.x, edge, 1), cells(size.y, edge, 1), nz + pad_layers};
  // from the upper face down, so that the pad's bricks come last; x is turned to keep their hand
  ShapeMesh mesh = grid(n, [&](int i, int j, int k) {
    const double z =
        k <= nz ? size.z / 2 - size.z * k / nz : -size.z / 2 - pad * (k - nz) / pad_layers;
    return Point{-size.x / 2 * share(i, n[0]), size.y / 2 * share(j, n[1]), z};
  });
  mesh.pad_bricks = std::size_t(n[0] * n[1] * pad_layers);
  return mesh;
}

ShapeMesh cylinder_mesh(double radius, double length, double edge) {
  const int across = 2 * cells(radius, edge, 2);
  const std::array<int, 3> n{across, across, cells(length, edge, 1)};
  // a square mapped onto the disc, so that its edge lies on the circle
  return grid(n, [&](int i, int j, int k) {
    const double y = share(i, across), z = share(j, across);
    return Point{length / 2 * share(k, n[2]), radius * y * std::sqrt(1 - z * z / 2),
                 radius * z * std::sqrt(1 - y * y / 2)};
  });
}

ShapeMesh ball_mesh(double radius, double edge) {
  const int n = 2 * cells(radius, edge, 2);
  // a cube mapped onto the ball, so that its faces lie on the sphere
  return grid({n, n, n}, [&](int i, int j, int k) {
    const double x = share(i, n), y = share(j, n), z = share(k, n);
    const double xx = x * x, yy = y * y, zz = z * z;
    return Point{radius * x * std::sqrt(1 - yy / 2 - zz / 2 + yy * zz / 3),
                 radius * y * std::sqrt(1 - zz / 2 - xx / 2 + zz * xx / 3),
                 radius * z * std::sqrt(1 - xx / 2 - yy / 2 + xx * yy / 3)};
  });
}

}  // namespace fabrica::body
