// The GPU's phases run by the host, thread after thread, against the CPU driver: the same bits in
// forces, history, energies, steps and motion. What no host can check (barriers, memory spaces,
// launches) is left to fabrica_gpu_check.
#include "solver/cuda/tile_phases.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <type_traits>

#include "element/hex8.h"
#include "element/shell_bt.h"
#include "element/tet4.h"
#include "solver/cuda/gpu_laws.h"
#include "solver/cuda/step_phases.h"
#include "solver/simulation.h"

namespace fabrica {
namespace {

constexpr int threads = 96;  // of an imagined block; no multiple of anything

struct Case {
  std::vector<std::pair<std::string, double>> section, material;
  std::string law;
  bool shell = false, tetrahedra = false;
  int hourglass = 1;
  double qm = 0.1;
};

void set_all(Card& card, const std::vector<std::pair<std::string, double>>& values) {
  for (const auto& [name, value] : values) card.set(name, value);
}

// a distorted block of 10 x 7 x 7 cells, or a plate of 21 x 17: more than one tile, the last block
// padded
void add_mesh(Builder& b, const Case& c) {
  const int nx = c.shell ? 21 : 10, ny = c.shell ? 17 : 7, nz = c.shell ? 0 : 7;
  auto id = [&](int i, int j, int k) {
    return std::int64_t(1) + i + (nx + 1) * (j + std::int64_t(ny + 1) * k);
  };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        b.add_node(id(i, j, k),
                   {2.0 * i + 0.2 * std::sin(1.0 * j + k), 2.0 * j + 0.2 * std::cos(2.0 * i),
                    2.0 * k + 0.2 * std::sin(3.0 * i + j)});
  std::int64_t e = 0;
  static const int split[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                  {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  for (int k = 0; k < std::max(nz, 1); ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const int up = c.shell ? 0 : 1;
        const std::int64_t n[8] = {
            id(i, j, k),      id(i + 1, j, k),      id(i + 1, j + 1, k),      id(i, j + 1, k),
            id(i, j, k + up), id(i + 1, j, k + up), id(i + 1, j + 1, k + up), id(i, j + 1, k + up)};
        if (c.shell) {
          b.add_shell(++e, 1, n, 4);
        } else if (c.tetrahedra) {
          for (const auto& t : split) {
            const std::int64_t corner[8] = {n[t[0]], n[t[1]], n[t[2]], n[t[3]],
                                            n[t[3]], n[t[3]], n[t[3]], n[t[3]]};
            b.add_solid(++e, 1, corner, 8);
          }
        } else {
          b.add_solid(++e, 1, n, 8);
        }
      }
}

std::unique_ptr<Model> make(const Case& c, Diagnostics& diagnostics) {
  Builder b(diagnostics);
  b.add_card("CONTROL_TERMINATION").set("endtim", 1.0);
  add_mesh(b, c);
  set_all(b.add_card(c.shell ? "SECTION_SHELL" : "SECTION_SOLID").set("secid", 1), c.section);
  set_all(b.add_card(c.law).set("mid", 1), c.material);
  b.add_card("HOURGLASS").set("hgid", 1).set("ihq", c.hourglass).set("qm", c.qm);
  Card part("PART");
  part.title = "block";
  part.set("pid", 1).set("secid", 1).set("mid", 1).set("hgid", 1);
  b.add_card(std::move(part));
  return b.finish();
}

// Memory of an imagined device: copies of what the CPU driver holds.
struct Host {
  GpuLayout layout;
  Tiles tiles;
  State state;
  std::vector<TileResult> result;
  GpuClock clock{};

  Host(const Tiles& t, const State& s)
      : layout(t), tiles(t), state(s), result(t.tiles.size(), TileResult{}) {
    clock.dt = s.dt_previous;
  }
  GpuArrays arrays() {
    GpuArrays g;
    g.tile = layout.tile.data(), g.node = tiles.node.data(),
    g.connectivity = tiles.connectivity.data();
    g.corner_first = layout.corner_first.data(), g.corner = layout.corner.data();
    g.partial_first = tiles.partial_first.data(), g.partial = tiles.partial.data();
    g.state = tiles.state_.data(), g.force = tiles.force.data();
    g.moment = tiles.any_rotations ? tiles.moment.data() : nullptr;
    g.nodes = state.nodes.data(), g.spins = tiles.any_rotations ? state.spins.data() : nullptr;
    g.result = result.data(), g.clock = &clock;
    g.tiles = int(tiles.tiles.size()), g.node_count = int(state.nodes.size());
    return g;
  }
};

template <class Phase>
void every_thread(Phase phase) {
  for (int i = 0; i < threads; ++i) phase(Lot{i, threads});
}

template <class E, class M>
void run_tiles(const GpuArrays& g, const M& law, const ElementParameters& p, int fields) {
  for (int i = 0; i < g.tiles; ++i) {
    const GpuTile& t = g.tile[i];
    AlignedVector<unsigned char> memory(TileMemory<E>::bytes(t.node_count));
    const TileMemory<E> m(memory.data(), t.node_count);
    every_thread([&](Lot lot) { fill_nodes<E>(lot, g, t, m); });
    every_thread([&](Lot lot) { element_forces<E>(lot, g, t, law, p, fields, m); });
    every_thread([&](Lot lot) { sum_corners<E>(lot, g, t, m); });
    every_thread([&](Lot lot) { sum_lanes<E>(lot, t, m); });
    every_thread([&](Lot lot) { sum_tile<E>(lot, m, g.result[i]); });
  }
}

void step_nodes(const GpuArrays& g) {
  StepFinding f;
  for (int i = 0; i < g.tiles; ++i) look_at(g.tile[i], g.result[i], f);
  choose_step(f, GpuStepping{}, *g.clock);
  for (int n = 0; n < g.node_count; ++n) advance_node(g, n);
}

// one step of the CPU: Simulation's passes for a model that nothing acts on
void step_cpu(Tiles& tiles, State& s, Team& team) {
  tiles.forces(s, team);
  double step = 1e30;
  for (const Tile& t : tiles.tiles) step = std::min(step, double(t.time_step));
  step *= 0.9;
  if (s.dt_previous > 0) step = std::min(step, 1.05 * s.dt_previous);
  s.dt = step;
  tiles.sum_partials(s, 0, int(s.nodes.size()));
  for (std::size_t n = 0; n < s.nodes.size(); ++n) {
    s.nodes[n].v += (s.mean_dt() * s.nodes[n].inverse_mass) * s.force[n];
    if (!s.spins.empty() && s.spins[n].inertia > 0)
      s.spins[n].w += (s.mean_dt() / s.spins[n].inertia) * s.moment[n];
    s.nodes[n].x += s.dt * s.nodes[n].v;
  }
  s.dt_previous = s.dt;
}

template <class A>
bool same_bits(const A& a, const A& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

void check_results(const Tiles& tiles, const std::vector<TileResult>& result) {
  for (std::size_t i = 0; i < result.size(); ++i) {
    CHECK(tiles.tiles[i].internal == result[i].internal);
    CHECK(tiles.tiles[i].hourglass == result[i].hourglass);
    CHECK(tiles.tiles[i].damping == result[i].damping);
    CHECK(tiles.tiles[i].time_step == result[i].time_step);
    CHECK(tiles.tiles[i].smallest_volume == result[i].smallest_volume);
  }
}

// whether the GPU would take this law for the case's card
template <unsigned families, class M>
bool is_law(const Case& c, const Parameters& parameters) {
  return with_gpu_law<families>(c.law, parameters, nullptr, [](const auto& law) {
    return std::is_same_v<std::decay_t<decltype(law)>, M>;
  });
}

// The element E with the law M, which the case's card must ask for.
template <class E, class M>
void compare(const Case& c) {
  constexpr unsigned families = E::rotations ? in_shells : in_solids;
  Diagnostics diagnostics;
  const auto model = make(c, diagnostics);
  for (const auto& d : diagnostics.list()) MESSAGE(diagnostics.format(d));
  REQUIRE(model);
  REQUIRE(!diagnostics.has_errors());
  Simulation simulation(*model, {}, diagnostics);
  REQUIRE(!diagnostics.has_errors());
  Tiles tiles = simulation.tiles();
  State state = simulation.state();
  REQUIRE(tiles.tiles.size() > 1);
  for (NodeMotion& n : state.nodes)
    n.v = {8 * std::sin(0.3 * n.x.y), 8 * std::sin(0.3 * n.x.z + 0.2 * n.x.x),
           8 * std::sin(0.3 * n.x.x)};
  Host host(tiles, state);
  const CardParameters parameters(*model, *model->materials[0].card);
  Team team(2);
  REQUIRE(is_law<families, M>(c, parameters));
  const M law = make_material<M>(parameters, nullptr);
  for (int i = 0; i < 200; ++i) {
    step_cpu(tiles, state, team);
    run_tiles<E>(host.arrays(), law, tiles.classes[0].parameters, tiles.classes[0].fields);
    step_nodes(host.arrays());
  }
  CHECK(state.dt > 0);
  CHECK(host.clock.ending == GpuEnding::running);
  CHECK(state.dt == host.clock.dt);
  CHECK(same_bits(tiles.state_, host.tiles.state_));
  CHECK(same_bits(tiles.force, host.tiles.force));
  CHECK(same_bits(tiles.moment, host.tiles.moment));
  CHECK(same_bits(state.nodes, host.state.nodes));
  CHECK(same_bits(state.spins, host.state.spins));
  check_results(tiles, host.result);
  double energy = 0;
  for (const Tile& t : tiles.tiles) energy += std::abs(t.internal);
  CHECK(energy > 0);
}

const std::vector<std::pair<std::string, double>> steel = {
    {"ro", 7.85e-6}, {"e", 210}, {"pr", 0.3}, {"sigy", 0.3}, {"etan", 2.1}};

}  // namespace

TEST_CASE("gpu phases: bricks with plasticity and every hourglass control") {
  for (int hourglass : {1, 4, 6}) {
    CAPTURE(hourglass);
    Case c{{{"elform", 1}}, steel, "MAT_PLASTIC_KINEMATIC"};
    c.hourglass = hourglass;
    compare<Hex8<false>, PlasticKinematic>(c);
  }
}

TEST_CASE("gpu phases: bricks with a rate effect and failure") {
  Case c{{{"elform", 1}}, steel, "MAT_PLASTIC_KINEMATIC"};
  for (const auto& [name, value] :
       {std::pair{"src", 0.04}, {"srp", 5.0}, {"fs", 0.02}, {"beta", 0.5}})
    c.material.push_back({name, value});
  compare<Hex8<false>, PlasticKinematic>(c);
}

TEST_CASE("gpu phases: rubber and viscoelastic bricks") {
  compare<Hex8<false>, MooneyRivlin>({{{"elform", 1}},
                                      {{"ro", 1.1e-6}, {"a", 0.01}, {"b", 0.002}, {"pr", 0.49}},
                                      "MAT_MOONEY-RIVLIN_RUBBER"});
  compare<Hex8<false>, Viscoelastic>(
      {{{"elform", 1}},
       {{"ro", 1.1e-6}, {"bulk", 0.5}, {"g0", 0.1}, {"gi", 0.02}, {"beta", 5}},
       "MAT_VISCOELASTIC"});
}

TEST_CASE("gpu phases: tetrahedra") {
  Case c{{{"elform", 10}}, {{"ro", 1.1e-6}, {"e", 0.5}, {"pr", 0.4}}, "MAT_ELASTIC"};
  c.tetrahedra = true;
  compare<Tet4, ElasticLaw>(c);
}

TEST_CASE("gpu phases: shells with five layers, plastic by line and by points") {
  Case c{
      {{"elform", 2}, {"nip", 5}, {"t1", 1.5}, {"shrf", 0.8333}}, steel, "MAT_PLASTIC_KINEMATIC"};
  c.shell = true, c.hourglass = 4;
  compare<ShellBT, PlasticKinematic>(c);
  c.law = "MAT_PIECEWISE_LINEAR_PLASTICITY";
  for (const auto& [name, value] : {std::pair{"eps1", 0.0},
                                    {"eps2", 0.01},
                                    {"eps3", 0.1},
                                    {"es1", 0.3},
                                    {"es2", 0.4},
                                    {"es3", 0.5},
                                    {"c", 0.04},
                                    {"p", 5.0}})
    c.material.push_back({name, value});
  compare<ShellBT, PiecewiseLinearPlasticity>(c);
}

TEST_CASE("gpu phases: a law with a curve is refused") {
  struct Bent : PiecewiseLinearPlasticity {
  } law;
  CHECK(!uses_curves(law));
  const Real x[2] = {0, 1}, y[2] = {1, 2};
  law.curve = {x, y, 2, true};
  CHECK(uses_curves(law));
}

}  // namespace fabrica
