#include "body/turned_bricks.h"

#include <doctest/doctest.h>

#include "body/assembly.h"
#include "body/body.h"

using namespace fabrica::body;

namespace {

// unit cubes in a row along x, each with nodes of its own
struct Row {
  std::vector<Point> nodes;
  std::vector<Brick> bricks;
  explicit Row(int count) {
    const double unit[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                               {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    for (int e = 0; e < count; ++e) {
      bricks.push_back({});
      for (int c = 0; c < 8; ++c) {
        bricks.back()[std::size_t(c)] = int(nodes.size());
        nodes.push_back({unit[c][0] + 2 * e, unit[c][1], unit[c][2]});
      }
    }
  }
};

}  // namespace

// The corner (s, s, s) of the unit cube and its neighbours (1, 0, 1), (0, 1, 1), (1, 1, 0), which
// lie in the plane x + y + z = 2: it turns over at s = 2/3, while the volume stays positive. A
// wedge has corners without volume, and has not turned over.
TEST_CASE("a brick turns over where a corner passes the plane of its neighbours") {
  Row row(1);
  const auto with_corner_at = [&](double s) {
    row.nodes[6] = {s, s, s};
    return corners_of(row.nodes, row.bricks[0]);
  };
  CHECK_FALSE(turned_over(with_corner_at(0.667)));
  CHECK(turned_over(with_corner_at(0.666)));
  CHECK(volume_of(with_corner_at(0.666)) > 0);
  const Brick wedge{0, 1, 2, 3, 4, 4, 7, 7};
  CHECK_FALSE(turned_over(corners_of(row.nodes, wedge)));
}

// Four cubes of two kinds in three states: a disc's turns over and comes back, two of cartilage
// turn over in turn, one that is deleted does not count.
TEST_CASE("turned bricks are counted by kind, at once, at last and ever") {
  Row row(4);
  const std::vector<Point> sound = row.nodes;
  const auto turn = [&](int brick) {
    row.nodes[std::size_t(8 * brick + 6)] = row.nodes[8 * brick];
  };
  TurnedBrickCounter counter(row.bricks,
                             {"spine.mid.disc_L3_L4.annulus", "leg.right.hip.cartilage_femur",
                              "leg.right.hip.cartilage_femur", "leg.right.hip.cartilage_femur"});
  counter.take(0, row.nodes, {});
  turn(0), turn(1), turn(3);
  counter.take(2, row.nodes, {1, 1, 1, 0});
  row.nodes = sound;
  turn(2);
  counter.take(4, row.nodes, {1, 1, 1, 0});
  const TurnedBricks &disc = counter.kinds().at("disc"),
                     &cartilage = counter.kinds().at("joint cartilage");
  CHECK(counter.kinds().size() == 2);
  CHECK(disc.bricks == 1);
  CHECK(disc.most == 1);
  CHECK(disc.most_time == 2);
  CHECK(disc.last == 0);
  CHECK(cartilage.bricks == 3);
  CHECK(cartilage.ever == 2);
  CHECK(cartilage.most == 1);
  CHECK(cartilage.last == 1);
  CHECK(cartilage.parts == std::map<std::string, int>{{"leg.right.hip.cartilage_femur", 2}});
}

// A knee, a lumbar unit and a rib with its cartilage: every part with bricks has a kind, and none
// of it is missed.
TEST_CASE("the kind of a part follows from its title") {
  BodyOptions options;
  options.only = {"L3", "L4", "rib5", "T5", "costal_cartilage5", "femur", "tibia"};
  const Body body = build_body(options);
  fabrica::Diagnostics diagnostics;
  fabrica::Builder builder(diagnostics);
  const AssembledBody assembled = assemble(body, {}, builder);
  for (const PartEntry& part : assembled.parts) {
    CAPTURE(part.name);
    const std::string kind = kind_of_part(part.name);
    if (part.bone >= 0 && part.name.find("shell") == std::string::npos) {
      const bool rib = part.name.find("costal_cartilage") != std::string::npos;
      CHECK(kind == (rib ? "costal cartilage" : "bone"));
    }
    if (part.piece < 0) continue;
    const Piece& piece = body.between.pieces[std::size_t(part.piece)];
    if (!piece.bricks.empty()) CHECK(kind != "other");
  }
}
