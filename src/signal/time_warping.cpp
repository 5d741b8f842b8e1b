// D(i, j) = (a_i - b_j)^2 + min(D(i-1, j), D(i, j-1), D(i-1, j-1)).
// The two sums are carried along with D, so that no path has to be stored. Cells of one
// antidiagonal i + j = k do not depend on each other; cell (i, k - i) is kept at index i, of which
// three antidiagonals are needed at a time.
#include "signal/time_warping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fabrica {
namespace {

constexpr double unreached = std::numeric_limits<double>::infinity();

// one antidiagonal, by i; index 0 stands for i = -1
struct Diagonal {
  std::vector<double> cost, difference, reference;
  explicit Diagonal(long n)
      : cost(n + 2, unreached), difference(n + 2, 0.0), reference(n + 2, 0.0) {}
};

// Cells i = low ... high of antidiagonal k, from the two before it; `reversed` is b from its end to
// its start.
void advance(Diagonal& now, const Diagonal& before, const Diagonal& earlier, const double* a,
             const double* reversed, long low, long high) {
  const double *up = before.cost.data(), *left = before.cost.data() + 1,
               *corner = earlier.cost.data();
  const double *up_d = before.difference.data(), *left_d = up_d + 1,
               *corner_d = earlier.difference.data();
  const double *up_r = before.reference.data(), *left_r = up_r + 1,
               *corner_r = earlier.reference.data();
  double* cost = now.cost.data() + 1;
  double* difference = now.difference.data() + 1;
  double* reference = now.reference.data() + 1;
#pragma GCC ivdep
  for (long i = low; i <= high; ++i) {
    const double b = reversed[i], e = a[i] - b;
    const bool from_up = up[i] <= left[i];
    const double c1 = from_up ? up[i] : left[i];
    const double d1 = from_up ? up_d[i] : left_d[i];
    const double r1 = from_up ? up_r[i] : left_r[i];
    const bool straight = c1 <= corner[i];
    cost[i] = (straight ? c1 : corner[i]) + e * e;
    difference[i] = (straight ? d1 : corner_d[i]) + std::abs(e);
    reference[i] = (straight ? r1 : corner_r[i]) + std::abs(b);
  }
}

}  // namespace

WarpedSums warped_sums(std::span<const double> a, std::span<const double> b, long band) {
  const long n = long(a.size());
  Diagonal now(n), before(n), earlier(n);
  const std::vector<double> reversed(b.rbegin(), b.rend());
  now.cost[1] = (a[0] - b[0]) * (a[0] - b[0]);
  now.difference[1] = std::abs(a[0] - b[0]);
  now.reference[1] = std::abs(b[0]);
  for (long k = 1; k <= 2 * (n - 1); ++k) {
    std::swap(earlier, before);
    std::swap(before, now);
    // j = k - i within the curve, |i - j| = |2 i - k| < band
    const long low = std::max({0L, k - (n - 1), (k - band) / 2 + 1});
    const long high = std::min({n - 1, k, (k + band - 1) / 2});
    // reversed[n - 1 - j] = b[j] with j = k - i
    if (low <= high)
      advance(now, before, earlier, a.data(), reversed.data() + (n - 1 - k), low, high);
    // neighbours outside the band must not be taken for cells of this antidiagonal
    now.cost[low] = unreached;
    now.cost[high + 2] = unreached;
  }
  return {now.difference[n], now.reference[n]};
}

}  // namespace fabrica
