// Solid elements against closed forms. Numbers refer to the catalogue of verification problems in
// docs/verification.md.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "base/pack.h"
#include "element/element_driver.h"
#include "element/hex8.h"
#include "element/hex8_full.h"
#include "element/penta6.h"
#include "element/tet4.h"
#include "material/elastic.h"

using namespace fabrica;
using fabrica::test::Mesh;

namespace {

constexpr bool in_double = sizeof(Real) == 8;

ElasticLaw steel() {
  const Elastic e = Elastic::from_youngs(7.85e-6, 210, 0.3);
  return {Real(e.density), Real(e.bulk), Real(e.shear)};
}
ElasticLaw law(double rho, double E, double nu) {
  const Elastic e = Elastic::from_youngs(rho, E, nu);
  return {Real(e.density), Real(e.bulk), Real(e.shear)};
}

// the seven bricks of MacNeal and Harder's patch: a distorted one inside a unit cube
template <class M>
void patch_mesh(M& m) {
  const double outer[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                              {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const double inner[8][3] = {{.249, .342, .192}, {.826, .288, .288}, {.850, .649, .263},
                              {.273, .750, .230}, {.320, .186, .643}, {.677, .305, .683},
                              {.788, .693, .644}, {.165, .745, .702}};
  for (auto& p : outer) m.add({p[0], p[1], p[2]});
  for (auto& p : inner) m.add({p[0], p[1], p[2]});
  m.elements = {{8, 9, 10, 11, 12, 13, 14, 15}, {0, 1, 2, 3, 8, 9, 10, 11},
                {12, 13, 14, 15, 4, 5, 6, 7},   {0, 1, 9, 8, 4, 5, 13, 12},
                {9, 1, 2, 10, 13, 5, 6, 14},    {11, 10, 2, 3, 15, 14, 6, 7},
                {0, 8, 11, 3, 4, 12, 15, 7}};
}

// two by two by two cells with an inner node out of place, each cut into two wedges or six
// tetrahedra
template <class M>
void cut_patch_mesh(M& m) {
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) m.add({0.5 * i, 0.5 * j, 0.5 * k});
  m.x[13] += Vec3d{0.11, -0.07, 0.09};
  static const int wedges[2][6] = {{0, 1, 3, 4, 5, 7}, {1, 2, 3, 5, 6, 7}};
  static const int tets[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                 {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  for (int cell = 0; cell < 8; ++cell) {
    const int o = cell % 2 + cell / 2 % 2 * 3 + cell / 4 * 9;
    const int c[8] = {o, o + 1, o + 4, o + 3, o + 9, o + 10, o + 13, o + 12};
    if constexpr (M::N == 6)
      for (const auto& w : wedges)
        m.elements.push_back({c[w[0]], c[w[1]], c[w[2]], c[w[3]], c[w[4]], c[w[5]]});
    if constexpr (M::N == 4)
      for (const auto& t : tets) m.elements.push_back({c[t[0]], c[t[1]], c[t[2]], c[t[3]]});
  }
}

// linear displacement field imposed on all nodes in small steps; inner nodes must then be in
// equilibrium
template <class E>
void patch_test(int hourglass, double tolerance) {
  Mesh<E, ElasticLaw> m{steel()};
  m.moduli();
  m.p.hourglass = hourglass, m.p.hourglass_coefficient = Real(0.05);
  m.p.linear_viscosity = m.p.quadratic_viscosity = 0;
  std::vector<int> inner = {13};
  if constexpr (E::corners == 8)
    patch_mesh(m), inner = {8, 9, 10, 11, 12, 13, 14, 15};
  else
    cut_patch_mesh(m);
  m.start(0);
  // a small velocity gradient for one unit of time in 4 steps, so that terms of second order in the
  // strain vanish
  const double u = in_double ? 1e-12 : 1e-6;
  const double g[3][3] = {{u, 0.5 * u, 0.2 * u}, {0.5 * u, u, 0.3 * u}, {0.2 * u, 0.3 * u, u}};
  m.dt = 0.25;
  for (std::size_t n = 0; n < m.x.size(); ++n)
    for (int i = 0; i < 3; ++i)
      m.v[n][i] = g[i][0] * m.x[n].x + g[i][1] * m.x[n].y + g[i][2] * m.x[n].z;
  for (int k = 0; k < 4; ++k) m.forces();
  const double lambda = m.law.bulk - 2.0 / 3 * m.law.shear, G = m.law.shear, tr = 3 * u;
  const double expected[6] = {lambda * tr + 2 * G * u, lambda * tr + 2 * G * u,
                              lambda * tr + 2 * G * u, 2 * G * 0.5 * u,
                              2 * G * 0.3 * u,         2 * G * 0.2 * u};
  double worst = 0;
  for (int e = 0; e < int(m.elements.size()); ++e)
    for (int i = 0; i < 6; ++i) {
      const StateView<Real> s{m.view(e).block + E::template point_at<ElasticLaw>(m.p) * block_size};
      worst = std::max(worst, std::abs(double(s.load(i)) - expected[i]) / expected[0]);
    }
  double residual = 0;
  for (int n : inner) residual = std::max(residual, norm(m.force[n]) / expected[0]);
  MESSAGE("corners ", E::corners, ": error of stress ", worst, ", force on inner nodes ", residual);
  CHECK(worst < tolerance);
  CHECK(residual < tolerance);
}

// spin about an oblique axis for a full turn: no stress, no energy
template <class E>
double spin_stress(Mesh<E, ElasticLaw>& m, int steps) {
  const Vec3d axis = (1 / std::sqrt(3.0)) * Vec3d{1, 1, 1};
  m.dt = 1;
  const std::vector<Vec3d> start = m.x;
  auto turned = [&](const Vec3d& r, double a) {
    return std::cos(a) * r + std::sin(a) * cross(axis, r) +
           ((1 - std::cos(a)) * dot(axis, r)) * axis;
  };
  for (int k = 1; k <= steps; ++k) {
    const double a0 = 2 * M_PI * (k - 1) / steps, a1 = 2 * M_PI * k / steps;
    for (std::size_t n = 0; n < m.x.size(); ++n) {
      const Vec3d from = turned(start[n], a0), to = turned(start[n], a1);
      m.x[n] = to, m.v[n] = to - from;
    }
    m.forces();
  }
  double worst = 0;
  for (int e = 0; e < int(m.elements.size()); ++e)
    for (int i = 0; i < 6; ++i) {
      const StateView<Real> s{m.view(e).block + E::template point_at<ElasticLaw>(m.p) * block_size};
      worst = std::max(worst, std::abs(double(s.load(i))));
    }
  return worst / m.p.youngs;
}

template <class M>
void unit_brick(M& m) {
  const double c[8][3] = {{0, 0, 0}, {1, 0, 0},   {1, 1, 0},   {0, 1, 0},
                          {0, 0, 1}, {1.1, 0, 1}, {1, 1, 1.2}, {0, 1, 1}};
  for (auto& p : c) m.add({p[0], p[1], p[2]});
}

// stable step of one free cube by trial: does a random start stay bounded?
bool stable(double nu, double factor) {
  Mesh<Hex8<false>, ElasticLaw> m{law(1, 1, nu)};
  m.moduli();
  m.p.hourglass = 6, m.p.hourglass_coefficient = 1;
  m.p.linear_viscosity = m.p.quadratic_viscosity = 0;
  const double c[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                          {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (auto& p : c) m.add({p[0], p[1], p[2]});
  m.elements = {{0, 1, 2, 3, 4, 5, 6, 7}};
  m.start(0);
  const Elastic e = m.law.elastic();
  const double speed = std::sqrt(e.wave_modulus() / e.density);
  m.dt = factor / speed;
  // the breathing mode controls: start from it, very small so that geometry stays
  for (int n = 0; n < 8; ++n) m.v[n] = 1e-7 * Vec3d{c[n][0] - 0.5, c[n][1] - 0.5, c[n][2] - 0.5};
  for (int k = 0; k < 400; ++k) m.cycle([](auto&) {});
  return m.kinetic() < 1e-12;
}

}  // namespace

// V16: u linear -> constant stress, and equilibrium inside, on distorted bricks, wedges and
// tetrahedra. In float the bound is that of rounded positions and velocities.
TEST_CASE("patch test of distorted bricks, wedges and tetrahedra") {
  const double tolerance = in_double ? 1e-10 : 2e-5;
  patch_test<Hex8<true>>(5, tolerance);
  patch_test<Hex8<true>>(3, tolerance);
  patch_test<Hex8Full>(2, tolerance);
  patch_test<Penta6>(2, tolerance);
  patch_test<Tet4>(2, tolerance);
}

// E2, V12: rigid rotation by one turn leaves stress below 1e-6 E
TEST_CASE("rigid rotation leaves no stress in solids") {
  const double bound = 1e-6;
  for (int type : {2, 5, 6}) {
    Mesh<Hex8<false>, ElasticLaw> m{steel()};
    m.moduli();
    m.p.hourglass = type, m.p.hourglass_coefficient = Real(0.05);
    unit_brick(m);
    m.elements = {{0, 1, 2, 3, 4, 5, 6, 7}};
    m.start(0);
    CHECK(spin_stress(m, 20000) < bound * (in_double ? 1 : 20));
    CHECK(std::abs(m.hourglass) < 1e-9 * m.p.youngs);
  }
  Mesh<Tet4, ElasticLaw> t{steel()};
  t.moduli();
  unit_brick(t);
  t.elements = {{0, 1, 2, 4}};
  t.start(0);
  CHECK(spin_stress(t, 20000) < bound * (in_double ? 1 : 20));
}

// V04: the one-point cube is unstable above 0.577 L/c for nu = 0.4999
TEST_CASE("stability limit of one free cube") {
  const double limit = 1 / std::sqrt(3.0);
  CHECK(stable(0.4999, 0.99 * limit));
  CHECK(!stable(0.4999, 1.01 * limit));
}

// A free flat brick thrown against itself across its thin side, at 0.9 of the step that it asks
// for: the damper of bulk viscosity must take energy, not feed it. (A free cube at this step is
// unstable by itself, see above.)
TEST_CASE("a flat brick with bulk viscosity is stable at its own step") {
  for (double flat : {4.0, 20.0, 100.0}) {
    Mesh<Hex8<false>, ElasticLaw> m{steel()};
    m.moduli();
    m.p.quadratic_viscosity = Real(1.5), m.p.linear_viscosity = Real(0.06);
    for (int a = 0; a < 8; ++a)
      m.add({(a % 4 == 1 || a % 4 == 2) ? flat : 0.0, a % 4 >= 2 ? flat : 0.0, a >= 4 ? 1.0 : 0.0});
    m.elements = {{0, 1, 2, 3, 4, 5, 6, 7}};
    for (int a = 0; a < 8; ++a) m.v[a].z = a < 4 ? 0.05 : -0.05;
    m.start(0);
    const double before = m.kinetic();
    double most = 0;
    for (int k = 0; k < 2000; ++k) {
      m.dt = 0.9 * m.step;
      m.cycle([](auto&) {});
      most = std::max(most, m.kinetic());
    }
    INFO("width over height ", flat);
    CHECK(most < 2 * before);  // the first kick at nearly the limit of the step overshoots
    CHECK(m.kinetic() < 0.1 * before);
  }
}

// largest kinetic energy of free cycles, NaN if it comes to that
template <class M>
double largest_kinetic(M& mesh, int cycles) {
  double most = 0;
  for (int k = 0; k < cycles; ++k) {
    mesh.cycle([](auto&) {});
    most = mesh.kinetic() <= most ? most : mesh.kinetic();
  }
  return most;
}

// A free flat brick, warped by as much as it is thick, rings from a thrown corner at 0.9 of the
// step that it asks for. Energy of the linear modes stays; what a mode beyond the limit of the step
// gains grows without end. QM = 2/3 holds a flat brick as full integration does
// (docs/body/trials.md).
TEST_CASE("stiffness hourglass control is stable in a warped flat brick at its own step") {
  for (double warp : {0.0, 0.5, 1.0}) {
    Mesh<Hex8<true>, ElasticLaw> m{law(1e-6, 0.01, 0.49)};
    m.moduli();
    m.p.hourglass = 5, m.p.hourglass_coefficient = Real(2.0 / 3.0);
    for (int a = 0; a < 8; ++a) {
      const double x = (a % 4 == 1 || a % 4 == 2) ? 2.5 : -2.5, y = a % 4 >= 2 ? 2.5 : -2.5;
      m.add({x, y, (a >= 4 ? 0.25 : -0.25) + 0.5 * warp * x * y / 6.25});
    }
    m.elements = {{0, 1, 2, 3, 4, 5, 6, 7}};
    m.v[6].z = -1e-3;
    m.start(0);
    const double before = m.kinetic();
    INFO("warp over thickness ", warp);
    CHECK(largest_kinetic(m, 5000) < 2 * before);
  }
}

// Free flat bricks of random shape, up to corners that are nearly closed and tops that have slid
// aside by half the thickness: from a small random motion nothing grows at 0.9 of the step that the
// brick asks for. Their hourglass vectors are far from square to one another and to the strains.
TEST_CASE("stiffness hourglass control is stable in distorted flat bricks at their own step") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(0, 1);
  int grown = 0;
  for (int shape = 0; shape < 200; ++shape) {
    Mesh<Hex8<true>, ElasticLaw> m{law(1e-6, 0.01, 0.48)};
    m.moduli();
    m.p.hourglass = 5, m.p.hourglass_coefficient = Real(2.0 / 3.0);
    for (int a = 0; a < 8; ++a) {
      const double x = (a % 4 == 1 || a % 4 == 2) ? 2.5 : -2.5, y = a % 4 >= 2 ? 2.5 : -2.5;
      const double side = a >= 4 ? 0.25 : 0, top = a >= 4 ? 0.5 * (0.15 + 1.2 * u(random)) : 0;
      m.add({x + side * (2 * u(random) - 1), y + side * (2 * u(random) - 1), top});
    }
    m.elements = {{0, 1, 2, 3, 4, 5, 6, 7}};
    for (Vec3d& v : m.v) v = 1e-6 * Vec3d{u(random) - 0.5, u(random) - 0.5, u(random) - 0.5};
    m.start(0);
    const double before = m.kinetic();
    grown += !(largest_kinetic(m, 3000) < 20 * before);
  }
  CHECK(grown == 0);
}

// the exact mean gradient is the derivative of the volume
TEST_CASE("exact gradient of the brick is dV/dx") {
  Vec3<double> x[8];
  const double c[8][3] = {{0, .1, 0}, {1, 0, -.1}, {1.2, 1, 0},   {0, .9, .1},
                          {0, 0, 1},  {1.1, 0, 1}, {1, 1.3, 1.2}, {.1, 1, .8}};
  for (int a = 0; a < 8; ++a) x[a] = {c[a][0], c[a][1], c[a][2]};
  const auto g = hex_gradient<true>(x);
  for (int a = 0; a < 8; ++a)
    for (int i = 0; i < 3; ++i) {
      Vec3<double> y[8];
      std::copy(x, x + 8, y);
      y[a][i] += 1e-6;
      const double up = hex_gradient<true>(y).volume;
      y[a][i] -= 2e-6;
      const double down = hex_gradient<true>(y).volume;
      CHECK(g.b[a][i] * g.volume == doctest::Approx((up - down) / 2e-6).epsilon(1e-7));
    }
}

// V17: one brick through the thickness, L/h = 10: tip deflection P L^3/(3EI) + P L/(G A 5/6), IHQ 6
// with QM = 1
TEST_CASE("assumed-strain hourglass control bends like a beam") {
  Mesh<Hex8<false>, ElasticLaw> m{law(7.85e-6, 210, 0.3)};
  m.moduli();
  m.p.hourglass = 6, m.p.hourglass_coefficient = 1;
  m.p.linear_viscosity = m.p.quadratic_viscosity = 0;
  const int n = 10;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k < 4; ++k)
      m.add({double(i), k == 1 || k == 2 ? 1.0 : 0.0, k >= 2 ? 1.0 : 0.0});
  for (int i = 0; i < n; ++i) {
    const int a = 4 * i, b = 4 * (i + 1);
    m.elements.push_back({a, b, b + 1, a + 1, a + 3, b + 3, b + 2, a + 2});
  }
  // clamped as a beam: axial motion fixed at the root, lateral contraction free
  for (int k = 0; k < 4; ++k) m.fixed[k] = 1;
  m.fixed[0] |= 6, m.fixed[1] |= 4;
  m.start(0);
  const double P = 1e-3, L = 10, E = 210, I = 1. / 12, G = E / 2.6;
  // a single column of bricks is stable up to 0.81 of length / wave speed only
  m.dt *= 0.8;
  m.damping = 6.0;
  double before = 0;
  for (int k = 0; k < 60000; ++k) {
    m.cycle([&](auto& mesh) {
      for (int c = 0; c < 4; ++c) mesh.force[4 * n + c].z += P / 4;
    });
    if (k % 5000 == 4999) {
      const double now = m.x[4 * n].z;
      if (std::abs(now - before) < 1e-7 * std::abs(now)) break;
      before = now;
    }
  }
  const double tip = m.x[4 * n].z, exact = P * L * L * L / (3 * E * I) + P * L / (G * 5. / 6);
  MESSAGE("tip / exact = ", tip / exact);
  CHECK(tip == doctest::Approx(exact).epsilon(0.01));
}

// The driver's packs and one lane at a time must give the same bits.
TEST_CASE("bricks: every lane width gives the same bits") {
  using L = RealPack;
  constexpr int W = native_width;
  const ElasticLaw material = steel();
  ElementParameters p;
  p.density = material.density, p.bulk = material.bulk, p.shear = material.shear, p.youngs = 210,
  p.poisson = Real(0.3);
  p.hourglass_coefficient = Real(0.05);
  for (int type : {2, 5, 6}) {
    p.hourglass = type;
    const int fields = Hex8<false>::state_fields<ElasticLaw>(p);
    AlignedVector<Real> a(fields * block_size, Real(0)), b(fields * block_size, Real(0));
    Corners<L, 8> wide{};
    Corners<Real, 8> one[W];
    unsigned seed = 7;
    auto random = [&] { return Real((seed = seed * 1664525u + 1013904223u) >> 8) / Real(1 << 24); };
    static const Real c[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    for (int i = 0; i < W; ++i)
      for (int n = 0; n < 8; ++n)
        for (int d = 0; d < 3; ++d) {
          const Real x = c[n][d] + Real(0.2) * random(), v = random();
          set(wide.x[n][d], i, x), set(wide.v[n][d], i, v);
          one[i].x[n][d] = x, one[i].v[n][d] = v;
        }
    Hex8<false>::initialise<L>(material, p, wide, Given<L>{}, StateView<L>{a.data()});
    CornerForces<L, 8> out;
    Totals<L> totals;
    for (int k = 0; k < 3; ++k)
      Hex8<false>::forces<L>(material, p, Real(1e-5), wide, StateView<L>{a.data()}, out, totals);
    for (int i = 0; i < W; ++i) {
      const StateView<Real> s{b.data() + i};
      Hex8<false>::initialise<Real>(material, p, one[i], Given<Real>{}, s);
      CornerForces<Real, 8> f;
      Totals<Real> t;
      for (int k = 0; k < 3; ++k)
        Hex8<false>::forces<Real>(material, p, Real(1e-5), one[i], s, f, t);
      bool same = t.internal == get(totals.internal, i) && t.time_step == get(totals.time_step, i);
      for (int n = 0; n < 8; ++n)
        for (int d = 0; d < 3; ++d) same = same && f.f[n][d] == get(out.f[n][d], i);
      CHECK(same);
    }
  }
}
