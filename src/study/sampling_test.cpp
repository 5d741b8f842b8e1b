#include "study/sampling.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "study/campaign.h"

using namespace fabrica::study;

TEST_CASE("a grid holds every combination once") {
  const auto points = grid({2, 3, 2});
  CHECK(points.size() == 12);
  CHECK(std::set<std::vector<std::size_t>>(points.begin(), points.end()).size() == 12);
  CHECK(points[0] == std::vector<std::size_t>{0, 0, 0});
  CHECK(points[1] == std::vector<std::size_t>{0, 0, 1});
  CHECK(points[11] == std::vector<std::size_t>{1, 2, 1});
}

TEST_CASE("a Latin hypercube has one point in each stretch of every axis") {
  const int samples = 40;
  const auto points = latin_hypercube(samples, 5, 7);
  for (std::size_t d = 0; d < 5; ++d) {
    std::set<int> stretches;
    for (const auto& p : points) {
      CHECK(p[d] >= 0);
      CHECK(p[d] < 1);
      stretches.insert(int(p[d] * samples));
    }
    CHECK(stretches.size() == samples);
  }
}

TEST_CASE("the seed alone decides the points of a hypercube") {
  CHECK(latin_hypercube(10, 3, 1) == latin_hypercube(10, 3, 1));
  CHECK(latin_hypercube(10, 3, 1) != latin_hypercube(10, 3, 2));
}

// Spearman: rho = 1 - 6 sum d^2 / (n (n^2 - 1)) without ties
TEST_CASE("rank correlation is that of Spearman's formula") {
  CHECK(rank_correlation({1, 2, 3, 4}, {10, 20, 30, 400}) == doctest::Approx(1));
  CHECK(rank_correlation({1, 2, 3, 4}, {4, 3, 2, 1}) == doctest::Approx(-1));
  CHECK(rank_correlation({1, 2, 3, 4, 5}, {2, 1, 4, 3, 5}) ==
        doctest::Approx(1 - 6.0 * 4 / (5 * 24)));
  // ranks 0, 1.5, 1.5, 3 against 0, 1, 2, 3: covariance 4.5, variances 4.5 and 5
  CHECK(rank_correlation({1, 2, 2, 3}, {1, 2, 3, 4}) ==
        doctest::Approx(4.5 / std::sqrt(4.5 * 5.0)));
  CHECK(mean_error({1.1, 0.8}, {1, 1}) == doctest::Approx(0.15));
}
