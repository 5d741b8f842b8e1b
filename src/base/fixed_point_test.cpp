#include "base/fixed_point.h"

#include <doctest/doctest.h>

#include "base/team.h"

using namespace fabrica;

// Sums of eighths are exact in fixed point, in any order and from any thread; taking all of them
// finds each entry that was added to, once, and leaves zeros.
TEST_CASE("fixed point: all sums are handed out once") {
  const std::size_t n = 1000;
  FixedVectors sums;
  sums.resize(n, FixedScale::of(10));
  Team team(3);
  for (int round = 0; round < 3; ++round) {
    // every seventh entry of the upper half, by all chunks
    team.for_each(16, [&](int chunk, int) {
      for (std::size_t i = n / 2; i < n; i += 7)
        sums.add(i, Vec3d{0.125 * chunk, -0.25 * double(i), 1});
    });
    std::vector<Vec3d> found(n, Vec3d{0, 0, 0});
    std::size_t visits = 0;
    for (std::size_t first = 0; first < n; first += 4 * FixedVectors::run)
      sums.take_all(first, std::min(n, first + 4 * FixedVectors::run),
                    [&](std::size_t i, const Vec3d& f) { found[i] += f, ++visits; });
    for (std::size_t i = 0; i < n; ++i) {
      const bool added = i >= n / 2 && (i - n / 2) % 7 == 0;
      CHECK(found[i].x == (added ? 0.125 * 120 : 0));
      CHECK(found[i].y == (added ? -0.25 * 16 * double(i) : 0));
      CHECK(found[i].z == (added ? 16 : 0));
      CHECK(norm(sums.get(i)) == 0);
    }
    CHECK(visits < n / 2 + 2 * FixedVectors::run);
  }
}
