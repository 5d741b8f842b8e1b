// Distances of surfaces known in closed form.
#include "body/mesh/distance_field.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace fabrica::body;

// |p|^2 / 20 - 5 has the level 0 of the sphere of radius 10; its distance is |p| - 10. Differences
// against the wind are off by s/2 sum |n_a| |d_aa|, at most s / (sqrt(3) r), along the way from 10
// to r: s / sqrt(3) |ln(r / 10)|. A plane for the sphere
// beside a point is off by up to s^2 / 2r, reading between points as much again.
TEST_CASE("a field with the right surface becomes its distance") {
  constexpr double spacing = 0.5;
  DistanceField field =
      DistanceField::of_function(Box{{-10, -10, -10}, {10, 10, 10}}, spacing, 6,
                                 [](const Point& p) { return dot(p, p) / 20 - 5; });
  const Point directions[] = {{1, 0, 0}, {0, -1, 0}, {0.6, 0, 0.8}, {-2.0 / 3, 1.0 / 3, 2.0 / 3}};
  CHECK(field.value(13.5 * directions[0]) > 4);
  field.measure_distance();
  for (const Point& direction : directions)
    for (const double distance : {-3.5, -2.0, -0.25, 0.0, 0.25, 2.0, 3.5}) {
      CAPTURE(distance);
      const double late = spacing / std::sqrt(3.0) * std::abs(std::log(1 + distance / 10));
      CHECK(std::abs(field.value((10 + distance) * direction) - distance) <
            late + spacing * spacing / 10);
    }
  CHECK(field.value({0, 0, 0}) == doctest::Approx(-8 * spacing));
  CHECK(field.value({0, 0, 15}) == doctest::Approx(8 * spacing));
}

// A round plate of radius 15 from z = 0 upwards beside a rod of radius 4 that goes on below, slices
// 2 mm apart: in the slice below the plate its centre is 21 mm from the rod, in that of its end 15
// mm inside, so that it ends at z = -2 * 15 / 36. Below that, distances in the slices stay at 21.
TEST_CASE("a flat end along the slices is as far as it is") {
  constexpr double spacing = 0.5;
  std::vector<Slice> slices;
  const auto circle = [](double x, double radius) {
    std::vector<std::array<double, 2>> loop;
    for (int i = 0; i < 72; ++i) {
      const double t = 2 * std::numbers::pi * i / 72;
      loop.push_back({x + radius * std::cos(t), radius * std::sin(t)});
    }
    return loop;
  };
  for (int height = -20; height <= 20; height += 2) {
    slices.push_back({double(height), {circle(-25, 4)}});
    if (height >= 0) slices.back().loops.push_back(circle(0, 15));
  }
  DistanceField field = DistanceField::of_slices(slices, Axes{}, spacing, 4);
  CHECK(field.value({0, 0, -4}) > 15);
  field.measure_distance();
  for (const double z : {-1.5, -2.5, -3.5})
    CHECK(std::abs(field.value({0, 0, z}) - (-30.0 / 36 - z)) < 0.5 * spacing);
}

// A ball of radius 11 beside a rod, slices 5 mm apart, the first within the ball e mm above its
// end. Between that slice and the next the end is anywhere: halfway is off by half their distance
// at most, and by what the grid reads. By the distance to the rod, 14 mm, it would end at the
// first.
TEST_CASE("a bulge that ends between two slices ends within half their distance of its end") {
  constexpr double spacing = 0.5, apart = 5, radius = 11;
  const auto circle = [](double x, double r) {
    std::vector<std::array<double, 2>> loop;
    for (int i = 0; i < 72; ++i) {
      const double t = 2 * std::numbers::pi * i / 72;
      loop.push_back({x + r * std::cos(t), r * std::sin(t)});
    }
    return loop;
  };
  for (const double e : {0.5, 2.0, 3.5, 4.9}) {
    CAPTURE(e);
    std::vector<Slice> slices;
    for (double height = e - 2 * apart; height < radius; height += apart) {
      slices.push_back({height, {circle(-30, 4)}});
      if (height > 0) slices.back().loops.push_back(circle(0, std::sqrt(height * (22 - height))));
    }
    const DistanceField field = DistanceField::of_slices(slices, Axes{}, spacing, 4, true);
    double end = e;  // lowest point of the ball on its axis, which lies at z = 0
    while (field.value({0, 0, end}) < 0) end -= 0.05;
    CHECK(std::abs(end) < apart / 2 + spacing / 2);
    const DistanceField linear = DistanceField::of_slices(slices, Axes{}, spacing, 4);
    if (e > 4) CHECK(linear.value({0, 0, (apart + spacing) / 2}) > 0);
  }
}
