#include "material/law_test.h"

namespace fabrica {
namespace {

// Uniaxial Cauchy stress of W = A (I1 - 3) + B (I2 - 3) + C (1/I3^2 - 1) + D (I3 - 1)^2 with free
// sides, from
//   J sigma_i = 2 (lam_i^2 (W1 + I1 W2) - lam_i^4 W2 + I3 W3),  C = A/2 + B,
//   D = (A (5 nu - 2) + B (11 nu - 5)) / (2 (1 - 2 nu))
double mooney_reference(double A, double B, double nu, double lam) {
  const double C = A / 2 + B, D = (A * (5 * nu - 2) + B * (11 * nu - 5)) / (2 * (1 - 2 * nu));
  auto sigma = [&](double l, double t, double own) {
    const double I1 = l * l + 2 * t * t, I3 = l * l * t * t * t * t;
    const double W3 = -2 * C / (I3 * I3 * I3) + 2 * D * (I3 - 1);
    return 2 * (own * own * (A + I1 * B) - own * own * own * own * B + I3 * W3) / std::sqrt(I3);
  };
  double low = 0.5 / std::sqrt(lam), high = 1.5 / std::sqrt(lam);
  for (int i = 0; i < 100; ++i) {
    const double t = 0.5 * (low + high);
    (sigma(lam, t, t) > 0 ? high : low) = t;
  }
  return sigma(lam, low, lam);
}

// V79. A = .4, B = .1, nu = .495; reference: solution of the compressible uniaxial problem, 3.13869
// (J = 1.00349), 1.4726, -2.0868; tolerances: half a unit of the last digit given
TEST_CASE("027: uniaxial tension and compression") {
  const auto m =
      MooneyRivlin::from(TestParameters{{"ro", 1e-6}, {"a", .4}, {"b", .1}, {"pr", .495}});
  double lateral = 0;
  CHECK(near(free_uniaxial(m, 2, lateral), 3.13869, 2e-6));
  CHECK(near(2 * lateral * lateral, 1.00349, 3e-6));
  CHECK(near(free_uniaxial(m, 1.5, lateral), 1.4726, 4e-5));
  CHECK(near(free_uniaxial(m, 0.5, lateral), -2.0868, 4e-5));
  for (const double lam : {2.0, 1.5, 0.5})
    CHECK(near(free_uniaxial(m, lam, lateral), mooney_reference(.4, .1, .495, lam), 1e-6));
  // towards incompressibility: 2 (lam^2 - 1/lam) (A + B/lam) = 3.150
  const auto stiff =
      MooneyRivlin::from(TestParameters{{"ro", 1e-6}, {"a", .4}, {"b", .1}, {"pr", .49999}});
  CHECK(near(free_uniaxial(stiff, 2, lateral), 3.150, 2e-5));
}

TEST_CASE("027: the constants are recovered from a curve they made") {
  TestParameters p{{"ro", 1e-6}, {"pr", .495}, {"sgl", 10}, {"sw", 2}, {"st", 3}};
  TestParameters::Points points;
  for (double lam = 0.6; lam < 3; lam += 0.1)
    points.push_back({10 * (lam - 1), 6 * 2 * (lam - 1 / (lam * lam)) * (0.4 + 0.1 / lam)});
  p.set_curve("lcid", points);
  const auto m = MooneyRivlin::from(p);
  CHECK(near(m.A, 0.4, 2e-6));
  CHECK(near(m.B, 0.1, 1e-5));
}

// V81. mu = .63, .0012, -.01, alpha = 1.3, 5, -2: nominal stress sum mu (lam^(a-1) - lam^(-a/2-1))
// of the incompressible rubber; .401617, .602722, 1.207971 to the digits given
TEST_CASE("077: uniaxial nominal stress") {
  const auto m = Ogden::from(TestParameters{{"ro", 1e-6},
                                            {"pr", .49999},
                                            {"mu1", .63},
                                            {"mu2", .0012},
                                            {"mu3", -.01},
                                            {"alpha1", 1.3},
                                            {"alpha2", 5},
                                            {"alpha3", -2}});
  const double reference[3] = {.401617, .602722, 1.207971}, stretch[3] = {1.5, 2, 4};
  for (int i = 0; i < 3; ++i) {
    double lateral = 0;
    const double sigma = free_uniaxial(m, stretch[i], lateral);
    CHECK(near(sigma * lateral * lateral, reference[i], 1e-3));
    // the deviatoric difference does not depend on K: tau_1 - tau_2 at isochoric stretches
    const Sym3<double> s =
        total_stress(m, diagonal(stretch[i], 1 / std::sqrt(stretch[i]), 1 / std::sqrt(stretch[i])));
    double sum = 0;
    for (const auto& [mu, alpha] : {std::pair{.63, 1.3}, {.0012, 5.0}, {-.01, -2.0}})
      sum += mu * (std::pow(stretch[i], alpha - 1) - std::pow(stretch[i], -0.5 * alpha - 1));
    CHECK(std::abs(sum - reference[i]) < 0.6e-6);
    CHECK(near((s.xx - s.yy) / stretch[i], sum, 1e-6));
  }
}

TEST_CASE("077: a curve fit is refused in clear words") {
  const TestParameters p{{"ro", 1e-6}, {"pr", .49}, {"n", 2}, {"mu1", 1}, {"alpha1", 2}};
  CHECK_THROWS_AS(Ogden::from(p), std::invalid_argument);
}

// A held simple shear: the extra stress fades as sum G_i e^(-beta_i t) x its value after a fast
// step.
TEST_CASE("077: viscous branches fade with their own rates") {
  TestParameters p{{"ro", 1e-6}, {"pr", .49}, {"mu1", 1}, {"alpha1", 2}};
  p.add_row({{"gi", .3}, {"betai", .5}}).add_row({{"gi", .1}, {"betai", 2}});
  const auto m = ViscousOgden::from(p);
  auto state = fresh_state<ViscousOgden>();
  Mat3<double> F = identity3<double>();
  F.a[0][1] = 1e-4;
  auto fast = fresh_point(m, 1e-9);
  const double start = m.stress(F, fast, state).xy;
  CHECK(near(start, 1e-4 * (1 + 0.3 + 0.1), 1e-5));
  auto later = fresh_point(m, 1.5);
  const double end = m.stress(F, later, state).xy;
  CHECK(near(end, 1e-4 * (1 + 0.3 * std::exp(-0.75) + 0.1 * std::exp(-3.0)), 1e-5));
}

// The polynomial with every term, at a stretch that keeps the volume: x = lam^2 + 2/lam - 3,
// y = 2 lam + lam^-2 - 3, sigma_1 - sigma_2 = 2 (lam^2 - 1/lam) (Wx + Wy/lam). Rivlin and Saunders.
TEST_CASE("077_H: uniaxial stretches without change of volume") {
  const auto m = HyperelasticRubber::from(Samples().hyperelastic);
  for (const double lam : {0.4, 0.8, 1.3, 2.0, 3.0}) {
    const double lateral = 1 / std::sqrt(lam);
    const double x = lam * lam + 2 / lam - 3, y = 2 * lam + 1 / (lam * lam) - 3;
    const double Wx = .1 + .6 * y + 2 * .05 * x + 3 * .01 * x * x, Wy = .45 + .6 * x + 2 * .02 * y;
    const Sym3<double> s = total_stress(m, diagonal(lam, lateral, lateral));
    CHECK(near(s.xx - s.yy, 2 * (lam * lam - 1 / lam) * (Wx + Wy / lam), 2e-6));
    CHECK(std::abs(s.xx + s.yy + s.zz) < 1e-9 * std::abs(s.xx - s.yy));
  }
}

// Simple shear by gamma: x = y = gamma^2, sigma_xy = 2 gamma (Wx + Wy),
// sigma_xx - sigma_yy = gamma sigma_xy (Rivlin's universal relation),
// sigma_zz - sigma_yy = 2 gamma^2 Wy. Free volume change: sigma = K (J - 1).
TEST_CASE("077_H: simple shear and dilation") {
  const auto m = HyperelasticRubber::from(Samples().hyperelastic);
  for (const double gamma : {1e-3, 0.2, 1.0}) {
    Mat3<double> F = identity3<double>();
    F.a[0][1] = gamma;
    const double x = gamma * gamma;
    const double Wx = .1 + .6 * x + 2 * .05 * x + 3 * .01 * x * x, Wy = .45 + .6 * x + 2 * .02 * x;
    const Sym3<double> s = total_stress(m, F);
    CHECK(near(s.xy, 2 * gamma * (Wx + Wy), 2e-6));
    CHECK(near(s.xx - s.yy, gamma * s.xy, 2e-6));
    CHECK(near(s.zz - s.yy, 2 * x * Wy, 2e-6));
  }
  const double G = 2 * (.1 + .45), K = 2 * G * (1 + .45) / (3 * (1 - 2 * .45));
  const Sym3<double> s = total_stress(m, diagonal(1.1, 1.1, 1.1));
  CHECK(near(s.xx, K * (1.1 * 1.1 * 1.1 - 1), 2e-6));
  CHECK(near(s.yy, s.xx, 1e-12));
  CHECK(std::abs(s.xy) < 1e-15);
}

TEST_CASE("077_H: what is not supported is refused in clear words") {
  const auto from = [](std::initializer_list<std::pair<const std::string, double>> more) {
    TestParameters p{{"ro", 1e-6}, {"pr", .49}, {"c10", 1}, {"c01", .1}};
    for (const auto& [field, value] : more) p.set(field, value);
    HyperelasticRubber::from(p);
  };
  CHECK_NOTHROW(from({}));
  CHECK_THROWS_AS(from({{"n", 2}}), std::invalid_argument);
  CHECK_THROWS_AS(from({{"g", .1}}), std::invalid_argument);
  CHECK_THROWS_AS(from({{"c10", -.2}}), std::invalid_argument);
}

// sigma = (1/J) dW/dF F^T, by central differences of the energy
template <class M>
void check_energy_derivative(const M& m) {
  std::mt19937 random(4);
  for (int k = 0; k < 50; ++k) {
    const Mat3<double> F = random_gradient(random, 0.3);
    const double J = det(F), h = 1e-5;
    const Sym3<double> s = total_stress(m, F);
    const double sigma[3][3] = {{s.xx, s.xy, s.zx}, {s.xy, s.yy, s.yz}, {s.zx, s.yz, s.zz}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        Mat3<double> up = identity3<double>(), down = up;
        up.a[i][j] += h, down.a[i][j] -= h;
        const Mat3<double> A = up * F, B = down * F;
        const double slope = (m.energy(A, det(A)) - m.energy(B, det(B))) / (2 * h);
        CHECK(std::abs(slope / J - sigma[i][j]) < 1e-6 * (largest(s) + 0.1));
      }
  }
}

TEST_CASE("rubbers: stress is the derivative of the energy") {
  const Samples samples;
  check_energy_derivative(MooneyRivlin::from(samples.mooney));
  check_energy_derivative(Ogden::from(samples.ogden));
  check_energy_derivative(HyperelasticRubber::from(samples.hyperelastic));
}

// float lanes at strains of 1e-4: the linear answer stays good to float accuracy
TEST_CASE("rubbers: small strains do not cancel in float") {
  const Samples samples;
  auto check = [](const auto& m) {
    using M = std::decay_t<decltype(m)>;
    Mat3<float> F = identity3<float>();
    F.a[0][1] = 1e-4f;
    auto state = fresh_state<M, float>();
    auto point = fresh_point<float>(m, 1);
    CHECK(near(m.stress(F, point, state).xy, 1e-4 * m.elastic().shear, 1e-5));
  };
  check(MooneyRivlin::from(samples.mooney));
  check(Ogden::from(samples.ogden));
  check(HyperelasticRubber::from(samples.hyperelastic));
}

}  // namespace
}  // namespace fabrica
