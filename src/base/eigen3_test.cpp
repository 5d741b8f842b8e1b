#include "base/eigen3.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/pack.h"

namespace fabrica {
namespace {

template <class T>
void check_random(double spread) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const T unit = std::numeric_limits<T>::epsilon();
  T worst_rebuild = 0, worst_orthogonal = 0;
  for (int k = 0; k < 5000; ++k) {
    Sym3<T> s;
    for (int i = 0; i < 6; ++i) s[i] = T(uniform(random) * (i < 3 ? 1 : spread));
    // every third tensor has a double eigenvalue
    if (k % 3 == 0) {
      const Vec3<T> n{s.xx, s.yy, s.zz};
      s = {n.x * n.x + 1, n.y * n.y + 1, n.z * n.z + 1, n.x * n.y, n.y * n.z, n.z * n.x};
    }
    const Eigen3<T> e = eigen_symmetric(s);
    const Sym3<T> back = from_principal(e.value, e.vector);
    for (int i = 0; i < 6; ++i) worst_rebuild = std::max(worst_rebuild, std::abs(back[i] - s[i]));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        worst_orthogonal =
            std::max(worst_orthogonal, std::abs(dot(e.vector[i], e.vector[j]) - T(i == j)));
  }
  CHECK(worst_rebuild < 20 * unit);
  CHECK(worst_orthogonal < 20 * unit);
}

// s = sum of value n n with orthonormal n; also for nearly diagonal tensors, as small strains give
TEST_CASE("eigenvectors rebuild the tensor") {
  check_random<float>(1);
  check_random<double>(1);
  check_random<float>(1e-5);
  check_random<double>(1e-5);
}

TEST_CASE("eigenvalues of a known tensor, of the unit tensor and of zero") {
  // 2 on the diagonal, 1 beside it: 1, 1, 4
  const Eigen3<double> e = eigen_symmetric(Sym3<double>{2, 2, 2, 1, 1, 1});
  const double low = std::min({e.value.x, e.value.y, e.value.z}),
               high = std::max({e.value.x, e.value.y, e.value.z});
  CHECK(low == doctest::Approx(1).epsilon(1e-14));
  CHECK(high == doctest::Approx(4).epsilon(1e-14));
  CHECK(e.value.x + e.value.y + e.value.z == doctest::Approx(6).epsilon(1e-14));
  CHECK(eigen_symmetric(Sym3<double>{1, 1, 1, 0, 0, 0}).value.y == 1);
  CHECK(eigen_symmetric(Sym3<double>{0, 0, 0, 0, 0, 0}).value.y == 0);
}

TEST_CASE("eigenvalues: same bits for every width") {
  using P = Pack<float, 16>;
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(-1, 1);
  Sym3<P> s;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 16; ++j) set(s[i], j, uniform(random));
  const Eigen3<P> e = eigen_symmetric(s);
  for (int j = 0; j < 16; ++j) {
    Sym3<float> one;
    for (int i = 0; i < 6; ++i) one[i] = get(s[i], j);
    const Eigen3<float> r = eigen_symmetric(one);
    for (int i = 0; i < 3; ++i) {
      CHECK(r.value[i] == get(e.value[i], j));
      CHECK(r.vector[i].y == get(e.vector[i].y, j));
    }
  }
}

}  // namespace
}  // namespace fabrica
