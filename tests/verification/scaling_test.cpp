// Selective mass scaling (IMSCL of *CONTROL_TIMESTEP, src/solver/selective_mass.h). kg mm ms kN
// GPa; nu = 0, so that a bar is a bar.
#include <cmath>
#include <filesystem>

#include "deck.h"

using namespace fabrica;
using namespace fabrica::verification;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double rho = 7.85e-6, young = 200;
const double speed = std::sqrt(young / rho);

// the step of mass scaling, the same in every cycle; imscl: 0 conventional, 1 all parts
Deck& scale_to(Deck& deck, double step, int imscl) {
  deck.key("CONTROL_TIMESTEP").card(0, 0.9, 0, 0, -step).card(0, 0, imscl);
  return deck.no_bulk_viscosity();
}

// A bar along z of n bricks, fixed at z = 0 and free at its end, held sideways, with the velocity
// v sin(pi z / 2L) at the start; place(k) is the height of layer k.
template <class Place>
Deck swinging_bar(int n, Place place) {
  Deck deck;
  deck.end(1e3);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, rho, young, 0.0);
  deck.part(1, 1, 1);
  const Grid g = bricks(
      deck, 1, 1, n, [&](int i, int j, int k) { return Vec3d(i, j, place(k)); },
      [](int, int, int k) { return k == 0 ? 7 : 4; }, 1);
  deck.key("INITIAL_VELOCITY_NODE");
  for (int k = 1; k <= n; ++k)
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        deck.card(g.at(i, j, k), 0.0, 0.0, 0.1 * std::sin(pi * place(k) / (2 * place(n))));
  return deck;
}

// 1/2 v-.(M + dM).v+, which with the internal and the hourglass energy is constant (docs/step.md);
// of the quadratic form q it is (q(v- + v+) - q(v+ - v-)) / 4
double kinetic_energy(const Run& run, const std::vector<Vec3d>& before) {
  const auto& nodes = run.state().nodes;
  double sum = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    sum += 0.5 * nodes[n].mass * dot(before[n], nodes[n].v);
  const SelectiveMass& m = run.simulation->mass_scaling().selective();
  const auto mean = [&](int n) { return before[n] + nodes[n].v; };
  const auto change = [&](int n) { return nodes[n].v - before[n]; };
  return sum + 0.25 * (m.kinetic_energy(mean) - m.kinetic_energy(change));
}

// circular frequency of the last node over ten half waves, the step that was used, and the largest
// change of the energy over that of the start
double frequency(const Deck& deck, double& step, double& energy_change) {
  Run run(deck);
  const int last = run.model->nodes.size();
  double before = 0, first = 0, end = 0;
  int crossings = 0;
  const auto velocities = [&] {
    std::vector<Vec3d> v;
    for (const NodeMotion& n : run.state().nodes) v.push_back(n.v);
    return v;
  };
  std::vector<Vec3d> v = velocities();
  const double start = kinetic_energy(run, v);
  energy_change = 0;
  while (crossings < 11) {
    REQUIRE(run.step());
    const Energies& e = run.state().energy;
    const double energy = kinetic_energy(run, v) + e.internal + e.hourglass;
    energy_change = std::max(energy_change, std::abs(energy / start - 1));
    v = velocities();
    const double u = run.displacement(last).z;
    if (before != 0 && before * u < 0) {
      end = run.time() - run.state().dt * u / (u - before);
      if (crossings++ == 0) first = end;
    }
    before = u;
  }
  step = run.state().dt;
  return pi * 10 / (end - first);
}

// a free block of 3 x 2 x 4 bricks of unequal heights; part 2 is its upper half
Grid block(Deck& deck) {
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, rho, young, 0.3);
  deck.part(1, 1, 1);
  return bricks(
      deck, 3, 2, 4,
      [](int i, int j, int k) {
        return Vec3d(i, j, k < 3 ? k : k - 0.8) +
               (k == 2 && i == 1 ? Vec3d(.1, .2, 0) : Vec3d(0, 0, 0));
      },
      [](int, int, int) { return 0; }, 1);
}

Vec3d mean_velocity(const Run& run, double& mass) {
  Vec3d momentum{0, 0, 0};
  mass = 0;
  for (const NodeMotion& n : run.state().nodes) momentum += n.mass * n.v, mass += n.mass;
  return (1 / mass) * momentum;
}

}  // namespace

// Every element scaled by s = (2)^2 - 1: with k h = pi / 2n
//   w^2 = 4 (c/h)^2 sin^2(kh/2) / (1 + s sin^2(kh/2)),   sin(w' dt/2) = w dt/2.
TEST_CASE("V10: selective mass scaling slows a bar as its closed form says") {
  const int n = 20;
  double step = 0, change = 0, plain_step = 0;
  Deck plain = swinging_bar(n, [](int k) { return double(k); }).no_bulk_viscosity();
  const double unscaled = frequency(plain, plain_step, change);
  Deck deck = swinging_bar(n, [](int k) { return double(k); });
  const double measured = frequency(scale_to(deck, 2 / speed, 1), step, change);
  const double square = std::pow(std::sin(pi / (4 * n)), 2);
  const double w = 2 * speed * std::sqrt(square / (1 + 3 * square));
  const double expected = 2 / step * std::asin(w * step / 2);
  report("frequency / closed form - 1, shift, step ratio, energy change",
         {measured / expected - 1, 1 - measured / unscaled, step / plain_step, change});
  CHECK(measured == doctest::Approx(expected).epsilon(1e-5));
  CHECK(std::abs(1 - measured / unscaled) < 0.01);
  CHECK(step == doctest::Approx(2 * plain_step).epsilon(1e-6));
  // the solve stops at 1e-6 of the force
  CHECK(change < tolerance(2e-6, 1e-5));
}

