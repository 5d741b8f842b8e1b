// Tests of truss and beams: patch, rigid rotation, virtual power, cantilever, torsion, roll-up,
// frequency, stability.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

#include "base/lane_math.h"
#include "base/pack.h"
#include "element/beam_hughes_liu.h"
#include "element/beam_schwer.h"
#include "element/element_driver.h"
#include "element/truss.h"
#include "material/elastic.h"

using namespace fabrica;
using namespace fabrica::test;

namespace {

constexpr bool mixed = sizeof(Real) == 4;
const double pi = 3.14159265358979323846;

// a straight beam of n elements along x, square section of side b
template <class E>
Mesh<E, ElasticLaw> straight(int n, double length, double b) {
  Mesh<E, ElasticLaw> m;
  const Elastic e = Elastic::from_youngs(7.85e-6, 210, 0.3);
  m.law = {Real(e.density), Real(e.bulk), Real(e.shear)};
  m.moduli();
  m.p.area = Real(b * b), m.p.iss = m.p.itt = Real(b * b * b * b / 12),
  m.p.torsion = Real(0.1406 * b * b * b * b);
  m.p.section_points = 4;
  for (int q = 0; q < 4; ++q) {
    m.p.section_s[q] = Real((q & 1 ? 0.5 : -0.5) * b / std::sqrt(3.0));
    m.p.section_t[q] = Real((q & 2 ? 0.5 : -0.5) * b / std::sqrt(3.0));
    m.p.section_weight[q] = Real(0.25);
  }
  m.p.shear_factor = Real(5.0 / 6.0);
  for (int i = 0; i <= n; ++i) m.add({length * i / n, 0, 0});
  for (int i = 0; i < n; ++i) m.elements.push_back({i, i + 1});
  return m;
}

// length of a run in periods of the first bending mode of a cantilever, damped to rest
template <class M>
double first_mode(const M& m, double length) {
  return 3.516 / (length * length) *
         std::sqrt(double(m.p.youngs) * m.p.iss / (double(m.p.density) * m.p.area));
}

}  // namespace

TEST_CASE("truss: force E A dL/L, no force from a finite rotation") {
  auto m = straight<Truss>(1, 10, 1);
  m.start(0);
  m.dt = 1;
  m.v[1] = {1e-4, 0, 0}, m.x[1].x += 1e-4;
  m.forces();
  CHECK(std::abs(m.force[0].x / (210 * 1e-5) - 1) < 1e-4);
  const double before = norm(m.force[0]);
  const int steps = 1000;
  const double length = m.x[1].x;
  for (int k = 1; k <= steps; ++k) {
    const Vec3d to{length * std::cos(2 * pi * k / steps), length * std::sin(2 * pi * k / steps), 0};
    m.v[1] = to - m.x[1], m.x[1] = to;
    m.forces();
  }
  CHECK(std::abs(norm(m.force[0]) / before - 1) < (mixed ? 1e-2 : 1e-10));
}

// Rigid rotation about a skew axis leaves no force; error of third order of the step.
TEST_CASE_TEMPLATE("beams: a finite rigid rotation leaves no force", E, BeamSchwer, BeamHughesLiu) {
  auto m = straight<E>(1, 10, 1);
  m.start(0);
  const auto first = m.x;
  const int steps = 4000;
  const Vec3d axis{0.6, -0.48, 0.64};
  m.dt = 1;
  for (int k = 1; k <= steps; ++k) {
    const double t = 2 * pi * k / steps;
    for (int a = 0; a < 2; ++a) {
      const Vec3d r = first[a], along = dot(axis, r) * axis;
      const Vec3d to = along + std::cos(t) * (r - along) + std::sin(t) * cross(axis, r);
      m.v[a] = to - m.x[a], m.x[a] = to, m.w[a] = (2 * pi / steps) * axis;
    }
    m.forces();
  }
  // third order: theta_step^2 Theta / 12 = 1.3e-6
  const double force = norm(m.force[0]) / 210, moment = norm(m.moment[0]) / (210 * 10.0);
  MESSAGE("force / EA = ", force, ", moment / (EA L) = ", moment);
  CHECK(force < 1.3e-6);
  CHECK(moment < 1.3e-6);
}

