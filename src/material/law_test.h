#pragma once
// What the tests of laws share. Laws are driven over double lanes in every build; in the mixed
// build only the parameters are rounded to float.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "material/materials.h"
#include "material/test_parameters.h"

namespace fabrica {

// relative error of results whose only error is the rounding of the parameters
inline constexpr double parameter_error = sizeof(Real) == 8 ? 1e-12 : 5e-7;

inline bool near(double value, double reference, double relative) {
  return std::abs(value - reference) <= relative * std::abs(reference);
}

template <class M, class L = double>
typename M::template State<L> fresh_state() {
  using S = typename M::template State<L>;
  S s;
  if constexpr (!std::is_empty_v<S>)
    for (unsigned i = 0; i < sizeof(S) / sizeof(L); ++i) reinterpret_cast<L*>(&s)[i] = L(0.0);
  return s;
}

template <class L = double, class M>
Point<L> fresh_point(const M& m, double dt, double volume_ratio = 1, double length = 1) {
  const Elastic e = m.elastic();
  return {L(dt), L(volume_ratio), L(length), L(e.wave_modulus()), L(e.shear), L(1.0)};
}

inline Sym3<double> no_stress() { return {0, 0, 0, 0, 0, 0}; }

inline Mat3<double> diagonal(double a, double b, double c) {
  return {{{a, 0, 0}, {0, b, 0}, {0, 0, c}}};
}

template <class M>
Sym3<double> total_stress(const M& m, const Mat3<double>& F, double dt = 1) {
  auto point = fresh_point(m, dt, det(F));
  auto state = fresh_state<M>();
  return m.stress(F, point, state);
}

// Axial stress of a total law at the stretch lam with free sides, and the lateral stretch.
template <class M>
double free_uniaxial(const M& m, double lam, double& lateral) {
  double low = 0.2 / std::sqrt(lam), high = 3 / std::sqrt(lam);
  for (int i = 0; i < 200; ++i) {
    lateral = 0.5 * (low + high);
    (total_stress(m, diagonal(lam, lateral, lateral)).yy > 0 ? high : low) = lateral;
  }
  return total_stress(m, diagonal(lam, lateral, lateral)).xx;
}

// A random gradient with stretches of about 1 +- size, positive volume.
inline Mat3<double> random_gradient(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  for (;;) {
    Mat3<double> F = identity3<double>();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) F.a[i][j] += uniform(random);
    if (det(F) > 0.3) return F;
  }
}

inline Vec3<double> random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Vec3<double> n{normal(random), normal(random), normal(random)};
  return (1 / norm(n)) * n;
}

inline Mat3<double> rotation_about(const Vec3<double>& n, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const double u[3] = {n.x, n.y, n.z};
  Mat3<double> R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R.a[i][j] = (1 - c) * u[i] * u[j] + (i == j ? c : 0);
  R.a[0][1] -= s * n.z, R.a[1][0] += s * n.z, R.a[0][2] += s * n.y;
  R.a[2][0] -= s * n.y, R.a[1][2] -= s * n.x, R.a[2][1] += s * n.x;
  return R;
}

inline double largest(const Sym3<double>& s) {
  double r = 0;
  for (int i = 0; i < 6; ++i) r = std::max(r, std::abs(s[i]));
  return r;
}

