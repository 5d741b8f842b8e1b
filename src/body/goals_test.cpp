#include "body/goals.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "body/skeleton.h"

using namespace fabrica::body;

namespace {

Goals goals_of(const std::string& text) {
  const std::string path =
      (std::filesystem::temp_directory_path() / "fabrica_goals_test.toml").string();
  std::ofstream(path) << text;
  const Goals goals = read_goals(path);
  std::remove(path.c_str());
  return goals;
}

const char* const car = R"(
h_point = [100, 0, 250]
torso_angle = 25
head_level = true
[wheel]
centre = [505, 0, 580]
diameter = 370
tilt = 25
hands = [60, -60]
[foot.right]
heel = [850, -130, 40]
ball = [950, -140, 160]
[foot.left]
heel = [850, 130, 40]
)";

}  // namespace

TEST_CASE("a driver holds the wheel, stands on the floor and sits as asked, within all ranges") {
  const Subject man = make_subject("male", 1750, 77);
  Posture posture = named_posture("driver");
  const Goals goals = goals_of(car);
  solve(posture, man, goals);
  const Skeleton skeleton(man, posture);  // throws where an angle is out of its range
  const Point h =
      0.5 * (skeleton.joint_centre("hip", Side::right) + skeleton.joint_centre("hip", Side::left));
  CHECK(norm(h - Point{100, 0, 250}) < 1e-9);
  const Point c7 = skeleton.joint_centre("C7") - h;
  CHECK(std::atan2(-c7.x, c7.z) * 57.29578 == doctest::Approx(25).epsilon(0.001));
  CHECK(std::abs(std::atan2(skeleton.frame("head").R(0, 2), skeleton.frame("head").R(2, 2))) *
            57.3 <
        1);
  for (const auto* list : {&goals.hands, &goals.feet})
    for (const Reach& g : *list) {
      const Point standing = g.side == Side::left ? mirror(g.standing) : g.standing;
      CAPTURE(g.name);
      CHECK(norm(skeleton.carried(g.frame, g.side, standing) - g.target) < 5);
    }
  CHECK(goals.hands.size() == 2);
  CHECK(goals.feet.size() == 3);
}

TEST_CASE("symmetric goals give a symmetric posture") {
  const Subject man = make_subject("male", 1750, 77);
  Posture posture = named_posture("driver");
  solve(
      posture, man,
      goals_of("[wheel]\ncentre = [400, 0, 330]\ndiameter = 370\ntilt = 25\nhands = [80, -80]\n"));
  const Skeleton s(man, posture);
  CHECK(norm(s.frame("hand", Side::right).t - mirror(s.frame("hand", Side::left).t)) < 1e-6);
}

TEST_CASE("a goal out of reach is refused with the nearest point that can be reached") {
  const Subject man = make_subject("male", 1750, 77);
  Posture posture = named_posture("driver");
  const Goals far = goals_of("[wheel]\ncentre = [1400, 0, 330]\ndiameter = 370\n");
  CHECK_THROWS_WITH(
      solve(posture, man, far),
      doctest::Contains("out of reach within the joint ranges; the nearest point is ["));
  CHECK_THROWS_WITH(solve(posture, man, goals_of("torso_angle = 120\n")),
                    doctest::Contains("the nearest is 95"));
}

TEST_CASE("a broken goals file is refused with its line and remedy") {
  CHECK_THROWS_WITH(goals_of("h_point = [1, 2]\n"),
                    doctest::Contains(":1: h_point must be a place such as"));
  CHECK_THROWS_WITH(goals_of("\nhpoint = 3\n"),
                    doctest::Contains(":2: hpoint is no goal here; there are h_point"));
  CHECK_THROWS_WITH(goals_of("[wheel]\ndiameter = 3\n"), doctest::Contains("lacks 'centre'"));
  CHECK_THROWS_WITH(goals_of("h_point = \n"), doctest::Contains("write key = value"));
}
