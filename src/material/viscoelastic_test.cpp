#include "material/law_test.h"

namespace fabrica {
namespace {

// Deviatoric shear rate .01 to t = 5, then held to t = 50, G0 = .01, GI = .002, BETA = .1:
//   s12(5) = 2 (.01) (GI 5 + (G0 - GI)/BETA (1 - e^-.5)),   s12(50) = 2 (.01) (GI 5 + (G0 -
//   GI)/BETA (e^-4.5 - e^-5))
template <class M>
void check_ramp_and_hold(const M& m, int steps_per_unit) {
  auto state = fresh_state<M>();
  Sym3<double> s = no_stress();
  double at_5 = 0;
  for (int i = 1; i <= 50 * steps_per_unit; ++i) {
    auto point = fresh_point(m, 1.0 / steps_per_unit);
    const double rate = i <= 5 * steps_per_unit ? 0.01 : 0;
    s = m.stress(s, Sym3<double>{0, 0, 0, rate / steps_per_unit, 0, 0}, point, state);
    if (i == 5 * steps_per_unit) at_5 = s.xy;
  }
  const double tolerance = sizeof(Real) == 8 ? 1e-10 : 1e-6;
  const double G0 = 0.01, GI = 0.002, b = 0.1;
  CHECK(near(at_5, 0.02 * (GI * 5 + (G0 - GI) / b * (1 - std::exp(-0.5))), tolerance));
  CHECK(near(s.xy, 0.02 * (GI * 5 + (G0 - GI) / b * (std::exp(-4.5) - std::exp(-5.0))), tolerance));
  CHECK(near(at_5, 8.29551e-4, 1e-5));
  CHECK(near(s.xy, 2.06994e-4, 1e-5));
}

TEST_CASE("006 and 061: ramp and hold, for coarse and fine steps") {
  const TestParameters p{{"ro", 1e-6}, {"bulk", 1},  {"g0", .01},
                         {"gi", .002}, {"beta", .1}, {"dc", .1}};
  const TestParameters kelvin{{"ro", 1e-6}, {"bulk", 1}, {"g0", .01},
                              {"gi", .002}, {"dc", 10},  {"fo", 1}};
  for (const int steps : {1, 10, 1000}) {
    check_ramp_and_hold(Viscoelastic::from(p), steps);
    check_ramp_and_hold(KelvinMaxwell::from(p), steps);
    check_ramp_and_hold(KelvinMaxwell::from(kelvin), steps);
  }
}

TEST_CASE("006: the pressure is elastic") {
  const auto m = Viscoelastic::from(
      TestParameters{{"ro", 1e-6}, {"bulk", 2}, {"g0", .01}, {"gi", .002}, {"beta", .1}});
  auto state = fresh_state<Viscoelastic>();
  auto point = fresh_point(m, 1);
  const Sym3<double> s =
      m.stress(no_stress(), Sym3<double>{.001, .001, .001, 0, 0, 0}, point, state);
  CHECK(near(s.xx, 0.006, parameter_error));
  CHECK(near(s.zz, 0.006, parameter_error));
}

TEST_CASE("relaxation factor (1 - e^-x) / x") {
  for (const double x : {0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.49, 0.51, 2.0, 50.0, 1e8}) {
    double decay = 0;
    const double phi = relaxation(x, decay);
    CHECK(near(phi, x > 0 ? -std::expm1(-x) / x : 1.0, 1e-14));
    CHECK(std::abs(decay - std::exp(-x)) < 1e-15);
  }
}

}  // namespace
}  // namespace fabrica
