// Tests of the membranes: patch state, rigid rotation, virtual power, stretched bar, stability,
// lane widths.
#include "element/membrane.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

#include "base/lane_math.h"
#include "base/pack.h"
#include "element/element_driver.h"
#include "element/membrane_full.h"
#include "material/elastic.h"

using namespace fabrica;
using namespace fabrica::test;

namespace {

constexpr bool mixed = sizeof(Real) == 4;
const double pi = 3.14159265358979323846;

template <class E>
Mesh<E, ElasticLaw> sheet() {
  Mesh<E, ElasticLaw> m;
  const Elastic e = Elastic::from_youngs(7.85e-6, 210, 0.3);
  m.law = {Real(e.density), Real(e.bulk), Real(e.shear)};
  m.moduli();
  gauss_layers(m.p, 1);
  m.p.hourglass = 4, m.p.hourglass_coefficient = Real(0.8);
  return m;
}
template <class E>
Mesh<E, ElasticLaw> one(double warp = 0) {
  auto m = sheet<E>();
  m.add({0, 0, warp}), m.add({1.1, 0.1, -warp}), m.add({1.2, 1.0, warp}), m.add({-0.1, 0.9, -warp});
  m.elements.push_back({0, 1, 2, 3});
  return m;
}

}  // namespace

// v = G x: sigma = plane stress modulus times G dt; the Almansi strain differs by dt^2 G^T G / 2,
// here 2e-7 of it.
TEST_CASE_TEMPLATE("membranes: constant strain gives exact stress", E, Membrane, MembraneFull) {
  auto m = one<E>();
  m.start(0.1);
  const double ex = 1e-4, ey = 3e-4, exy = -2e-4;
  for (Vec3d& v : m.v) {
    const Vec3d r = m.x[&v - m.v.data()];
    v = {ex * r.x + exy * r.y, ey * r.y + exy * r.x, 0};
  }
  m.dt = 1e-3;
  m.forces();
  const Sym3<Real> s = E::template stress<ElasticLaw>(m.p, m.view(0), 0);
  const Mat3<Real> R = E::frame(m.gather(0).x).rotation();
  Mat3d Rd;
  for (int i = 0; i < 9; ++i) Rd.a[i / 3][i % 3] = R.a[i / 3][i % 3];
  const Sym3<double> g = rotate(Rd, Sym3<double>{s.xx, s.yy, 0, s.xy, 0, 0});
  const double c = 210 / (1 - 0.09) * 1e-3, tolerance = (mixed ? 2e-6 : 3e-7) * c * 4e-4;
  CHECK(std::abs(g.xx - c * (ex + 0.3 * ey)) < tolerance);
  CHECK(std::abs(g.yy - c * (ey + 0.3 * ex)) < tolerance);
  CHECK(std::abs(g.xy - c * 0.7 * exy) < tolerance);
}

TEST_CASE_TEMPLATE("membranes: a finite rigid rotation leaves no stress", E, Membrane,
                   MembraneFull) {
  auto m = one<E>();
  m.start(0.1);
  const auto first = m.x;
  const int steps = 4000;
  const Vec3d axis{0.6, -0.48, 0.64};
  m.dt = 1;
  for (int k = 1; k <= steps; ++k) {
    const double t = 2 * pi * k / steps;
    for (int a = 0; a < 4; ++a) {
      const Vec3d r = first[a], along = dot(axis, r) * axis;
      const Vec3d to = along + std::cos(t) * (r - along) + std::sin(t) * cross(axis, r);
      m.v[a] = to - m.x[a], m.x[a] = to;
    }
    m.forces();
  }
  const Sym3<Real> s = E::template stress<ElasticLaw>(m.p, m.view(0), 0);
  CHECK(std::max({std::abs(s.xx), std::abs(s.yy), std::abs(s.xy)}) / 210 < (mixed ? 3e-6 : 1e-12));
}

TEST_CASE_TEMPLATE("membranes: corner forces are the transpose of the strain rates", E, Membrane,
                   MembraneFull) {
  auto m = one<E>(0.04);
  m.start(0.1);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  auto shake = [&] {
    for (Vec3d& v : m.v) v = {u(random), u(random), u(random)};
  };
  shake();
  m.dt = 1e-3;
  m.forces();
  for (int trial = 0; trial < 4; ++trial) {
    shake();
    m.dt = 1e-8, m.internal = m.hourglass = 0;
    m.forces();
    double power = 0, scale = 0;
    for (int a = 0; a < 4; ++a) power += dot(m.force[a], m.v[a]), scale += norm(m.force[a]);
    CHECK(std::abs((m.internal + m.hourglass) / m.dt + power) < 1e-4 * scale);
    CHECK(norm(m.force[0] + m.force[1] + m.force[2] + m.force[3]) < (mixed ? 1e-5 : 1e-13) * scale);
  }
}

