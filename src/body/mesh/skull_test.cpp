#include "body/mesh/skull.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "body/mesh/skull_vault.h"
#include "body/placement.h"

using namespace fabrica::body;

namespace {

// thickness of the bricks of a layer, through their corners 0-3 to 4-7; the median
double median_thickness(const BoneMesh& mesh, int layer) {
  std::vector<double> thickness;
  for (std::size_t e = 0; e < mesh.bricks.size(); ++e) {
    if (mesh.brick_layer[e] != layer) continue;
    const Corners x = corners_of(mesh.nodes, mesh.bricks[e]);
    const Point area = 0.5 * fabrica::cross(x[6] - x[4], x[7] - x[5]);
    thickness.push_back(volume_of(x) / fabrica::norm(area));
  }
  std::sort(thickness.begin(), thickness.end());
  return thickness[thickness.size() / 2];
}

}  // namespace

// Typical adult vault: frontal 7, parietal 6, occipital 8 mm
// (data/anatomy/bones/cortical_thickness.csv).
TEST_CASE("the vault is as thick as the literature says") {
  const VaultSurface outer("outer"), inner("inner");
  const auto thickness = [&](const Point& d) {
    return outer.radius(unit(d)) - inner.radius(unit(d));
  };
  CHECK(thickness({1, 0, 0.4}) == doctest::Approx(7).epsilon(0.2));    // frontal
  CHECK(thickness({0, 0.2, 1}) == doctest::Approx(6).epsilon(0.2));    // parietal
  CHECK(thickness({-1, 0, 0.1}) == doctest::Approx(8).epsilon(0.25));  // occipital
  // the table of samples follows the sum
  CHECK(outer.radius(unit({0.3, -0.5, 0.8})) ==
        doctest::Approx(
            outer.exact_radius(std::acos(unit({0.3, -0.5, 0.8}).z), std::atan2(-0.5, 0.3)))
            .epsilon(1e-3));
}

TEST_CASE(
    "the vault has three layers of bricks of the right thickness at standard, and no shells on "
    "them") {
  const BoneMesh skull = mesh_bone({"skull", Resolution::standard});
  CHECK(median_thickness(skull, 1) == doctest::Approx(1.7).epsilon(0.15));
  CHECK(median_thickness(skull, 3) == doctest::Approx(1.4).epsilon(0.15));
  const MeshReport figures = report(skull);
  CHECK(figures.min_scaled_jacobian >= 0.30);
  CHECK(figures.p1_scaled_jacobian >= 0.42);
  CHECK(figures.error_mean <= 0.8);
  REQUIRE(skull.cortex.size() == skull.surface.size());
  int solid = 0, shells = 0;
  for (std::size_t q = 0; q < skull.surface.size(); ++q) {
    double z = 0;
    for (const int n : skull.surface[q]) z += 0.25 * skull.nodes[n].z;
    if (z > 90) CHECK(skull.cortex[q] == 0);
    if (z < 50) CHECK(skull.cortex[q] > 0);
    (skull.cortex[q] == 0 ? solid : shells) += 1;
  }
  CHECK(solid > 1000);
  CHECK(shells > 1000);
}

TEST_CASE("at coarse the vault is diploe between shells") {
  const BoneMesh skull = mesh_bone({"skull", Resolution::coarse});
  CHECK(std::count(skull.brick_layer.begin(), skull.brick_layer.end(), 2) > 300);
  CHECK(std::count(skull.brick_layer.begin(), skull.brick_layer.end(), 1) == 0);
  for (const double t : skull.cortex) CHECK(t > 0);
}
