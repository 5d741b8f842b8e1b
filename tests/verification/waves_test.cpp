// Waves in bars of one-point bricks (V05 to V08, V10). kg mm ms kN GPa; nu = 0, so that a bar is a
// bar.
#include <cmath>

#include "deck.h"

using namespace fabrica;
using namespace fabrica::verification;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double rho = 7.85e-6, young = 200;
const double speed = std::sqrt(young / rho);  // 5047.54 mm/ms... of the bar

// n unit cubes along z from z = 0; the sides may not move across, `code` holds chosen layers too
template <class Code>
Grid bar(Deck& deck, int n, Code code) {
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, rho, young, 0.0);
  deck.part(1, 1, 1);
  return bricks(
      deck, 1, 1, n, [](int i, int j, int k) { return Vec3d(i, j, k); },
      [&](int, int, int k) { return code(k); }, 1);
}

std::vector<int> layer(const Grid& g, int k) {
  return {g.at(0, 0, k), g.at(1, 0, k), g.at(1, 1, k), g.at(0, 1, k)};
}

double mean_stress(const Run& run, const Grid& g, int first, int last) {
  double sum = 0;
  for (int k = first; k < last; ++k) sum += run.solid(g.element(0, 0, k)).stress[0].zz;
  return sum / (last - first);
}

}  // namespace

// V05: sigma = rho c v = 0.396232 GPa behind a front of speed c; the bar leaves after 2 L/c.
TEST_CASE("V05: a bar hits a rigid wall") {
  Deck deck;
  deck.end(0.06);
  const int n = 100;
  const Grid g = bar(deck, n, [](int) { return 0; });
  deck.key("INITIAL_VELOCITY").card(0).card(0, 0, -10.0);
  deck.key("RIGIDWALL_PLANAR").card(0).card(0, 0, 0, 0, 0, 1.0);
  Run run(deck);
  const double sigma = rho * speed * 10;
  CHECK(sigma == doctest::Approx(0.396232).epsilon(1e-5));

  // arrival of half the stress at the middle of element 50, within the time of one element
  double arrival = 0;
  while (run.time() < 80 / speed) {
    REQUIRE(run.step());
    if (arrival == 0 && -run.solid(g.element(0, 0, 50)).stress[0].zz > sigma / 2)
      arrival = run.time() - run.state().dt;  // stress belongs to the step's start
  }
  report("arrival, of 50.5", {arrival * speed});
  CHECK(std::abs(arrival * speed - 50.5) < 1);
  report("plateau / rho c v", {-mean_stress(run, g, 5, 65) / sigma});
  CHECK(-mean_stress(run, g, 5, 65) == doctest::Approx(sigma).epsilon(1e-3));

  double last_contact = 0;
  while (run.step()) {
    if (run.simulation->rigid_walls().normal_force(0) > sigma / 2) last_contact = run.time();
  }
  double momentum = 0, mass = 0;
  for (const NodeMotion& m : run.state().nodes) momentum += m.mass * m.v.z, mass += m.mass;
  report("leaves after 200 with 10", {last_contact * speed, momentum / mass});
  CHECK(std::abs(last_contact * speed - 2 * n) < 2);
  CHECK(momentum > 0);
}

