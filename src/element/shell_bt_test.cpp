// Tests of the Belytschko-Tsay shell: patch states, rigid rotation, virtual power, plates.
#include "element/shell_bt.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

#include "base/lane_math.h"
#include "base/pack.h"
#include "element/element_driver.h"
#include "material/elastic.h"

using namespace fabrica;
using namespace fabrica::test;

namespace {

constexpr bool mixed = sizeof(Real) == 4;
const double pi = 3.14159265358979323846;
ElasticLaw steel() {
  const Elastic e = Elastic::from_youngs(7.85e-6, 210, 0.3);
  return {Real(e.density), Real(e.bulk), Real(e.shear)};
}

template <class E>
Mesh<E, ElasticLaw> one(double warp = 0) {
  Mesh<E, ElasticLaw> m;
  m.law = steel();
  m.moduli();
  gauss_layers(m.p, 3);
  m.p.shear_factor = Real(5.0 / 6.0);
  m.p.hourglass = 4;
  m.p.hourglass_coefficient = Real(0.05);
  m.add({0, 0, warp}), m.add({1.1, 0.1, -warp}), m.add({1.2, 1.0, warp}), m.add({-0.1, 0.9, -warp});
  m.elements.push_back({0, 1, 2, 3});
  return m;
}

}  // namespace

// Patch: v = G x with constant curvature rate k; sigma = plane stress modulus times (G + z k) dt.
TEST_CASE_TEMPLATE("shell: constant membrane strain and curvature give exact stress", E, ShellBT, ShellBTInvariant) {
  auto m = one<E>();
  m.start(0.1);
  const double kx = 2e-3, ky = -1e-3, kxy = 0.7e-3, ex = 1e-4, ey = 3e-4, exy = -2e-4;
  for (int a = 0; a < 4; ++a) {
    const Vec3d r = m.x[a];
    // w = -(kx x^2 + ky y^2 + 2 kxy x y)/2, wy = -w,x, wx = w,y: kxx = wy,x, kyy = -wx,y
    m.v[a] = {ex * r.x + exy * r.y, ey * r.y + exy * r.x, 0};
    m.w[a] = {-(ky * r.y + kxy * r.x), kx * r.x + kxy * r.y, 0};
  }
  m.dt = 1e-3;
  // shear does not vanish at the corners' mean, so only the in-plane stress is compared
  m.forces();
  const auto axes = E::frame(m.gather(0).x);
  const double c = 210 / (1 - 0.09), G = 210 / 2.6;
  for (int q = 0; q < 3; ++q) {
    const double z = 0.05 * m.p.layer_z[q];
    const double xx = 1e-3 * (ex + z * kx), yy = 1e-3 * (ey + z * ky), xy = 1e-3 * (exy + z * kxy);
    const Sym3<Real> s = E::template stress<ElasticLaw>(m.p, m.view(0), q);
    const Sym3<double> sd{s.xx, s.yy, s.zz, s.xy, 0, 0};
    const Mat3<Real> R = axes.rotation();
    Mat3d Rd;
    for (int i = 0; i < 9; ++i) Rd.a[i / 3][i % 3] = R.a[i / 3][i % 3];
    const Sym3<double> g = rotate(Rd, sd);
    const double tolerance = (mixed ? 1e-5 : 2e-6) * 1e-4;  // second-order part of the Almansi strain: 4e-7 relative
    CHECK(std::abs(g.xx - c * (xx + 0.3 * yy)) < tolerance);
    CHECK(std::abs(g.yy - c * (yy + 0.3 * xx)) < tolerance);
    CHECK(std::abs(g.xy - 2 * G * xy) < tolerance);
  }
}

