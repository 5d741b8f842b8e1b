#include "material/law_test.h"

namespace fabrica {
namespace {

// Drives the volume from 1 to `end` in n steps; returns the pressure.
double compress(const Null& m, typename Null::State<double>& state, double end, int n) {
  Sym3<double> s = no_stress();
  auto start = fresh_point(m, 1, 1);
  s = m.stress(s, no_stress(), start, state);
  for (int i = 1; i <= n; ++i) {
    const double V = 1 + (end - 1) * i / n;
    auto point = fresh_point(m, 1, V);
    s = m.stress(s, no_stress(), point, state);
  }
  return -s.xx;
}

// C4 = C5 = gamma - 1 makes an ideal gas, p = (gamma - 1) e / V: p = p0 V^-gamma along an adiabat
TEST_CASE("009: adiabatic compression of an ideal gas") {
  const TestParameters material{{"ro", 1.2e-9}, {"pc", 0}};
  const TestParameters eos{{"c4", .4}, {"c5", .4}, {"e0", 2.5e-4}};
  const Null m = Null::from(material, &eos);
  auto state = fresh_state<Null>();
  const double p = compress(m, state, 0.5, 20000);
  CHECK(near(p, 1e-4 * std::pow(2, 1.4), 1e-6));
  // sound: rho c^2 = gamma p
  auto point = fresh_point(m, 1, 0.5);
  m.stress(Sym3<double>{-p, -p, -p, 0, 0, 0}, no_stress(), point, state);
  CHECK(near(point.modulus, 1.4 * p, 1e-5));
}

TEST_CASE("009: cubic compression, cut-off in tension, viscosity, failure") {
  const TestParameters material{{"ro", 1e-6}, {"pc", -.001}, {"mu", 1e-3}, {"terod", 1.1}};
  const TestParameters eos{{"c0", .01}, {"c1", 2}, {"c2", 3}, {"c3", 4}};
  const Null m = Null::from(material, &eos);
  auto state = fresh_state<Null>();
  const double mu = 1 / 0.9 - 1;
  CHECK(near(compress(m, state, 0.9, 10), .01 + 2 * mu + 3 * mu * mu + 4 * mu * mu * mu, 1e-6));
  state = fresh_state<Null>();
  CHECK(near(compress(m, state, 1.05, 10), -.001, 1e-6));
  state = fresh_state<Null>();
  auto point = fresh_point(m, 0.5, 1.2);
  const Sym3<double> s = m.stress(no_stress(), Sym3<double>{0, 0, 0, .01, 0, 0}, point, state);
  CHECK(near(s.xy, 2 * 1e-3 * .01 / .5, 1e-6));
  CHECK(point.alive == 0);
  CHECK(Null::from(material).stress(no_stress(), Sym3<double>{1, 0, 0, 0, 0, 0}, point, state).xx ==
        0);
}

TEST_CASE("elastic fluid: pressure, cavitation limit, viscosity") {
  const auto m =
      ElasticFluid::from(TestParameters{{"ro", 1e-6}, {"k", 2.2}, {"vc", .1}, {"cp", .001}});
  auto state = fresh_state<ElasticFluid>();
  auto point = fresh_point(m, 2, 1, 5);
  const Sym3<double> squeezed =
      m.stress(no_stress(), Sym3<double>{-.01, 0, 0, .02, 0, 0}, point, state);
  CHECK(near(trace(squeezed) / 3, -.022, 1e-6));
  CHECK(near(squeezed.xy, .1 * 5 * std::sqrt(2.2 * 1e-6) * .02 / 2, 1e-6));
  CHECK(near(trace(m.stress(no_stress(), Sym3<double>{.01, 0, 0, 0, 0, 0}, point, state)) / 3, .001,
             1e-6));
}

}  // namespace
}  // namespace fabrica
