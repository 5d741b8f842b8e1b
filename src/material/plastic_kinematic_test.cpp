#include "material/law_test.h"

namespace fabrica {
namespace {

// Uniaxial stress over a strain path in `steps` equal parts; the sides are found by the adaptor,
// from the law's own fibre form (own = true) or from its three-dimensional form.
template <class M>
double pull(const M& m, typename M::template State<double>& state, Sym3<double>& s, double strain,
            double dt, int steps, bool own) {
  for (int i = 0; i < steps; ++i) {
    auto point = fresh_point(m, dt);
    Sym3<double> e{strain / steps, 0, 0, 0, 0, 0};
    s = own ? uniaxial(m, s, e.xx, 0.0, 0.0, 1.0, point, state)
            : detail::free_sides<12>(m, s, e, point, state);
  }
  return s.xx;
}

TestParameters steel(double beta) {
  return {{"ro", 7.8e-6}, {"e", 210}, {"pr", .3}, {"sigy", .3}, {"etan", 2.1}, {"beta", beta}};
}

const double tolerance = sizeof(Real) == 8 ? 1e-8 : 2e-6;

// sigma = SIGY + ETAN (eps - SIGY / E); reversed, the yield range is 2 SIGY (kinematic) or 2 sigma
// (isotropic)
template <class M>
void check_cycle(double beta, double reversed) {
  for (const bool own : {true, false})
    for (const int steps : {1, 100}) {
      const M m = M::from(steel(beta));
      auto state = fresh_state<M>();
      Sym3<double> s = no_stress();
      CHECK(near(pull(m, state, s, 0.01, 1, steps, own), 0.318, tolerance));
      CHECK(near(pull(m, state, s, -0.01, 1, steps, own), reversed, tolerance));
    }
}

TEST_CASE("003 and 024: uniaxial bilinear hardening and the reversed yield point") {
  check_cycle<PlasticKinematic>(0, -0.282 - 2.1 * (0.01 - 0.6 / 210));
  check_cycle<PlasticKinematic>(1, -0.318 - 2.1 * (0.01 - 0.636 / 210));
  check_cycle<PiecewiseLinearPlasticity>(0, -0.318 - 2.1 * (0.01 - 0.636 / 210));
}

// perfectly plastic flow at a steady rate: sigma = SIGY (1 + (r/C)^(1/P)), r = 100/s, C = 40/s, P =
// 5: 2.20112
template <class M>
void check_rate(TestParameters p, double axial_rate) {
  for (const bool own : {true, false}) {
    const M m = M::from(p);
    auto state = fresh_state<M>();
    Sym3<double> s = no_stress();
    const int steps = 200;
    const double dt = 1e-6;
    const double sigma = pull(m, state, s, axial_rate * dt * steps, dt, steps, own);
    CHECK(near(sigma, 0.3 * (1 + std::pow(2.5, 0.2)), tolerance));
    CHECK(near(sigma / 0.3, 2.20112, 3e-6));
  }
}

TEST_CASE("003 and 024: Cowper-Symonds") {
  const TestParameters viscoplastic{{"ro", 7.8e-6}, {"e", 210}, {"pr", .3}, {"sigy", .3}, {"vp", 1},
                                    {"src", 40},    {"srp", 5}, {"c", 40},  {"p", 5}};
  check_rate<PlasticKinematic>(viscoplastic, 100);
  check_rate<PiecewiseLinearPlasticity>(viscoplastic, 100);
  // VP = 0: the rate is sqrt(D:D) = sqrt(3/2) x the axial rate of flow at constant volume
  const TestParameters total{{"ro", 7.8e-6}, {"e", 210}, {"pr", .3}, {"sigy", .3},
                             {"src", 40},    {"srp", 5}, {"c", 40},  {"p", 5}};
  check_rate<PlasticKinematic>(total, 100 / std::sqrt(1.5));
  check_rate<PiecewiseLinearPlasticity>(total, 100 / std::sqrt(1.5));
  // VP = -1: the effective deviatoric rate is the axial rate
  const TestParameters deviatoric{{"ro", 7.8e-6}, {"e", 210}, {"pr", .3}, {"sigy", .3},
                                  {"vp", -1},     {"c", 40},  {"p", 5}};
  check_rate<PiecewiseLinearPlasticity>(deviatoric, 100);
}

// pulled by e_xx and e_yy and turned in its plane, the layer's greater principal strain is known
TEST_CASE("123: flows as 024 and fails at a strain in the plane") {
  TestParameters p{{"ro", 7.8e-6}, {"e", 210}, {"pr", .3}, {"sigy", .3}, {"etan", 2.1}};
  const auto plain = PiecewiseLinearPlasticity::from(p);
  p.set("epsmaj", 0.0201).set("numint", 1);
  const auto m = ModifiedPiecewiseLinearPlasticity::from(p);
  CHECK(!plain.may_fail());
  CHECK(m.may_fail());
  CHECK(m.layers_to_fail() == 1);
  auto state = fresh_state<ModifiedPiecewiseLinearPlasticity>();
  auto other = fresh_state<PiecewiseLinearPlasticity>();
  Sym3<double> s = no_stress(), t = s;
  // principal strains a, -a / 2 with a = 1e-3 a step, 30 degrees from the axes
  const double a = 1e-3, c = std::cos(M_PI / 6), d = std::sin(M_PI / 6);
  const Sym3<double> e{a * (c * c - d * d / 2), a * (d * d - c * c / 2), 0, 1.5 * a * c * d, 0, 0};
  for (int k = 1; k <= 25; ++k) {
    auto point = fresh_point(m, 1), beside = fresh_point(plain, 1);
    double dzz = 0, zz = 0;
    s = m.plane_stress(s, e, point, state, dzz);
    t = plain.plane_stress(t, e, beside, other, zz);
    CHECK(largest(s - t) == 0);
    CHECK(dzz == zz);
    CHECK((point.alive == 0) == (k > 20));
  }
  CHECK_THROWS_WITH(ModifiedPiecewiseLinearPlasticity::from(p.set("numint", -50)),
                    doctest::Contains("NUMINT"));
}

TEST_CASE("024: yield stress from a curve, from points, from a table and with a rate curve") {
  auto flow_stress = [](const TestParameters& p, double strain, double dt) {
    const auto m = PiecewiseLinearPlasticity::from(p);
    auto state = fresh_state<PiecewiseLinearPlasticity>();
    Sym3<double> s = no_stress();
    const double sigma = pull(m, state, s, strain, dt, 200, true);
    return std::pair(sigma, state.plastic_strain);
  };
  // ep + sigma(ep) / E = eps with sigma = .36 + 1.5 (ep - .01)
  const double ep = (0.03 - 0.345 / 210) / (1 + 1.5 / 210);
  TestParameters curve{{"ro", 7.8e-6}, {"e", 210}, {"pr", .3}};
  curve.set_curve("lcss", {{0, .3}, {.01, .36}, {.05, .42}, {.2, .5}});
  TestParameters points{{"ro", 7.8e-6}, {"e", 210},    {"pr", .3},   {"eps1", 0},
                        {"es1", .3},    {"eps2", .01}, {"es2", .36}, {"eps3", .05},
                        {"es3", .42},   {"eps4", .2},  {"es4", .5}};
  for (const auto& p : {curve, points}) {
    const auto [sigma, plastic] = flow_stress(p, 0.03, 1);
    CHECK(near(sigma, 0.36 + 1.5 * (ep - 0.01), tolerance));
    CHECK(near(plastic, ep, tolerance));
  }
  // a table of constants at rates 1 and 100, logarithmic: the mean at 10
  TestParameters table{{"ro", 7.8e-6}, {"e", 210}, {"pr", .3}, {"vp", 1}};
  table.set_table(
      "lcss", {{std::log(1.0), {{0, .3}, {1, .3}}}, {std::log(100.0), {{0, .5}, {1, .5}}}}, true);
  CHECK(near(flow_stress(table, 0.02, 0.02 / 200 / 10).first, 0.4, tolerance));
  TestParameters factor{{"ro", 7.8e-6}, {"e", 210}, {"pr", .3}, {"sigy", .3}, {"vp", 1}};
  factor.set_curve("lcsr", {{0, 1}, {20, 2}});
  CHECK(near(flow_stress(factor, 0.02, 0.02 / 200 / 10).first, 0.45, tolerance));
}

TEST_CASE("003 and 024: a point fails where its plastic strain passes the limit") {
  const TestParameters p{{"ro", 7.8e-6}, {"e", 210},  {"pr", .3},
                         {"sigy", .3},   {"fs", .01}, {"fail", .01}};
  auto check = [&](const auto& m) {
    using M = std::decay_t<decltype(m)>;
    auto state = fresh_state<M>();
    Sym3<double> s = no_stress();
    for (int i = 1; i <= 40; ++i) {
      auto point = fresh_point(m, 1);
      s = m.stress(s, Sym3<double>{0, 0, 0, 0.0005, 0, 0}, point, state);
      CHECK((point.alive == 0) == (state.plastic_strain > double(Real(0.01))));
    }
    CHECK(state.plastic_strain > 0.02);
  };
  check(PlasticKinematic::from(p));
  check(PiecewiseLinearPlasticity::from(p));
}

}  // namespace
}  // namespace fabrica
