// Solids at rest under a load that does not change (V18, V22, V56), by damping the slowest mode.
#include <cmath>

#include "deck.h"

using namespace fabrica;
using namespace fabrica::verification;

namespace {

constexpr double pi = 3.14159265358979323846;

// eight times of the slowest mode `omega`, damped critically
void settle(Deck& deck, double omega) {
  deck.end(8 / omega).curve(99, {{0, 1}, {1e9, 1}}).no_bulk_viscosity();
  deck.key("DAMPING_GLOBAL").card(0, 2 * omega);
}
void force(Deck& deck, int node, int direction, double value) {
  deck.key("LOAD_NODE_POINT").card(node, direction, 99, value);
}

}  // namespace

// V18: share of the hourglass energy in a cantilever L/h = 10 under a force at its tip, by bricks
// over its height: below 5 % with four. Viscous control (type 2) takes its energy while the beam
// moves. Type 6 with QM = 1 carries what one point misses of the bending exactly: 1/n^2 of the
// energy, or 1/(n^2 - 1) of the rest.
TEST_CASE("V18: hourglass energy of a bent beam") {
  for (int type : {2, 4, 6})
    for (int n : {1, 4}) {
      Deck deck;
      const double L = 10, rho = 7.85e-6, young = 210, I = 1. / 12;
      deck.key("SECTION_SOLID").card(1, 1);
      deck.key("MAT_ELASTIC").card(1, rho, young, 0.3);
      deck.key("HOURGLASS").card(1, type, type == 6 ? 1.0 : 0.05);
      deck.part(1, 1, 1, 1);
      const Grid g = bricks(
          deck, 10 * n, n, n, [&](int i, int j, int k) { return (1.0 / n) * Vec3d(i, j, k); },
          [](int i, int, int) { return i == 0 ? 7 : 0; }, 1);
      deck.key("CONTROL_TIMESTEP")
          .card(0, 0.7);  // a single column of bricks is stable up to 0.81 only
      settle(deck, 3.516 / (L * L) * std::sqrt(young * I / rho));
      for (int j = 0; j <= n; ++j)
        for (int k = 0; k <= n; ++k) force(deck, g.at(10 * n, j, k), 3, 1e-3 / ((n + 1) * (n + 1)));
      Run run(deck);
      run.finish();
      const Energies& e = run.state().energy;
      report("type, bricks over the height, hourglass / internal",
             {double(type), double(n), e.hourglass / e.internal});
      if (n == 4 && type != 6) CHECK(e.hourglass / e.internal < 0.05);
      if (n == 4 && type == 6) CHECK(std::abs(e.hourglass / e.internal * (n * n - 1) - 1) < 0.1);
    }
}

// V22: a thick cylinder a = 1, b = 2 in plane strain, nu = .4999, under inner pressure: Lame's
// u(a) = p a (1 + nu)/E ((1 - 2 nu) a^2 + b^2)/(b^2 - a^2). An element that locks gives far less.
TEST_CASE("V22: a thick cylinder of nearly incompressible material") {
  for (int formulation : {1, 2}) {
    Deck deck;
    const double a = 1, b = 2, nu = 0.4999, p = 1e-4, h = 0.1;
    const int radial = 10, around = 16;
    deck.key("SECTION_SOLID").card(1, formulation);
    deck.key("MAT_ELASTIC").card(1, 1.0, 1.0, nu);
    deck.key("HOURGLASS").card(1, 6, 1.0);
    deck.part(1, 1, 1, 1);
    const Grid g = bricks(
        deck, radial, around, 1,
        [&](int i, int j, int k) {
          const double r = a + (b - a) * i / radial, angle = 0.5 * pi * j / around;
          return Vec3d(r * std::cos(angle), r * std::sin(angle), h * k);
        },
        [&](int, int j, int) { return j == 0        ? 5
                                      : j == around ? 6
                                                    : 3; }, 1);
    // radial motion c/r: w^2 = 2 G (1/a^2 - 1/b^2) / (rho ln(b/a))
    settle(deck, std::sqrt(2.0 / 3 * 0.75 / std::log(2.0)));
    for (int j = 0; j <= around; ++j) {
      const double angle = 0.5 * pi * j / around;
      // half of a cell's chord on either side and in either layer, pressed along its normal
      const double chord = 2 * a * std::sin(0.25 * pi / around), each = p * chord * h / 4;
      for (int side : {-1, 1}) {
        if (j + side < 0 || j + side > around) continue;
        const double normal = angle + side * 0.25 * pi / around;
        for (int k : {0, 1}) {
          force(deck, g.at(0, j, k), 1, each * std::cos(normal));
          force(deck, g.at(0, j, k), 2, each * std::sin(normal));
        }
      }
    }
    Run run(deck);
    run.finish();
    const double exact = p * a * (1 + nu) * ((1 - 2 * nu) * a * a + b * b) / (b * b - a * a);
    report("formulation, u(a) / exact, cycles",
           {double(formulation), run.displacement(g.at(0, 0, 0)).x / exact,
            double(run.state().cycle)});
    CHECK(std::abs(run.displacement(g.at(0, 0, 0)).x / exact - 1) < 0.01);
  }
}