// Cards of every law, for the properties that all laws share. Owns the curves.
struct Samples {
  TestParameters elastic{{"ro", 7.8e-6}, {"e", 210}, {"pr", 0.3}};
  TestParameters fluid{{"ro", 1e-6}, {"k", 2.2}, {"vc", 0.1}};
  TestParameters plastic{{"ro", 7.8e-6}, {"e", 210},    {"pr", .3},
                         {"sigy", .3},   {"etan", 2.1}, {"beta", .5}};
  TestParameters plastic_rate{{"ro", 7.8e-6}, {"e", 210},   {"pr", .3}, {"sigy", .3}, {"etan", 2.1},
                              {"beta", .5},   {"src", .04}, {"srp", 5}, {"vp", 1}};
  TestParameters curved{{"ro", 7.8e-6}, {"e", 210}, {"pr", .3}, {"sigy", .3}};
  TestParameters tabled{{"ro", 7.8e-6}, {"e", 210}, {"pr", .3}, {"vp", 1}};
  TestParameters viscoelastic{{"ro", 1e-6}, {"bulk", 1}, {"g0", .01}, {"gi", .002}, {"beta", .1}};
  TestParameters kelvin{{"ro", 1e-6}, {"bulk", 1}, {"g0", .01},
                        {"gi", .002}, {"dc", 10},  {"fo", 1}};
  TestParameters mooney{{"ro", 1e-6}, {"a", .4}, {"b", .1}, {"pr", .45}};
  TestParameters hyperelastic{{"ro", 1e-6}, {"pr", .45},  {"c10", .1},  {"c01", .45},
                              {"c11", .6},  {"c20", .05}, {"c02", .02}, {"c30", .01}};
  TestParameters ogden{{"ro", 1e-6},  {"pr", .45},     {"mu1", .63},  {"mu2", .0012},
                       {"mu3", -.01}, {"alpha1", 1.3}, {"alpha2", 5}, {"alpha3", -2}};
  TestParameters ogden_viscous{{"ro", 1e-6}, {"pr", .45}, {"mu1", .63}, {"alpha1", 1.3}};
  TestParameters foam{{"ro", 5e-8}, {"e", .001}, {"hu", .2}, {"shape", 2}, {"tc", 1}};
  TestParameters foam_viscous{{"ro", 5e-8}, {"e", .001},  {"hu", .2},    {"shape", 2},
                              {"tc", 1},    {"ed", .001}, {"beta1", .1}, {"damp", .1}};
  TestParameters viscous_foam{{"ro", 5e-8}, {"e1", .02}, {"n1", 4},  {"v2", .05},
                              {"e2", .1},   {"n2", .2},  {"pr", .05}};
  TestParameters crushable{{"ro", 5e-8}, {"e", .01}, {"pr", .1}, {"tsc", .0005}, {"damp", .1}};

  TestParameters bone{{"ro", 2e-6}, {"e", 17},  {"pr", .3},  {"fail", 1e20},
                      {"c", .36},   {"p", 4.6}, {"pc", .05}, {"pt", .02}};
  TestParameters bone_viscous{{"ro", 2e-6}, {"e", 17}, {"pr", .3}, {"fail", 1e20}};

  Samples() {
    for (TestParameters* p : {&bone, &bone_viscous})
      p->set_curve("lcidc", {{0, .18}, {.02, .2}, {1, .5}})
          .set_curve("lcidt", {{0, .11}, {.01, .12}, {1, .3}});
    bone_viscous.add_row({{"gi", 2}, {"betai", .5}}).add_row({{"gi", 3}, {"betai", 20}});
    curved.set_curve("lcss", {{0, .3}, {.01, .36}, {.05, .42}, {.2, .5}, {1, .55}});
    tabled.set_table(
        "lcss", {{-7, {{0, .3}, {1, .4}}}, {0, {{0, .4}, {1, .5}}}, {4, {{0, .6}, {1, .7}}}}, true);
    ogden_viscous.add_row({{"gi", .3}, {"betai", .5}}).add_row({{"gi", .1}, {"betai", 20}});
    foam.set_curve("lcid", foam_points());
    foam_viscous.set_curve("lcid", foam_points());
    crushable.set_curve("lcid", {{0, .0002}, {.5, .0004}, {.8, .002}});
  }
  static TestParameters::Points foam_points() {
    return {{0, 0}, {.1, .0001}, {.5, .0002}, {.8, .001}, {.95, .01}};
  }

  // calls visit(law) for all of them
  template <class Visit>
  void each(Visit&& visit) const {
    visit(ElasticLaw::from(elastic)), visit(ElasticFluid::from(fluid));
    visit(PlasticKinematic::from(plastic)), visit(PlasticKinematic::from(plastic_rate));
    visit(PiecewiseLinearPlasticity::from(plastic)), visit(PiecewiseLinearPlasticity::from(curved));
    visit(PiecewiseLinearPlasticity::from(tabled));
    visit(ModifiedPiecewiseLinearPlasticity::from(curved));
    visit(Viscoelastic::from(viscoelastic)), visit(KelvinMaxwell::from(kelvin));
    visit(MooneyRivlin::from(mooney)), visit(Ogden::from(ogden)),
        visit(ViscousOgden::from(ogden_viscous)), visit(HyperelasticRubber::from(hyperelastic));
    visit(LowDensityFoam::from(foam)), visit(ViscousLowDensityFoam::from(foam_viscous));
    visit(PlasticityCompressionTension::from(bone)),
        visit(ViscousPlasticityCompressionTension::from(bone_viscous));
    visit(ViscousFoam::from(viscous_foam)), visit(CrushableFoam::from(crushable));
  }
};

}  // namespace fabrica
