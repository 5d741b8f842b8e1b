// Tests of the options of shells: thickness update, reference surface, failure, hourglass forms,
// stable step.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "element/element_driver.h"
#include "element/membrane.h"
#include "element/shell_bt.h"
#include "element/shell_full.h"
#include "element/shell_triangle.h"
#include "material/elastic.h"
#include "material/modified_piecewise_linear_plasticity.h"
#include "material/plastic_kinematic.h"

using namespace fabrica;
using namespace fabrica::test;

namespace {

template <class E, class M = ElasticLaw>
Mesh<E, M> rectangle(double a, double b) {
  Mesh<E, M> m;
  const Elastic e = Elastic::from_youngs(7.85e-6, 210, 0.3);
  if constexpr (std::is_same_v<M, ElasticLaw>) {
    m.law = {Real(e.density), Real(e.bulk), Real(e.shear)};
  } else if constexpr (std::is_same_v<M, ModifiedPiecewiseLinearPlasticity>) {
    m.law.plasticity.density = Real(e.density);
    m.law.plasticity.moduli = {Real(e.bulk), Real(e.shear), Real(0)};
    m.law.plasticity.yield_stress = Real(0.3), m.law.plasticity.hardening = Real(1);
  } else {
    m.law = M{};
    m.law.density = Real(e.density), m.law.moduli = {Real(e.bulk), Real(e.shear), Real(0)};
    m.law.yield_stress = Real(0.3), m.law.failure_strain = Real(0.02);
  }
  m.moduli();
  gauss_layers(m.p, 3);
  m.p.shear_factor = Real(5.0 / 6.0), m.p.hourglass = 4, m.p.hourglass_coefficient = Real(0.05);
  m.add({0, 0, 0}), m.add({a, 0, 0});
  if constexpr (E::corners == 4) {
    m.add({a, b, 0}), m.add({0, b, 0});
    m.elements.push_back({0, 1, 2, 3});
  } else {
    m.add({0, b, 0});
    m.elements.push_back({0, 1, 2});
  }
  return m;
}
template <class M>
void stretch(M& m, double exx, double eyy) {
  for (std::size_t a = 0; a < m.x.size(); ++a) m.v[a] = {exx * m.x[a].x, eyy * m.x[a].y, 0};
}

}  // namespace

// ISTUPD = 1, elastic: dh/h = -nu/(1 - nu) (exx + eyy).
TEST_CASE_TEMPLATE("shells: the thickness follows the plane stress strain", E, ShellBT, ShellFull,
                   ShellTriangle) {
  for (const int update : {0, 1}) {
    auto m = rectangle<E>(1, 1);
    m.p.thickness_update = update;
    m.start(0.1);
    stretch(m, 1e-3, 2e-3);
    m.dt = 1;
    m.forces();
    const double exact = update ? -0.3 / 0.7 * 3e-3 : 0;
    CHECK(std::abs(E::thickness(m.view(0)) / 0.1 - 1 - exact) <
          6e-6);  // the Almansi strain is 0.15 % smaller
  }
}

// Bulk viscosity: q = rho l r (Q1^2 l r - Q2 c) for the rate r < 0 of the area, l = sqrt(A), pushes
// the corner at x = 1 out with A dN/dx q h = q h / 2; dt = s / (Q + sqrt(Q^2 + c^2)),
// Q = Q2 c + Q1 s |r|. Its energy, A h q |r| dt, is counted with the option 2 alone.
TEST_CASE_TEMPLATE("shells: bulk viscosity in compression", E, ShellBT, ShellFull, ShellTriangle) {
  const double rate = -100, dt = 1e-6, h = 0.1;
  auto pressed = [&](int option, double r) {
    auto m = rectangle<E>(1, 1);
    m.p.shell_viscosity = option;
    m.start(h);
    stretch(m, r, 0);
    m.dt = dt, m.internal = 0;
    m.forces();
    return m;
  };
  const auto without = pressed(0, rate), silent = pressed(1, rate), counted = pressed(2, rate);
  const double area = E::corners == 4 ? 1 : 0.5, size = E::corners == 4 ? 1 : std::sqrt(0.5);
  const double c = plate_speed(without.p), l = std::sqrt(area);
  const double q = 7.85e-6 * l * rate * (1.5 * 1.5 * l * rate - 0.06 * c);
  CHECK(q > 0);
  CHECK(counted.force[1].x - without.force[1].x == doctest::Approx(0.5 * q * h).epsilon(1e-3));
  CHECK(silent.force[1].x == counted.force[1].x);
  const double Q = 0.06 * c + 1.5 * size * -rate;
  CHECK(without.step == doctest::Approx(size / c).epsilon(1e-5));
  CHECK(counted.step == doctest::Approx(size / (Q + std::sqrt(Q * Q + c * c))).epsilon(1e-5));
  CHECK(counted.internal - without.internal ==
        doctest::Approx(area * h * q * -rate * dt).epsilon(1e-3));
  CHECK(silent.internal == without.internal);
  // none in tension
  CHECK(pressed(2, -rate).force[1].x == pressed(0, -rate).force[1].x);
  CHECK(pressed(2, -rate).step == pressed(0, -rate).step);
}

