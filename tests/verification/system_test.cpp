// The energy identity (V09) and equal bits (V15) on a mixed model.
#include <cmath>
#include <filesystem>

#include "deck.h"

using namespace fabrica;
using namespace fabrica::verification;

namespace {

// Two plastic blocks that collide, the upper with a rigid cube joined to a second one by a ball
// joint, springs and dampers across, shells beside, and a wall underneath.
Deck mixed(int seed) {
  Deck deck;
  deck.end(0.4).constant_step(1e-4, 9);
  deck.key("SECTION_SOLID").card(1, 1);
  deck.key("SECTION_SHELL").card(2, 2, 0.833, 3).card(0.5, 0.5, 0.5, 0.5);
  deck.key("SECTION_DISCRETE").card(3).card(0, 0);
  deck.key("MAT_PLASTIC_KINEMATIC").card(1, 7.85e-6, 20.0, 0.3, 0.02, 0.2);
  deck.key("MAT_RIGID").card(2, 7.85e-6, 20.0, 0.3);
  deck.key("MAT_SPRING_ELASTIC").card(3, 0.01 + 1e-4 * seed);
  deck.key("MAT_DAMPER_VISCOUS").card(4, 1e-4);
  deck.part(1, 1, 1).part(2, 1, 1).part(3, 1, 2).part(4, 1, 2).part(5, 2, 1).part(6, 3, 3).part(
      7, 3, 4);
  const double shift = 0.01 * (seed % 17);
  const auto free = [](int, int, int) { return 0; };
  const Grid low = bricks(
      deck, 3, 3, 3, [](int i, int j, int k) { return Vec3d(i, j, k + 0.02); }, free, 1);
  const Grid up = bricks(
      deck, 2, 2, 2, [&](int i, int j, int k) { return Vec3d(i + 0.4 + shift, j + 0.3, k + 3.07); },
      free, 2);
  const Grid r1 = bricks(
      deck, 1, 1, 1, [](int i, int j, int k) { return Vec3d(i + 6, j, k); }, free, 3);
  const Grid r2 = bricks(
      deck, 1, 1, 1, [](int i, int j, int k) { return Vec3d(i + 8, j, k); }, free, 4);
  int s[3][3];
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) s[i][j] = deck.node(Vec3d(-3 + i, j, 0.3 + 0.1 * i * j));
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) deck.shell(5, {s[i][j], s[i + 1][j], s[i + 1][j + 1], s[i][j + 1]});
  const int j1 = deck.node({7.5, 0.5, 0.5}), j2 = deck.node({7.5, 0.5, 0.5});
  deck.node_set(1, {j1}).node_set(2, {j2});
  deck.key("CONSTRAINED_EXTRA_NODES_SET").card(3, 1).card(4, 2);
  deck.key("CONSTRAINED_JOINT_SPHERICAL").card(j1, j2);
  deck.spring(6, low.at(3, 1, 2), r1.at(0, 1, 1));
  deck.spring(6, low.at(0, 1, 1), s[2][1]);
  deck.spring(7, up.at(2, 1, 2), r1.at(0, 0, 1));
  deck.spring(7, low.at(0, 0, 0), s[2][0]);
  deck.key("INITIAL_VELOCITY_GENERATION").card(2, 2, 0.0, 0.3, 0.1 * (seed % 3), -3.0).card(0);
  deck.card(1, 2, 0.0, 0, 0, -0.5).card(0);
  deck.card(4, 2, 0.5, 0, 0.4, 0.2).card(8.5, 0.5, 0.5, 0, 0, 1.0);
  deck.card(5, 2, 0.2, 0, 0.1, -0.5).card(0, 0, 0, 1.0, 0, 0);
  deck.key("RIGIDWALL_PLANAR").card(0).card(0, 0, 0, 0, 0, 1.0, 0.2);
  deck.key("CONTACT_AUTOMATIC_SURFACE_TO_SURFACE").card(1, 2, 3, 3).card(0.2, 0.2).card(1.0, 1.0);
  return deck;
}

// kinetic energy with products of the half-step velocities, of free nodes that no wall touches
struct Before {
  std::vector<Vec3d> v, w;
};
Before velocities(const State& s) {
  Before b;
  for (const NodeMotion& n : s.nodes) b.v.push_back(n.v);
  for (const NodeSpin& n : s.spins) b.w.push_back(n.w);
  return b;
}

}  // namespace

