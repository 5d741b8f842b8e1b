#include "signal/corridor.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace fabrica;

namespace {

// half a turn of an ellipse from (0, 0) through its top to (a, 0)
Signal arch(double a, double b, int n) {
  Signal s{"arch", "kN", "mm", {}, {}};
  for (int i = 0; i <= n; ++i) {
    const double w = std::numbers::pi * i / n;
    s.x.push_back(0.5 * a * (1 - std::cos(w)));
    s.y.push_back(b * std::sin(w));
  }
  return s;
}

}  // namespace

// values 1, 2, 3: mean 2, sample SD 1
TEST_CASE("mean corridor: mean and deviation at each time") {
  std::vector<Signal> curves;
  for (const double v : {1.0, 2.0, 3.0})
    curves.push_back({"a", "kN", "ms", {0, 1, 2}, {0, v, 2 * v}});
  const Corridor c = mean_corridor(curves, 2);
  CHECK(c.mean.y[2] == 4);
  CHECK(std::abs(c.deviation_y[2] - 2) < 1e-12);
  CHECK(std::abs(c.high.y[1] - 4) < 1e-12);
  CHECK(c.low.y[1] == 0);
}

TEST_CASE("mean corridor: curves of other units and sampling are brought to those of the first") {
  const Signal a{"a", "kN", "ms", {0, 1, 2}, {0, 1, 2}}, b{"b", "N", "s", {0, 0.002}, {0, 2000}};
  const Corridor c = mean_corridor({a, b});
  CHECK(std::abs(c.mean.y[1] - 1) < 1e-12);
  CHECK(c.deviation_y[1] < 1e-12);
}

TEST_CASE(
    "arc-length average: of one loop sampled in different ways it is the loop, without spread") {
  const Corridor c = arc_length_corridor({arch(60, 3, 400), arch(60, 3, 150)}, 1, 101);
  CHECK(std::abs(c.mean.x[50] - 30) < 1e-2);
  CHECK(std::abs(c.mean.y[50] - 3) < 1e-3);
  CHECK(c.mean.x.back() == 60);
  CHECK(c.deviation_y[25] < 1e-3);
}

// loops of one shape, sizes 0.9 and 1.1: the average has size 1 and deviations 0.1 sqrt(2) of its
// coordinates
TEST_CASE(
    "arc-length average: of similar loops it is the mean loop, and turning back in x does not "
    "matter") {
  Signal small = arch(54, 2.7, 300), large = arch(66, 3.3, 300);
  for (Signal* s : {&small, &large}) {  // unload along a line back to the start
    s->x.push_back(0), s->y.push_back(0);
  }
  const Corridor c = arc_length_corridor({small, large}, 1, 401);
  const double expected = 0.1 * std::sqrt(2.0);
  double largest = 0;
  for (std::size_t i = 0; i < c.mean.size(); ++i)
    largest = std::max({largest, std::abs(c.deviation_x[i] - expected * std::abs(c.mean.x[i])),
                        std::abs(c.deviation_y[i] - expected * std::abs(c.mean.y[i]))});
  CHECK(largest < 1e-6);
  // at the top the normal points along y: the edges are one deviation above and below
  std::size_t top = 0;
  for (std::size_t i = 0; i < c.mean.size(); ++i)
    if (c.mean.y[i] > c.mean.y[top]) top = i;
  CHECK(std::abs(c.high.y[top] - c.mean.y[top] - expected * 3) < 0.01);
  CHECK(std::abs(c.low.y[top] - c.mean.y[top] + expected * 3) < 0.01);
}

TEST_CASE("a corridor of one curve is refused") {
  CHECK_THROWS_AS(mean_corridor({arch(1, 1, 5)}), SignalError);
  CHECK_THROWS_AS(arc_length_corridor({arch(1, 1, 5)}), SignalError);
}