// A sheet held on one side and pulled on the other: elongation F L/(E A) at rest, free to contract.
TEST_CASE_TEMPLATE("membranes: stretched sheet", E, Membrane, MembraneFull) {
  auto m = sheet<E>();
  const int n = 6;
  const double a = 10, h = 0.1, F = 1e-3;
  square(m, n, a);
  for (std::size_t k = 0; k < m.x.size(); ++k) m.fixed[k] = m.x[k].x == 0 ? 0b101 : 0b100;
  m.fixed[0] |= 0b010;
  m.start(h);
  const double first = 0.5 * pi / a * std::sqrt(210 / 7.85e-6);
  m.damping = first, m.dt *= 0.5;  // the lagged damping takes some of the stable step
  std::vector<int> edge;
  for (std::size_t k = 0; k < m.x.size(); ++k)
    if (m.x[k].x == a) edge.push_back(int(k));
  while (m.time < 20 / first)
    m.cycle([&](auto& mesh) {
      for (const int k : edge)
        mesh.force[k].x += (k == edge.front() || k == edge.back() ? 0.5 : 1.0) * F / n;
    });
  const double exact = F / (h * 210);
  CHECK(std::abs((m.x[edge[2]].x - a) / exact - 1) < 1e-3);
}

TEST_CASE_TEMPLATE("membranes: the estimated step is stable", E, Membrane, MembraneFull) {
  auto m = sheet<E>();
  square(m, 4, 4.0);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  for (Vec3d& x : m.x) x += Vec3d{0.15 * u(random), 0.15 * u(random), 0};
  m.start(0.1);
  for (Vec3d& v : m.v) v = {1e-4 * u(random), 1e-4 * u(random), 0};
  double first = 0, last = 0;
  for (int k = 0; k < 5000; ++k) {
    m.cycle([](auto&) {});
    if (k < 500) first = std::max(first, m.kinetic());
    if (k >= 4500) last = std::max(last, m.kinetic());
  }
  CHECK(last < 1.2 * first);
}

TEST_CASE_TEMPLATE("membranes: a pack gives the bits of the scalar lanes", E, Membrane,
                   MembraneFull) {
  constexpr int W = native_width < block_size ? native_width : block_size;
  using P = Pack<Real, W>;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  auto m = one<E>();
  m.p.thickness_update = 1, m.p.stiffness_damping = Real(0.1);
  const int fields = E::template state_fields<ElasticLaw>(m.p);
  AlignedVector<Real> wide(fields * block_size), narrow(fields * block_size);
  Corners<P, 4> c;
  Corners<Real, 4> s[W];
  for (int i = 0; i < W; ++i)
    for (int a = 0; a < 4; ++a)
      for (int d = 0; d < 3; ++d) {
        s[i].x[a][d] = Real((d == 0 ? m.x[a].x : d == 1 ? m.x[a].y : 0) + 0.1 * u(random));
        s[i].v[a][d] = Real(u(random));
        set(c.x[a][d], i, s[i].x[a][d]), set(c.v[a][d], i, s[i].v[a][d]);
      }
  Given<P> gp{};
  Given<Real> gs{};
  for (int a = 0; a < 4; ++a) gp.thickness[a] = P(0.1), gs.thickness[a] = Real(0.1);
  E::template initialise<P, ElasticLaw>(m.law, m.p, c, gp, {wide.data()});
  for (int i = 0; i < W; ++i)
    E::template initialise<Real, ElasticLaw>(m.law, m.p, s[i], gs, {narrow.data() + i});
  for (int k = 0; k < 3; ++k) {
    CornerForces<P, 4> fp;
    Totals<P> tp;
    E::template forces<P, ElasticLaw>(m.law, m.p, Real(1e-3), c, {wide.data()}, fp, tp);
    for (int i = 0; i < W; ++i) {
      CornerForces<Real, 4> f;
      Totals<Real> t;
      E::template forces<Real, ElasticLaw>(m.law, m.p, Real(1e-3), s[i], {narrow.data() + i}, f, t);
      bool same = t.time_step == get(tp.time_step, i) && t.internal == get(tp.internal, i);
      for (int a = 0; a < 4; ++a)
        for (int d = 0; d < 3; ++d) same = same && f.f[a][d] == get(fp.f[a][d], i);
      CHECK(same);
    }
  }
}
