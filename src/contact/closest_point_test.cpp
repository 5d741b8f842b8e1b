#include "contact/closest_point.h"

#include <doctest/doctest.h>

#include <random>

#include "contact/candidate_search.h"

using namespace fabrica;

namespace {

// brute force over a fine grid of a bilinear quad
double grid_distance(const Vec3d* X, const Vec3d& x) {
  double best = 1e300;
  const int n = 400;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double r = -1 + 2.0 * i / n, s = -1 + 2.0 * j / n;
      const Vec3d p = (0.25 * (1 - r) * (1 - s)) * X[0] + (0.25 * (1 + r) * (1 - s)) * X[1] +
                      (0.25 * (1 + r) * (1 + s)) * X[2] + (0.25 * (1 - r) * (1 + s)) * X[3];
      best = std::min(best, norm(x - p));
    }
  return best;
}

}  // namespace

TEST_CASE("closest point of a warped quad agrees with a fine grid") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int trial = 0; trial < 60; ++trial) {
    Vec3d X[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    for (Vec3d& c : X) c += 0.2 * Vec3d{u(random), u(random), u(random)};
    const Vec3d x{1.8 * u(random), 1.8 * u(random), 0.5 * u(random)};
    const SurfacePoint p = closest_point_quad(X, x, 0, 0);
    Vec3d interpolated{0, 0, 0};
    double sum = 0;
    for (int i = 0; i < 4; ++i) interpolated += p.phi[i] * X[i], sum += p.phi[i];
    CHECK(sum == doctest::Approx(1).epsilon(1e-12));
    CHECK(norm(interpolated - p.x) < 1e-12);
    CHECK(norm(x - p.x) == doctest::Approx(grid_distance(X, x)).epsilon(2e-3));
  }
}

TEST_CASE("distance is continuous across edges and corners") {
  const Vec3d quad[4] = {{-1, -1, 0}, {1, -1, 0.1}, {1.2, 1, 0}, {-1, 1, 0.2}};
  const Vec3d triangle[4] = {{-1, -1, 0}, {1, -1, 0.1}, {1.2, 1, 0}, {1.2, 1, 0}};
  for (int path = 0; path < 4; ++path) {
    const Vec3d direction{std::cos(0.7 * path), std::sin(0.7 * path), 0.05};
    double last_quad = -1, last_triangle = -1;
    const double step = 1e-3;
    for (double t = -2; t < 2; t += step) {
      const Vec3d x = Vec3d{0.1, 0.2, 0.15} + t * direction;
      const double q = norm(x - closest_point_quad(quad, x, 0, 0).x);
      const double d = norm(x - closest_point_triangle(triangle, x).x);
      // a distance changes no faster than the point moves
      if (last_quad >= 0) CHECK(std::abs(q - last_quad) <= 1.01 * step * norm(direction));
      if (last_triangle >= 0) CHECK(std::abs(d - last_triangle) <= 1.01 * step * norm(direction));
      last_quad = q, last_triangle = d;
    }
  }
}

TEST_CASE("closest points of crossing and parallel edges") {
  const EdgePoints cross = closest_points_edges({-1, 0, 0.5}, {2, 0, 0}, {0.25, -1, 0}, {0, 4, 0});
  CHECK(cross.a == doctest::Approx(0.625));
  CHECK(cross.b == doctest::Approx(0.25));
  CHECK(norm(cross.gap) == doctest::Approx(0.5));
  const EdgePoints parallel = closest_points_edges({0, 0, 1}, {1, 0, 0}, {3, 0, 0}, {1, 0, 0});
  CHECK(norm(parallel.gap) == doctest::Approx(std::sqrt(5.0)));
}

TEST_CASE("the search finds exactly the pairs of brute force") {
  struct Odd : PairFilter {
    bool keep(int point, int box) const override { return (point + box) % 7 != 0; }
  } filter;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Vec3d> points(400);
    std::vector<BoundingBox> boxes(300);
    for (Vec3d& p : points) p = {10 * u(random), 5 * u(random), trial % 2 ? 0.0 : 3 * u(random)};
    for (BoundingBox& b : boxes) {
      b.low = {12 * u(random) - 1, 7 * u(random) - 1, 4 * u(random) - 1};
      const double size = u(random) < 0.05 ? 20 : 0.6;  // a few boxes hold nearly all
      b.high = b.low + Vec3d{size * u(random), size * u(random), size * u(random)};
    }
    const PointBoxPairs found = find_pairs(points, boxes, filter);
    std::vector<int> expected;
    std::size_t wrong = 0;
    for (int p = 0; p < 400; ++p) {
      expected.clear();
      for (int b = 0; b < 300; ++b)
        if (boxes[b].holds(points[p]) && filter.keep(p, b)) expected.push_back(b);
      wrong += expected != std::vector<int>(found.box.begin() + found.first[p],
                                            found.box.begin() + found.first[p + 1]);
    }
    CHECK(wrong == 0);
  }
}
