#include "body/joints/layer.h"

#include <doctest/doctest.h>

using doctest::Approx;
using namespace fabrica::body;

namespace {

struct Sheet {
  std::vector<Point> nodes;
  std::vector<std::array<int, 4>> quads;
};

// n x n quads of 2 mm over x, y from 0, at height(x, y), seen from above or from below
template <class Height>
Sheet sheet(int n, double edge, bool up, Height height) {
  Sheet s;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      s.nodes.push_back({edge * i, edge * j, height(edge * i, edge * j)});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = i + (n + 1) * j, b = a + 1, c = b + n + 1, d = a + n + 1;
      s.quads.push_back(up ? std::array{a, b, c, d} : std::array{a, d, c, b});
    }
  return s;
}

LayerPlan plan_of(const Sheet& s, double thickness, std::vector<int>& all) {
  all.clear();
  for (int q = 0; q < int(s.quads.size()); ++q) all.push_back(q);
  LayerPlan plan{layer_normals(s.nodes, s.quads, all), {}};
  for (const auto& [node, normal] : plan.normal) plan.thickness[node] = thickness;
  return plan;
}

}  // namespace

TEST_CASE(
    "a layer fills half of the space of its joint, up to its bound and never less than it was") {
  const Sheet low = sheet(4, 2, true, [](double, double) { return 0.0; });
  const Sheet high = sheet(4, 2, false, [](double x, double) { return 1 + 0.5 * x; });
  std::vector<int> all;
  LayerPlan plan = plan_of(low, 0.6, all);
  CHECK(plan.normal.at(0).z == Approx(1));
  fill_room(low.nodes, low.quads, all, BoneSurface(high.nodes, high.quads), 0.1, 1.5, plan);
  const double tilt = 1 / std::sqrt(1.25);     // distance over height
  CHECK(plan.thickness.at(0) == Approx(0.6));  // where there is room for 0.4 alone
  CHECK(plan.thickness.at(2) == Approx(0.5 * (3 * tilt - 0.1)));
  CHECK(plan.thickness.at(4) == Approx(1.5));
}

// A knob of the other bone stands over the middle of a face, far from its nodes.
TEST_CASE("a layer leaves room for what the other bone has between its nodes") {
  const Sheet low = sheet(1, 8, true, [](double, double) { return 0.0; });
  const Sheet high =
      sheet(8, 1, false, [](double x, double y) { return x == 4 && y == 4 ? 1.5 : 4.0; });
  std::vector<int> all;
  LayerPlan lower = plan_of(low, 0.2, all);
  fill_room(low.nodes, low.quads, all, BoneSurface(high.nodes, high.quads), 0.1, 2, lower);
  LayerPlan upper = plan_of(high, 0.2, all);
  fill_room(high.nodes, high.quads, all, BoneSurface(low.nodes, low.quads), 0.1, 2, upper);
  double middle = 0;
  for (const auto& [node, thickness] : lower.thickness) middle += thickness / 4;
  const double knob = upper.thickness.at(4 + 9 * 4);
  CHECK(knob == Approx(0.7));
  CHECK(middle == Approx(0.7));
  CHECK(middle + knob <= 1.5 - 0.1 + 1e-9);
}

// faces of a row of squares: 0 and 1 share an edge with each other, 3 and 4 too, 6 stands alone
TEST_CASE("a face that stands alone beside a layer is left out of it") {
  std::vector<std::array<int, 4>> surface;
  for (int i = 0; i < 8; ++i) surface.push_back({2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
  std::vector<int> quads{0, 1, 3, 4, 6};
  leave_out_tiles(surface, quads);
  CHECK(quads == std::vector<int>{0, 1, 3, 4});
  quads = {0, 2, 4, 5};  // as many alone as together: no layer to be beside
  leave_out_tiles(surface, quads);
  CHECK(quads == std::vector<int>{0, 2, 4, 5});
}
