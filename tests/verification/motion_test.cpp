// Bodies in motion: rotation, translation, vibration, collision (V12 to V14, V54, V62). kg mm ms kN
// GPa.
#include <cmath>

#include "deck.h"

using namespace fabrica;
using namespace fabrica::verification;

namespace {
constexpr double pi = 3.14159265358979323846;
constexpr double rho = 7.85e-6;
}  // namespace

// V12: a brick, a tetrahedron and a plate of each shell turn by 720 degrees at 50 rad/s in 5e4
// steps: stress below 1e-6 E, which the centrifugal stress rho w^2 R^2 = 3e-7 E is too; angular
// momentum and kinetic energy constant.
TEST_CASE("V12: spinning bricks, tetrahedra and plates") {
  const double omega = 0.05, end = 4 * pi / omega, young = 20;
  struct Body {
    Family family;
    int formulation;
  };
  for (const Body body : {Body{Family::solid, 1},
                          {Family::solid, 2},
                          {Family::solid, 10},
                          {Family::shell, 2},
                          {Family::shell, 16},
                          {Family::shell, 4}}) {
    Deck deck;
    deck.end(end).constant_step(end / 50000, 9);
    deck.key("MAT_ELASTIC").card(1, rho, young, 0.3);
    deck.part(1, 1, 1);
    const auto free = [](int, int, int) { return 0; };
    if (body.family == Family::solid) {
      deck.key("SECTION_SOLID").card(1, body.formulation);
      if (body.formulation == 10) {
        const int a = deck.node({0, 0, 0}), b = deck.node({30, 0, 0}), c = deck.node({0, 30, 0}),
                  d = deck.node({0, 0, 30});
        deck.solid(1, {a, b, c, d, d, d, d, d});
      } else {
        bricks(
            deck, 1, 1, 1,
            [](int i, int j, int k) { return 20.0 * Vec3d(i - 0.5, j - 0.5, k - 0.5); }, free, 1);
      }
    } else {
      deck.key("SECTION_SHELL").card(1, body.formulation, 5. / 6, 2).card(2.0, 2.0, 2.0, 2.0);
      const int a = deck.node({-10, -10, 0}), b = deck.node({10, -10, 0}),
                c = deck.node({10, 10, 0}), d = deck.node({-10, 10, 0});
      if (body.formulation == 4)
        deck.shell(1, {a, b, c, c}), deck.shell(1, {a, c, d, d});
      else
        deck.shell(1, {a, b, c, d});
    }
    deck.key("INITIAL_VELOCITY_GENERATION").card(1, 2, omega).card(0, 0, 0, 1.0, 2.0, 2.0);
    Run run(deck);
    const Vec3d axis = (1.0 / 3) * Vec3d(1, 2, 2);
    const auto momentum = [&] {  // about the centre, at the middle of the last step
      const State& s = run.state();
      Vec3d centre{0, 0, 0}, sum{0, 0, 0};
      double mass = 0;
      for (const NodeMotion& m : s.nodes)
        centre += m.mass * (m.x - 0.5 * s.dt * m.v), mass += m.mass;
      for (const NodeMotion& m : s.nodes)
        sum += m.mass * cross(m.x - 0.5 * s.dt * m.v - (1 / mass) * centre, m.v);
      for (const NodeSpin& n : s.spins) sum += n.inertia * n.w;
      return dot(sum, axis);
    };
    const auto energy = [&] {
      double sum = 0;
      for (const NodeMotion& m : run.state().nodes) sum += 0.5 * m.mass * dot(m.v, m.v);
      for (const NodeSpin& n : run.state().spins) sum += 0.5 * n.inertia * dot(n.w, n.w);
      return sum;
    };
    run.step();
    const double L = momentum(), K = energy();
    double stress = 0;
    while (run.step())
      if (run.state().cycle % 500 == 0) {
        const ElementReadout r = body.family == Family::solid ? run.solid(1) : run.shell(1);
        for (int k = 0; k < 6; ++k) stress = std::max(stress, std::abs(r.stress[0][k]) / young);
      }
    report("formulation, stress / E, angular momentum - 1, energy - 1",
           {double(body.formulation), stress, momentum() / L - 1, energy() / K - 1});
    CHECK(stress < 1e-6);
    CHECK(std::abs(momentum() / L - 1) < 1e-6);
    // the plate of two triangles loses 8e-6 in double too; rounding in float adds up to 4e-6
    CHECK(std::abs(energy() / K - 1) < tolerance(body.formulation == 4 ? 1e-5 : 1e-6, 1e-5));
  }
}

