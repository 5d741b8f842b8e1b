#include "body/joint_gaps.h"

#include <doctest/doctest.h>

#include <cmath>

#include "body/error.h"
#include "body/joints/surface_gap.h"
#include "body/mesh/quality.h"

using namespace fabrica::body;
using doctest::Approx;
using fabrica::Mat3d;

namespace {

// two cubes of edge 10 in one list of nodes, 2 x 2 x 2 bricks each
struct Cubes {
  std::vector<Point> nodes;
  std::vector<Quad> a, b;
};

std::vector<Quad> add_cube(std::vector<Point>& nodes, const Mat3d& turn, const Point& centre) {
  const int first = int(nodes.size());
  std::vector<Brick> bricks;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        nodes.push_back(centre + turn * Point{5.0 * (i - 1), 5.0 * (j - 1), 5.0 * (k - 1)});
  const auto at = [&](int i, int j, int k) { return first + 9 * k + 3 * j + i; };
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i)
        bricks.push_back({at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k),
                          at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1),
                          at(i, j + 1, k + 1)});
  return boundary_quads(bricks);
}

Mat3d turn_about(int axis, double angle) {
  Mat3d m{};
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  m(axis, axis) = 1;
  m(i, i) = m(j, j) = std::cos(angle);
  m(i, j) = -std::sin(angle), m(j, i) = std::sin(angle);
  return m;
}

Cubes cubes(const Mat3d& turn, const Point& centre) {
  Cubes c;
  c.a = add_cube(c.nodes, turn_about(0, 0), {0, 0, 0});
  c.b = add_cube(c.nodes, turn, centre);
  return c;
}

}  // namespace

// Two lines askew at right angles: the distance along their common normal; beyond their ends that
// of the ends.
TEST_CASE("two segments have the distance of their nearest points") {
  CHECK(segment_distance({0, 0, 0}, {4, 0, 0}, {1, -2, 3}, {1, 2, 3}) == Approx(3));
  CHECK(segment_distance({0, 0, 0}, {4, 0, 0}, {7, 4, 0}, {7, 9, 0}) == Approx(5));
  CHECK(segment_distance({0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {9, 1, 0}) == Approx(1));  // parallel
}

// Faces opposite each other, edge across edge (a cube on its edge over another one turned by a
// right angle: half the diagonal of a face below its middle), and one reaching into the other.
TEST_CASE(
    "surfaces have the least distance of faces, corners and edges, and none where they meet") {
  const Cubes flat = cubes(turn_about(0, 0), {1, 2, 10.7});
  CHECK(SurfaceGap(flat.nodes, flat.a, flat.b).least() == Approx(0.7));
  const double half = 5 * std::sqrt(2.0);
  Cubes crossed;
  crossed.a = add_cube(crossed.nodes, turn_about(0, M_PI / 4), {0, 1.3, 0});
  crossed.b = add_cube(crossed.nodes, turn_about(1, M_PI / 4), {0.7, 0, 2 * half + 0.4});
  CHECK(SurfaceGap(crossed.nodes, crossed.a, crossed.b).least() == Approx(0.4));
  const Cubes into = cubes(turn_about(0, 0), {1, 2, 9.5});
  CHECK(SurfaceGap(into.nodes, into.a, into.b).least() == 0);
}

// One cube leaves the other by 2.5 along the normal: both figures grow by 2.5. It turns by 0.3
// about its lower edge at x = -5: that edge stays, and the corner of the lower cube below the far
// edge is 10 sin 0.3 from the tilted face.
TEST_CASE("a joint that leaves is apart, one that tilts is open on one side only") {
  const Cubes start = cubes(turn_about(0, 0), {0, 0, 10.2});
  JointFollower leaves(start.a, start.b), tilts(start.a, start.b);
  leaves.take(0, start.nodes), tilts.take(0, start.nodes);
  CHECK(leaves.gap().start == Approx(0.2));
  CHECK(leaves.gap().facing == 9);
  leaves.take(5, cubes(turn_about(0, 0), {0, 0, 12.7}).nodes);
  leaves.take(10, start.nodes);
  CHECK(leaves.gap().apart == Approx(2.5));
  CHECK(leaves.gap().apart_time == 5);
  CHECK(leaves.gap().open == Approx(2.5));
  const double angle = 0.3;
  const Mat3d turn = turn_about(1, -angle);  // lifts the side of positive x
  tilts.take(5, cubes(turn, Point{-5, 0, 5.2} + turn * Point{5, 0, 5}).nodes);
  CHECK(tilts.gap().apart == Approx(0).scale(1));
  CHECK(tilts.gap().open ==
        Approx(10 * std::sin(angle) + 0.2 * std::cos(angle) - 0.2).epsilon(1e-9));
}

TEST_CASE("the list of joints is read as it was written, and a bad line is named") {
  const std::vector<JointRow> rows{{"leg.right.knee", JointKind::sliding, {7000001, 7000002}, {7}},
                                   {"thorax.mid.disc", JointKind::tied, {1}, {2, 3}}};
  const std::vector<JointRow> read = read_joints(joints_csv(rows));
  REQUIRE(read.size() == 2);
  CHECK(read[0].name == rows[0].name);
  CHECK(read[0].a == rows[0].a);
  CHECK(read[1].kind == JointKind::tied);
  CHECK(read[1].b == rows[1].b);
  CHECK_THROWS_WITH_AS(read_joints("joint,kind,parts_a,parts_b\nknee,tied,1,x\n"),
                       "line 2: 'x' is not the id of a part", BodyError);
}

// Table of discs: area measured, height of the literature. The outline may be drawn in by 5 % of
// the radius; endplates rise by at most 3.5 mm; L3-L4 lacks 2.6 mm (8.2 mm, measured 5.6).
TEST_CASE("discs have the area and the height of their table") {
  BodyOptions options;
  options.only = {"C6", "C7", "T6", "T7", "T11", "T12", "L3", "L4", "L5"};
  const Body body = build_body(options);
  REQUIRE(body.joined.discs.size() == 5);
  for (const DiscReport& disc : body.joined.discs) {
    CAPTURE(disc.name);
    CHECK(disc.area > 0.88 * disc.table_area);
    CHECK(disc.area < 1.02 * disc.table_area);
    CHECK(disc.height < 1.05 * disc.wanted);
    CHECK(disc.height > 0.9 * disc.wanted);
  }
}

// Two vertebrae, a rib, the vertebra that it hangs on and its cartilage: every joint has parts on
// either side.
TEST_CASE("the joints of a body name parts that are there") {
  BodyOptions options;
  options.only = {"L3", "L4", "rib5", "T5", "costal_cartilage5"};
  const Body body = build_body(options);
  fabrica::Diagnostics diagnostics;
  fabrica::Builder builder(diagnostics);
  const AssembledBody assembled = assemble(body, {}, builder);
  const std::vector<JointRow> rows = joint_rows(body, assembled);
  const auto count = [&](const char* part, JointKind kind) {
    int n = 0;
    for (const JointRow& row : rows)
      n += row.name.find(part) != std::string::npos && row.kind == kind && !row.a.empty() &&
           !row.b.empty();
    return n;
  };
  CHECK(count("disc_L3_L4", JointKind::tied) == 2);
  CHECK(count("costochondral_5", JointKind::tied) == 2);
  CHECK(rows.size() >= 6);
}