// NLOC = 1: the nodes lie on the upper surface, so that a membrane force n acts at z = -h/2: m = -n
// h/2.
TEST_CASE_TEMPLATE("shells: the reference surface shifts the layers", E, ShellBT, ShellFull,
                   ShellTriangle) {
  auto m = rectangle<E>(1, 1);
  m.p.reference_location = 1;
  m.start(0.1);
  stretch(m, 1e-4, 0);
  m.dt = 1;
  m.forces();
  double r[8];
  E::template resultants<ElasticLaw>(m.p, m.view(0), r);
  CHECK(r[5] > 0);
  CHECK(std::abs(r[0] / (-0.05 * r[5]) - 1) < 1e-5);
}

// A law that fails: beyond its failure strain the element is dead and gives no force.
TEST_CASE_TEMPLATE("shells: a failed element gives no force", E, ShellBT, ShellFull,
                   ShellTriangle) {
  auto m = rectangle<E, PlasticKinematic>(1, 1);
  m.start(0.1);
  m.dt = 1;
  double before = 0;
  for (int k = 0; k < 10; ++k) {
    stretch(m, 1e-3, 0);
    for (std::size_t a = 0; a < m.x.size(); ++a) m.x[a] += m.v[a];
    m.forces();
  }
  for (const Vec3d& f : m.force) before = std::max(before, norm(f));
  CHECK(before > 0.3 * 0.1 * 0.3);
  for (int k = 0; k < 20; ++k) {
    stretch(m, 1e-3, 0);
    for (std::size_t a = 0; a < m.x.size(); ++a) m.x[a] += m.v[a];
    m.forces();
  }
  CornerForces<Real, E::corners> out{};
  Totals<Real> t{};
  E::template forces<Real, PlasticKinematic>(m.law, m.p, Real(0), m.gather(0), m.view(0), out, t);
  CHECK(t.alive == 0);
  for (int a = 0; a < E::corners; ++a) CHECK(norm(out.f[a]) == 0);
  CHECK(E::template plastic_strain<PlasticKinematic>(m.p, m.view(0), 1) > Real(0.0199));
}

// Bent by turning its corners, a layer reaches a strain of kappa z in tension; with NUMINT = 1 it
// takes the others along, in compression none fails.
TEST_CASE_TEMPLATE("shells: one failed layer takes the others along where the law says so", E,
                   ShellBT, ShellFull, ShellTriangle) {
  for (const int together : {0, 1}) {
    auto m = rectangle<E, ModifiedPiecewiseLinearPlasticity>(1, 1);
    m.law.major_strain = Real(0.02), m.law.failed_layers = together;
    m.start(0.1);
    m.dt = 1;
    int failed_at = -1;
    for (int k = 0; k < 60 && failed_at < 0; ++k) {
      for (std::size_t a = 0; a < m.x.size(); ++a) m.w[a] = {0, m.x[a].x > 0.5 ? 0.005 : -0.005, 0};
      m.forces();
      CornerForces<Real, E::corners> out{};
      Totals<Real> t{};
      E::template forces<Real, ModifiedPiecewiseLinearPlasticity>(m.law, m.p, Real(0), m.gather(0),
                                                                  m.view(0), out, t);
      if (t.alive > 0) continue;
      failed_at = k + 1;
      for (int a = 0; a < E::corners; ++a) CHECK(norm(out.m[a]) == 0);
    }
    if (!together) CHECK(failed_at == -1);
    if (!together) continue;
    // curvature of 0.01 a step, outermost layer at z
    double z = 0;
    for (int q = 0; q < m.p.layers; ++q) z = std::max(z, 0.05 * double(m.p.layer_z[q]));
    CHECK(failed_at == int(std::floor(0.02 / (0.01 * z))) + 1);
  }
}

// Hourglass motion: viscous forms take energy out at the rate f.v, the stiffness form gives it
// back.
TEST_CASE("shell: hourglass forms") {
  for (const int form : {2, 4}) {
    auto m = rectangle<ShellBT>(1, 1);
    m.p.hourglass = form;
    m.start(0.1);
    m.dt = 1e-4;
    const double sign[4] = {1, -1, 1, -1};
    double most = 0;
    for (int k = 0; k < 20; ++k) {
      for (int a = 0; a < 4; ++a) m.v[a] = {(k < 10 ? 1e-3 : -1e-3) * sign[a], 0, 0};
      m.forces();
      double power = 0;
      for (int a = 0; a < 4; ++a) power += dot(m.force[a], m.v[a]);
      if (form == 2 || k < 10) CHECK(power < 0);
      most = std::max(most, m.hourglass);
    }
    CHECK(most > 0);
    if (form == 2) CHECK(m.hourglass == doctest::Approx(most));
    if (form == 4) CHECK(std::abs(m.hourglass) < 1e-4 * most);
    CHECK(std::abs(m.internal) < 1e-6 * most);
  }
}

