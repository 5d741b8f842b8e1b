#include "material/law_test.h"

namespace fabrica {
namespace {

TEST_CASE("057: the loading curve is returned, without lateral stress") {
  const Samples samples;
  const auto m = LowDensityFoam::from(samples.foam);
  // compression by 30 %: .0001 + (.2/.4) .0001; the cross-section does not change
  CHECK(near(total_stress(m, diagonal(0.7, 1, 1)).xx, -0.00015, 1e-6));
  CHECK(total_stress(m, diagonal(0.7, 1, 1)).yy == 0);
  // with lateral compression: nominal stress over the shrunk area
  CHECK(near(total_stress(m, diagonal(0.7, 0.8, 1)).xx, -0.00015 / 0.8, 1e-6));
  CHECK(near(total_stress(m, diagonal(1.2, 1, 1)).xx, 0.0002, 1e-6));
}

TEST_CASE("057: tension is cut off, and torn where FAIL says so") {
  for (const double fail : {0.0, 1.0}) {
    TestParameters p{{"ro", 5e-8}, {"e", .001}, {"hu", 1}, {"tc", 1e-4}, {"fail", fail}};
    p.set_curve("lcid", Samples::foam_points());
    const auto m = LowDensityFoam::from(p);
    auto state = fresh_state<LowDensityFoam>();
    auto point = fresh_point(m, 1, 1.5);
    const double beyond = m.stress(diagonal(1.5, 1, 1), point, state).xx;
    auto back = fresh_point(m, 1, 1.05);
    const double later = m.stress(diagonal(1.05, 1, 1), back, state).xx;
    if (fail > 0) {
      CHECK(beyond == 0);
      CHECK(later == 0);
    } else {
      CHECK(near(beyond, 1e-4, 1e-6));
      CHECK(near(later, 5e-5, 1e-6));
    }
  }
}

// One cycle to strain .6 returns HU + (1 - HU) / (1 + SHAPE) of the work of loading.
TEST_CASE("057: energy of a cycle, and no jump where unloading begins") {
  for (const double shape : {1.0, 4.0}) {
    TestParameters p{{"ro", 5e-8}, {"e", .001}, {"hu", .2}, {"shape", shape}};
    p.set_curve("lcid", Samples::foam_points());
    const auto m = LowDensityFoam::from(p);
    auto state = fresh_state<LowDensityFoam>();
    const int n = 20000;
    double work = 0, returned = 0, last = 0, peak = 0, jump = 0;
    for (int i = 1; i <= 2 * n; ++i) {
      const double e = 0.6 * (i <= n ? i : 2 * n - i) / n;
      auto point = fresh_point(m, 1, 1 - e);
      const double tau = -m.stress(diagonal(1 - e, 1, 1), point, state).xx;
      const double part = 0.5 * (tau + last) * 0.6 / n;
      (i <= n ? work : returned) += part;
      peak = std::max(peak, tau);
      if (i == n + 1) jump = std::abs(tau - last);
      last = tau;
    }
    CHECK(near(work, 0.5e-5 + 0.6e-4 + 0.5 * 0.1 * (0.0002 + 0.0002 + 0.1 * 0.0008 / 0.3), 2e-6));
    CHECK(near(returned / work, 0.2 + 0.8 / (1 + shape), 2e-6));
    CHECK(jump < 1e-3 * peak);
  }
}

TEST_CASE("057: BETA lets the foam forget its peak") {
  TestParameters p{{"ro", 5e-8}, {"e", .001}, {"hu", .2}, {"shape", 1}, {"beta", .1}};
  p.set_curve("lcid", Samples::foam_points());
  const auto m = LowDensityFoam::from(p);
  auto state = fresh_state<LowDensityFoam>();
  auto point = fresh_point(m, 1, 0.5);
  m.stress(diagonal(0.5, 1, 1), point, state);
  const double peak = state.peak;
  auto later = fresh_point(m, 20, 1);
  m.stress(diagonal(1, 1, 1), later, state);
  CHECK(near(state.peak, peak * std::exp(-2.0), 1e-6));
}

// uniaxial strain rate r: DAMP sqrt(E rho) l r, and the branch ED (1 - e^(-BETA1 t)) / BETA1 r
TEST_CASE("057: viscous stresses") {
  const Samples samples;
  const auto m = ViscousLowDensityFoam::from(samples.foam_viscous);
  auto state = fresh_state<ViscousLowDensityFoam>();
  double sigma = 0;
  const double rate = 1e-6;
  for (int i = 1; i <= 100; ++i) {
    const double lam = std::exp(rate * i);
    auto point = fresh_point(m, 1, lam, 5);
    sigma = m.stress(diagonal(lam, 1, 1), point, state).xx;
  }
  const double spring = 0.001 * rate * 100, damper = 0.1 * std::sqrt(0.001 * 5e-8) * 5 * rate;
  const double branch = 0.001 * rate * (1 - std::exp(-10.0)) / 0.1;
  CHECK(near(sigma, spring + damper + branch, 1e-4));
}

// fast: E1 + E2 act together; slow: the viscous branch carries V_t x rate
TEST_CASE("062: fast and slow limits") {
  const TestParameters p{{"ro", 5e-8}, {"e1", .02}, {"n1", 4}, {"v2", .05},
                         {"e2", .1},   {"n2", .2},  {"pr", 0}};
  const auto m = ViscousFoam::from(p);
  auto state = fresh_state<ViscousFoam>();
  const double V = 0.8, E = 0.02 * std::pow(V, -4), Vt = 0.05 * std::pow(0.2, 0.2);
  auto fast = fresh_point(m, 1e-9, V);
  Sym3<double> s = m.stress(no_stress(), Sym3<double>{-1e-3, 0, 0, 0, 0, 0}, fast, state);
  CHECK(near(s.xx, -1e-3 * (E + 0.1), 1e-6));
  CHECK(s.yy == 0);
  state = fresh_state<ViscousFoam>();
  s = no_stress();
  for (int i = 0; i < 1000; ++i) {
    auto slow = fresh_point(m, 0.1, V);
    s = m.stress(s, Sym3<double>{-1e-6, 0, 0, 0, 0, 0}, slow, state);
  }
  CHECK(near(state.viscous.xx, -Vt * 1e-5, 1e-6));
  CHECK(near(s.xx, -1e-3 * E - Vt * 1e-5, 1e-6));
}

TEST_CASE("063: crushing follows the curve, unloading is elastic, tension is cut off") {
  TestParameters p{{"ro", 5e-8}, {"e", .01}, {"pr", 0}, {"tsc", .0001}};
  p.set_curve("lcid", {{0, .0002}, {.5, .0004}, {.8, .002}});
  const auto m = CrushableFoam::from(p);
  auto state = fresh_state<CrushableFoam>();
  Sym3<double> s = no_stress();
  const int n = 1000;
  for (int i = 1; i <= n; ++i) {
    auto point = fresh_point(m, 1, 1 - 0.4 * i / n);
    s = m.stress(s, Sym3<double>{-0.4 / n, 0, 0, 0, 0, 0}, point, state);
  }
  CHECK(near(s.xx, -0.00036, 1e-6));
  auto point = fresh_point(m, 1, 0.61);
  s = m.stress(s, Sym3<double>{0.01, 0, 0, 0, 0, 0}, point, state);
  CHECK(near(s.xx, -0.00036 + 0.0001, 1e-6));
  s = m.stress(s, Sym3<double>{0.1, 0, 0, 0, 0, 0}, point, state);
  CHECK(near(s.xx, 0.0001, 1e-6));
}

}  // namespace
}  // namespace fabrica
