#include "material/law_test.h"

namespace fabrica {
namespace {

const double tolerance = sizeof(Real) == 8 ? 1e-8 : 2e-6;

TestParameters bone() {
  TestParameters p{{"ro", 2e-6}, {"e", 17}, {"pr", .3}};
  p.set_curve("lcidc", {{0, .18}, {.02, .2}, {1, 1.18}});
  p.set_curve("lcidt", {{0, .11}, {.01, .12}, {1, 1.11}});
  return p;
}

// Uniaxial stress over a strain path in equal parts, in three dimensions or in plane stress.
template <class M>
double pull(const M& m, typename M::template State<double>& state, Sym3<double>& s, double strain,
            double dt, int steps, bool plane) {
  for (int i = 0; i < steps; ++i) {
    auto point = fresh_point(m, dt);
    Sym3<double> e{strain / steps, 0, 0, 0, 0, 0};
    if (!plane) {
      s = detail::free_sides<12>(m, s, e, point, state);
      continue;
    }
    // the width strain that leaves no stress, by bisection
    double low = -std::abs(e.xx), high = std::abs(e.xx);
    Sym3<double> now = s;
    auto end = state;
    for (int k = 0; k < 80; ++k) {
      const double yy = 0.5 * (low + high);
      end = state;
      double dzz = 0;
      now = plane_stress(m, s, e.xx, yy, 0.0, 0.0, 0.0, 1.0, point, end, dzz);
      (now.yy > 0 ? high : low) = yy;
    }
    s = now, state = end;
  }
  return s.xx;
}

// sigma on the curve of the sign: ep = eps - sigma / E
TEST_CASE("124: compression and tension follow their own curves") {
  const TestParameters p = bone();
  const auto m = PlasticityCompressionTension::from(p);
  for (const bool plane : {false, true})
    for (const int steps : {1, 40}) {
      auto state = fresh_state<PlasticityCompressionTension>();
      Sym3<double> s = no_stress();
      // 0.11 + ep on the first part of LCIDT, 0.18 + ep on the first of LCIDC
      const double pulled = pull(m, state, s, 0.01, 1, steps, plane);
      CHECK(pulled == doctest::Approx((0.11 + 0.01) / (1 + 1 / 17.0)).epsilon(tolerance));
      state = fresh_state<PlasticityCompressionTension>(), s = no_stress();
      const double pressed = pull(m, state, s, -0.02, 1, steps, plane);
      CHECK(pressed == doctest::Approx(-(0.18 + 0.02) / (1 + 1 / 17.0)).epsilon(tolerance));
    }
}

// a biaxial path under a mean stress between -PT and PC has a yield stress between the curves
TEST_CASE("124: between PC and PT the yield stress is interpolated by the pressure") {
  auto p = bone();
  p.set("pc", 0.04).set("pt", 0.04);
  const auto m = PlasticityCompressionTension::from(p);
  // shear alone: p = 0, half of both
  auto state = fresh_state<PlasticityCompressionTension>();
  auto point = fresh_point(m, 1);
  Sym3<double> strain = no_stress();
  strain.xy = 0.01;
  const Sym3<double> s = m.stress(no_stress(), strain, point, state);
  const double q = std::sqrt(3.0) * s.xy, G = 17 / 2.6;
  // q = 0.145 + ep, 3 G ep = q_trial - q
  const double trial = std::sqrt(3.0) * 2 * G * 0.01;
  const double ep = (trial - 0.145) / (3 * G + 1);
  CHECK(near(q, 0.145 + ep, 1e-5));
  // p = -0.02: three quarters of tension
  strain.xx = strain.yy = strain.zz = 0.02 / (17 / (3 * (1 - 0.6))) / 3;
  state = fresh_state<PlasticityCompressionTension>();
  const Sym3<double> t = m.stress(no_stress(), strain, point, state);
  const double start = 0.25 * 0.18 + 0.75 * 0.11, ept = (trial - start) / (3 * G + 1);
  CHECK(near(std::sqrt(3.0) * t.xy, start + ept, 1e-5));
}

// simple shear at a steady rate r: s = 2 G r t (or the yield stress over sqrt(3)) + sum 2 GI r (1 -
// e^(-BETAI t)) / BETAI
TEST_CASE("124: Maxwell branches stand beside the elastic and the plastic stress") {
  auto p = bone();
  p.add_row({{"gi", 2}, {"betai", 0.5}}).add_row({{"gi", 3}, {"betai", 20}});
  CHECK(!PlasticityCompressionTension::matches(p));
  const auto m = ViscousPlasticityCompressionTension::from(p);
  const double rate = 1e-3, dt = 0.01, G = 17 / 2.6;
  auto state = fresh_state<ViscousPlasticityCompressionTension>();
  Sym3<double> s = no_stress(), strain = no_stress();
  strain.xy = rate * dt;
  for (int i = 1; i <= 2000; ++i) {
    auto point = fresh_point(m, dt);
    s = m.stress(s, strain, point, state);
    CHECK(near(point.modulus, 17 / (3 * (1 - 0.6)) + 4.0 / 3 * (G + 5), tolerance));
    if (i != 300 && i != 2000) continue;
    const double t = i * dt;
    const double viscous =
        4 * rate * (1 - std::exp(-0.5 * t)) / 0.5 + 6 * rate * (1 - std::exp(-20 * t)) / 20;
    const double plastic = std::min(2 * G * rate * t, 1.0);
    if (i == 300) CHECK(near(s.xy, plastic + viscous, 1e-5));
    // no pressure is tension: q = 0.11 + ep to ep = 0.01, then 0.12 + (ep - 0.01)
    const double trial = std::sqrt(3.0) * 2 * G * rate * t, ep = (trial - 0.11) / (3 * G + 1);
    if (i == 2000) CHECK(near(s.xy, (0.11 + ep) / std::sqrt(3.0) + viscous, 1e-4));
  }
}

TEST_CASE("124: flow at a rate, failure, and what is refused") {
  auto p = bone();
  p.set("c", 40).set("p", 5).set("srflag", 1);
  const auto m = PlasticityCompressionTension::from(p);
  auto state = fresh_state<PlasticityCompressionTension>();
  Sym3<double> s = no_stress();
  // ep = 0.009 at the end: nearly all of the strain flows, at the axial rate of 100
  const double sigma = pull(m, state, s, 0.03, 0.03 / 100 / 300, 300, false);
  CHECK(near(sigma, (0.11 + state.plastic_strain) * (1 + std::pow(2.5, 0.2)), 2e-3));
  p.set("fail", 0.005);
  const auto brittle = PlasticityCompressionTension::from(p);
  CHECK(brittle.may_fail());
  auto point = fresh_point(brittle, 1);
  Sym3<double> strain = no_stress();
  strain.xy = 0.05;
  auto fresh = fresh_state<PlasticityCompressionTension>();
  brittle.stress(no_stress(), strain, point, fresh);
  CHECK(point.alive == 0);
  p.set("ec", 16.8);
  CHECK_NOTHROW(PlasticityCompressionTension::from(p));
  CHECK_THROWS_WITH(PlasticityCompressionTension::from(p.set("ec", 12)), doctest::Contains("EC"));
  CHECK_THROWS_WITH(PlasticityCompressionTension::from(bone().set("k", 1)), doctest::Contains("K"));
  TestParameters bare{{"ro", 2e-6}, {"e", 17}, {"pr", .3}};
  CHECK_THROWS_WITH(PlasticityCompressionTension::from(bare), doctest::Contains("LCIDC and LCIDT"));
}

}  // namespace
}  // namespace fabrica