// V56: a cantilever of two blocks, cells 2 : 3 across, tied face to face, against the same beam of
// one mesh: pulled and bent it moves by the same at its tip.
TEST_CASE("V56: a tie of unlike meshes is as stiff as one mesh") {
  const auto tip = [](bool tied, int direction) {
    Deck deck;
    const double side = 6, half = 18, rho = 7.85e-6, young = 210, P = 1e-2;
    deck.key("SECTION_SOLID").card(1, 1);
    deck.key("MAT_ELASTIC").card(1, rho, young, 0.0);
    deck.key("HOURGLASS").card(1, 6, 1.0);
    deck.part(1, 1, 1, 1).part(2, 1, 1, 1);
    const int n[2] = {tied ? 2 : 3, 3};
    std::vector<Grid> grid;
    for (int b : {0, 1}) {
      const double h = side / n[b];
      if (tied || b == 0)
        grid.push_back(bricks(
            deck, n[b], n[b], (tied ? 3 : 6) * n[b],
            [&](int i, int j, int k) { return Vec3d(h * i, h * j, h * k + b * half); },
            [&](int, int, int k) { return b == 0 && k == 0 ? 7 : 0; }, b + 1));
    }
    const double I = std::pow(side, 4) / 12, area = side * side, L = 2 * half;
    settle(deck, direction == 3 ? 0.5 * pi / L * std::sqrt(young / rho)
                                : 3.516 / (L * L) * std::sqrt(young * I / (rho * area)));
    const Grid& end = grid.back();
    for (int j = 0; j <= 3; ++j)
      for (int i = 0; i <= 3; ++i) {
        const double weight = (i % 3 == 0 ? 0.5 : 1) * (j % 3 == 0 ? 0.5 : 1) / 9;
        force(deck, end.at(i, j, end.nz), direction, weight * P);
      }
    if (tied) deck.key("CONTACT_TIED_SURFACE_TO_SURFACE").card(2, 1, 3, 3).card(0).card(1.0, 1.0);
    Run run(deck);
    run.finish();
    const Vec3d u = run.displacement(end.at(1, 1, end.nz));
    return direction == 3 ? u.z : u.x;
  };
  for (int direction : {3, 1}) {
    const double one = tip(false, direction), two = tip(true, direction);
    report("direction, tied / one mesh", {double(direction), two / one});
    CHECK(std::abs(two / one - 1) < 0.01);
  }
}

// A block whose nodes all belong to a rigid body, as extra nodes, still is a surface to tie to: a
// second block tied to its face goes where the body goes.
TEST_CASE("a tie to a block that is potted whole carries") {
  Deck deck;
  deck.end(1.0);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("MAT_ELASTIC").card(1, 1e-3, 1.0, 0.3);
  deck.key("MAT_RIGID").card(2, 1e-3, 1.0, 0.3).card(1, 4, 7).card(0);
  deck.part(1, 1, 1).part(2, 1, 1).part(3, 1, 2);
  const auto free = [](int, int, int) { return 0; };
  const auto block = [&](int part, double z) {
    return bricks(
        deck, 2, 2, 1, [&](int i, int j, int k) { return Vec3d(0.5 * i, 0.5 * j, z + k); }, free,
        part);
  };
  const Grid potted = block(1, 0), tied = block(2, 1);
  block(3, -5);
  deck.node_set(1, potted.ids);
  deck.key("CONSTRAINED_EXTRA_NODES_SET").card(3, 1);
  deck.key("CONTACT_TIED_SURFACE_TO_SURFACE").card(2, 1, 3, 3).card(0).card(0);
  deck.curve(1, {{0, 0}, {1, 0.5}});
  deck.key("BOUNDARY_PRESCRIBED_MOTION_RIGID").card(3, 3, 2, 1);
  Run run(deck);
  run.finish();
  const double travelled = run.displacement(potted.at(0, 0, 0)).z;
  CHECK(travelled == doctest::Approx(0.5).epsilon(0.01));
  for (int i = 0; i <= 2; ++i)
    for (int j = 0; j <= 2; ++j)
      CHECK(run.displacement(tied.at(i, j, 0)).z == doctest::Approx(travelled).epsilon(1e-9));
}
