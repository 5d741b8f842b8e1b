// Single masses, springs, bodies and walls through decks (V01, V02, V52, V57, V68).
#include <cmath>

#include "deck.h"
#include "solver/history.h"

using namespace fabrica;
using namespace fabrica::verification;

namespace {
constexpr double pi = 3.14159265358979323846;
}

// V01: x = -g t^2/2, exact for the half-step start.
TEST_CASE("V01: free fall of one node over 1e6 steps") {
  Deck deck;
  // 9.81e-3 to 33 binary digits and a power of two as step: velocities, and products, are exact in
  // double, so that the scheme is tested and not a million roundings of the same sign (5.3e-12 with
  // dt = 1e-3)
  const double g = std::round(std::ldexp(9.81e-3, 39)) * 0x1p-39, dt = 0x1p-10;
  deck.end(2000).constant_step(dt, 1);
  deck.mass(deck.node({0, 0, 0}), 2.0);
  deck.curve(2, {{0, 1}, {1e4, 1}});
  deck.key("LOAD_BODY_Z").card(2, g);
  Run run(deck);
  for (int i = 0; i < 1000000; ++i) run.step();
  const double t = 1000000 * dt, error = run.x(1).z / (-0.5 * g * t * t) - 1;
  report("relative error", {error});
  CHECK(std::abs(error) < 1e-12);
  CHECK(run.time() == doctest::Approx(t).epsilon(1e-14));
}

// V52: L = 1 m, 90 degrees: T = 1.1803406 x 2 pi sqrt(L/g) = 2.367842 s for a point mass. Bodies
// are given by *PART_INERTIA; the inertia about the centre, I/m = 1e-4 L^2, adds its root to the
// period.
TEST_CASE("V52: a pendulum on a revolute joint") {
  Deck deck;
  const double L = 1000, g = 9.81e-3, ratio = 1e-4;
  deck.end(8000).constant_step(0.2, 1);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_RIGID").card(1, 7.85e-6, 210.0, 0.3);
  deck.key("MAT_RIGID").card(2, 7.85e-6, 210.0, 0.3).card(1, 7, 7).card(0);
  for (int p : {1, 2}) {
    const double at = p == 1 ? L : 0;
    deck.key("PART_INERTIA").card("body").card(p, 1, p);
    deck.card(at, 0, 0, 1.0, 0, 0);
    deck.card(ratio * L * L, 0, 0, ratio * L * L, 0, ratio * L * L).card(0, 0, 0, 0, 0, 0);
    bricks(
        deck, 1, 1, 1, [&](int i, int j, int k) { return Vec3d(at + i, j, k); },
        [](int, int, int) { return 0; }, p);
  }
  const int a1 = deck.node({0, 0, 0}), a2 = deck.node({0, 0, 100}), b1 = deck.node({0, 0, 0}),
            b2 = deck.node({0, 0, 100}), tip = deck.node({L, 0, 0});
  deck.node_set(1, {b1, b2, tip}).node_set(2, {a1, a2});
  deck.key("CONSTRAINED_EXTRA_NODES_SET").card(1, 1).card(2, 2);
  deck.key("CONSTRAINED_JOINT_REVOLUTE").card(a1, b1, a2, b2);
  deck.curve(2, {{0, 1}, {1e5, 1}});
  deck.key("LOAD_BODY_Y").card(2, g);
  Run run(deck);
  double before = 0;
  std::vector<double> zeros;
  while (run.step()) {
    const double x = run.x(tip).x;
    if (x * before < 0) zeros.push_back(run.time() - run.state().dt * x / (x - before));
    before = x;
  }
  REQUIRE(zeros.size() >= 5);
  const double period = (zeros[4] - zeros[0]) / 2;
  const double exact = 1.1803406 * 2 * pi * std::sqrt(L / g) * std::sqrt(1 + ratio);
  report("period / exact - 1", {period / exact - 1});
  CHECK(period == doctest::Approx(exact).epsilon(1e-5));
}

// V57: a node follows velocity, acceleration and displacement curves; at the end it has moved by
// the integral of the curve. v = 3 t: x = 3 t^2/2 by the midpoint rule, exact for a linear curve.
TEST_CASE("V57: prescribed motion is the integral of its curve") {
  for (int kind : {0, 2}) {
    Deck deck;
    deck.end(1.0).constant_step(1.0 / 512, 1);
    const int n = deck.node({5, 0, 0});
    deck.mass(n, 1.0);
    deck.curve(2, {{0, 0}, {2, kind == 0 ? 6.0 : 3.0}});
    deck.key("BOUNDARY_PRESCRIBED_MOTION_NODE").card(n, 1, kind, 2, 1.0);
    Run run(deck);
    run.finish();
    CHECK(run.time() == doctest::Approx(1).epsilon(1e-14));
    report("displacement - 1.5", {run.displacement(n).x - 1.5});
    CHECK(run.displacement(n).x == doctest::Approx(1.5).epsilon(1e-12));
  }
}

