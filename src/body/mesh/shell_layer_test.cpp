#include "body/mesh/shell_layer.h"

#include <doctest/doctest.h>

#include <cmath>

#include "body/mesh/distance_field.h"
#include "body/mesh/mesher.h"
#include "body/mesh/quality.h"

using namespace fabrica::body;

namespace {

double area(const BoneMesh& mesh, const Quad& q) {
  return 0.5 * fabrica::norm(
                   fabrica::cross(mesh.nodes[std::size_t(q[2])] - mesh.nodes[std::size_t(q[0])],
                                  mesh.nodes[std::size_t(q[3])] - mesh.nodes[std::size_t(q[1])]));
}

double ball(const Point& p) { return fabrica::norm(p) - 20; }

// a ring of eight faces, an octagonal prism of circumradius r, without its ends
BoneMesh octagon(double r) {
  BoneMesh mesh;
  for (int layer = 0; layer < 2; ++layer)
    for (int i = 0; i < 8; ++i)
      mesh.nodes.push_back(
          {r * std::cos(i * std::atan(1.0)), r * std::sin(i * std::atan(1.0)), 10.0 * layer});
  for (int i = 0; i < 8; ++i) mesh.surface.push_back({i, (i + 1) % 8, 8 + (i + 1) % 8, 8 + i});
  return mesh;
}

}  // namespace

// Octagon of apothem a: the layer of depth d has 1 - (1 - d/a)^2 of the area, which is a P/2.
TEST_CASE("shells around an octagon have the volume of the layer under it, to rounding") {
  const double a = 6 * std::cos(0.5 * std::atan(1.0)), d = 0.9;
  for (const double t : shell_thickness(octagon(6), std::vector<double>(8, d)))
    CHECK(t == doctest::Approx(0.5 * a * (1 - (1 - d / a) * (1 - d / a))).epsilon(1e-12));
}

// Ball of radius R: layer of depth d, 4 pi/3 (R^3 - (R - d)^3); uncorrected shells hold 1.23 of it.
TEST_CASE("shells on a ball have the volume of the layer under it") {
  DistanceField field = DistanceField::of_function({{-20, -20, -20}, {20, 20, 20}}, 0.8, 8, ball);
  const BoneMesh mesh = mesh_solid(field, {"ball", 4, 0, 2}, {33510.3, 100, 1.2, 1.2});
  const std::vector<double> thickness =
      shell_thickness(mesh, std::vector<double>(mesh.surface.size(), 4.0));
  double volume = 0, surface = 0;
  for (std::size_t q = 0; q < mesh.surface.size(); ++q) {
    volume += thickness[q] * area(mesh, mesh.surface[q]);
    surface += area(mesh, mesh.surface[q]);
  }
  const double share = (1 - 0.8 * 0.8 * 0.8) * 20 / 3 / 4;  // of depth x surface
  CHECK(volume / (4 * surface) == doctest::Approx(share).epsilon(0.03));
}

TEST_CASE("a flat sheet keeps its depth, none stays none, and no shell gets below half") {
  BoneMesh mesh;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) mesh.nodes.push_back({2.0 * i, 2.0 * j, 0});
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i)
      mesh.surface.push_back({3 * j + i, 3 * j + i + 1, 3 * j + i + 4, 3 * j + i + 3});
  const std::vector<double> flat = shell_thickness(mesh, {0.7, 0.7, 0.0, 1.2});
  CHECK(flat[0] == doctest::Approx(0.7).epsilon(1e-14));
  CHECK(flat[2] == 0);
  CHECK(flat[3] == doctest::Approx(1.2).epsilon(1e-14));
  for (const double t : shell_thickness(octagon(1), std::vector<double>(8, 3.0))) CHECK(t >= 1.5);
}