// V05 at Courant 1, h = c dt, without viscosity: the scheme is exact. Behind the front every
// element has the stress rho c v, ahead none, with no element between; the bar leaves with -v, but
// for the momentum that the wall takes from its first layer. The strain v/c = 2e-7 is small, so
// that the step stays h/c.
TEST_CASE("V05: a bar hits a rigid wall at Courant 1 and the wave is exact") {
  Deck deck;
  deck.end(0.06).no_bulk_viscosity();
  const int n = 100;
  const double v = 1e-3, sigma = rho * speed * v;
  deck.key("CONTROL_TIMESTEP").card(0, 1.1, 0, 0, 0, 9);
  deck.curve(9, {{0, 1 / speed}, {1e9, 1 / speed}});
  const Grid g = bar(deck, n, [](int) { return 0; });
  deck.key("INITIAL_VELOCITY").card(0).card(0, 0, -v);
  deck.key("RIGIDWALL_PLANAR").card(0).card(0, 0, 0, 0, 0, 1.0);
  Run run(deck);
  for (int i = 0; i <= 80; ++i)
    REQUIRE(run.step());  // the first finds the wall; then 80 elements are reached
  double behind = 0, ahead = 0;
  for (int k = 0; k < n; ++k) {
    const double s = -run.solid(g.element(0, 0, k)).stress[0].zz / sigma;
    if (k < 80) behind = std::max(behind, std::abs(s - 1));
    if (k >= 80) ahead = std::max(ahead, std::abs(s));
  }
  report("stress / (rho c v) - 1 behind, ahead", {behind, ahead});
  CHECK(behind < 1e-5);
  CHECK(ahead < 1e-5);
  while (run.time() < 220 / speed) REQUIRE(run.step());
  double momentum = 0, mass = 0;
  for (const NodeMotion& m : run.state().nodes) momentum += m.mass * m.v.z, mass += m.mass;
  report("leaves with, of v", {momentum / mass / v});
  CHECK(std::abs(momentum / mass / v - 1) < 0.011);
}

// V06: a step load F/A = s at the free end: s behind the front, 2 s at the wall between L/c and
// 3 L/c, tip displacement 2 s L/E at 2 L/c.
TEST_CASE("V06: a step load on a fixed bar doubles at the wall") {
  Deck deck;
  deck.end(0.1);
  const int n = 100;
  const double s = 0.1;
  const Grid g = bar(deck, n, [](int k) { return k == 0 ? 7 : 0; });
  deck.node_set(1, layer(g, n));
  deck.curve(1, {{0, 1}, {1, 1}});
  deck.key("LOAD_NODE_SET").card(1, 3, 1, s / 4);
  Run run(deck);
  run.until(0.9 * n / speed);
  report("stress / s", {mean_stress(run, g, 20, 95) / s});
  CHECK(mean_stress(run, g, 20, 95) == doctest::Approx(s).epsilon(0.005));
  run.until(1.8 * n / speed);
  report("reflected stress / s", {mean_stress(run, g, 0, 60) / s});
  CHECK(mean_stress(run, g, 0, 60) == doctest::Approx(2 * s).epsilon(0.005));
  run.until(2.0 * n / speed);
  report("tip / (2 s L/E)", {run.displacement(g.at(0, 0, n)).z / (2 * s * n / young)});
  CHECK(run.displacement(g.at(0, 0, n)).z == doctest::Approx(2 * s * n / young).epsilon(0.005));
}

// V07: stress transmitted 2 Z2/(Z1 + Z2), reflected (Z2 - Z1)/(Z1 + Z2), Z = rho c.
TEST_CASE("V07: a wave meets another material") {
  Deck deck;
  deck.end(0.1);
  const int n = 100;
  const double s = 0.1, young2 = 70, rho2 = 2.7e-6;
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, rho, young, 0.0);
  deck.key("MAT_ELASTIC").card(2, rho2, young2, 0.0);
  deck.part(1, 1, 1).part(2, 1, 2);
  Grid g{1, 1, 2 * n, {}, {}};
  for (int k = 0; k <= 2 * n; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) g.ids.push_back(deck.node(Vec3d(i, j, k)));
  for (int k = 0; k < 2 * n; ++k)
    g.elements.push_back(
        deck.solid(k < n ? 1 : 2,
                   {g.at(0, 0, k), g.at(1, 0, k), g.at(1, 1, k), g.at(0, 1, k), g.at(0, 0, k + 1),
                    g.at(1, 0, k + 1), g.at(1, 1, k + 1), g.at(0, 1, k + 1)}));
  deck.node_set(1, layer(g, 0));
  deck.curve(1, {{0, 1}, {1, 1}});
  deck.key("LOAD_NODE_SET").card(1, 3, 1, s / 4);
  Run run(deck);
  const double c2 = std::sqrt(young2 / rho2), z1 = rho * speed, z2 = rho2 * c2;
  run.until(1.8 * n / speed);
  // the reflected wave has come back to element 20, the transmitted one has gone 0.8 n c2/c
  const double reflected = -mean_stress(run, g, 35, 95),
               transmitted = -mean_stress(run, g, 105, 165);
  report("reflected, expected, transmitted, expected",
         {reflected / s - 1, (z2 - z1) / (z1 + z2), transmitted / s, 2 * z2 / (z1 + z2)});
  CHECK(reflected / s - 1 == doctest::Approx((z2 - z1) / (z1 + z2)).epsilon(0.01));
  CHECK(transmitted / s == doctest::Approx(2 * z2 / (z1 + z2)).epsilon(0.01));
}