// V13: a thin disc of radius R turning at constant w: in its middle the radial and the hoop stress
// are rho w^2 R^2 (3 + nu)/8. It starts without stress and vibrates about that state, sixteen
// times: the mean, weighted by 1 - cos over the run, is the steady stress.
TEST_CASE("V13: a spinning disc") {
  Deck deck;
  const double R = 16, omega = 10, young = 200, nu = 0.3;
  const int n = 8;  // cells along half a side of the inner square, and from it to the rim
  deck.end(0.15);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, rho, young, nu);
  deck.key("HOURGLASS").card(1, 6, 1.0);
  deck.part(1, 1, 1, 1);
  // layers of nodes: below and above
  const auto pair = [&](const Vec3d& p) {
    return std::array<int, 2>{deck.node(p), deck.node(p + Vec3d(0, 0, 1))};
  };
  using Pair = std::array<int, 2>;
  const auto cell = [&](const Pair& a, const Pair& b, const Pair& c, const Pair& d) {
    return deck.solid(1, {a[0], b[0], c[0], d[0], a[1], b[1], c[1], d[1]});
  };
  const auto square = [&](double u, double v) {
    return (0.5 - 0.08 * std::abs(u * v)) * R * Vec3d(u, v, 0);
  };
  std::vector<std::vector<Pair>> inner(2 * n + 1, std::vector<Pair>(2 * n + 1));
  for (int i = 0; i <= 2 * n; ++i)
    for (int j = 0; j <= 2 * n; ++j)
      inner[i][j] = pair(square(double(i) / n - 1, double(j) / n - 1));
  int middle = 0;
  for (int i = 0; i < 2 * n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const int e = cell(inner[i][j], inner[i + 1][j], inner[i + 1][j + 1], inner[i][j + 1]);
      if (i == n && j == n) middle = e;
    }
  // rays from the boundary of the square to the rim, counter-clockwise from its corner at (1, -1)
  std::vector<std::vector<Pair>> rays;
  for (int k = 0; k < 8 * n; ++k) {
    const int side = k / (2 * n), at = k % (2 * n);
    const int i = side == 0 ? 2 * n : side == 1 ? 2 * n - at : side == 2 ? 0 : at;
    const int j = side == 0 ? at : side == 1 ? 2 * n : side == 2 ? 2 * n - at : 0;
    const double angle = 0.25 * pi * (k / double(n) - 1);
    const Vec3d from = square(double(i) / n - 1, double(j) / n - 1),
                to{R * std::cos(angle), R * std::sin(angle), 0};
    rays.push_back({inner[i][j]});
    for (int r = 1; r <= n; ++r) rays.back().push_back(pair(from + (double(r) / n) * (to - from)));
  }
  for (int k = 0; k < 8 * n; ++k)
    for (int r = 0; r < n; ++r) {
      const auto &a = rays[k], &b = rays[(k + 1) % (8 * n)];
      cell(a[r], a[r + 1], b[r + 1], b[r]);
    }
  deck.key("INITIAL_VELOCITY_GENERATION").card(1, 2, omega).card(0, 0, 0, 0, 0, 1.0);
  Run run(deck);
  double weights = 0;
  Sym3<double> mean{0, 0, 0, 0, 0, 0};
  while (run.step()) {
    const double weight = run.state().dt * (1 - std::cos(2 * pi * run.time() / 0.15));
    mean = mean + weight * run.solid(middle).stress[0];
    weights += weight;
  }
  const double exact = rho * omega * omega * R * R * (3 + nu) / 8 * weights;
  report("sigma / exact, cycles", {mean.xx / exact, mean.yy / exact, double(run.state().cycle)});
  CHECK(std::abs(mean.xx / exact - 1) < 0.02);
  CHECK(std::abs(mean.yy / exact - 1) < 0.02);
}

// V14: 500 mm at 15 mm/ms in 740 thousand steps leave no strain and arrive where they should.
TEST_CASE("V14: a long translation leaves no strain") {
  Deck deck;
  // a step of few binary digits: what is tested is not how 740 thousand equal roundings add up
  const double v = 15, end = 500 / v, dt = 47 * 0x1p-20, young = 20;
  deck.end(end).constant_step(dt, 9);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, rho, young, 0.3);
  deck.part(1, 1, 1);
  const Grid g = bricks(
      deck, 1, 1, 1, [](int i, int j, int k) { return 1.7 * Vec3d(i + 0.1 * j, j, k + 0.2 * i); },
      [](int, int, int) { return 0; }, 1);
  deck.key("INITIAL_VELOCITY").card(0).card(v * 2 / 3, v * 2 / 3, v / 3);
  Run run(deck);
  run.finish();
  CHECK(run.state().cycle > 740000);
  double stress = 0, arrival = 0;
  for (int k = 0; k < 6; ++k)
    stress = std::max(stress, std::abs(run.solid(g.elements[0]).stress[0][k]) / young);
  for (int n : g.ids)
    arrival = std::max(arrival, std::abs(norm(run.displacement(n)) / (v * run.time()) - 1));
  report("strain, displacement - 1", {stress, arrival});
  CHECK(stress < tolerance(1e-10, 1e-7));
  CHECK(arrival < tolerance(1e-12, 1e-6));
}

