#include "body/joints/disc.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "body/body.h"
#include "body/mesh/quality.h"

using namespace fabrica::body;
using doctest::Approx;

namespace {

const Piece& piece(const Body& body, const std::string& name) {
  const auto& pieces = body.between.pieces;
  const auto at =
      std::find_if(pieces.begin(), pieces.end(), [&](const Piece& p) { return p.name == name; });
  REQUIRE(at != pieces.end());
  return *at;
}

Body lumbar_pair() {
  BodyOptions options;
  options.only = {"L3", "L4"};
  return build_body(options);
}

}  // namespace

// The fibres of a ring hold E times their share of its volume, k L^2 summed; half of them run
// within 6 degrees of the angles of the source, 45 degrees to the disc's plane inside, 30 outside.
TEST_CASE("the fibres of a disc have their volume, modulus and direction") {
  const Body body = lumbar_pair();
  const Point normal = [&] {
    const Piece& nucleus = piece(body, "abdomen.mid.disc_L3_L4.nucleus");
    Point up{0, 0, 0};
    for (const auto& brick : nucleus.bricks)
      for (std::size_t i = 0; i < 4; ++i)
        up += nucleus.nodes[std::size_t(brick[i + 4])].x - nucleus.nodes[std::size_t(brick[i])].x;
    return (1 / norm(up)) * up;
  }();
  const double modulus[] = {0.360, 0.550}, wanted[] = {45, 30};
  for (const int ring : {0, 1}) {
    const std::string number = std::to_string(ring + 1);
    const Piece& annulus = piece(body, "abdomen.mid.disc_L3_L4.annulus" + number);
    double volume = 0;
    for (const auto& brick : annulus.bricks) {
      Corners corners;
      for (std::size_t i = 0; i < 8; ++i) corners[i] = annulus.nodes[std::size_t(brick[i])].x;
      volume += volume_of(corners);
    }
    const Piece& fibres = piece(body, "abdomen.mid.disc_L3_L4.fibres" + number);
    double sum = 0;
    std::vector<double> miss;
    for (std::size_t i = 0; i < fibres.lines.size(); ++i) {
      const Point d = fibres.nodes[std::size_t(fibres.lines[i][0])].x -
                      fibres.nodes[std::size_t(fibres.lines[i][1])].x;
      sum += fibres.line_scale[i] * dot(d, d);
      miss.push_back(std::abs(
          std::asin(std::abs(dot(d, normal)) / norm(d)) * 180 / std::numbers::pi - wanted[ring]));
    }
    CHECK(sum == Approx(modulus[ring] * 0.16 * volume).epsilon(1e-6));
    std::sort(miss.begin(), miss.end());
    CHECK(miss[miss.size() / 2] < 6);
  }
}

// Between the endplates every node of a ring's outer face is the end of fibres, so that none bulges
// freely where the disc is pressed.
TEST_CASE("the fibres of a disc hold its bulge") {
  const Body body = lumbar_pair();
  for (const std::string number : {"1", "2"}) {
    const Piece& annulus = piece(body, "abdomen.mid.disc_L3_L4.annulus" + number);
    const Piece& fibres = piece(body, "abdomen.mid.disc_L3_L4.fibres" + number);
    std::vector<Point> middle;  // two bricks high: of the lower one above, outside
    for (std::size_t e = 0; e < annulus.bricks.size(); e += 2)
      middle.push_back(annulus.nodes[std::size_t(annulus.bricks[e][5])].x);
    REQUIRE(middle.size() > 8);
    for (const Point& p : middle) {
      int ends = 0;
      for (const auto& line : fibres.lines)
        for (const int end : line) ends += norm(fibres.nodes[std::size_t(end)].x - p) < 1e-9;
      CHECK(ends >= 2);
    }
  }
}

// Behind the toe the slope is that of the modulus; at its end, 4.1 % of the mean length outside,
// the force is the slope times the toe over 2.5.
TEST_CASE("the fibres of a disc have a toe") {
  const Body body = lumbar_pair();
  const Piece& fibres = piece(body, "abdomen.mid.disc_L3_L4.fibres2");
  double length = 0;
  for (const auto& line : fibres.lines)
    length += norm(fibres.nodes[std::size_t(line[0])].x - fibres.nodes[std::size_t(line[1])].x) /
              double(fibres.lines.size());
  const auto& curve = fibres.law.curve;
  const auto& toe = curve[curve.size() - 2];
  CHECK(toe.first == Approx(0.041 * length).epsilon(1e-6));
  CHECK(toe.second == Approx(toe.first / 2.5).epsilon(1e-6));
  const auto& far = curve.back();
  CHECK((far.second - toe.second) / (far.first - toe.first) == Approx(1));
  CHECK(curve.front().second == 0);
}
