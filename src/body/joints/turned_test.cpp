#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>
#include <tuple>

#include "body/body.h"
#include "body/joints/cartilage.h"

using namespace fabrica::body;

namespace {

Body body_of(const std::vector<std::string>& bones) {
  BodyOptions options;
  options.only = bones;
  return build_body(options);
}
Body forearm() { return body_of({"right.humerus", "right.radius", "right.ulna"}); }

// by how much [mm] a line of a piece is longer once the bone `turned` is turned about a centre
double stretch(const Body& body, const Piece& piece, const std::array<int, 2>& line, int turned,
               const Point& centre, const fabrica::Mat3d& turn) {
  const auto length = [&](bool after) {
    Point x[2];
    for (std::size_t i = 0; i < 2; ++i) {
      const PieceNode& n = piece.nodes[std::size_t(line[i])];
      // the own node of an earlier piece is a hub: it goes with the bone of its spokes
      const int bone =
          n.bone >= 0 ? n.bone : body.between.pieces[std::size_t(n.piece)].nodes.back().bone;
      x[i] = after && bone == turned ? centre + turn * (n.x - centre) : n.x;
    }
    return norm(x[1] - x[0]);
  };
  return length(true) - length(false);
}

// by how much [mm] a strand is longer where it begins to pull
double slack(const Piece& piece) {
  double longest = 0;
  for (const auto& [elongation, force] : piece.law.curve)
    if (force == 0) longest = std::max(longest, elongation);
  return longest;
}

}  // namespace

// The radius turns in the annular ligament and, beside the membrane, nothing that goes to it is
// drawn by more than a fifth of a capsule that was fastened to its head (16 mm at 78 degrees).
TEST_CASE("what holds the radius lets it turn") {
  const Body body = forearm();
  const int radius = find_bone(body.bones, "radius", Side::right);
  const Joint& joint = *find_joint("forearm");
  // the middle of its head, where clearing left it
  const Point centre = body.bones[std::size_t(radius)].placement({0, 0, 0});
  double annular = 0;
  for (double degrees : {-20.0, 30.0, 60.0, 90.0, 120.0, 160.0}) {
    const fabrica::Mat3d turn =
        rotation_about(joint.axes.front().axis, degrees * std::numbers::pi / 180);
    for (const Piece& piece : body.between.pieces) {
      if (piece.kind != PieceKind::spring) continue;
      for (const auto& line : piece.lines) {
        const double longer = stretch(body, piece, line, radius, centre, turn);
        CAPTURE(piece.name);
        CAPTURE(degrees);
        CHECK(longer - slack(piece) < 3);
        if (piece.name.find("annular") != std::string::npos)
          annular = std::max(annular, std::abs(longer));
      }
    }
  }
  CHECK(annular < 0.5);
}

// Radius and ulna meet at both ends: each joint lies at its own, and the head that turns there has
// cartilage all around, as faces that look away from the notch at rest come to it.
TEST_CASE("radius and ulna have a joint at either end, around the head that turns") {
  const Body body = forearm();
  const auto& bones = body.bones;
  for (const auto& [name, head, notch, above] :
       {std::tuple{"radioulnar_proximal", "radius", "ulna", true},
        std::tuple{"radioulnar_distal", "ulna", "radius", false}}) {
    const PlacedBone& bone = bones[std::size_t(find_bone(bones, head, Side::right))];
    int found = 0;
    for (const Piece& piece : body.between.pieces) {
      if (piece.name.find(name) == std::string::npos) continue;
      CAPTURE(piece.name);
      ++found;
      Point low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};
      for (const PieceNode& n : piece.nodes) {
        const Point p = bone.placement.inverse(n.x);
        for (int i = 0; i < 3; ++i)
          low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
      }
      CHECK(high.z - low.z < 35);
      CHECK((above ? low.z > -60 : high.z < -200));
      const bool around = piece.name.ends_with(std::string("cartilage_") + head);
      CHECK((std::min(high.x - low.x, high.y - low.y) > 14) == around);
    }
    CHECK(found == 2);
  }
}

// The lower part of the capsule lies in folds: bent, the hip does not draw it over the rim.
TEST_CASE("the capsule below the hip lets it bend") {
  const Body body = body_of({"right.hip_bone", "right.femur"});
  const int femur = find_bone(body.bones, "femur", Side::right);
  const Point centre = body.skeleton.joint_centre("hip", Side::right);
  const JointAxis& flexion = find_joint("hip")->axes.front();
  const auto piece =
      std::find_if(body.between.pieces.begin(), body.between.pieces.end(),
                   [](const Piece& p) { return p.name == "pelvis.right.capsule_inferior"; });
  REQUIRE(piece != body.between.pieces.end());
  for (double degrees : {30.0, 60.0, 90.0, flexion.high}) {
    const fabrica::Mat3d turn = rotation_about(flexion.axis, degrees * std::numbers::pi / 180);
    CAPTURE(degrees);
    for (const auto& line : piece->lines)
      CHECK(stretch(body, *piece, line, femur, centre, turn) - slack(*piece) < 1.5);
  }
}