// Rigid rotation: v of the half step carries x exactly from one rotated place to the next; no stress may remain.
TEST_CASE_TEMPLATE("shell: a finite rigid rotation leaves no stress", E, ShellBT, ShellBTInvariant) {
  for (const int formulation : {2, 10}) {
    auto m = one<E>(formulation == 10 ? 0.05 : 0.0);
    m.p.formulation = formulation;
    m.start(0.1);
    const auto first = m.x;
    const int steps = 4000;
    Vec3d axis{0.6, -0.48, 0.64};
    m.dt = 1;
    auto turned = [&](const Vec3d& r, double t) {
      const Vec3d along = dot(axis, r) * axis;
      return along + std::cos(t) * (r - along) + std::sin(t) * cross(axis, r);
    };
    for (int k = 1; k <= steps; ++k) {
      const double theta = 2 * pi * k / steps;
      for (int a = 0; a < 4; ++a) {
        const Vec3d to = turned(first[a], theta);
        m.v[a] = to - m.x[a], m.x[a] = to;
        m.w[a] = (2 * pi / steps) * axis;
      }
      m.forces();
    }
    double plane = 0, across = 0;
    for (int q = 0; q < 3; ++q) {
      const Sym3<Real> s = E::template stress<ElasticLaw>(m.p, m.view(0), q);
      plane = std::max({plane, std::abs(double(s.xx)), std::abs(double(s.yy)), std::abs(double(s.xy))});
      across = std::max({across, std::abs(double(s.yz)), std::abs(double(s.zx))});
    }
    // in the plane exact; the turn of the normal is exact to third order, theta_step^2 Theta / 12 = 1.3e-6
    MESSAGE("formulation ", formulation, ": stress / E after one turn ", plane / 210, " ", across / 210);
    CHECK(plane / 210 < (mixed ? 3e-6 : 1e-12));
    CHECK(across / 210 < (mixed ? 3e-6 : 1.3e-6));
    CHECK(std::abs(m.hourglass) < (mixed ? 1e-10 : 1e-20));
  }
}

// Virtual power: with stress s held, f.v + m.w = -A h sum w s:d - hourglass power for any corner motion.
TEST_CASE_TEMPLATE("shell: corner forces are the transpose of the strain rates", E, ShellBT, ShellBTInvariant) {
  for (const int formulation : {2, 10}) {
    auto m = one<E>(0.04);
    m.p.formulation = formulation;
    m.start(0.1);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u(-1, 1);
    auto shake = [&](double size) {
      for (int a = 0; a < 4; ++a) {
        m.v[a] = {size * u(random), size * u(random), size * u(random)};
        m.w[a] = {size * u(random), size * u(random), size * u(random)};
      }
    };
    shake(1);
    m.dt = 1e-3;
    m.forces();  // builds up stress
    // a tiny step in another direction: the energy increment is the power of the held stress
    shake(1);
    m.dt = 1e-8;
    m.internal = m.hourglass = 0;
    m.forces();
    double power = 0;
    for (int a = 0; a < 4; ++a) power += dot(m.force[a], m.v[a]) + dot(m.moment[a], m.w[a]);
    // the energy uses the mean stress of the step: relative difference of order 1e-8 / 1e-3
    const double scale = std::abs(m.internal) + std::abs(m.hourglass);
    CHECK(std::abs(m.internal + m.hourglass + power * m.dt) < 1e-4 * scale);
    Vec3d total{0, 0, 0}, spin{0, 0, 0};
    double size = 0, moment_size = 0;
    for (int a = 0; a < 4; ++a) {
      total += m.force[a];
      spin += cross(m.x[a], m.force[a]) + m.moment[a];
      size += norm(m.force[a]), moment_size += norm(m.moment[a]) + norm(cross(m.x[a], m.force[a]));
    }
    CHECK(norm(total) < (mixed ? 1e-5 : 1e-13) * size);
    if (formulation == 10) CHECK(norm(spin) < (mixed ? 1e-5 : 1e-13) * moment_size);
  }
}

