#include "body/joints/meniscus.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "body/body.h"
#include "body/joints/meniscus_plan.h"
#include "body/mesh/quality.h"
#include "body/tables.h"

namespace fabrica::body {
namespace {

using doctest::Approx;

// a plate of bricks of 6 mm over the plateau, its upper or lower face at a height of the tibia
PlacedBone plate(const std::string& name, Side side, double low) {
  constexpr int n = 20;
  constexpr double edge = 6;
  PlacedBone bone;
  bone.mesh.name = name;
  bone.side = side, bone.region = Region::leg;
  const auto index = [&](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
  for (int k = 0; k <= 1; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        bone.mesh.nodes.push_back({edge * (i - n / 2), edge * (j - n / 2), low + 20 * k});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      bone.mesh.bricks.push_back({index(i, j, 0), index(i + 1, j, 0), index(i + 1, j + 1, 0),
                                  index(i, j + 1, 0), index(i, j, 1), index(i + 1, j, 1),
                                  index(i + 1, j + 1, 1), index(i, j + 1, 1)});
  bone.mesh.brick_layer.assign(bone.mesh.bricks.size(), 0);
  bone.mesh.surface = boundary_quads(bone.mesh.bricks);
  bone.nodes = bone.mesh.nodes;
  // the centre of the hip stands 842 mm above that of the ankle
  if (name == "femur") bone.placement.t = {0, 0, 842};
  for (Point& p : bone.mesh.nodes) p = bone.placement.inverse(p);
  return bone;
}

struct FlatKnee {
  std::vector<PlacedBone> bones;
  BetweenBones between;
  std::vector<MeniscusReport> reports;
  // plates with their faces at 390 mm and that much higher
  explicit FlatKnee(double room, Side side = Side::right)
      : bones{plate("tibia", side, 370), plate("femur", side, 390 + room)} {
    reports = add_menisci(bones, between);
  }
  const Piece& piece(const std::string& name) const {
    for (const Piece& p : between.pieces)
      if (p.name == name) return p;
    throw BodyError("no piece " + name);
  }
};

}  // namespace

// Between planes that leave more room than they want the menisci are what the table says: with N
// equal parts of s and trapezia of the sections, V = sum of (1/2) (A(i) + A(i+1)) ds to the second
// order, A = width (e + H) / 2; summed here over 400 sections. Tolerance: the polygons of 14 to 16
// parts inscribe arcs of 180 and 255 degrees, 1 - (sin a / a) with a = 0.16: 2 %.
TEST_CASE("a meniscus with room has the volume and the height of its plan") {
  const FlatKnee knee(20);
  REQUIRE(knee.reports.size() == 2);
  for (const MeniscusReport& report : knee.reports) {
    CAPTURE(report.name);
    const MeniscusPlan plan(report.name.find("medial") != std::string::npos ? "medial" : "lateral",
                            {1, 1, 1}, 0);
    constexpr int parts = 400;
    double volume = 0;
    for (int i = 0; i < parts; ++i) {
      const double s = (i + 0.5) / parts;
      const PlanPoint a = plan.at(s - 0.5 / parts, 0), b = plan.at(s + 0.5 / parts, 0),
                      c = plan.at(s + 0.5 / parts, 1), d = plan.at(s - 0.5 / parts, 1);
      const double area = 0.5 * std::abs((c.x - a.x) * (d.y - b.y) - (c.y - a.y) * (d.x - b.x));
      // the mean of a wedge over a sector lies outwards of its middle: two points of Gauss in r
      double mean = 0, weight = 0;
      for (const double r : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)}) {
        const PlanPoint p = plan.at(s - 0.5 / parts, r), q = plan.at(s + 0.5 / parts, r);
        const double length = std::hypot(q.x - p.x, q.y - p.y);
        mean += length * plan.height(s, r), weight += length;
      }
      volume += area * mean / weight;
    }
    CHECK(report.volume == Approx(volume).epsilon(0.02));
    CHECK(report.without_room == 0);
    CHECK(report.drawn_in == 0);
    CHECK(report.least_scaled_jacobian > 0.5);
    CHECK(report.rim_length == Approx(plan.rim_length()).epsilon(0.01));
  }
}

// The lengths of knees measured after dissection (Murlimanju 2012, 46 menisci): rim 99 +- 11 and
// 90 +- 9 mm, inner edge 55 +- 8 and 51 +- 5 mm, root to root. The roots of ours add the distance
// from the middle of each end; an inner edge within two standard deviations.
TEST_CASE("the plans of the menisci are as long as dissected ones") {
  const Table ligaments("anatomy/joints/meniscus_ligaments.csv");
  for (const auto& [name, rim, rim_sd, inner, inner_sd] :
       {std::tuple{"medial", 99.06, 11.21, 55.44, 8.37}, {"lateral", 90.25, 9.36, 50.63, 5.33}}) {
    CAPTURE(name);
    const MeniscusPlan plan(name, {1, 1, 1}, 0);
    double roots = 0;
    for (int row = 0; row < ligaments.rows(); ++row) {
      if (ligaments.text(row, "meniscus") != name || ligaments.text(row, "kind") != "root" ||
          ligaments.text(row, "bone") != "tibia")
        continue;
      const PlanPoint end = plan.at(ligaments.text(row, "end") == "anterior" ? 0 : 1, 0.5);
      roots += std::hypot(ligaments.number(row, "x") - end.x, ligaments.number(row, "y") - end.y);
    }
    CHECK(std::abs(plan.rim_length() + roots - rim) < rim_sd);
    CHECK(std::abs(plan.inner_length() + roots - inner) < 2 * inner_sd);
  }
}

// Thompson 1991: from extension to full flexion the medial meniscus goes back by 5.1 mm, the
// lateral one by 11.2 mm; here the middle of each. The ends stay within 2 mm of where their roots
// hold them.
TEST_CASE("the menisci travel backwards as the knee bends") {
  for (const auto& [name, back] : {std::pair{"medial", 5.1}, {"lateral", 11.2}}) {
    CAPTURE(name);
    const MeniscusPlan straight(name, {1, 1, 1}, 0), bent(name, {1, 1, 1}, 120);
    const auto moved = [&](double s, const MeniscusPlan& plan) {
      const PlanPoint a = straight.at(s, 0.5), b = plan.at(s, 0.5);
      return std::hypot(b.x - a.x, b.y - a.y);
    };
    CHECK(moved(0.5, bent) == Approx(back).epsilon(0.01));  // digits of the table
    CHECK(moved(0, bent) < 2);
    CHECK(moved(1, bent) < 2);
    // to the back, which the frame of the tibia sees turned by the torsion of 34 degrees
    const PlanPoint a = straight.at(0.5, 0.5), b = bent.at(0.5, 0.5);
    CHECK(std::atan2(a.y - b.y, a.x - b.x) * 57.3 == Approx(33.7).epsilon(0.02));
    double last = 0;
    for (double f = 10; f <= 120; f += 10) {
      const double now = moved(0.5, MeniscusPlan(name, {1, 1, 1}, f));
      CHECK(now > last);
      last = now;
    }
    CHECK(moved(0.5, MeniscusPlan(name, {1, 1, 1}, 140)) == Approx(last));
  }
}

// A knee of our own bones: menisci find room in front of and behind the condyle as it rolls back.
TEST_CASE("menisci find room in a knee that bends") {
  BodyOptions options;
  options.only = {"right.femur", "right.tibia", "right.fibula"};
  for (const double flexion : {20, 60, 120}) {
    CAPTURE(flexion);
    set_angle(options.posture, "knee", flexion);
    const Body body = build_body(options);
    REQUIRE(body.joined.menisci.size() == 2);
    for (const MeniscusReport& report : body.joined.menisci) {
      CAPTURE(report.name);
      CHECK(report.least_scaled_jacobian >= 0.3);
      CHECK(report.without_room <= 0.15 * (report.bricks + report.without_room));
      if (flexion == 60) CHECK(report.without_room == 0);  // driver and passenger
    }
  }
}

// Fibres of a straight bar would give it E A: each edge holds E times a quarter of the bricks
// around it over L^2, so that the sum of k L^2 over all is E V, exactly.
TEST_CASE("the fibres of a meniscus hold its volume times their modulus") {
  const FlatKnee knee(20);
  for (const MeniscusReport& report : knee.reports) {
    const Piece& fibres = knee.piece(report.name + ".fibres");
    double sum = 0;
    for (std::size_t i = 0; i < fibres.lines.size(); ++i) {
      const Point d = fibres.nodes[std::size_t(fibres.lines[i][0])].x -
                      fibres.nodes[std::size_t(fibres.lines[i][1])].x;
      sum += fibres.line_scale[i] * dot(d, d);
    }
    CHECK(sum == Approx(0.12 * report.volume).epsilon(1e-9));
  }
}

// The femur 3.4 mm above the tibia: 0.1 mm is left to either, everything between is meniscus.
TEST_CASE("a meniscus keeps its gap to both bones where room is short") {
  const FlatKnee knee(3.4);
  for (const MeniscusReport& report : knee.reports) {
    double low = 1e30, high = -1e30;
    for (const PieceNode& n : knee.piece(report.name).nodes)
      low = std::min(low, n.x.z), high = std::max(high, n.x.z);
    CHECK(low == Approx(390.1));
    CHECK(high <= 393.3 + 1e-9);
    CHECK(high > 393.2);
    CHECK(report.without_room == 0);
  }
  CHECK_THROWS_AS(FlatKnee(0.3), BodyError);
}

// Invariance: the left knee is the mirror image of the right one.
TEST_CASE("menisci of both sides mirror each other") {
  const FlatKnee right(5), left(5, Side::left);
  for (std::size_t m = 0; m < 2; ++m) {
    const Piece &a = right.piece(right.reports[m].name), &b = left.piece(left.reports[m].name);
    REQUIRE(a.nodes.size() == b.nodes.size());
    std::set<std::array<long, 3>> places;
    const auto key = [](const Point& p) {
      return std::array<long, 3>{std::lround(1e6 * p.x), std::lround(1e6 * p.y),
                                 std::lround(1e6 * p.z)};
    };
    for (const PieceNode& n : a.nodes) places.insert(key(n.x));
    for (const PieceNode& n : b.nodes) CHECK(places.count(key(mirror(n.x))) == 1);
    for (const auto& brick : b.bricks) {
      Corners corners;
      for (std::size_t i = 0; i < 8; ++i) corners[i] = b.nodes[std::size_t(brick[i])].x;
      CHECK(volume_of(corners) > 0);
    }
  }
}

// Roots and rims hang on the bones: every row of the table becomes a piece whose strands start at
// a node of the meniscus and end at one of a bone or of the other meniscus; the stiffness of a root
// is that of its row.
TEST_CASE("menisci hang on their roots, their rims and each other") {
  const FlatKnee knee(20);
  const Table table("anatomy/joints/meniscus_ligaments.csv");
  for (int row = 0; row < table.rows(); ++row) {
    const Piece& piece = knee.piece("leg.right." + table.text(row, "name"));
    CAPTURE(piece.name);
    double sum = 0;
    for (std::size_t i = 0; i < piece.lines.size(); ++i) {
      const PieceNode &a = piece.nodes[std::size_t(piece.lines[i][0])],
                      &b = piece.nodes[std::size_t(piece.lines[i][1])];
      CHECK(a.piece >= 0);
      CHECK((b.bone >= 0 || (b.piece >= 0 && b.piece != a.piece)));
      sum += piece.line_scale[i];
    }
    if (table.text(row, "kind") != "coronary")
      CHECK(sum == Approx(1e-3 * table.number(row, "stiffness")));
  }
}

}  // namespace fabrica::body