// V54: a beam whose ends are nodes of heavy nodal rigid bodies vibrates as if clamped: w
// = 22.373/L^2 sqrt(EI/(rho A)).
TEST_CASE("V54: a beam between rigid bodies has the frequency of clamped ends") {
  Deck deck;
  const double L = 100, b = 2, young = 210, area = b * b, I = b * b * b * b / 12;
  const double exact = 22.373 / (L * L) * std::sqrt(young * I / (rho * area));
  const int n = 20;
  deck.end(6 * pi / exact);
  deck.key("SECTION_BEAM").card(1, 2).card(area, I, I, 2 * I);
  deck.key("MAT_ELASTIC").card(1, rho, young, 0.3);
  deck.part(1, 1, 1);
  std::vector<int> ids;
  for (int i = 0; i <= n; ++i) ids.push_back(deck.node({L * i / n, 0, 0}));
  deck.key("ELEMENT_BEAM");
  const int third = deck.node({0, 100, 0});
  for (int i = 0; i < n; ++i) deck.card(i + 1, 1, ids[i], ids[i + 1], third);
  // each body has three more nodes around the end, of a mass that makes it as good as fixed
  const double M = 1e6 * rho * area * L;
  for (int end : {0, 1}) {
    const Vec3d at{end * L, 0, 0};
    std::vector<int> body = {ids[end * n]};
    for (const Vec3d& r : {Vec3d(0, 30, 0), Vec3d(0, -30, 30), Vec3d(0, 0, -30)})
      body.push_back(deck.node(at + r)), deck.mass(body.back(), M);
    deck.node_set(end + 1, body);
    deck.key("CONSTRAINED_NODAL_RIGID_BODY").card(10 + end, 0, end + 1);
  }
  // a start near the first mode; what is in the third mode turns the zeros by little
  deck.key("INITIAL_VELOCITY_NODE");
  for (int i = 1; i < n; ++i) {
    const double x = 4.73004 * i / n, ratio = 0.982502;
    deck.card(
        ids[i], 0, 0, 1e-3 * (std::cosh(x) - std::cos(x) - ratio * (std::sinh(x) - std::sin(x))), 0,
        -1e-3 * 4.73004 / L * (std::sinh(x) + std::sin(x) - ratio * (std::cosh(x) - std::cos(x))),
        0);
  }
  Run run(deck);
  double before = 0;
  std::vector<double> zeros;
  while (run.step()) {
    const double u = run.displacement(ids[n / 2]).z;
    if (u * before < 0) zeros.push_back(run.time() - run.state().dt * u / (u - before));
    before = u;
  }
  REQUIRE(zeros.size() >= 5);
  const double found = 2 * 2 * pi / (zeros[4] - zeros[0]);
  report("frequency / exact", {found / exact});
  CHECK(std::abs(found / exact - 1) < 0.01);
}

// V62: a bar meets a bar at rest of equal length, wave speed c and impedance end to end: they part
// after 2 L/c with their velocities exchanged. The first is slimmer and denser, so that its corners
// land within the other's end.
TEST_CASE("V62: two bars collide and exchange their velocities") {
  Deck deck;
  const double young = 200, c = std::sqrt(young / rho), v = 1;
  const int n = 100;
  const double side = 0.8, denser = 1 / (side * side);
  deck.end(2.6 * n / c).no_bulk_viscosity();
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, rho, young, 0.0);
  deck.key("MAT_ELASTIC").card(2, denser * rho, denser * young, 0.0);
  deck.part(1, 1, 2).part(2, 1, 1);
  const auto free = [](int, int, int) { return 0; };
  const Grid a = bricks(
      deck, 1, 1, n,
      [side](int i, int j, int k) { return Vec3d(0.1 + side * i, 0.1 + side * j, k - 100 - 1e-4); },
      free, 1);
  const Grid b = bricks(
      deck, 1, 1, n, [](int i, int j, int k) { return Vec3d(i, j, k); }, free, 2);
  deck.key("INITIAL_VELOCITY_GENERATION").card(1, 2, 0, 0, 0, v).card(0);
  deck.key("CONTACT_AUTOMATIC_SURFACE_TO_SURFACE").card(1, 2, 3, 3).card(0).card(1.0, 1.0).card(1);
  Run run(deck);
  const auto velocity = [&](const Grid& g) {
    double p = 0, m = 0;
    for (int id : g.ids) {
      const NodeMotion& node = run.state().nodes[std::size_t(id - 1)];
      p += node.mass * node.v.z, m += node.mass;
    }
    return p / m;
  };
  double parts = 0, closed = 0;
  while (run.step()) {
    const double force = run.simulation->contacts().resultants()[0].side_a.z;
    if (std::abs(force) > 0.25 * rho * c * v)
      parts = run.time(), closed = closed > 0 ? closed : run.time();
  }
  const double first = velocity(a), second = velocity(b);
  report("restitution, contact time / (2 L/c), velocities",
         {(second - first) / v, (parts - closed) * c / (2 * n), first, second});
  CHECK((second - first) / v > 0.99);
  CHECK(std::abs((parts - closed) * c / (2 * n) - 1) < 0.02);
  CHECK(std::abs(first + second - v) < 1e-6 * v);
}