// V68: masses m hit a free wall M at rest: common velocity m v / (m + M).
TEST_CASE("V68: a wall and the nodes that it stops share their momentum") {
  Deck deck;
  const double m = 3, M = 5, v = 2;
  deck.end(1).constant_step(1e-3, 1);
  const int n = deck.node({0, 0, 0.1});
  deck.mass(n, m);
  deck.key("INITIAL_VELOCITY_NODE").card(n, 0, 0, -v);
  deck.key("RIGIDWALL_PLANAR_MOVING").card(0).card(0, 0, 0, 0, 0, 1.0).card(M, 0);
  Run run(deck);
  run.finish();
  report("node, wall, expected",
         {run.v(n).z, run.simulation->rigid_walls().velocity(0).z, -m * v / (m + M)});
  CHECK(run.v(n).z == doctest::Approx(-m * v / (m + M)).epsilon(1e-12));
  CHECK(run.simulation->rigid_walls().velocity(0).z ==
        doctest::Approx(-m * v / (m + M)).epsilon(1e-12));
}

// V02 as a deck without any deformable element: w dt = 0.1, period / exact = (w dt/2) / asin(w
// dt/2).
TEST_CASE("V02: a spring between masses has the period of the central difference scheme") {
  Deck deck;
  const double k = 4, m = 2, omega = std::sqrt(2 * k / m), dt = 0.1 / omega, v = 1e-3;
  deck.end(2000 * dt).constant_step(dt, 9);
  deck.key("SECTION_DISCRETE").card(1).card(0, 0);
  deck.key("MAT_SPRING_ELASTIC").card(1, k);
  deck.part(1, 1, 1);
  const int a = deck.node({0, 0, 0}), b = deck.node({10, 0, 0});
  deck.mass(a, m), deck.mass(b, m);
  deck.spring(1, a, b);
  deck.key("INITIAL_VELOCITY_NODE").card(a, -v).card(b, v);
  Run run(deck);
  const double theta = 2 * std::asin(0.05);  // turn of the phase in one step
  double before = 0, first = 0, last = 0;
  int crossings = 0;
  while (run.step()) {
    const double d = run.displacement(b).x - run.displacement(a).x;
    if (before < 0 && d >= 0) {
      // between the steps the motion is A sin(theta n + phi)
      last = run.time() -
             run.state().dt * std::atan2(std::sin(theta), std::cos(theta) - before / d) / theta;
      if (crossings++ == 0) first = last;
    }
    before = d;
  }
  REQUIRE(crossings > 20);
  const double ratio = (last - first) / (crossings - 1) * omega / (2 * pi);
  report("period / exact, expected", {ratio, 0.05 / std::asin(0.05)});
  CHECK(ratio == doctest::Approx(0.05 / std::asin(0.05)).epsilon(1e-8));
}

// A muscle lifts a weight of a sixth of its strength. With Hill's g(r) = (1 + r)/(1 - 4 r) it
// shortens at r = -1/2, so v = SRM lopt / 2, approached as exp(-t/tau), tau = m SRM lopt/(F g').
// The sums of forces are kept to q = 2^-40 of m size/dt^2, 4.8e-7 with the spring's step, and two
// roundings move v by q/(F g')/r = 3e-5.
// In the steady state it gives the power of the lifted weight. The truss and the spring are the
// same muscle.
TEST_CASE("V97: a muscle shortens under a weight at the speed of Hill's curve") {
  const double lopt = 100, srm = 0.01, area = 200, peak = 3e-4, strength = area * peak;
  const double weight = strength / 6, m = 0.02, v = 0.5 * srm * lopt;
  const auto muscle = [&](bool truss) {
    Deck deck;
    deck.end(80).constant_step(2e-3, 9);
    // the chord between two points holds r = -1/2 as its own point
    std::vector<std::array<double, 2>> hill;
    for (int i = 0; i <= 20; ++i) hill.push_back({-1 + 0.05 * i, 0.05 * i / (5 - 0.2 * i)});
    deck.curve(1, hill).curve(2, {{0, 1}, {1e9, 1}});
    if (truss) {
      deck.key("SECTION_BEAM").card(1, 3).card(area);
      deck.key("MAT_MUSCLE").card(1, 1e-6, 1.2, srm, peak, 0, 0, 0).card(1, 1, 1, -1, 1);
    } else {
      deck.key("SECTION_DISCRETE").card(1, 0).card(0, 0);
      deck.key("MAT_SPRING_MUSCLE").card(1, lopt, srm * lopt, 1, 1, strength, 1, -1).card(1, 0, 0);
    }
    deck.part(1, 1, 1);
    const int a = deck.node({0, 0, 0}, 7, 7), b = deck.node({120, 0, 0}, 5, 7);
    // half of the truss, 0.01, counts at its end
    deck.mass(a, m), deck.mass(b, truss ? m - 0.01 : m);
    truss ? deck.beam(1, a, b) : deck.spring(1, a, b);
    deck.key("LOAD_NODE_POINT").card(b, 1, 2, weight);
    return deck;
  };
  Vec3d end[2];
  for (const bool truss : {true, false}) {
    Run run(muscle(truss));
    double work = 0;
    while (run.step()) work -= weight * run.v(2).x * run.state().dt;
    const double kinetic = 0.5 * m * run.v(2).x * run.v(2).x;
    const double given = truss ? run.state().energy.internal : run.state().energy.discrete;
    report("velocity / Hill, energy given / work", {-run.v(2).x / v, -given / (work + kinetic)});
    CHECK(-run.v(2).x == doctest::Approx(v).epsilon(truss ? 1e-6 : 3e-5));
    CHECK(-given == doctest::Approx(work + kinetic).epsilon(1e-3));
    end[truss] = run.x(2);
  }
  CHECK(end[0].x == doctest::Approx(end[1].x).epsilon(3e-5));
}

