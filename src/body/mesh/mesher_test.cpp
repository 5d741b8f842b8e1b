// Solids of known volume, Euler number and surface through the whole mesher.
#include "body/mesh/mesher.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "body/mesh/loft.h"

using namespace fabrica::body;

namespace {

constexpr double pi = std::numbers::pi;

struct Solid {
  const char* name;
  Box box;
  double (*phi)(const Point&);
  double volume;
  int euler;
  double error;  // [mm] mean distance allowed: curvature over one edge h^2 / (8 r), or what a sharp
                 // edge costs
};

double box_distance(const Point& p, const Point& half) {
  const Point q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
  const Point out{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
  return fabrica::norm(out) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

double sphere(const Point& p) { return fabrica::norm(p) - 20; }
double block(const Point& p) { return box_distance(p, {20, 15, 10}); }
double cylinder(const Point& p) { return std::max(std::hypot(p.x, p.y) - 14, std::abs(p.z) - 40); }
double torus(const Point& p) { return std::hypot(std::hypot(p.x, p.y) - 24, p.z) - 9; }
double pierced_plate(const Point& p) {
  return std::max(box_distance(p, {30, 25, 5}), 10 - std::hypot(p.x, p.y));
}

const Solid solids[] = {
    // 4/3 pi r^3
    {"sphere", {{-20, -20, -20}, {20, 20, 20}}, sphere, 4.0 / 3 * pi * 8000, 2},
    // a b c
    {"block", {{-20, -15, -10}, {20, 15, 10}}, block, 40 * 30 * 20, 2},
    // pi r^2 l
    {"cylinder", {{-14, -14, -40}, {14, 14, 40}}, cylinder, pi * 196 * 80, 2},
    // 2 pi^2 R r^2
    {"torus", {{-33, -33, -9}, {33, 33, 9}}, torus, 2 * pi* pi * 24 * 81, 0},
    // a b c - pi r^2 c
    {"plate with a hole",
     {{-30, -25, -5}, {30, 25, 5}},
     pierced_plate,
     60 * 50 * 10 - pi * 100 * 10,
     0,
     0.45},
};

}  // namespace

TEST_CASE("solids of known shape get their volume, topology and surface in well-shaped bricks") {
  constexpr double edge = 4;  // [mm]
  for (const Solid& solid : solids) {
    CAPTURE(solid.name);
    DistanceField field = DistanceField::of_function(solid.box, 0.8, 8, solid.phi);
    CHECK(field.volume() == doctest::Approx(solid.volume).epsilon(0.01));
    BoneMesh mesh =
        mesh_solid(field, {solid.name, edge, 0, solid.euler}, {solid.volume, 100, 1.2, 1.2});
    const MeshReport figures = measure(mesh);
    CHECK(figures.volume == doctest::Approx(solid.volume).epsilon(0.01));
    CHECK(figures.euler == solid.euler);
    CHECK(figures.min_scaled_jacobian >= 0.30);
    CHECK(figures.p1_scaled_jacobian >= 0.42);
    CHECK(surface_error(mesh, field).mean <= 0.1 * edge);
  }
}

TEST_CASE("a solid whose Euler number no grid gives is refused with the numbers found") {
  DistanceField field = DistanceField::of_function({{-33, -33, -9}, {33, 33, 9}}, 0.8, 8, torus);
  CHECK_THROWS_WITH_AS(cells_of(field, {"ring", 4, 0, 2}),
                       doctest::Contains("the Euler number 2; grids of 4 mm gave 0 0"), BodyError);
}

TEST_CASE("the same field gives the same mesh, bit for bit") {
  DistanceField field = DistanceField::of_function({{-33, -33, -9}, {33, 33, 9}}, 0.8, 8, torus);
  const BoneMesh a = mesh_solid(field, {"ring", 5, 0, 0}, {30000, 100, 1, 1}),
                 b = mesh_solid(field, {"ring", 5, 0, 0}, {30000, 100, 1, 1});
  REQUIRE(a.nodes.size() == b.nodes.size());
  for (std::size_t n = 0; n < a.nodes.size(); ++n)
    CHECK((a.nodes[n].x == b.nodes[n].x && a.nodes[n].y == b.nodes[n].y &&
           a.nodes[n].z == b.nodes[n].z));
  CHECK(a.bricks == b.bricks);
}

// A ball of radius R cut into slices: circles of radius sqrt(R^2 - z^2).
TEST_CASE("slices of a ball give back its surface and volume") {
  constexpr double R = 20;
  std::vector<Slice> slices;
  for (double z = -19.5; z <= 19.6; z += 1.5) {
    Slice slice{z, {{}}};
    const double r = std::sqrt(R * R - z * z);
    for (int m = 0; m < 72; ++m)
      slice.loops[0].push_back({r * std::cos(2 * pi * m / 72), r * std::sin(2 * pi * m / 72)});
    slices.push_back(slice);
  }
  const DistanceField field = DistanceField::of_slices(slices, Axes{}, 0.8, 6);
  CHECK(field.volume() == doctest::Approx(4.0 / 3 * pi * R * R * R).epsilon(0.02));
  for (const Point& d :
       {Point{1, 0, 0}, Point{0, 0.6, 0.8}, Point{-0.8, 0, -0.6}, Point{0.48, -0.64, 0.6}}) {
    CHECK(field.value(R * d) == doctest::Approx(0).epsilon(1).scale(0.3));
    CHECK(field.value((R + 2) * d) == doctest::Approx(2).epsilon(0.2));
    CHECK(field.value((R - 2) * d) == doctest::Approx(-2).epsilon(0.2));
  }
}

TEST_CASE("a hole in a slice stays open") {
  std::vector<Slice> slices;
  for (double z = 0; z <= 12; z += 3) {
    Slice slice{z, {{}, {}}};
    for (int m = 0; m < 64; ++m) {
      const double t = 2 * pi * m / 64;
      slice.loops[0].push_back({15 * std::cos(t), 15 * std::sin(t)});
      slice.loops[1].push_back({6 * std::cos(t), -6 * std::sin(t)});  // clockwise
    }
    slices.push_back(slice);
  }
  const DistanceField field = DistanceField::of_slices(slices, Axes{}, 0.8, 6);
  CHECK(field.value({4, 0, 6}) == doctest::Approx(2).epsilon(0.1));
  CHECK(field.value({0, 8, 6}) == doctest::Approx(-2).epsilon(0.1));
  CHECK(field.value({-17, 0, 6}) == doctest::Approx(2).epsilon(0.1));
  CHECK(euler_number(cells_of(field, {"ring", 3, 0, 0}).surface) == 0);
}

// A plate of 30 x 30 x 12 mm with two holes of radius 4 mm: Euler 2 - 2 x 2, which no grid of 3 mm
// gives as 2.
TEST_CASE("openings that the grid leaves open are taken where they are allowed") {
  const Box box{{-15, -15, -6}, {15, 15, 6}};
  const DistanceField field = DistanceField::of_function(box, 0.8, 6, [](const Point& q) {
    const double plate = std::max({std::abs(q.x) - 15, std::abs(q.y) - 15, std::abs(q.z) - 6});
    const double hole = 4 - std::hypot(std::abs(q.x) - 8, q.y);
    return std::max(plate, hole);
  });
  CHECK_THROWS_AS(cells_of(field, {"plate", 3, 0, 2}), BodyError);
  CHECK(euler_number(cells_of(field, {"plate", 3, 0, 2, false, -2}).surface) == -2);
  CHECK(euler_number(cells_of(field, {"plate", 3, 0, -2, false, 2}).surface) == -2);
}

namespace {

// of a straight round loft of radius 7 and length 60
std::vector<LoftStation> round_stations() {
  std::vector<LoftStation> stations;
  for (int i = 0; i < 6; ++i) {
    LoftStation s;
    s.c = {0, 0, 12.0 * i};
    s.n = {0, 0, 1};
    s.e1 = {1, 0, 0};
    s.r0 = 7;
    stations.push_back(s);
  }
  return stations;
}

}  // namespace

// Straight round loft of radius r and length l with domes of height d r: pi r^2 l + 4/3 pi r^2 d r.
TEST_CASE("a round loft has the volume of a cylinder with domes, and its bricks fit its surface") {
  const double exact = pi * 49 * 60 + 4.0 / 3 * pi * 343;
  Loft loft(round_stations(), 0.5);
  loft.match_volume(exact);
  DistanceField field = DistanceField::of_triangles(loft.surface(64, 2), 0.5, 4);
  CHECK(field.volume() == doctest::Approx(exact).epsilon(0.01));
  CHECK(field.value({0, 0, 30}) < -3.9);
  CHECK(field.value({7.5, 0, 30}) == doctest::Approx(0.5).epsilon(0.1));
  CHECK(field.value({0, 0, 67}) == doctest::Approx(0).epsilon(1).scale(0.2));
  BoneMesh mesh = loft.bricks(2, true, 6);
  UntangleProblem problem = problem_of(mesh, field, 3);
  for (const Brick& brick : mesh.bricks)
    problem.target.push_back(edge_lengths(corners_of(mesh.nodes, brick)));
  fit(mesh, field, problem, {exact, 100, 0.5});
  const MeshReport figures = measure(mesh);
  CHECK(figures.euler == 2);
  CHECK(figures.min_scaled_jacobian > 0.5);
  CHECK(figures.volume == doctest::Approx(exact).epsilon(0.01));
  CHECK(surface_error(mesh, field).mean < 0.4);
}

// A straight round loft whose ends lie in a box: one station stands outside of it, the other has
// room for a dome of 3. Closed form: the faces of the box, and the volume that was asked for.
TEST_CASE("the ends of a loft reach to the faces of a box and the girth takes the volume") {
  const double volume = pi * 49 * 62;
  Loft loft(round_stations(), 0.8);
  loft.fit_ends({-9, -9, -3}, {9, 9, 58}, volume);
  const TriangleSurface surface = loft.surface(64, 1);
  double low = 0, high = 0;
  for (const Point& p : surface.nodes) low = std::min(low, p.z), high = std::max(high, p.z);
  CHECK(low == doctest::Approx(-3).epsilon(0.1));
  CHECK(high == doctest::Approx(58).epsilon(0.01));
  CHECK(DistanceField::of_triangles(surface, 0.5, 4).volume() ==
        doctest::Approx(volume).epsilon(0.01));
  CHECK(loft.section(0).r0 > 7.3);  // wider where the bone ends
  CHECK(loft.section(0.5 * loft.length()).r0 == doctest::Approx(7));
}

// A sphere of radius 10 about y = 1 becomes the sphere about 0: the distance |p| - 10. Invariance:
// each node has its image, to the bit.
TEST_CASE("a field, its cells and the bricks fitted to it mirror themselves") {
  const Point centre{0, 1, 0};
  const DistanceField sphere =
      DistanceField::of_function(Box{{-10, -9, -10}, {10, 11, 10}}, 0.5, 4,
                                 [&](const Point& p) { return norm(p - centre) - 10; });
  DistanceField field = sphere.symmetric();
  for (const Point& p : {Point{3, 4, 8}, Point{-7, -5, 3}, Point{1, 9, -2}, Point{6, 0, 7}}) {
    CHECK(std::abs(field.value(p) - (norm(p) - 10)) < 0.03);
    CHECK(field.value(p) == doctest::Approx(field.value({p.x, -p.y, p.z})).epsilon(1e-9));
  }
  CellOptions options{"sphere", 3, 0, 2, true};
  const BoneMesh mesh = mesh_solid(field, options, {field.volume(), 100, 0.5});
  CHECK(measure(mesh).min_scaled_jacobian > 0.4);
  REQUIRE(mesh.image.size() == mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const int m = mesh.image[n];
    CHECK(mesh.image[m] == int(n));
    CHECK((mesh.nodes[m].x == mesh.nodes[n].x && mesh.nodes[m].y == -mesh.nodes[n].y &&
           mesh.nodes[m].z == mesh.nodes[n].z));
  }
  std::set<Quad> quads(mesh.surface.begin(), mesh.surface.end());
  for (const Quad& q : mesh.surface)
    CHECK(quads.count({mesh.image[q[0]], mesh.image[q[3]], mesh.image[q[2]], mesh.image[q[1]]}) ==
          1);
}

TEST_CASE("a tangled block comes back to cubes") {
  CellGrid grid;
  grid.count = {6, 6, 6};
  grid.inside.assign(216, 0);
  for (int k = 1; k < 5; ++k)
    for (int j = 1; j < 5; ++j)
      for (int i = 1; i < 5; ++i) grid.inside[grid.index(i, j, k)] = 1;
  BoneMesh mesh = bricks_of(grid);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const double s = double(n);
    mesh.nodes[n] +=
        0.9 * Point{std::sin(12.9 * s), std::sin(78.2 * s + 1), std::sin(37.7 * s + 2)};
  }
  REQUIRE(measure(mesh).min_scaled_jacobian < -0.5);
  UntangleProblem problem;
  problem.bricks = mesh.bricks;
  problem.target.assign(mesh.bricks.size(), {1, 1, 1});
  for (int i = 0; i < 5; ++i) untangle(problem, mesh.nodes, 0, 60);
  CHECK(measure(mesh).min_scaled_jacobian > 0.99);
  CHECK(measure(mesh).volume == doctest::Approx(64).epsilon(0.02));
}

TEST_CASE("two cells that meet along an edge or at a corner are repaired into a manifold") {
  for (const Point& second : {Point{3, 3, 2}, Point{3, 3, 3}}) {
    CellGrid grid;
    grid.count = {6, 6, 6};
    grid.inside.assign(216, 0);
    grid.fraction.assign(216, 0);
    for (const Point& cell : {Point{2, 2, 2}, second}) {
      grid.inside[grid.index(int(cell.x), int(cell.y), int(cell.z))] = 1;
      grid.fraction[grid.index(int(cell.x), int(cell.y), int(cell.z))] = 0.9f;
    }
    CHECK(repair(grid));
    CHECK(euler_number(bricks_of(grid).surface) == 2);
  }
}

TEST_CASE("a pillow wraps a region in one layer and leaves the nodes of its boundary shared") {
  CellGrid grid;
  grid.count = {6, 5, 5};
  grid.inside.assign(150, 0);
  for (int k = 1; k < 4; ++k)
    for (int j = 1; j < 4; ++j)
      for (int i = 1; i < 5; ++i) grid.inside[grid.index(i, j, k)] = 1;
  BoneMesh mesh = bricks_of(grid);
  const double before = measure(mesh).volume;
  const auto surface = mesh.surface;
  std::vector<char> region;  // the upper two of four sheets
  for (const Brick& brick : mesh.bricks) region.push_back(mesh.nodes[brick[0]].x > 2.5);
  const std::size_t bricks = mesh.bricks.size();
  add_pillow(mesh, region, 0.25);
  // 2 x 3 x 3 cells have 2 (9 + 6 + 6) faces
  CHECK(mesh.bricks.size() == bricks + 42);
  CHECK(boundary_quads(mesh.bricks).size() == surface.size());
  CHECK(measure(mesh).volume == doctest::Approx(before));
  CHECK(measure(mesh).min_scaled_jacobian > 0.3);
}

TEST_CASE("quality figures of single bricks are those of their closed forms") {
  const Corners box{Point{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0},
                    {0, 0, 4},      {2, 0, 4}, {2, 3, 4}, {0, 3, 4}};
  CHECK(scaled_jacobian(box) == doctest::Approx(1));
  CHECK(volume_of(box) == doctest::Approx(24));
  CHECK(size_of(box) == doctest::Approx(2));  // 24 / (3 x 4)
  Corners sheared = box;                      // by 45 degrees along x: the angle's sine
  for (int c = 4; c < 8; ++c) sheared[c].x += 4;
  CHECK(scaled_jacobian(sheared) == doctest::Approx(std::sqrt(0.5)));
  CHECK(volume_of(sheared) == doctest::Approx(24));
}
