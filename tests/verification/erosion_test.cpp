// Energies of deleted elements (V28). kg mm ms kN GPa; nu = 0 and sides held, so that a bar is a
// bar.
#include <cmath>
#include <filesystem>

#include "deck.h"

using namespace fabrica;
using namespace fabrica::verification;

namespace {

constexpr double rho = 7.85e-6, young = 200;
const double speed = std::sqrt(young / rho);

// A bar of n unit bricks on either side of one in the middle, thrown apart with +-v. The middle,
// part 2, yields at 0.2 GPa and fails at a plastic strain of 1 %. The wave of the bars pulls with
// at most rho c v, so that v must be above 0.2 GPa / rho c = 5.05 mm/ms; the plastic strain grows
// by 2 (v - 5.05) / mm until the free ends answer at 2 n / c: 1.2 % at 8 mm/ms.
Deck torn_bar(int n, double v, Grid& g) {
  Deck deck;
  deck.end(1e3);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, rho, young, 0.0);
  deck.key("MAT_PLASTIC_KINEMATIC").card(2, rho, young, 0.0, 0.2, 1.0, 1.0).card(0.0, 0.0, 1e-2);
  deck.part(1, 1, 1).part(2, 1, 2);
  g = bricks(
      deck, 1, 1, n, [](int i, int j, int k) { return Vec3d(i, j, k); },
      [](int, int, int) { return 4; }, 1);
  // brick n between two of the same bars
  Grid h = bricks(
      deck, 1, 1, n, [&](int i, int j, int k) { return Vec3d(i, j, n + 1 + k); },
      [](int, int, int) { return 4; }, 1);
  const int middle = deck.solid(2, {g.at(0, 0, n), g.at(1, 0, n), g.at(1, 1, n), g.at(0, 1, n),
                                    h.at(0, 0, 0), h.at(1, 0, 0), h.at(1, 1, 0), h.at(0, 1, 0)});
  g.elements.push_back(middle);
  deck.no_bulk_viscosity().constant_step(0.5 / speed, 9);
  deck.key("INITIAL_VELOCITY_NODE");
  for (const Grid* bar : {&g, &h})
    for (const int id : bar->ids) deck.card(id, 0.0, 0.0, bar == &g ? -v : v);
  return deck;
}

// A column of n unit bricks that yield at 0.2 GPa and fail at a plastic strain.
Deck failing_bricks(int n, double failure, Grid& g) {
  Deck deck;
  deck.end(1e3);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_PLASTIC_KINEMATIC").card(1, rho, young, 0.0, 0.2, 1.0, 1.0).card(0.0, 0.0, failure);
  deck.part(1, 1, 1);
  g = bricks(
      deck, 1, 1, n, [](int i, int j, int k) { return Vec3d(i, j, k); },
      [](int, int, int) { return 4; }, 1);
  return deck;
}

}  // namespace

// V28: with 1/2 m v(n-1/2).v(n+1/2) as kinetic energy, kinetic + internal + hourglass + eroded is
// constant (docs/step.md), through the deletion too: an element that fails gives no force, and what
// it held goes from the internal to the eroded energy.
TEST_CASE("V28: the energy of a bar is constant while it tears") {
  Grid g;
  const double v = 8;
  Run run(torn_bar(5, v, g));
  const double start = 0.5 * rho * 11 * v * v;
  std::vector<Vec3d> before;
  for (const NodeMotion& n : run.state().nodes) before.push_back(n.v);
  const auto stored = [&] {
    const Energies& e = run.state().energy;
    return e.internal + e.hourglass + e.eroded_internal + e.eroded_hourglass;
  };
  double worst = 0, held = 0, eroded = 0;
  for (int i = 0; i < 200; ++i) {
    REQUIRE(run.step());
    // after the step: forces and energies at t(n), velocities at t(n+1/2)
    double kinetic = 0;
    for (std::size_t n = 0; n < before.size(); ++n) {
      kinetic += 0.5 * run.state().nodes[n].mass * dot(before[n], run.state().nodes[n].v);
      before[n] = run.state().nodes[n].v;
    }
    worst = std::max(worst, std::abs(kinetic + stored() - start) / start);
    eroded = run.state().energy.eroded_internal;
    if (eroded == 0) held = run.simulation->part_internal()[1];
  }
  report("largest change of energy, eroded share", {worst, eroded / start});
  CHECK(worst < tolerance(1e-10, 1e-6));
  // the brick has failed; what it held the step before, and the work of half a step, went with it
  CHECK(eroded > 0.02 * start);
  CHECK(eroded == doctest::Approx(held).epsilon(0.2));
  CHECK(run.simulation->part_internal()[1] == doctest::Approx(0).epsilon(1e-12));
  CHECK(run.simulation->part_eroded_internal()[1] == doctest::Approx(eroded));
  CHECK(run.state().energy.eroded_kinetic == 0);
}