// A rigid cube of bricks, the only thing with rotations in its model, on a torsional spring to the
// ground: T = 2 pi sqrt(I/k), I = m a^2/4 of the nodes' masses, less the (w dt)^2/24 of the scheme.
TEST_CASE("a torsional spring turns a rigid body of bricks") {
  Deck deck;
  const double k = 0.5, rho = 1e-3, a = 10, inertia = rho * std::pow(a, 5) / 4,
               omega = std::sqrt(k / inertia);
  deck.end(8 * pi / omega).constant_step(0.01 / omega, 9);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_RIGID").card(1, rho, 210.0, 0.3);
  deck.key("SECTION_DISCRETE").card(2, 1).card(0, 0);
  deck.key("MAT_SPRING_ELASTIC").card(2, k);
  deck.key("DEFINE_SD_ORIENTATION").card(3, 0, 0, 0, 1.0);
  deck.part(1, 1, 1).part(2, 2, 2);
  const Grid g = bricks(
      deck, 2, 2, 2, [&](int i, int j, int k) { return 0.5 * a * Vec3d(i - 1, j - 1, k - 1); },
      [](int, int, int) { return 0; }, 1);
  deck.key("ELEMENT_DISCRETE").card(1, 2, g.at(1, 1, 1), 0, 3);
  deck.key("INITIAL_VELOCITY_GENERATION").card(1, 2, 1e-3 * omega).card(0, 0, 0, 0, 0, 1.0);
  Run run(deck);
  double before = 0;
  std::vector<double> zeros;
  while (run.step()) {
    const double u = run.displacement(g.at(2, 1, 1)).y;
    if (u * before < 0) zeros.push_back(run.time() - run.state().dt * u / (u - before));
    before = u;
  }
  REQUIRE(zeros.size() >= 5);
  const double period = (zeros[4] - zeros[0]) / 2;
  report("period / exact", {period * omega / (2 * pi)});
  CHECK(period * omega / (2 * pi) == doctest::Approx(1).epsilon(1e-4));
}

// Sums by part are the same in animation and in history: a rigid block has its mass, energy and
// velocity.
TEST_CASE("animation states hold the mass and the motion of rigid parts") {
  Deck deck;
  deck.end(1).constant_step(0.1, 9);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_RIGID").card(1, 1e-3, 210.0, 0.3);
  deck.part(1, 1, 1);
  bricks(
      deck, 1, 1, 1, [](int i, int j, int k) { return Vec3d(i, j, k); },
      [](int, int, int) { return 0; }, 1);
  deck.key("INITIAL_VELOCITY").card(0).card(3.0, 0.0, -4.0);
  Run run(deck);
  run.step();
  const AnimationState a = animation_state(*run.simulation);
  CHECK(a.part_mass[0] == doctest::Approx(1e-3).epsilon(1e-12));
  CHECK(a.part_kinetic_energy[0] == doctest::Approx(0.5e-3 * 25).epsilon(1e-12));
  CHECK(a.part_velocity[0] == doctest::Approx(3).epsilon(1e-12));
  CHECK(a.momentum_velocity[2] == doctest::Approx(-4).epsilon(1e-12));
}

// K = 1/2 (I_zz + m r^2) w^2 with the tensor of *ELEMENT_INERTIA at one node of a nodal rigid body.
TEST_CASE("a nodal rigid body takes the inertia tensor of its node once") {
  Deck deck;
  deck.end(1).constant_step(1e-3, 9);
  const int a = deck.node({0, 0, 0}), b = deck.node({10, 0, 0});
  deck.key("ELEMENT_INERTIA").card(1, a).card(2.0, 0, 0, 3.0, 0, 4.0, 1.0);
  deck.mass(b, 1e-12);
  deck.node_set(1, {a, b});
  deck.key("CONSTRAINED_NODAL_RIGID_BODY").card(9, 0, 1);
  deck.key("INITIAL_VELOCITY_GENERATION").card(1, 3, 1.0).card(0, 0, 0, 0, 0, 1.0);
  Run run(deck);
  CHECK(run.simulation->rigid_bodies().kinetic_energy() == doctest::Approx(2).epsilon(1e-9));
}
