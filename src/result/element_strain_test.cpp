// Strain from positions against homogeneous deformations, whose strain is that of every element.
#include "result/element_strain.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "result/sample_test.h"

using namespace fabrica;

namespace {

template <int n>
void map(const double (&F)[3][3], const double (&X)[n][3], double (&x)[n][3]) {
  for (int a = 0; a < n; ++a)
    for (int i = 0; i < 3; ++i) x[a][i] = F[i][0] * X[a][0] + F[i][1] * X[a][1] + F[i][2] * X[a][2];
}

}  // namespace

// Simple shear by k: lam = k/2 + sqrt(1 + k^2/4); then a turn, which strains nothing
TEST_CASE("element strain: sheared and turned bricks, wedges and tetrahedra") {
  const double k = 0.4, lam = k / 2 + std::sqrt(1 + k * k / 4), c = std::cos(1.0),
               s = std::sin(1.0);
  const double F[3][3] = {{c, c * k - s, 0}, {s, s * k + c, 0}, {0, 0, 1}};
  const double brick[8][3] = {{0, 0, 0}, {2, 0, 0.1}, {2.2, 1, 0}, {0, 1, 0},
                              {0, 0, 3}, {2, 0.3, 3}, {2, 1, 3},   {0.1, 1, 3.2}};
  for (const auto& nodes :
       {std::array<int, 8>{0, 1, 2, 3, 4, 5, 6, 7}, std::array<int, 8>{0, 1, 2, 3, 4, 4, 5, 5},
        std::array<int, 8>{0, 1, 2, 5, 5, 5, 5, 5}, std::array<int, 8>{0, 1, 2, 3, 4, 4, 4, 4}}) {
    double X[8][3], x[8][3];
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) X[a][i] = brick[nodes[std::size_t(a)]][i];
    map(F, X, x);
    CHECK(solid_strain(X, x, StrainMeasure::logarithmic) ==
          doctest::Approx(std::log(lam)).epsilon(1e-12));
    CHECK(solid_strain(X, x, StrainMeasure::green) ==
          doctest::Approx((lam * lam - 1) / 2).epsilon(1e-12));
    CHECK(std::abs(solid_strain(X, X, StrainMeasure::green)) < 1e-14);
    CHECK(solid_volume(x) == doctest::Approx(solid_volume(X)).epsilon(1e-12));  // det F = 1
  }
}

TEST_CASE("element strain: volumes of a box, a wedge, a pyramid and a tetrahedron") {
  const double box[8][3] = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0},
                            {0, 0, 5}, {2, 0, 5}, {2, 3, 5}, {0, 3, 5}};
  CHECK(solid_volume(box) == doctest::Approx(30));
  const auto shape = [&](const std::array<int, 8>& nodes) {
    double X[8][3];
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) X[a][i] = box[nodes[std::size_t(a)]][i];
    return solid_volume(X);
  };
  CHECK(shape({0, 1, 2, 2, 4, 5, 6, 6}) == doctest::Approx(15));
  CHECK(shape({0, 1, 2, 3, 4, 4, 4, 4}) == doctest::Approx(10));
  CHECK(shape({0, 1, 2, 4, 4, 4, 4, 4}) == doctest::Approx(5));
}

// stretched by 1.2 along x and 0.9 along y, out of plane by a shear that lengthens x
TEST_CASE("element strain: membranes of quadrilaterals and triangles") {
  const double F[3][3] = {{1.2, 0, 0}, {0, 0.9, 0}, {0.5, 0, 1}}, lam2 = 1.2 * 1.2 + 0.5 * 0.5;
  const double quad[4][3] = {{0, 0, 0}, {2, 0.2, 0}, {1.9, 1, 0}, {0, 1.3, 0}},
               triangle[4][3] = {{0, 0, 0}, {2, 0.2, 0}, {1, 1, 0}, {1, 1, 0}};
  double x[4][3];
  map(F, quad, x);
  CHECK(shell_strain(quad, x, StrainMeasure::logarithmic) ==
        doctest::Approx(std::log(lam2) / 2).epsilon(1e-12));
  map(F, triangle, x);
  CHECK(shell_strain(triangle, x, StrainMeasure::green) ==
        doctest::Approx((lam2 - 1) / 2).epsilon(1e-12));
}

// of three states the second is stretched most; the tetrahedron is gone in it
TEST_CASE("element strain: the largest over the states in which an element lives") {
  const sample::Scratch scratch;
  const ResultMesh mesh = sample::mesh();
  {
    D3plotWriter out(scratch.file("d3plot"), mesh, D3plotOptions{});
    for (const double stretch : {1.0, 1.5, 1.25}) {
      AnimationState s = sample::state(mesh, stretch);
      s.position = mesh.position;
      for (std::size_t i = 0; i < s.position.size(); i += 3) s.position[i] *= float(stretch);
      s.solid_alive.assign(3, 1), s.solid_alive[1] = stretch != 1.5;
      out.write(s);
    }
  }
  const D3plotReader file(scratch.file("d3plot"));
  const PeakStrains all =
      peak_strains(file, std::vector<bool>(5, true), StrainMeasure::logarithmic);
  for (std::size_t e = 0; e < 3; ++e) {
    const bool tetrahedron = file.mesh().solid_id[e] == 10;
    CHECK(all.solid[e] == doctest::Approx(std::log(tetrahedron ? 1.25 : 1.5)).epsilon(1e-6));
    CHECK(all.solid_volume[e] == doctest::Approx(tetrahedron                     ? 1 / 6.0
                                                 : file.mesh().solid_id[e] == 30 ? 1.0
                                                                                 : 0.5)
                                     .epsilon(1e-6));
  }
  for (const double e : all.shell) CHECK(e == doctest::Approx(std::log(1.5)).epsilon(1e-6));
  const PeakStrains none = peak_strains(file, std::vector<bool>(5, false), StrainMeasure::green);
  CHECK(none.solid == std::vector<double>(3, 0.0));
}