// One element of a tenth of the length: the step grows tenfold, the first frequency stays, which
// conventional scaling shifts by its 99 tenths of an element.
TEST_CASE("V10: one thin element costs the frequency nothing when its scaling is selective") {
  const int n = 10;
  const auto place = [](int k) { return k <= 5 ? double(k) : k - 0.9; };
  double step = 0, change = 0, plain_step = 0;
  Deck plain = swinging_bar(n, place).no_bulk_viscosity();
  const double unscaled = frequency(plain, plain_step, change);
  Deck selective = swinging_bar(n, place), conventional = swinging_bar(n, place);
  const double kept = frequency(scale_to(selective, 1 / speed, 1), step, change);
  report("selective shift, step ratio, energy change",
         {1 - kept / unscaled, step / plain_step, change});
  CHECK(std::abs(1 - kept / unscaled) < 0.01);
  CHECK(step == doctest::Approx(10 * plain_step).epsilon(1e-5));
  // the solve stops at 1e-6 of the force
  CHECK(change < tolerance(2e-6, 1e-5));
  const double shifted = frequency(scale_to(conventional, 1 / speed, 0), step, change);
  report("conventional shift", {1 - shifted / unscaled});
  CHECK(1 - shifted / unscaled > 0.1);
}

// A free block flies on as it was thrown, and its centre of mass follows F = m a with the mass of
// the deck, whatever s; conventional scaling makes it heavier.
TEST_CASE("V10: selective mass scaling leaves translation alone") {
  for (const int imscl : {1, 0}) {
    Deck deck;
    deck.end(1e3).curve(1, {{0, 1}, {1e9, 1}});
    const Grid g = block(deck);
    scale_to(deck, 1 / speed, imscl);
    deck.key("INITIAL_VELOCITY").card(0).card(1.0, 2.0, -3.0);
    Deck pulled = deck;
    pulled.key("LOAD_NODE_POINT").card(g.at(0, 0, 0), 1, 1, 0.01).card(g.at(3, 1, 4), 3, 1, 0.02);
    const double physical = rho * 3 * 2 * 3.2;

    Run thrown(deck);
    for (int i = 0; i < 100; ++i) REQUIRE(thrown.step());
    double worst = 0;
    for (const NodeMotion& n : thrown.state().nodes)
      worst = std::max(worst, norm(n.v - Vec3d{1, 2, -3}));
    report("thrown: largest change of velocity", {worst});
    CHECK(worst < tolerance(1e-9, 1e-5));
    CHECK(thrown.simulation->physical_mass() == doctest::Approx(physical).epsilon(1e-6));
    CHECK(thrown.simulation->added_mass() > physical);

    Run run(pulled);
    for (int i = 0; i < 200; ++i) REQUIRE(run.step());
    double mass = 0;
    const Vec3d v = mean_velocity(run, mass) - Vec3d{1, 2, -3};
    const double t = run.time() - 0.5 * run.state().dt;
    report("pulled: m v / F t - 1",
           {v.x * physical / (0.01 * t) - 1, v.z * physical / (0.02 * t) - 1});
    if (imscl == 1) {
      CHECK(mass == doctest::Approx(physical).epsilon(1e-6));
      CHECK(v.x * mass == doctest::Approx(0.01 * t).epsilon(tolerance(1e-9, 1e-6)));
      CHECK(v.z * mass == doctest::Approx(0.02 * t).epsilon(tolerance(1e-9, 1e-6)));
    } else {
      CHECK(mass > 2 * physical);
    }
  }
}

// Rigid rotation about any axis: what is added is s times the inertia of each element about its own
// centre, not about that of the body. A unit cube of eight corners: sum m/8 (x^2 + y^2) = m/2.
TEST_CASE("V10: what selective mass does to rotation") {
  SelectiveMass scaled;
  std::vector<Vec3d> x;
  int node[8];
  double mass[8];
  for (int e = 0; e < 3; ++e) {
    for (int a = 0; a < 8; ++a) {
      node[a] = int(x.size()), mass[a] = 0.125 * rho;
      x.push_back(Vec3d(e + (a & 1), (a >> 1) & 1, (a >> 2) & 1));
    }
    scaled.add(node, mass, 8, 4.0);
  }
  const Vec3d w{0, 0, 2};
  const double energy = scaled.kinetic_energy([&](int n) { return cross(w, x[std::size_t(n)]); });
  CHECK(energy == doctest::Approx(0.5 * 3 * 4.0 * (rho / 2) * 4).epsilon(1e-12));
  CHECK(std::abs(scaled.kinetic_energy([](int) { return Vec3d{3, 4, 5}; })) < 1e-18);
}