// Energies element by element are kept only where the parameters of a law let something fail.
TEST_CASE("V28: a law without a failure strain keeps no energies of elements") {
  for (const double failure : {0.0, 1e-3, 1e20, 1e21}) {
    Grid g;
    Deck deck = failing_bricks(1, failure, g);
    Run run(deck);
    CHECK(run.simulation->tiles().energies.empty() == (failure != 1e-3));
  }
}

// The two faces of a brick are pushed through each other: it fails, turns inside out, and its nodes
// fly on as nothing holds them, beside a brick that shares four of them and stays a brick.
TEST_CASE("V28: a failed brick that turns inside out gives no force") {
  Grid g;
  Deck deck = failing_bricks(2, 1e-3, g);
  deck.constant_step(0.2 / speed, 9);
  deck.key("INITIAL_VELOCITY_NODE");
  for (const int id : g.ids) deck.card(id, 0.0, 0.0, id > 4 ? -20.0 : 20.0);
  Run run(deck);
  for (int i = 0; i < 2000; ++i) REQUIRE(run.step());
  REQUIRE(run.simulation->tiles().has_failed(0, 0));
  REQUIRE(!run.simulation->tiles().has_failed(0, 1));
  for (const int id : g.ids) {
    CHECK(std::isfinite(run.v(id).z));
    if (id <= 4) CHECK(run.v(id).z > 15);
    if (id > 4) CHECK(run.v(id).z < -5);
  }
}

// A brick that fails as a whole leaves nodes that nothing holds: their kinetic energy is eroded.
TEST_CASE("V28: nodes without elements carry eroded kinetic energy") {
  Grid g;
  Deck deck = failing_bricks(1, 1e-3, g);
  deck.no_bulk_viscosity().constant_step(0.2 / speed, 9);
  deck.mass(g.at(0, 0, 1), rho);
  deck.key("INITIAL_VELOCITY_NODE");
  for (const int id : g.ids) deck.card(id, 0.0, 0.0, id > 4 ? 20.0 : -20.0);
  Run run(deck);
  double kinetic = 0, eroded = 0, total = 0, first = 0;
  Sampler always{[](double) { return true; },
                 [&] {
                   const Energies& e = run.state().energy;
                   kinetic = e.kinetic, eroded = e.eroded_kinetic, total = e.total();
                   if (first == 0) first = total;
                 }};
  for (int i = 0; i < 50; ++i) REQUIRE(run.step(always));
  REQUIRE(run.simulation->tiles().has_failed(0, 0));
  // the corner with the mass of its own stays
  const int kept = g.at(0, 0, 1);
  double others = 0;
  for (const int id : g.ids)
    if (id != kept) others += 0.5 * 0.125 * rho * dot(run.v(id), run.v(id));
  CHECK(kinetic ==
        doctest::Approx(0.5 * 1.125 * rho * dot(run.v(kept), run.v(kept))).epsilon(1e-6));
  CHECK(eroded == doctest::Approx(others).epsilon(1e-6));
  CHECK(eroded > 0.25 * kinetic);
  CHECK(total == doctest::Approx(first).epsilon(0.02));
}

// the energies of deleted elements are those of an unbroken run after a restart
TEST_CASE("V28: eroded energies go on over a restart") {
  const std::string path =
      (std::filesystem::temp_directory_path() / "fabrica_erosion_restart").string();
  Grid g;
  Run whole(torn_bar(5, 8, g));
  int at = 0;
  while (
      !whole.simulation->tiles().has_failed(whole.simulation->tiles().place_of_solid[10].tile, 0))
    REQUIRE((whole.step() && ++at < 200));
  Run first(torn_bar(5, 8, g));
  for (int i = 0; i < at - 2; ++i) REQUIRE(first.step());
  first.simulation->save(path);
  Run again(torn_bar(5, 8, g));
  again.simulation->load(path);
  for (int i = 0; i < 10; ++i) REQUIRE(again.step());
  for (int i = 0; i < 8; ++i) REQUIRE(whole.step());
  CHECK(again.state().energy.eroded_internal > 0);
  CHECK(again.state().energy.eroded_internal == whole.state().energy.eroded_internal);
  CHECK(again.state().energy.internal == whole.state().energy.internal);
  std::filesystem::remove(path);
}
