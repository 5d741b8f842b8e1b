#include "material/plane_stress.h"

#include "material/law_test.h"

namespace fabrica {
namespace {

// plane stress: s = E / (1 - nu^2) (e_xx + nu e_yy), e_zz = -nu / (1 - nu) (e_xx + e_yy)
TEST_CASE("shells: elasticity is exact, by the law's own form and by the adaptor") {
  const auto m = ElasticLaw::from(TestParameters{{"ro", 7.8e-6}, {"e", 210}, {"pr", .3}});
  auto state = fresh_state<ElasticLaw>();
  auto point = fresh_point(m, 1);
  double dzz = 0;
  const Sym3<double> s =
      plane_stress(m, no_stress(), .001, -.0004, .0006, .0002, .0008, 0.5, point, state, dzz);
  Sym3<double> e{.001, -.0004, 0, .0003, .00005, .0002};
  const Sym3<double> general = detail::free_thickness<4>(m, no_stress(), e, point, state);
  const double c = 210 / (1 - 0.09), G = 210 / 2.6, tolerance = sizeof(Real) == 8 ? 1e-12 : 1e-6;
  const Sym3<double> exact{
      c * (.001 - .3 * .0004), c * (-.0004 + .3 * .001), 0, .0006 * G, .0001 * G, .0004 * G};
  for (int i = 0; i < 6; ++i) {
    CHECK(std::abs(s[i] - exact[i]) < tolerance * 0.3);
    CHECK(std::abs(general[i] - exact[i]) < tolerance * 0.3);
  }
  CHECK(s.zz == 0);
  CHECK(near(dzz, -.3 / .7 * .0006, tolerance));
  CHECK(near(e.zz, -.3 / .7 * .0006, tolerance));
}

// The closed plane stress form and the three-dimensional law with free thickness give the same
// step; across: transverse shear as a share of the rest.
template <class M>
void check_shell_is_solid(const M& m, double size, double dt, double across = 1) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-size, size);
  auto shell = fresh_state<M>(), solid = shell;
  Sym3<double> a = no_stress(), b = a;
  double worst = 0, worst_dzz = 0;
  for (int i = 0; i < 300; ++i) {
    auto point = fresh_point(m, dt);
    Sym3<double> e{uniform(random), uniform(random),          0,
                   uniform(random), across * uniform(random), across * uniform(random)};
    double dzz = 0;
    a = plane_stress(m, a, e.xx, e.yy, 2 * e.xy, 2 * e.yz, 2 * e.zx, 1.0, point, shell, dzz);
    b = detail::free_thickness<30>(m, b, e, point, solid);
    CHECK(a.zz == 0);
    worst = std::max(worst, largest(a - b));
    worst_dzz = std::max(worst_dzz, std::abs(dzz - e.zz));
  }
  // the solid's rates differ where the yield stress does not matter; J2 without rates agrees to its
  // convergence
  CHECK(worst < 1e-5 * 0.3);
  CHECK(worst_dzz < 1e-5 * size);
}

TEST_CASE("shells: the plastic step equals the solid's with free thickness") {
  const Samples samples;
  for (const double size : {1e-4, 1e-3, 1e-2}) {
    check_shell_is_solid(PlasticKinematic::from(samples.plastic), size, 1, 0);
    check_shell_is_solid(PiecewiseLinearPlasticity::from(samples.plastic), size, 1);
  }
  check_shell_is_solid(PlasticKinematic::from(samples.plastic_rate), 1e-3, 1e-2, 0);
  check_shell_is_solid(Viscoelastic::from(samples.viscoelastic), 1e-3, 1);
}

// *MAT_PLASTIC_KINEMATIC: transverse shear is elastic beside flow in the plane, neither feels the
// other
TEST_CASE("shells: transverse shear outside the yield condition") {
  const Samples samples;
  for (const auto& parameters : {samples.plastic, samples.plastic_rate}) {
    const auto m = PlasticKinematic::from(parameters);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1e-2, 1e-2);
    auto sheared = fresh_state<PlasticKinematic>(), plain = sheared;
    Sym3<double> a = no_stress(), b = a;
    double yz = 0, zx = 0;
    for (int i = 0; i < 100; ++i) {
      const double xx = uniform(random), yy = uniform(random), xy = uniform(random);
      const double shear_yz = uniform(random), shear_zx = uniform(random);
      auto p = fresh_point(m, 1), q = p;
      double da = 0, db = 0;
      a = plane_stress(m, a, xx, yy, xy, shear_yz, shear_zx, 0.8, p, sheared, da);
      b = plane_stress(m, b, xx, yy, xy, 0.0, 0.0, 0.8, q, plain, db);
      yz += 0.8 * 210 / 2.6 * shear_yz, zx += 0.8 * 210 / 2.6 * shear_zx;
      CHECK(a.xx == b.xx);
      CHECK(a.yy == b.yy);
      CHECK(a.xy == b.xy);
      CHECK(da == db);
      CHECK(near(a.yz, yz, 1e-5));
      CHECK(near(a.zx, zx, 1e-5));
    }
    CHECK(sheared.plastic_strain > 0.1);
  }
}

// after a step far beyond yield the stress lies on the yield surface
TEST_CASE("shells: large steps end on the yield surface") {
  const auto m = PiecewiseLinearPlasticity::from(
      TestParameters{{"ro", 1}, {"e", 210}, {"pr", .3}, {"sigy", .3}});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-.05, .05);
  for (int i = 0; i < 1000; ++i) {
    auto state = fresh_state<PiecewiseLinearPlasticity>();
    auto point = fresh_point(m, 1);
    double dzz = 0;
    const Sym3<double> s =
        plane_stress(m, no_stress(), uniform(random), uniform(random), uniform(random),
                     uniform(random), uniform(random), 1.0, point, state, dzz);
    CHECK(near(von_mises_of_deviator(deviator(s)), 0.3, 1e-5));
  }
}

TEST_CASE("beams: elastic fibre, and plastic fibre equal to the solid with free sides") {
  const Samples samples;
  const auto elastic = ElasticLaw::from(samples.elastic);
  auto none = fresh_state<ElasticLaw>();
  auto point = fresh_point(elastic, 1);
  const Sym3<double> s = uniaxial(elastic, no_stress(), .001, .0004, .0002, 1.0, point, none);
  CHECK(near(s.xx, .21, 1e-6));
  CHECK(near(s.zx, .0002 * 210 / 2.6, 1e-6));
  auto check = [](const auto& m, double tolerance) {
    using M = std::decay_t<decltype(m)>;
    std::mt19937 random(8);
    std::uniform_real_distribution<double> uniform(-1e-3, 1e-3);
    auto fibre = fresh_state<M>(), solid = fibre;
    Sym3<double> a = no_stress(), b = a;
    for (int i = 0; i < 300; ++i) {
      auto p = fresh_point(m, 1);
      Sym3<double> e{uniform(random), 0, 0, uniform(random), 0, uniform(random)};
      a = uniaxial(m, a, e.xx, 2 * e.xy, 2 * e.zx, 1.0, p, fibre);
      b = detail::free_sides<30>(m, b, e, p, solid);
      CHECK(largest(a - b) < tolerance);
    }
  };
  check(PlasticKinematic::from(samples.plastic), 1e-5 * 0.3);
  check(PiecewiseLinearPlasticity::from(samples.curved), 1e-5 * 0.3);
  check(Viscoelastic::from(samples.viscoelastic), 1e-10);
}

}  // namespace
}  // namespace fabrica