// V09: K(n) = 1/2 m v(n-1/2).v(n+1/2) and, with one step dt, K(n+1) - K(n) = dt/2 (f(n) +
// f(n+1)).v(n+1/2) for whatever forces act. Forces are the solver's sums; nodes that a wall or a
// body moves in the step obey other laws and are left out. The sum over all nodes is compared with
// the work done.
TEST_CASE("V09: kinetic energy changes by the work of the forces, to the last digits") {
  double worst = 0;
  long compared = 0;
  for (int seed = 0; seed < 50; ++seed) {
    Run run(mixed(seed));
    const std::size_t n = std::size_t(run.model->nodes.size());
    std::vector<double> kinetic(n, 0), kinetic_spin(n, 0);
    std::vector<Vec3d> force(n), moment(n);
    double sum = 0, work = 0, scale = 0;
    for (int step = 0; step < 300; ++step) {
      const Before before = velocities(run.state());
      REQUIRE(run.step());
      const State& s = run.state();
      for (std::size_t i = 0; i < n; ++i) {
        const bool near_wall = s.nodes[i].x.z < 0.05;
        if (s.owner[i] != NodeOwner::free || near_wall) {
          kinetic[i] = -1;
          continue;
        }
        const double k = 0.5 * s.nodes[i].mass * dot(before.v[i], s.nodes[i].v);
        if (step > 1 && kinetic[i] != -1) {
          sum += k - kinetic[i];
          work += 0.5 * s.dt * dot(force[i] + s.force[i], before.v[i]);
          scale += std::abs(k - kinetic[i]);
          ++compared;
        }
        kinetic[i] = k, force[i] = s.force[i];
        if (s.spins.empty() || s.spins[i].inertia <= 0) continue;
        const double r = 0.5 * s.spins[i].inertia * dot(before.w[i], s.spins[i].w);
        if (step > 1) {
          sum += r - kinetic_spin[i];
          work += 0.5 * s.dt * dot(moment[i] + s.moment[i], before.w[i]);
        }
        kinetic_spin[i] = r, moment[i] = s.moment[i];
      }
    }
    worst = std::max(worst, std::abs(sum - work) / scale);
  }
  report("residual, comparisons", {worst, double(compared)});
  CHECK(compared > 100000);
  CHECK(worst < 1e-12);
}

// V15: the same bits for 1, 2 and 3 threads, and over a restart in the middle.
TEST_CASE("V15: a mixed model has the same bits for any thread count and over a restart") {
  std::vector<std::uint64_t> hash, energy_bits;
  const std::string path =
      (std::filesystem::temp_directory_path() / "fabrica_verification_restart").string();
  for (int threads : {1, 2, 3}) {
    Run run(mixed(3), threads);
    for (int i = 0; i < 2000; ++i) {
      REQUIRE(run.step());
      if (i == 999 && threads == 2) run.simulation->save(path);
    }
    hash.push_back(run.simulation->state_hash());
    if (threads == 1) {
      // it is a run worth comparing: contact, wall and plastic flow have acted
      CHECK(run.state().energy.rigid_wall != 0);
      CHECK(run.state().energy.contact != 0);
      CHECK(run.state().energy.internal > 0);
      CHECK(run.state().energy.discrete != 0);
    }
  }
  CHECK(hash[0] == hash[1]);
  CHECK(hash[0] == hash[2]);
  Run again(mixed(3), 3);
  again.simulation->load(path);
  for (int i = 0; i < 1000; ++i) REQUIRE(again.step());
  CHECK(again.simulation->state_hash() == hash[0]);
  std::filesystem::remove(path);
}

// A light brick under a force of 1e-9 of what would move a corner by its size in a step, beside one
// node of 2000 of its corners: m v = F t all the same. The resolution is 1e-12 of that force.
TEST_CASE("V09: a heavy node does not swallow small forces on light ones") {
  const double rho = 7.85e-6, young = 200, step = 0.1 * std::sqrt(rho / young);
  const double force = 1e-9 * (rho / 8) / (step * step);
  for (const double heavy : {1.0, 2000.0, 1e9}) {
    Deck deck;
    deck.end(1e3).curve(1, {{0, 1}, {1e9, 1}}).constant_step(step, 2);
    deck.key("SECTION_SOLID").card(1, 1);
    deck.key("MAT_ELASTIC").card(1, rho, young, 0.0);
    deck.part(1, 1, 1);
    const Grid g = bricks(
        deck, 1, 1, 1, [](int i, int j, int k) { return Vec3d(i, j, k); },
        [](int, int, int) { return 0; }, 1);
    deck.key("LOAD_NODE_POINT");
    for (const int id : g.ids) deck.card(id, 1, 1, force);
    deck.mass(deck.node({5, 0, 0}), heavy * rho / 8);
    Run run(deck);
    bool warned = false;
    for (const Diagnostic& d : run.diagnostics.list()) warned |= d.name == "heavy-node";
    CHECK(warned == (heavy > 1e6));
    if (warned) continue;
    for (int i = 0; i < 100; ++i) REQUIRE(run.step());
    double momentum = 0;
    for (const int id : g.ids) momentum += rho / 8 * run.v(id).x;
    const double expected = 8 * force * (run.time() - 0.5 * run.state().dt);
    report("heavy node: m v / F t - 1", {heavy, momentum / expected - 1});
    CHECK(momentum == doctest::Approx(expected).epsilon(5e-3));
  }
}
