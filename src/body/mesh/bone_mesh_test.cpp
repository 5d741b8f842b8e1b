#include "body/mesh/bone_mesh.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "body/mesh/quality.h"
#include "body/placement.h"
#include "body/tables.h"

using namespace fabrica::body;

namespace {

bool near(double a, double b) { return std::abs(a - b) < 1e-12; }

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

TEST_CASE("bones of each kind mesh at standard within the gates") {
  for (const char* name :
       {"L3", "hip_bone", "scapula", "rib5", "metacarpal2", "costal_cartilage6", "femur"})
    check_bone(name, Resolution::standard, 0.8);
}

// Midshaft of the femur: inner / outer diameter 0.50 to 0.59 (J Exp Biol 2005;208:899) in a shaft
// of 14 mm radius.
TEST_CASE("the cortex of the femur is solid at standard and as thick as the table says") {
  const BoneMesh mesh = mesh_bone({"femur", Resolution::standard});
  CHECK(mesh.cortex.empty());
  std::vector<double> midshaft;
  for (std::size_t e = 0; e < mesh.bricks.size(); ++e) {
    if (mesh.brick_layer[e] != 1) continue;
    const Corners x = corners_of(mesh.nodes, mesh.bricks[e]);
    const Point through = 0.25 * ((x[4] - x[0]) + (x[5] - x[1]) + (x[6] - x[2]) + (x[7] - x[3]));
    if (x[0].z > -230 && x[0].z < -170) midshaft.push_back(norm(through));
  }
  REQUIRE(midshaft.size() > 20);
  std::sort(midshaft.begin(), midshaft.end());
  CHECK(midshaft[midshaft.size() / 2] == doctest::Approx(6.6).epsilon(0.10));
}

TEST_CASE("shells get the thickness of the table: a profile along ribs, regions on vertebrae") {
  const BoneMesh rib = mesh_bone({"rib5", Resolution::coarse});
  REQUIRE(rib.cortex.size() == rib.surface.size());
  for (const double t : rib.cortex) CHECK((t >= 0.5 && t <= 0.95));
  const BoneMesh vertebra = mesh_bone({"L3", Resolution::coarse});
  REQUIRE(vertebra.cortex.size() == vertebra.surface.size());
  for (std::size_t q = 0; q < vertebra.surface.size(); ++q) {
    double x = 0;
    for (const int n : vertebra.surface[q]) x += 0.25 * vertebra.nodes[n].x;
    if (x > -10)
      CHECK(
          (near(vertebra.cortex[q], 0.45) || near(vertebra.cortex[q], 0.6)));  // body and endplates
    if (x < -30) CHECK(vertebra.cortex[q] <= 1.1);                             // arch and processes
  }
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

TEST_CASE("a bone of the midline has its other half's nodes and thicknesses, to the bit") {
  for (const char* name : {"C4", "sacrum", "sternum_body"}) {
    CAPTURE(name);
    const BoneMesh mesh = mesh_bone({name, Resolution::coarse});
    REQUIRE(mesh.image.size() == mesh.nodes.size());
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      CHECK(norm(mesh.nodes[n] - mirror(mesh.nodes[mesh.image[n]])) == 0);
    std::map<Quad, double> cortex;
    for (std::size_t q = 0; q < mesh.surface.size(); ++q) cortex[mesh.surface[q]] = mesh.cortex[q];
    for (const auto& [q, t] : cortex)
      CHECK(cortex.at({mesh.image[q[0]], mesh.image[q[3]], mesh.image[q[2]], mesh.image[q[1]]}) ==
            t);
  }
}

// The box of each ray as it was measured (index.csv). An end may stand out by what a low dome of
// the coarse mesh takes: half an edge of 6 mm.
TEST_CASE("rays of hand and foot end where the measured bones end") {
  const Table index("anatomy/bones/index.csv");
  int rays = 0;
  for (int row = 0; row < index.rows(); ++row) {
    const std::string& name = index.text(row, "bone");
    if (!name.starts_with("meta") && name.find("_phalanx") == std::string::npos) continue;
    CAPTURE(name);
    ++rays;
    double past = 0;
    for (const Point& p : mesh_bone({name, Resolution::coarse}).nodes)
      for (int i = 0; i < 3; ++i) {
        const std::string axis(1, "xyz"[i]);
        past = std::max(
            {past, p[i] - index.number(row, axis + "max"), index.number(row, axis + "min") - p[i]});
      }
    CHECK(past < 3);
  }
  CHECK(rays == 38);
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

TEST_CASE("bones keep their shape of bricks over the sizes of people") {
  for (const std::string& name : bone_names())
    for (const Point& scale : {Point{1.1, 0.95, 1.05}, Point{0.95, 1.1, 1.0},
                               Point{1.05, 0.95, 1.12}, Point{0.9, 0.9, 0.88}}) {
      CAPTURE(name);
      const MeshReport figures = report(mesh_bone({name, Resolution::coarse, scale}));
      CHECK(figures.min_scaled_jacobian >= 0.30);
      CHECK(figures.p1_scaled_jacobian >= 0.42);
    }
  CHECK_THROWS_AS(mesh_bone({"L3", Resolution::coarse, {3, 0.5, 1}}), BodyError);
}

TEST_CASE("an unknown bone is refused with the nearest name") {
  CHECK_THROWS_WITH_AS(mesh_bone({"femurr", Resolution::coarse}),
                       "no bone is called 'femurr'; the nearest name is 'femur'", BodyError);
}