// Simply supported square plate: first frequency w = 2 pi^2/a^2 sqrt(D / (rho h)).
TEST_CASE("shell: first frequency of a simply supported plate (V30)") {
  Mesh<ShellBT, ElasticLaw> m;
  m.law = steel(), m.moduli();
  gauss_layers(m.p, 2);
  m.p.shear_factor = Real(5.0 / 6.0), m.p.hourglass = 4, m.p.hourglass_coefficient = Real(0.05);
  const double a = 100, h = 1;
  const int n = 16;
  square(m, n, a);
  for (std::size_t k = 0; k < m.x.size(); ++k) {
    const bool side = m.x[k].x == 0 || m.x[k].x == a || m.x[k].y == 0 || m.x[k].y == a;
    m.fixed[k] = 0b100011 | (side ? 0b100 : 0);
    if (m.x[k].x == 0 || m.x[k].x == a) m.fixed[k] |= 0b001000;  // edge along y: no rotation about x
    if (m.x[k].y == 0 || m.x[k].y == a) m.fixed[k] |= 0b010000;
  }
  m.start(h);
  for (std::size_t k = 0; k < m.x.size(); ++k) {
    const double X = pi * m.x[k].x / a, Y = pi * m.x[k].y / a, v0 = 1e-3;
    m.v[k].z = m.fixed[k] >> 2 & 1 ? 0 : v0 * std::sin(X) * std::sin(Y);
    m.w[k] = {v0 * pi / a * std::sin(X) * std::cos(Y), -v0 * pi / a * std::cos(X) * std::sin(Y), 0};
  }
  const double D = 210 / (12 * (1 - 0.09)), exact = 2 * pi * pi / (a * a) * std::sqrt(D / 7.85e-6);
  // time of the second zero of the centre's deflection: one half period
  const int centre = (n / 2) * (n + 1) + n / 2;
  double before = 0, zero_time = 0;
  std::vector<double> zeros;
  for (int k = 0; k < 200000 && zeros.size() < 2; ++k) {
    m.cycle([](auto&) {});
    const double z = m.x[centre].z;
    if (before != 0 && (z > 0) != (before > 0)) {
      zero_time = m.time - m.dt * z / (z - before);
      zeros.push_back(zero_time);
    }
    before = z;
  }
  REQUIRE(zeros.size() == 2);
  const double found = pi / (zeros[1] - zeros[0]);
  MESSAGE("frequency / exact = ", found / exact);
  CHECK(found / exact == doctest::Approx(1).epsilon(0.01));
}

// The bits do not depend on the lane width.
TEST_CASE("shell: a pack gives the bits of the scalar lanes") {
  constexpr int W = native_width < block_size ? native_width : block_size;
  using P = Pack<Real, W>;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  auto m = one<ShellBT>();
  m.p.formulation = 10, m.p.thickness_update = 1;
  const int fields = ShellBT::state_fields<ElasticLaw>(m.p);
  AlignedVector<Real> wide(fields * block_size), narrow(fields * block_size);
  Corners<P, 4> c;
  Corners<Real, 4> s[W];
  const double x0[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int i = 0; i < W; ++i)
    for (int a = 0; a < 4; ++a)
      for (int d = 0; d < 3; ++d) {
        s[i].x[a][d] = Real((d < 2 ? x0[a][d] : 0) + 0.1 * u(random));
        s[i].v[a][d] = Real(u(random)), s[i].w[a][d] = Real(u(random));
        set(c.x[a][d], i, s[i].x[a][d]), set(c.v[a][d], i, s[i].v[a][d]), set(c.w[a][d], i, s[i].w[a][d]);
      }
  Given<P> gp{};
  Given<Real> gs{};
  for (int a = 0; a < 4; ++a) gp.thickness[a] = P(0.1), gs.thickness[a] = Real(0.1);
  ShellBT::initialise<P, ElasticLaw>(m.law, m.p, c, gp, {wide.data()});
  for (int i = 0; i < W; ++i) ShellBT::initialise<Real, ElasticLaw>(m.law, m.p, s[i], gs, {narrow.data() + i});
  for (int k = 0; k < 3; ++k) {
    CornerForces<P, 4> fp;
    Totals<P> tp;
    ShellBT::forces<P, ElasticLaw>(m.law, m.p, Real(1e-3), c, {wide.data()}, fp, tp);
    for (int i = 0; i < W; ++i) {
      CornerForces<Real, 4> f;
      Totals<Real> t;
      ShellBT::forces<Real, ElasticLaw>(m.law, m.p, Real(1e-3), s[i], {narrow.data() + i}, f, t);
      bool same = t.time_step == get(tp.time_step, i) && t.internal == get(tp.internal, i);
      for (int a = 0; a < 4; ++a)
        for (int d = 0; d < 3; ++d) same = same && f.f[a][d] == get(fp.f[a][d], i) && f.m[a][d] == get(fp.m[a][d], i);
      CHECK(same);
    }
  }
}