// Virtual power of held resultants, and the balance of forces and moments.
TEST_CASE_TEMPLATE("beams: corner forces are the transpose of the strain rates", E, BeamSchwer,
                   BeamHughesLiu) {
  auto m = straight<E>(1, 3, 1);
  m.x[1] = {2, 1.5, -1};
  m.start(0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  auto shake = [&] {
    for (int a = 0; a < 2; ++a)
      m.v[a] = {u(random), u(random), u(random)}, m.w[a] = {u(random), u(random), u(random)};
  };
  shake();
  m.dt = 1e-3;
  for (int a = 0; a < 2; ++a) m.x[a] += m.dt * m.v[a];
  m.forces();
  for (int trial = 0; trial < 4; ++trial) {
    shake();
    m.dt = 1e-8, m.internal = 0;
    m.forces();
    double power = 0, scale = 0;
    for (int a = 0; a < 2; ++a)
      power += dot(m.force[a], m.v[a]) + dot(m.moment[a], m.w[a]), scale += norm(m.force[a]);
    CHECK(std::abs(m.internal / m.dt + power) < 1e-4 * scale);
  }
  const Vec3d total = m.force[0] + m.force[1];
  const Vec3d spin =
      cross(m.x[0], m.force[0]) + cross(m.x[1], m.force[1]) + m.moment[0] + m.moment[1];
  CHECK(norm(total) < 1e-12 + (mixed ? 1e-5 : 1e-13) * norm(m.force[0]));
  CHECK(norm(spin) < (mixed ? 1e-5 : 1e-13) * norm(m.force[0]) * 3);
}

// Cantilever with a tip force: w = P L^3/(3 E I) + P L/(k G A) for the shear-flexible beam; torsion
// T L/(G J) (V39).
TEST_CASE_TEMPLATE("beams: cantilever and torsion", E, BeamSchwer, BeamHughesLiu) {
  const double length = 100, b = 5, P = 1e-3;
  const bool flexible = std::is_same_v<E, BeamHughesLiu>;
  const int n = flexible ? 20 : 4;
  auto m = straight<E>(n, length, b);
  m.fixed[0] = 0b111111;
  m.start(0);
  const double w1 = first_mode(m, length);
  m.damping = 2 * w1;
  while (m.time < 15 / w1)
    m.cycle([&](auto& mesh) { mesh.force[n].z += P, mesh.moment[n].x += 10 * P; });
  const double I = b * b * b * b / 12, A = b * b, G = 210 / 2.6;
  const double exact =
      P * std::pow(length, 3) / (3 * 210 * I) + (flexible ? P * length / (5.0 / 6 * G * A) : 0);
  MESSAGE("tip / exact = ", m.x[n].z / exact);
  CHECK(std::abs(m.x[n].z / exact - 1) < 0.01);
  double r[8];
  E::template resultants<ElasticLaw>(m.p, m.view(0), r);
  CHECK(std::abs(r[5] / (10 * P) - 1) < 0.01);  // torsion is carried
}

// A cantilever under the end moment 2 pi E I / L rolls up into a full circle (V36, E8).
TEST_CASE("beam: roll-up into a circle") {
  const double length = 100, b = 1;
  const int n = 20;
  auto m = straight<BeamSchwer>(n, length, b);
  m.fixed[0] = 0b111111;
  m.start(0);
  const double w1 = first_mode(m, length), I = b * b * b * b / 12, M = 2 * pi * 210 * I / length;
  m.damping = 2 * w1;
  const double ramp = 15 / w1;
  while (m.time < ramp + 15 / w1)
    m.cycle([&](auto& mesh) { mesh.moment[n].y += M * std::min(1.0, mesh.time / ramp); });
  const double gap = norm(m.x[n] - m.x[0]);
  MESSAGE("gap / length = ", gap / length);
  CHECK(gap < 0.005 * length);
}

// A frame with clamped feet sways under a force P at the height of its girder (V39), columns h,
// girder l, one EI: w = P h^3/(12 EI) (3k + 2)/(6k + 1), k = h/l (slope deflection of slender
// members: no shear, no shortening).
TEST_CASE_TEMPLATE("beams: a frame sways", E, BeamSchwer, BeamHughesLiu) {
  const double h = 100, l = 150, b = 1, P = 1e-4;
  const int n = std::is_same_v<E, BeamHughesLiu> ? 16 : 4;  // elements of a member
  auto m = straight<E>(3 * n, 1, b);
  for (int i = 0; i <= n; ++i) {
    m.x[i] = {0, 0, h * i / n}, m.x[n + i] = {l * i / n, 0, h},
    m.x[2 * n + i] = {l, 0, h - h * i / n};
  }
  m.fixed[0] = m.fixed[3 * n] = 0b111111;
  m.start(0);
  const double I = b * b * b * b / 12, k = h / l;
  const double exact = P * h * h * h / (12 * 210 * I) * (3 * k + 2) / (6 * k + 1);
  // two columns of stiffness P / w carry about the girder and half their own mass
  const double first = std::sqrt(P / exact / (7.85e-6 * b * b * (l + h)));
  m.damping = 2 * first;
  while (m.time < 12 / first) m.cycle([&](auto& mesh) { mesh.force[n].x += P; });
  MESSAGE("sway / exact = ", m.x[n].x / exact);
  CHECK(std::abs(m.x[n].x / exact - 1) < 0.01);
}

// A hinged column under twice its Euler load P = pi^2 EI/L^2 buckles: a sine of amplitude a obeys
// rho A a'' = (pi/L)^2 (2P - P) a, which grows as exp(s t), s = (pi/L)^2 sqrt(EI/(rho A)) (V39).
// The column is first shortened evenly, which makes no waves.
TEST_CASE_TEMPLATE("beams: a column buckles at the rate of Euler", E, BeamSchwer, BeamHughesLiu) {
  const double length = 100, b = 2;
  const int n = 20;
  auto m = straight<E>(n, length, b);
  m.start(0);
  const double I = b * b * b * b / 12, strain = 2 * pi * pi * I / (b * b * length * length);
  const int steps = 1000;
  for (int k = 0; k < steps; ++k) {
    for (int i = 0; i <= n; ++i)
      m.v[i] = {-std::log1p(strain) / (steps * m.dt) * m.x[i].x, 0, 0}, m.x[i] += m.dt * m.v[i];
    m.forces();
  }
  m.fixed[0] = m.fixed[n] = 0b101111;
  for (int i = 1; i < n; ++i) m.fixed[i] = 0b101011;
  MESSAGE("axial force / 2 P = ", -m.force[0].x / (2 * pi * pi * 210 * I / (length * length)));
  const double rate = pi * pi / (length * length) * std::sqrt(210 * I / (7.85e-6 * b * b));
  for (int i = 0; i <= n; ++i) {
    m.v[i] = {0, 0, i % n == 0 ? 0 : 1e-6 * std::sin(pi * i / n)};
    m.w[i] = {0, -1e-6 * pi / length * std::cos(pi * i / n), 0};
  }
  const double start = m.time;
  double before = 0;
  while (m.time < start + 6 / rate) {
    m.cycle([](auto&) {});
    if (before == 0 && m.time >= start + 4 / rate)
      before = std::log(m.x[n / 2].z), m.external = m.time;
  }
  const double found = (std::log(m.x[n / 2].z) - before) / (m.time - m.external);
  MESSAGE("growth rate / exact = ", found / rate);
  CHECK(std::abs(found / rate - 1) < 0.01);
}

// First frequency of a cantilever, 3.516/L^2 sqrt(EI/(rho A)); the energy of the undamped motion
// stays.
TEST_CASE_TEMPLATE("beams: first frequency of a cantilever", E, BeamSchwer, BeamHughesLiu) {
  const double length = 100, b = 2;
  const int n = 20;
  auto m = straight<E>(n, length, b);
  m.fixed[0] = 0b111111;
  m.start(0);
  const double exact = first_mode(m, length);
  // mode shape
  const double bl = 1.8751 / length, ratio = 0.7341;
  for (int k = 1; k <= n; ++k) {
    const double X = bl * m.x[k].x;
    m.v[k].z = 1e-4 * (std::cosh(X) - std::cos(X) - ratio * (std::sinh(X) - std::sin(X)));
    m.w[k].y = -1e-4 * bl * (std::sinh(X) + std::sin(X) - ratio * (std::cosh(X) - std::cos(X)));
  }
  const double start = m.kinetic();
  std::vector<double> zeros;
  double before = 0;
  for (int k = 0; k < 100000 && zeros.size() < 2; ++k) {
    m.cycle([](auto&) {});
    const double z = m.x[n].z;
    if (before != 0 && (z > 0) != (before > 0)) zeros.push_back(m.time - m.dt * z / (z - before));
    before = z;
  }
  REQUIRE(zeros.size() == 2);
  const double found = pi / (zeros[1] - zeros[0]);
  MESSAGE("frequency / exact = ", found / exact,
          ", energy / start = ", (m.kinetic() + m.internal) / start);
  CHECK(std::abs(found / exact - 1) < 0.01);
  CHECK(std::abs((m.kinetic() + m.internal) / start - 1) < 1e-3);
}

TEST_CASE_TEMPLATE("beams: the estimated step is stable", E, Truss, BeamSchwer, BeamHughesLiu) {
  for (const double b : {0.1, 1.0, 4.0}) {
    auto m = straight<E>(8, 16, b);
    m.start(0);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> u(-1, 1);
    for (std::size_t k = 0; k < m.x.size(); ++k) {
      m.v[k] = {1e-4 * u(random), 1e-4 * u(random), 1e-4 * u(random)};
      if constexpr (E::rotations) m.w[k] = {1e-4 * u(random), 1e-4 * u(random), 1e-4 * u(random)};
    }
    // largest kinetic energy of the first and of the last thousand steps
    double first = 0, last = 0;
    for (int k = 0; k < 20000; ++k) {
      m.cycle([](auto&) {});
      if (k < 1000) first = std::max(first, m.kinetic());
      if (k >= 19000) last = std::max(last, m.kinetic());
    }
    MESSAGE("b = ", b, ": last / first = ", last / first);
    CHECK(last < 1.2 * first);
  }
}

TEST_CASE_TEMPLATE("beams: a pack gives the bits of the scalar lanes", E, Truss, BeamSchwer,
                   BeamHughesLiu) {
  constexpr int W = native_width < block_size ? native_width : block_size;
  using P = Pack<Real, W>;
  auto m = straight<E>(1, 1, 0.2);
  m.p.axial_damping = m.p.bending_damping = Real(0.1), m.p.stiffness_damping = Real(0.1);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  const int fields = E::template state_fields<ElasticLaw>(m.p);
  AlignedVector<Real> wide(fields * block_size), narrow(fields * block_size);
  Corners<P, 2> c;
  Corners<Real, 2> s[W];
  for (int i = 0; i < W; ++i)
    for (int a = 0; a < 2; ++a)
      for (int d = 0; d < 3; ++d) {
        s[i].x[a][d] = Real(a + 0.3 * u(random)), s[i].v[a][d] = Real(u(random)),
        s[i].w[a][d] = Real(u(random));
        set(c.x[a][d], i, s[i].x[a][d]), set(c.v[a][d], i, s[i].v[a][d]),
            set(c.w[a][d], i, s[i].w[a][d]);
      }
  Given<P> gp{};
  Given<Real> gs{};
  gp.orientation = {P(0.0), P(1.0), P(0.0)}, gs.orientation = {0, 1, 0};
  E::template initialise<P, ElasticLaw>(m.law, m.p, c, gp, {wide.data()});
  for (int i = 0; i < W; ++i)
    E::template initialise<Real, ElasticLaw>(m.law, m.p, s[i], gs, {narrow.data() + i});
  for (int k = 0; k < 3; ++k) {
    CornerForces<P, 2> fp;
    Totals<P> tp;
    E::template forces<P, ElasticLaw>(m.law, m.p, Real(1e-2), c, {wide.data()}, fp, tp);
    for (int i = 0; i < W; ++i) {
      CornerForces<Real, 2> f;
      Totals<Real> t;
      E::template forces<Real, ElasticLaw>(m.law, m.p, Real(1e-2), s[i], {narrow.data() + i}, f, t);
      bool same = t.time_step == get(tp.time_step, i) && t.internal == get(tp.internal, i) &&
                  t.damping == get(tp.damping, i);
      for (int a = 0; a < 2; ++a)
        for (int d = 0; d < 3; ++d) {
          same = same && f.f[a][d] == get(fp.f[a][d], i);
          if constexpr (E::rotations) same = same && f.m[a][d] == get(fp.m[a][d], i);
        }
      CHECK(same);
    }
  }
}