// Closed form (theory page of shells): a flat square with nu = 0 under an hourglass motion of its
// corners. Normal strains at 2 x 2 points give E h A (4/a^2) q^2 / 6 for u = q xi eta and
// E h^3 A (4/a^2) q^2 / 72 for a rotation q xi eta; the stiffness form gives 3/16 QM and 3/32 QB of
// them.
TEST_CASE("shell: the stiffness form holds a known share of full integration") {
  const double q = 1e-4, h = 0.1, a = 2, E = 210;
  const double sign[4] = {1, -1, 1, -1};
  for (const bool bends : {false, true}) {
    const double exact = E * (bends ? h * h * h / 72 : h / 6) * 4 * q * q;
    for (const bool full : {false, true}) {
      const auto energy = [&](auto m) {
        m.p.hourglass_coefficient = Real(16.0 / 3), m.p.hourglass_bending = Real(16.0 / 3);
        m.law = {Real(7.85e-6), Real(E / 3), Real(E / 2)};  // nu = 0
        m.moduli();
        m.start(h);
        m.dt = 1;
        for (int c = 0; c < 4; ++c) (bends ? m.w : m.v)[std::size_t(c)] = {0, q * sign[c], 0};
        m.internal = m.hourglass = 0;
        m.forces();
        // both are counted as half the stress at the end times the motion
        return m.internal + m.hourglass;
      };
      const double found =
          full ? energy(rectangle<ShellFull>(a, a)) : energy(rectangle<ShellBT>(a, a));
      CHECK(found == doctest::Approx(full || !bends ? exact : 0.5 * exact).epsilon(1e-3));
    }
  }
}

// Equation (4) of shell_bt.h: an hourglass motion of amplitude q in the plane of a square takes
// QM E h q^2 / 8 of energy while it is elastic; while the square flows at the yield stress s,
// 4 q s h sqrt(A)/4, in bending 4 q s h^2 sqrt(A)/16; before and after flow the forces are elastic.
TEST_CASE_TEMPLATE("shells: hourglass forces are held at yield while the layers flow", E, ShellBT,
                   Membrane) {
  const double h = 0.1, a = 2, q = 1e-3, yield = 0.3;
  const double sign[4] = {1, -1, 1, -1};
  for (const bool bends : {false, true}) {
    if (bends && !E::rotations) continue;
    auto m = rectangle<E, PlasticKinematic>(a, a);
    m.law.failure_strain = Real(100);
    m.p.hourglass_coefficient = m.p.hourglass_bending = Real(1);
    m.start(h);
    m.dt = 1;
    const auto step = [&](double stretched) {
      stretch(m, stretched, 0);
      for (int c = 0; c < 4; ++c) {
        (bends ? m.w : m.v)[std::size_t(c)] += Vec3d{0, q * sign[c], 0};
      }
      m.hourglass = 0;
      m.forces();
      std::fill(m.w.begin(), m.w.end(), Vec3d{});
      return m.hourglass;
    };
    const double elastic = step(0), growth = step(0) - elastic;
    if (!bends) CHECK(elastic == doctest::Approx(210 * h * q * q / 8).epsilon(1e-3));
    CHECK(growth == doctest::Approx(2 * elastic).epsilon(1e-4));
    double flowing = 0;
    for (int k = 0; k < 100; ++k) flowing = step(2e-3);
    const double held = q * yield * h * a * (bends ? h / 4 : 1);
    CHECK(flowing == doctest::Approx(held).epsilon(2e-3));
    CHECK(step(-1e-5) == doctest::Approx(held + elastic).epsilon(2e-3));
  }
}

// Rectangle 2 x 1: A/longest side = 1, A/diagonal = 2/sqrt 5; ISDO = 2 uses the speed of a bar.
TEST_CASE("shell: stable step by ISDO") {
  const double bar = std::sqrt(210 / 7.85e-6), plate = bar / std::sqrt(1 - 0.09);
  const double exact[3] = {1 / plate, 2 / std::sqrt(5.0) / plate, 1 / bar};
  for (int option = 0; option < 3; ++option) {
    auto m = rectangle<ShellBT>(2, 1);
    m.p.time_step_option = option;
    m.start(0.1);
    CHECK(std::abs(m.step / exact[option] - 1) < 1e-6);
  }
}