// the same bits for one to three threads and over a restart, with a support and a moved face
TEST_CASE("V15: selective mass scaling has the same bits for any thread count and over a restart") {
  const std::string path =
      (std::filesystem::temp_directory_path() / "fabrica_selective_restart").string();
  const auto deck = [] {
    Deck deck;
    deck.end(1e3).curve(1, {{0, 0}, {0.01, 1}, {1e9, 1}});
    deck.key("SECTION_SOLID").card(1, 1);
    deck.key("MAT_ELASTIC").card(1, rho, young, 0.3);
    deck.part(1, 1, 1);
    const Grid g = bricks(
        deck, 8, 8, 24, [](int i, int j, int k) { return Vec3d(i, j, 0.3 * k); },
        [](int, int, int k) { return k == 0 ? 7 : 0; }, 1);
    scale_to(deck, 1 / speed, 1);
    std::vector<int> top;
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; j <= 8; ++j) top.push_back(g.at(i, j, 24));
    deck.node_set(1, top).key("BOUNDARY_PRESCRIBED_MOTION_SET").card(1, 1, 0, 1, 2.0);
    return deck;
  };
  std::vector<std::uint64_t> hash;
  for (const int threads : {1, 2, 3}) {
    Run run(deck(), threads);
    for (int i = 0; i < 60; ++i) {
      REQUIRE(run.step());
      if (i == 29 && threads == 2) run.simulation->save(path);
    }
    hash.push_back(run.simulation->state_hash());
    CHECK(run.simulation->mass_scaling().selective().mean_iterations() > 1);
    CHECK(run.simulation->mass_scaling().selective().unconverged() == 0);
  }
  CHECK(hash[0] == hash[1]);
  CHECK(hash[0] == hash[2]);
  Run again(deck(), 3);
  again.simulation->load(path);
  for (int i = 0; i < 30; ++i) REQUIRE(again.step());
  CHECK(again.simulation->state_hash() == hash[0]);
  std::filesystem::remove(path);
}

// IMSCL < 0: a part set is scaled selectively, the other part gets mass, m ((DT2MS/dt)^2 - 1)
TEST_CASE("V10: IMSCL names the part set of selective scaling") {
  Deck deck;
  deck.end(1e3);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, rho, young, 0.0);
  deck.part(1, 1, 1).part(2, 1, 1);
  deck.key("SET_PART_LIST").card(5).card(2);
  bricks(
      deck, 1, 1, 2, [](int i, int j, int k) { return Vec3d(i, j, 0.5 * k); },
      [](int, int, int) { return 0; }, 1);
  bricks(
      deck, 1, 1, 3, [](int i, int j, int k) { return Vec3d(i + 5, j, 0.5 * k); },
      [](int, int, int) { return 0; }, 2);
  scale_to(deck, 1 / speed, -5);
  Run run(deck);
  const MassScaling& m = run.simulation->mass_scaling();
  CHECK(m.selective_added_mass() == doctest::Approx(3 * 3 * 0.5 * rho).epsilon(1e-6));
  CHECK(m.added_mass() - m.selective_added_mass() ==
        doctest::Approx(2 * 3 * 0.5 * rho).epsilon(1e-6));
  CHECK(m.part_added_mass()[0] == doctest::Approx(2 * 3 * 0.5 * rho).epsilon(1e-6));
  CHECK(m.part_added_mass()[1] == doctest::Approx(3 * 3 * 0.5 * rho).epsilon(1e-6));
}

// An element with a corner on a rigid body gets mass on its other corners: the body keeps its own.
TEST_CASE("V10: rigid bodies are not scaled by elements that hang on them") {
  Deck deck;
  deck.end(1e3);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, rho, young, 0.0);
  deck.key("MAT_RIGID").card(2, rho, young, 0.0).card(0).card(0);
  deck.part(1, 1, 1).part(2, 1, 2);
  const Grid g = bricks(
      deck, 1, 1, 3, [](int i, int j, int k) { return Vec3d(i, j, 0.5 * k); },
      [](int, int, int) { return 0; }, 1);
  std::array<int, 8> n{};
  for (int a = 0; a < 4; ++a) {
    const int i = a == 1 || a == 2, j = a > 1;
    n[a] = deck.node(Vec3d(i, j, -1)), n[a + 4] = g.at(i, j, 0);
  }
  deck.solid(2, n);
  scale_to(deck, 1 / speed, 1);
  Run run(deck);
  const MassScaling& m = run.simulation->mass_scaling();
  CHECK(m.selective_added_mass() == doctest::Approx(2 * 3 * 0.5 * rho).epsilon(1e-6));
  CHECK(m.added_mass() - m.selective_added_mass() ==
        doctest::Approx(0.5 * 3 * 0.5 * rho).epsilon(1e-6));
  CHECK(run.simulation->rigid_bodies()[0].motion.mass == doctest::Approx(rho * 1.25).epsilon(1e-6));
}
