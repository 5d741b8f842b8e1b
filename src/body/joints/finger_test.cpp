#include <doctest/doctest.h>

#include "body/body.h"

using namespace fabrica::body;

// Cartilage lies between the bones of a finger wherever its joints stand, for none of them gets off
// the head that it glides around: a bone without cartilage and capsule would hang on nothing.
TEST_CASE("the bones of a bent finger hold together") {
  for (const char* finger : {"2", "4"})
    for (const double bend : {0.0, 0.5, 0.8, 1.0}) {
      BodyOptions options;
      const std::string name(finger);
      for (const char* bone : {"right.metacarpal%", "right.hand_phalanx%_proximal",
                               "right.hand_phalanx%_middle", "right.hand_phalanx%_distal"}) {
        std::string text = bone;
        options.only.push_back(text.replace(text.find('%'), 1, name));
      }
      for (const char* joint : {"mcp", "pip", "dip"}) {
        const double most = find_joint(joint + name)->axes.front().high;
        set_angle(options.posture, joint + name + ".right.flexion", bend * most);
      }
      const Body body = build_body(options);
      CAPTURE(finger);
      CAPTURE(bend);
      CHECK(unconnected(body.bones, body.between).empty());
      CHECK(body.joined.clearance.left.empty());
    }
}
