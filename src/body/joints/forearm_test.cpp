#include <doctest/doctest.h>

#include <algorithm>
#include <tuple>

#include "body/body.h"
#include "body/joints/cartilage.h"

using namespace fabrica::body;

namespace {

Body forearm() {
  BodyOptions options;
  options.only = {"right.humerus", "right.radius", "right.ulna"};
  return build_body(options);
}

}  // namespace

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
