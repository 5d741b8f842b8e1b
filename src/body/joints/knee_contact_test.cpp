#include "body/joints/knee_contact.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "body/skeleton.h"
#include "body/tables.h"

using namespace fabrica::body;

namespace {

// the bones of a right knee and where they meet as it bends
struct BentKnee {
  BoneMesh femur, tibia, patella;
  KneeSurfaces surfaces{femur, tibia, patella, Side::right};
  Subject man = make_subject("male", 1750, 77);
  explicit BentKnee(Resolution resolution)
      : femur(mesh_bone({"femur", resolution})),
        tibia(mesh_bone({"tibia", resolution})),
        patella(mesh_bone({"patella", resolution})) {}
  Skeleton at(double flexion) const {
    Posture posture;
    set_angle(posture, "knee.right", flexion);
    return Skeleton(man, posture);
  }
  KneeContacts contacts(double flexion) const {
    const Skeleton s = at(flexion);
    return surfaces.contacts(s.frame("femur", Side::right), s.frame("tibia", Side::right),
                             s.frame("patella", Side::right));
  }
  // [mm] forward of where it is when standing, in the axes of the standing body
  double forward(const Point& now, const Point& standing) const {
    return (at(0).frame("tibia", Side::right).R * (now - standing)).x;
  }
};

// 2.2 mm of cartilage on the condyles, 2.6 on the plateau, 3.3 on the patella, 0.1 between
constexpr double tibiofemoral = 4.9, patellofemoral = 5.6;

}  // namespace

// What the path is made for, at its knots, which lie 10 and 7.8 degrees apart, and between them.
TEST_CASE("both condyles and the patella keep the room of their cartilage as the knee bends") {
  const BentKnee knee(Resolution::standard);
  for (double f = 0; f <= 140; f += 5) {
    CAPTURE(f);
    const KneeContacts k = knee.contacts(f);
    // up to 30 degrees the condyles go over from where they stand, less than 1 mm from there
    CHECK(std::abs(k.medial.gap - tibiofemoral) < 1);
    CHECK(std::abs(k.lateral.gap - tibiofemoral) < 1);
    CHECK(std::abs(k.medial_patella.gap - patellofemoral) < 1);
    CHECK(std::abs(k.lateral_patella.gap - patellofemoral) < 1);
  }
}

// Surfaces of coarse bones are off by up to their 95th percentile (docs/body/bones.md), both at
// once by its root of squares; no bone reaches into the other.
TEST_CASE("coarse condyles keep the room of their cartilage as well as their meshes do") {
  const BentKnee knee(Resolution::coarse);
  const double off = 1 + std::hypot(report(knee.femur).error_p95, report(knee.tibia).error_p95);
  CHECK(off < 3.5);
  for (double f = 0; f <= 140; f += 5) {
    CAPTURE(f);
    const KneeContacts k = knee.contacts(f);
    CHECK(std::abs(k.medial.gap - tibiofemoral) < off);
    CHECK(std::abs(k.lateral.gap - tibiofemoral) < off);
    CHECK(std::min(k.medial.gap, k.lateral.gap) > 1);
    CHECK(std::min(k.medial_patella.gap, k.lateral_patella.gap) > 1);
  }
}

// Freeman and Pinskerova 2003 (abstract): from 10 to 120 degrees the medial condyle turns about the
// centre of its circle and does not move to the front or back, the lateral one rolls back with
// inward rotation of the tibia. Walker 1988, whom the path follows: with 8.5 mm of the middle, 15.0
// degrees and 46 mm between the centres 8.5 +- 23 sin 15 = 2.5 mm medially, 14.5 mm laterally.
TEST_CASE("the lateral condyle rolls back and the medial one stays") {
  const BentKnee knee(Resolution::standard);
  const Point medial = posterior_condyle(knee.femur, true).centre,
              lateral = posterior_condyle(knee.femur, false).centre;
  const auto on_tibia = [&](double f, const Point& p) {
    const Skeleton s = knee.at(f);
    return s.frame("tibia", Side::right).inverse(s.frame("femur", Side::right)(p));
  };
  double last = 0;
  for (double f = 10; f <= 120; f += 10) {
    CAPTURE(f);
    CHECK(std::abs(knee.forward(on_tibia(f, medial), on_tibia(0, medial))) < 3);
    const double now = knee.forward(on_tibia(f, lateral), on_tibia(0, lateral));
    CHECK(now < last + 0.2);  // never forward
    last = now;
  }
  CHECK(last == doctest::Approx(-14.5).epsilon(0.05));
  // and the places of contact with them; the medial one from the anterior facet to the posterior
  const KneeContacts start = knee.contacts(0), end = knee.contacts(120);
  CHECK(knee.forward(end.lateral.place, start.lateral.place) < -15);
  CHECK(knee.forward(end.lateral.place, start.lateral.place) > -24);
  CHECK(knee.forward(end.medial.place, start.medial.place) < 0);
  CHECK(knee.forward(end.medial.place, start.medial.place) > -10);
}

// The axis of flexion and its centre: those of the spheres that fit the posterior condyles, whose
// radii are 17 to 23 mm in men.
TEST_CASE("the knee bends about the axis through its posterior condyles") {
  const BentKnee knee(Resolution::standard);
  const CondyleSphere medial = posterior_condyle(knee.femur, true),
                      lateral = posterior_condyle(knee.femur, false);
  for (const CondyleSphere& s : {medial, lateral}) {
    CHECK(s.radius > 17);
    CHECK(s.radius < 23);
  }
  const Placement femur = knee.at(0).frame("femur", Side::right);
  const Point a = femur(medial.centre), b = femur(lateral.centre);
  for (const Joint& joint : joint_tree()) {
    if (joint.name != "knee" && joint.name != "patella") continue;
    CHECK(norm(joint.centre - 0.5 * (a + b)) < 0.1);  // digits of the table
    CHECK(norm(joint.axes.front().axis - unit(a - b)) < 1e-3);
  }
}

// Invariance.
TEST_CASE("a left knee is the mirror image of the right one") {
  const BoneMesh femur = mesh_bone({"femur", Resolution::coarse}),
                 tibia = mesh_bone({"tibia", Resolution::coarse}),
                 patella = mesh_bone({"patella", Resolution::coarse});
  const BoneMesh left_femur = mirrored(femur), left_tibia = mirrored(tibia),
                 left_patella = mirrored(patella);
  Posture posture;
  set_angle(posture, "knee", 60);
  const Skeleton s(make_subject("male", 1750, 77), posture);
  const auto of = [&](const KneeSurfaces& k, Side side) {
    return k.contacts(s.frame("femur", side), s.frame("tibia", side), s.frame("patella", side));
  };
  const KneeContacts right = of(KneeSurfaces(femur, tibia, patella, Side::right), Side::right),
                     left = of(KneeSurfaces(left_femur, left_tibia, left_patella, Side::left),
                               Side::left);
  CHECK(left.medial.gap == doctest::Approx(right.medial.gap));
  CHECK(left.lateral.gap == doctest::Approx(right.lateral.gap));
  CHECK(norm(left.lateral.place - mirror(right.lateral.place)) < 1e-6);
  CHECK(left.medial_patella.gap == doctest::Approx(right.medial_patella.gap));
}