// V08: a standing wave is a sum of two travelling ones; with sin(w dt/2) = C sin(k h/2) its phase
// speed is slower than c by pi^2/6 (h/lambda)^2 (1 - C^2) to leading order.
TEST_CASE("V08: numerical dispersion has the sign and size of the scheme") {
  for (int per_wave : {10, 20}) {
    Deck deck;
    deck.end(10);
    const int n = 2 * per_wave;  // two waves in a bar fixed at both ends
    const double courant = 0.5, k = 2 * pi / per_wave, v0 = 0.01;
    const Grid g = bar(deck, n, [&](int i) { return i == 0 || i == n ? 7 : 4; });
    deck.no_bulk_viscosity().constant_step(courant / speed, 9);
    deck.key("INITIAL_VELOCITY_NODE");
    for (int i = 1; i < n; ++i)
      for (int id : layer(g, i)) deck.card(id, 0, 0, v0 * std::sin(k * i));
    Run run(deck);
    // half periods between the zeros of the displacement at a quarter wave
    const int probe = g.at(0, 0, per_wave / 4 + (per_wave == 10 ? 1 : 0));
    double before = 0, first = 0, last = 0;
    int zeros = 0;
    while (zeros < 41) {
      REQUIRE(run.step());
      const double u = run.displacement(probe).z;
      if (before * u < 0) {
        last = run.time() - run.state().dt * u / (u - before);
        if (zeros++ == 0) first = last;
      }
      before = u;
    }
    const double phase_speed = 2 * pi / ((last - first) / 20) / k;
    const double error = 1 - phase_speed / speed;
    const double expected = pi * pi / 6 / (per_wave * per_wave) * (1 - courant * courant);
    report("error, expected", {error, expected});
    CHECK(error == doctest::Approx(expected).epsilon(0.1));
  }
}

// V10: an element of a tenth of the length is given mass m ((DT2MS/dt)^2 - 1), dt = (h/10)/c.
TEST_CASE("V10: mass scaling adds what the time step asks for") {
  Deck deck;
  deck.end(0.01);
  const double wanted = 0.9 / speed;
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, rho, young, 0.0);
  deck.part(1, 1, 1).no_bulk_viscosity();
  deck.key("CONTROL_TIMESTEP").card(0, 0.9, 0, 0, -wanted);
  bricks(
      deck, 1, 1, 10, [](int i, int j, int k) { return Vec3d(i, j, k <= 5 ? k : k - 0.9); },
      [](int, int, int) { return 0; }, 1);
  Run run(deck);
  const double added = rho * 0.1 * (std::pow(wanted / (0.1 / speed), 2) - 1);
  report("added mass / expected - 1", {run.simulation->added_mass() / added - 1});
  CHECK(run.simulation->added_mass() == doctest::Approx(added).epsilon(tolerance(1e-12, 1e-6)));
  run.finish();
  CHECK(run.state().dt == doctest::Approx(0.9 * wanted));
}
