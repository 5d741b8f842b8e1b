#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "body/joints/bone_surface.h"
#include "body/joints/cartilage.h"
#include "body/joints/join_bones.h"
#include "body/joints/joint_law.h"
#include "body/joints/ligament_law.h"
#include "body/joints/mend.h"
#include "body/joints/symphysis.h"
#include "body/joints/touch.h"
#include "body/mesh/quality.h"
#include "body/tables.h"

using namespace fabrica::body;
using doctest::Approx;

namespace {

// a block of n x n x n cubic bricks with edge length `size` / n, its lowest corner at `low`
PlacedBone block(const std::string& name, const Point& low, double size, int n) {
  PlacedBone bone;
  bone.mesh.name = name;
  const auto index = [&](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        bone.mesh.nodes.push_back(low + (size / n) * Point{double(i), double(j), double(k)});
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        bone.mesh.bricks.push_back({index(i, j, k), index(i + 1, j, k), index(i + 1, j + 1, k),
                                    index(i, j + 1, k), index(i, j, k + 1), index(i + 1, j, k + 1),
                                    index(i + 1, j + 1, k + 1), index(i, j + 1, k + 1)});
  bone.mesh.brick_layer.assign(bone.mesh.bricks.size(), 0);
  bone.mesh.surface = boundary_quads(bone.mesh.bricks);
  bone.nodes = bone.mesh.nodes;
  return bone;
}

}  // namespace

// Outside a cube the distance is that to the box; inside it is minus the depth under the nearest
// face.
TEST_CASE("the nearest point of a surface has the signed distance of a box") {
  const PlacedBone cube = block("cube", {0, 0, 0}, 10, 4);
  const BoneSurface surface(cube.nodes, cube.mesh.surface);
  CHECK(surface.nearest({5, 5, 13}, 5).distance == Approx(3));
  CHECK(surface.nearest({5, 5, 8}, 5).distance == Approx(-2));
  CHECK(surface.nearest({13, 14, 5}, 6).distance == Approx(5));
  CHECK(surface.nearest({5, 5, 20}, 5).quad == -1);
  const SurfacePoint hit = surface.hit({4, 6, 25}, {0, 0, -1}, 30);
  CHECK(hit.distance == Approx(15));
  CHECK(hit.normal.z == Approx(1));
}

// A valley of 40 degrees along x = 0 between two faces, and a place 0.5 mm under it: it stands over
// neither, its nearest place is the edge. Over the edge of a flat face, 0.3 mm beside it and 0.5 mm
// deep, nothing is behind; nor is what stands before the valley.
TEST_CASE("a place under a valley of two faces is behind them") {
  const double t = std::tan(0.5 * 40 * std::numbers::pi / 180);
  const std::array<Point, 4> left{{{-4, -2, 4 * t}, {0, -2, 0}, {0, 2, 0}, {-4, 2, 4 * t}}};
  CHECK(behind({0, 0, -0.5}, left, touching));
  CHECK(!behind({0, 0, 0.5}, left, touching));
  const std::array<Point, 4> flat{{{-4, -2, 0}, {0, -2, 0}, {0, 2, 0}, {-4, 2, 0}}};
  CHECK(behind({-0.5, 0, -0.5}, flat, touching));
  CHECK(!behind({0.3, 0, -0.5}, flat, touching));
}

// Blankevoort: k s at the end of the toe (x = 2 s), slope k beyond; nothing where slack or pressed.
TEST_CASE("a ligament pulls behind its toe with its stiffness and never pushes") {
  const LigamentStiffness one{20, 0.1, 0, 0, 2};
  const double s = 0.03 * 20;
  CHECK(ligament_force(one, 1.9) == 0);
  CHECK(ligament_force(one, -5) == 0);
  CHECK(ligament_force(one, 2 + 2 * s) == Approx(0.1 * s));
  CHECK(ligament_force(one, 10) - ligament_force(one, 9) == Approx(0.1));
  const LigamentStiffness two{10, 0.05, 0.2, 0.3, 0};
  CHECK(ligament_force(two, 3) == Approx(0.05 * 2 + 0.3 * 1));
}

// Anterior longitudinal ligament of the neck (Mattucci, Cronin 2015): to 1.79 mm and 116.0 N
// F = C3 (exp(C4 x) - 1) x^m with C3 = 1839710, C4 = 1.79e-5, m = 1.167, then 140.4 N/mm. The law
// has the same ends and slope there and follows to a hundredth between; its curve lies above it by
// less than h^2 / 8 max F'', h = xt / 8.
TEST_CASE("a ligament with a measured toe follows the average of its tests") {
  LigamentStiffness law{10, 0.1404, 0, 0, 0};
  law.toe = 1.79, law.toe_force = 0.116;
  const double n = 0.1404 * 1.79 / 0.116;
  for (double x = 0.1; x < 1.79; x += 0.1) {
    const double measured = 1e-3 * 1839710 * (std::exp(1.79e-5 * x) - 1) * std::pow(x, 1.167);
    CHECK(ligament_force(law, x) == Approx(measured).epsilon(0.01));
  }
  CHECK(ligament_force(law, 1.79) == Approx(0.116));
  CHECK(ligament_force(law, 2.79) == Approx(0.116 + 0.1404));
  CHECK((ligament_force(law, 1.79) - ligament_force(law, 1.789)) / 0.001 ==
        Approx(0.1404).epsilon(0.01));
  const double bound = 0.116 * n * (n - 1) / (8 * 64);
  const Law curve = ligament_curve(law, 1, "", "");
  REQUIRE(curve.curve.size() == 11);
  for (std::size_t i = 2; i + 1 < curve.curve.size(); ++i) {
    const double x = 0.5 * (curve.curve[i - 1].first + curve.curve[i].first);
    const double chord = 0.5 * (curve.curve[i - 1].second + curve.curve[i].second);
    CHECK(std::abs(chord - ligament_force(law, x)) <= bound * (1 + 1e-9));
  }
}

// A chord over a quarter of the toe lies above the parabola by k h^2 / (16 s), h = s / 2.
TEST_CASE("the curve of a ligament follows its law to the error of its chords") {
  const LigamentStiffness law{20, 0.1, 0, 0, 2};
  const Law curve = ligament_curve(law, 4, "", "");
  const double s = 0.03 * 20, bound = 0.1 * (s / 2) * (s / 2) / (16 * s) / 4;
  for (double x = -3; x < 20; x += 0.05) {
    std::size_t i = 1;
    while (i + 1 < curve.curve.size() && curve.curve[i].first < x) ++i;
    const auto [x0, f0] = curve.curve[i - 1];
    const auto [x1, f1] = curve.curve[i];
    const double f = f0 + (f1 - f0) * (x - x0) / (x1 - x0);
    CHECK(std::abs(f - ligament_force(law, x) / 4) <= bound * (1 + 1e-9));
  }
}

TEST_CASE("blocks that overlap are cleared to the gap without turning bricks over") {
  std::vector<PlacedBone> bones{block("a", {0, 0, 0}, 20, 4), block("b", {3, 2, 19.4}, 20, 4)};
  const ClearanceReport report = clear_bones(bones);
  CHECK(report.left.empty());
  CHECK(report.least_scaled_jacobian > 0.25);
  const BoneSurface b(bones[1].nodes, bones[1].mesh.surface);
  for (const Point& p : bones[0].nodes) {
    const SurfacePoint there = b.nearest(p, 3);
    if (there.quad >= 0) CHECK(there.distance > 0.15);
  }
  // what stands apart stays as it is
  std::vector<PlacedBone> apart{block("a", {0, 0, 0}, 20, 4), block("b", {0, 0, 25}, 20, 4)};
  CHECK(clear_bones(apart).largest_shift == 0);
}

// A toe's end reaches 0.8 mm into the bone before it: 2 mm of way are free, so it goes along its
// axis and keeps its form. Closed form: the volume of a cube.
TEST_CASE("a bone that others do not hold moves whole instead of being pressed small") {
  std::vector<PlacedBone> bones{block("foot_phalanx5_middle", {0, 0, 0}, 6, 2),
                                block("foot_phalanx5_distal", {5.2, 0.5, 0.5}, 5, 2)};
  const ClearanceReport report = clear_bones(bones);
  CHECK(report.left.empty());
  CHECK(report.whole_shift > 0.75);
  CHECK(report.whole_shift <= 2);
  double volume = 0;
  for (const auto& brick : bones[1].mesh.bricks)
    volume += volume_of(corners_of(bones[1].nodes, brick));
  CHECK(volume == Approx(125).epsilon(0.03));
}

// The edge of a fingertip reaches into an edge of the bone before it: one node of that, (6, 6, 3),
// and three of its own, (4.6, 4.8, z), stand inside. It moves from their middle to its own.
TEST_CASE("a phalanx is moved along its ray") {
  std::vector<PlacedBone> bones{block("hand_phalanx2_middle", {0, 0, 0}, 6, 2),
                                block("hand_phalanx2_distal", {4.6, 4.8, 0.5}, 5, 2)};
  const Point line{7.1 - (6 + 3 * 4.6) / 4, 7.3 - (6 + 3 * 4.8) / 4, 0};
  clear_bones(bones);
  const Point moved = bones[1].placement.t;
  CHECK(norm(moved) > 0.3);
  CHECK(norm(cross(moved, line)) < 1e-6 * norm(moved) * norm(line));
}

// A fingertip narrower than the bone before it stands 3.6 mm deep in its end of 6: its nodes are
// past the middle and nearest to the far side or to a side. It leaves by the end all the same.
TEST_CASE("a phalanx past the middle of the bone before it leaves by its end") {
  std::vector<PlacedBone> bones{block("hand_phalanx2_middle", {0, 0, 0}, 6, 2),
                                block("hand_phalanx2_distal", {2.4, 0.5, 0.5}, 5, 2)};
  const Surfaces surfaces(bones);
  CHECK(surfaces.way_out(1, surfaces.overlapping(1, 0, 8), {1, 0, 0}, 8) == Approx(3.6));
  const ClearanceReport report = clear_bones(bones);
  CHECK(report.left.empty());
  CHECK(bones[1].placement.t.x == Approx(2));  // the most; the rest gives way elastically
  CHECK(std::abs(bones[1].placement.t.y) + std::abs(bones[1].placement.t.z) < 0.01);
}

// A block on another, 2 mm apart and with a step of its neighbour 2 mm beside it: as a knee they
// part to the 2.2 + 2.6 + 0.1 of cartilage above the plateau and keep what they have beside it,
// where 1.6 are enough.
TEST_CASE("coarse condyles give way until their cartilage has room above the plateau") {
  std::vector<PlacedBone> bones{block("femur", {0, 0, 14}, 12, 4),
                                block("tibia", {0, 0, 0}, 12, 4)};
  CHECK(clear_bones(bones).left.empty());
  const auto least = [&] {
    const BoneSurface below(bones[1].nodes, bones[1].mesh.surface);
    double gap = 1e30;
    for (const Point& p : bones[0].nodes) gap = std::min(gap, below.nearest(p, 20).distance);
    return gap;
  };
  CHECK(least() > 4.9 - 0.1);
  CHECK(least() < 4.9 + 0.1);
  bones = {block("femur", {14, 0, 0}, 12, 4), block("tibia", {0, 0, 0}, 12, 4)};
  clear_bones(bones);
  CHECK(least() == Approx(2));
}

// The end of a cartilage stands 4 mm deep in that of its rib and 1 mm inside of a side, so that
// most of its nodes are nearer to a side than to the end: the ends part along their common axis and
// do not wrap one another.
TEST_CASE("ends that are grown together part along their axis") {
  std::vector<PlacedBone> bones{block("rib3", {0, 0, 0}, 12, 4),
                                block("costal_cartilage3", {8, 1, 3}, 6, 2)};
  const std::vector<Point> rib = bones[0].nodes, cartilage = bones[1].nodes;
  const ClearanceReport report = clear_bones(bones);
  CHECK(report.left.empty());
  double sideways = 0, lengthwise = 0;
  for (const auto& [now, before] :
       {std::pair{&bones[0].nodes, &rib}, {&bones[1].nodes, &cartilage}})
    for (std::size_t n = 0; n < now->size(); ++n) {
      const Point u = (*now)[n] - (*before)[n];
      sideways = std::max({sideways, std::abs(u.y), std::abs(u.z)});
      lengthwise = std::max(lengthwise, std::abs(u.x));
    }
  CHECK(lengthwise > 1.5);
  CHECK(sideways < 1);
}

// A cube of 27 bricks of 4 mm: an inner node of its upper face goes aside by 2 mm, so that two
// shells have an area of 12 mm2 on sides of at most sqrt(20) mm. A node off its plane by d costs
// 100 (d / 4 mm)^2, a shell at its wish 1: nodes stay within 0.4 mm of the face.
TEST_CASE("a moved bone gets the size of its shells back while its surface stays") {
  PlacedBone cube = block("cube", {0, 0, 0}, 12, 3);
  cube.mesh.cortex.assign(cube.mesh.surface.size(), 1.0);
  cube.mesh.shell_wish = 2.8;
  for (Point& p : cube.nodes)
    if (norm(p - Point{4, 4, 12}) < 1e-9) p.x += 2;
  const auto smallest = [&] {
    double least = 1e30;
    for (const Quad& q : cube.mesh.surface) least = std::min(least, shell_size(cube.nodes, q));
    return least;
  };
  CHECK(smallest() == Approx(12 / std::sqrt(20.0)));
  mend(cube.mesh, cube.nodes, false, BoneSurface(cube.nodes, cube.mesh.surface), {});
  CHECK(smallest() >= 2.8);
  // nodes within the face; those of its rim may also slide on the other faces
  for (std::size_t n = 0; n < cube.nodes.size(); ++n) {
    const Point& p = cube.mesh.nodes[n];
    if (std::max(std::abs(p.x - 6), std::abs(p.y - 6)) < 3 && p.z > 11)
      CHECK(std::abs(cube.nodes[n].z - 12) < 0.4);
  }
}

// A node of the left bone stands 0.5 mm before the inner side of a block on the midline, its image
// on the right, which gets its place, before nothing: what the left one asks for counts, mirrored.
TEST_CASE("a right bone stays in front of what its image touches") {
  std::vector<PlacedBone> bones{block("rib3", {0, -9, 0}, 4, 1), block("rib3", {0, 5, 0}, 4, 1),
                                block("L3", {0, -4.5, 0}, 9, 1)};
  const std::array<int, 4> side{2, 3, 7, 6};  // y = 4.5
  const std::vector<Touch> touches{{1, 5, 2, side, {0.25, 0.25, 0.25, 0.25}, {0, 1, 0}, 0.5, 1.2}};
  CHECK(planes_of(touches, 0, -1, bones).empty());
  const auto planes = planes_of(touches, 0, 1, bones);
  REQUIRE(planes.size() == 1);
  CHECK(planes[0].node == 5);
  CHECK(norm(planes[0].point - Point{4.5, -4.5 - 1.2, 4.5}) < 1e-12);
  CHECK(norm(planes[0].normal - Point{0, -1, 0}) < 1e-12);
}

// Two cubes of 12 mm whose faces reach 3 mm into one another and that nothing moves whole, of
// bricks of 3 mm at coarse and of 0.5 at fine: at rest they are the same elastic bodies under the
// same push, and as large as one another to 0.5 % whatever their bricks.
TEST_CASE("bones of fine meshes keep their volume where they give way") {
  const auto cleared = [](Resolution resolution, int n) {
    std::vector<PlacedBone> bones{block("L3", {0, 0, 0}, 12, n), block("T3", {0, 0, 9}, 12, n)};
    for (PlacedBone& bone : bones) bone.mesh.resolution = resolution;
    clear_bones(bones);
    std::array<double, 2> volume{0, 0};
    for (std::size_t b = 0; b < 2; ++b)
      for (const auto& brick : bones[b].mesh.bricks)
        volume[b] += volume_of(corners_of(bones[b].nodes, brick));
    return volume;
  };
  const auto coarse = cleared(Resolution::coarse, 4), fine = cleared(Resolution::fine, 24);
  for (std::size_t b = 0; b < 2; ++b) CHECK(std::abs(fine[b] - coarse[b]) < 0.005 * 12 * 12 * 12);
}

// Two blocks 9 mm apart: 5 mm after, the far halves as they were, mirror images to the bit.
TEST_CASE("pubic bones come to the width of a symphysis") {
  PlacedBone right = block("hip_bone", {0, -34.5, 0}, 30, 6);
  right.side = Side::right;
  PlacedBone left = right;
  left.side = Side::left;
  left.mesh = mirrored(right.mesh);
  for (Point& p : left.nodes) p = mirror(p);
  std::vector<PlacedBone> bones{right, left};
  CHECK(fit_symphysis(bones) == Approx(2));
  double nearest = 1e30, volume = 0;
  for (std::size_t n = 0; n < right.nodes.size(); ++n) {
    const Point &p = bones[0].nodes[n], q = mirror(bones[1].nodes[n]);
    CHECK((p.x == q.x && p.y == q.y && p.z == q.z));
    nearest = std::min(nearest, -p.y);
    if (right.nodes[n].y < -24.5) CHECK(p.y == right.nodes[n].y);
  }
  CHECK(nearest == Approx(2.5));
  for (const auto& brick : right.mesh.bricks)
    volume += volume_of(corners_of(bones[0].nodes, brick));
  CHECK(volume == Approx(27000 + 2 * 900));
  CHECK(fit_symphysis(bones) == Approx(0));
}

// Blocks 2 mm apart: the layer fills the gap, is as large as their faces and tied all over.
TEST_CASE("a joint that both bones have grown to is one layer tied to the second") {
  std::vector<PlacedBone> bones{block("hip_bone", {0, 0, 0}, 12, 4),
                                block("sacrum", {0, 14, 0}, 12, 4)};
  bones[0].side = Side::right, bones[1].side = Side::midline;
  BetweenBones between;
  const auto reports = add_articulations(bones, between);
  REQUIRE(reports.size() == 1);
  CHECK(reports[0].omitted.empty());
  CHECK(between.contacts.empty());
  REQUIRE(between.pieces.size() == 1);
  REQUIRE(between.ties.size() == 1);
  const Piece& layer = between.pieces[0];
  CHECK(layer.law.keyword == "MAT_OGDEN_RUBBER");
  double volume = 0;
  for (const auto& b : layer.bricks) {
    Corners corners;
    for (std::size_t i = 0; i < 8; ++i) corners[i] = layer.nodes[std::size_t(b[i])].x;
    volume += volume_of(corners);
  }
  CHECK(layer.bricks.size() == 16);
  CHECK(volume == Approx(12 * 12 * 1.95));
  CHECK(between.ties[0].a.size() == 25);
  for (const PieceNode& n : between.ties[0].a) CHECK(n.x.y == Approx(13.95));
  CHECK(between.ties[0].b.quads.size() >= 16);
}

TEST_CASE("every row of the tables of joints names bones and a law that exist") {
  std::set<std::string> known(bone_names().begin(), bone_names().end());
  known.insert("hip_bone_L");
  for (const char* file : {"anatomy/joints/ligaments.csv", "anatomy/joints/articulations.csv"}) {
    const Table table(file);
    for (int row = 0; row < table.rows(); ++row) {
      CAPTURE(table.text(row, "name"));
      CHECK(known.count(table.text(row, "bone1")) == 1);
      CHECK(known.count(table.text(row, "bone2")) == 1);
      CHECK(!table.text(row, "source").empty());
    }
  }
  for (const char* law : {"nucleus", "annulus", "cartilage", "sacroiliac", "symphysis"})
    CHECK(joint_law(law).fields.size() >= 3);
  CHECK_THROWS_AS(joint_law("ivory"), BodyError);
}

TEST_CASE("a part that hangs on nothing is named") {
  std::vector<PlacedBone> bones{block("a", {0, 0, 0}, 20, 2), block("b", {0, 0, 30}, 20, 2),
                                block("c", {0, 0, 60}, 20, 2)};
  BetweenBones between;
  Piece ligament;
  ligament.nodes = {{{}, 0, -1, 0}, {{}, 1, -1, 0}};
  ligament.lines = {{0, 1}};
  between.pieces.push_back(ligament);
  const auto alone = unconnected(bones, between);
  REQUIRE(alone.size() == 1);
  CHECK(alone[0].find(".c.") != std::string::npos);
}

namespace {

// a block on the right of that size, and its mirror image
std::pair<PlacedBone, PlacedBone> plates(double size) {
  PlacedBone right = block("plate", {2, -10, 2}, size, 3);
  right.side = Side::right;
  PlacedBone left = right;
  left.side = Side::left;
  left.mesh = mirrored(right.mesh);
  for (Point& p : left.nodes) p = mirror(p);
  return {right, left};
}

}  // namespace

// Two blocks that mirror each other reach by 0.5 mm on the right, and 0.1 mm on the left, into a
// block of the midline that stands 0.2 mm off the plane of symmetry. Invariance: what mirrored
// before mirrors after, to rounding.
TEST_CASE("bones of both sides still mirror each other where the bone between is not symmetric") {
  const auto [right, left] = plates(5.3);
  PlacedBone middle = block("wedge", {0, -5.2, 0}, 10, 4);
  middle.side = Side::midline;
  std::vector<PlacedBone> bones{right, left, middle};
  const ClearanceReport report = clear_bones(bones);
  CHECK(report.left.empty());
  CHECK(report.largest_shift > 0.2);
  double off = 0, moved = 0;
  for (std::size_t n = 0; n < right.nodes.size(); ++n) {
    off = std::max(off, norm(bones[0].nodes[n] - mirror(bones[1].nodes[n])));
    off = std::max(off, norm(bones[1].nodes[n] - bones[1].mesh.nodes[n]));
    moved = std::max(moved, norm(bones[1].nodes[n] - left.nodes[n]));
  }
  CHECK(off < 1e-12);
  CHECK(moved > 0.2);
}

// The same plates on both sides of a block that mirrors itself. Invariance, to the bit: nodes of
// the block are not moved one by one on both sides, but as one with their images.
TEST_CASE("a bone of the midline that mirrors itself does so after it was cleared") {
  const auto [right, left] = plates(5.5);
  PlacedBone middle = block("wedge", {0, -5, 0}, 10, 4);
  middle.side = Side::midline;
  for (const Point& p : middle.nodes) {
    std::size_t n = 0;
    while (norm(middle.nodes[n] - mirror(p)) > 1e-9) ++n;
    middle.mesh.image.push_back(int(n));
  }
  std::vector<PlacedBone> bones{right, left, middle};
  const ClearanceReport report = clear_bones(bones);
  CHECK(report.left.empty());
  double moved = 0;
  const std::vector<Point>& now = bones[2].nodes;
  for (std::size_t n = 0; n < now.size(); ++n) {
    const Point image = mirror(now[std::size_t(middle.mesh.image[n])]);
    CHECK((now[n].x == image.x && now[n].y == image.y && now[n].z == image.z));
    moved = std::max(moved, norm(now[n] - middle.nodes[n]));
  }
  CHECK(moved > 0.1);
  for (std::size_t n = 0; n < right.nodes.size(); ++n)
    CHECK(norm(bones[0].nodes[n] - mirror(bones[1].nodes[n])) < 1e-12);
}
