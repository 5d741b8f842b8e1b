#include "solver/partition.h"

#include <doctest/doctest.h>

#include <set>

using namespace fabrica;

namespace {
// points of a cube of n x n x n, numbered along the given axes: the first fastest
std::vector<Vec3d> cube(int n, int fast, int middle, int slow, double stretch = 1) {
  std::vector<Vec3d> x;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        Vec3d p{0, 0, 0};
        p[fast] = stretch * i, p[middle] = j, p[slow] = k;
        x.push_back(p);
      }
  return x;
}
}  // namespace

TEST_CASE("a cube is cut where its numbers are halved, however it is numbered") {
  const int axes[][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (const auto& a : axes) {
    const std::vector<Vec3d> x = cube(16, a[0], a[1], a[2]);
    const std::vector<int> order = compact_order(x, 256);
    REQUIRE(order.size() == x.size());
    CHECK(std::set<int>(order.begin(), order.end()).size() == x.size());
    int low = 0;
    for (int i = 0; i < 2048; ++i) low += order[i] < 2048;
    CHECK(low == 2048);
  }
}

TEST_CASE("a bar is cut across its length, whichever way it is numbered") {
  const std::vector<Vec3d> x = cube(16, 0, 1, 2, 3);
  const std::vector<int> order = compact_order(x, 256);
  for (int i = 0; i < 2048; ++i) CHECK(x[order[i]].x < 3 * 7.5);
}
