#include "body/mesh/bone_mesh.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "body/mesh/quality.h"

using namespace fabrica::body;

namespace {

void check_bone(const std::string& name, Resolution resolution, double most_error) {
  CAPTURE(name);
  const BoneMesh mesh = mesh_bone({name, resolution});
  const MeshReport figures = report(mesh);
  CHECK(figures.min_scaled_jacobian >= 0.30);
  CHECK(figures.p1_scaled_jacobian >= 0.42);
  CHECK(figures.euler == figures.expected_euler);
  CHECK(figures.error_mean <= most_error);
  if (figures.table_volume > 0) CHECK(std::abs(figures.volume / figures.table_volume - 1) < 0.03);
  // the surface is the bricks' own boundary, node for node
  CHECK(boundary_quads(mesh.bricks).size() == mesh.surface.size());
  std::set<int> used;
  for (const Brick& brick : mesh.bricks) used.insert(brick.begin(), brick.end());
  CHECK(used.size() == mesh.nodes.size());
}

}  // namespace

TEST_CASE("every bone meshes at coarse within the gates of quality, topology, volume and surface") {
  CHECK(bone_names().size() == 116);
  for (const std::string& name : bone_names()) check_bone(name, Resolution::coarse, 1.5);
}

TEST_CASE("the left bone is the exact mirror image of the right one") {
  const BoneMesh right = mesh_bone({"hip_bone", Resolution::coarse}), left = mirrored(right);
  REQUIRE(left.nodes.size() == right.nodes.size());
  for (std::size_t n = 0; n < left.nodes.size(); ++n) {
    CHECK(left.nodes[n].x == right.nodes[n].x);
    CHECK(left.nodes[n].y == -right.nodes[n].y);
    CHECK(left.nodes[n].z == right.nodes[n].z);
  }
  const MeshReport a = report(right), b = report(left);
  CHECK(b.min_scaled_jacobian == doctest::Approx(a.min_scaled_jacobian).epsilon(1e-12));
  CHECK(b.volume == doctest::Approx(a.volume).epsilon(1e-12));
  const BoneMesh back = mirrored(left);
  CHECK(back.bricks == right.bricks);
  CHECK(back.surface == right.surface);
}

// volume of a scaled bone: sx sy sz V
TEST_CASE("scaling a bone scales its volume by the product of the factors and keeps its cortex") {
  const BoneMesh unit = mesh_bone({"L3", Resolution::coarse}),
                 scaled = mesh_bone({"L3", Resolution::coarse, {1.1, 0.95, 1.05}});
  CHECK(report(scaled).volume ==
        doctest::Approx(1.1 * 0.95 * 1.05 * report(unit).volume).epsilon(1e-10));
  CHECK(scaled.cortex == unit.cortex);
  CHECK(report(scaled).min_scaled_jacobian > 0.30);
}

TEST_CASE("an unknown bone is refused with the nearest name") {
  CHECK_THROWS_WITH_AS(mesh_bone({"femurr", Resolution::coarse}),
                       "no bone is called 'femurr'; the nearest name is 'femur'", BodyError);
}
