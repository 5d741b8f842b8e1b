#pragma once
// Decks written as text, in comma format with all digits, and runs of them, for whole-solver tests.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "deck/reader.h"
#include "solver/simulation.h"

namespace fabrica::verification {

// tolerance of kernels in double, and in float
constexpr double tolerance(double in_double, double in_float) {
  return sizeof(Real) == 8 ? in_double : in_float;
}

// what was measured, for whoever runs the program by hand
inline void report(const char* what, std::initializer_list<double> values) {
  MESSAGE(fmt::format("measured: {}: {:.10g}", what, fmt::join(values, ", ")));
}

inline std::string field(int x) { return fmt::format("{}", x); }
inline std::string field(double x) { return fmt::format("{:.17g}", x); }
inline std::string field(const char* x) { return x; }

class Deck {
 public:
  // a keyword without its star
  Deck& key(const std::string& name) {
    text_ += "*" + name + "\n";
    return *this;
  }
  // one card; the comma at its end makes a line of one value comma format too
  template <class... T>
  Deck& card(T... values) {
    std::string line;
    ((line += field(values), line += ","), ...);
    text_ += line + "\n";
    return *this;
  }
  Deck& end(double time) { return key("CONTROL_TERMINATION").card(time); }
  Deck& part(int id, int section, int material, int hourglass = 0) {
    return key("PART").card("part").card(id, section, material, 0, hourglass);
  }
  Deck& curve(int id, const std::vector<std::array<double, 2>>& points) {
    key("DEFINE_CURVE").card(id);
    for (const auto& p : points) card(p[0], p[1]);
    return *this;
  }
  // the step, the same in every cycle: TSSFAC is large and the curve of LCTM limits
  Deck& constant_step(double dt, int curve_id) {
    key("CONTROL_TIMESTEP").card(0, 0.9, 0, 0, 0, curve_id);
    return curve(curve_id, {{0, dt}, {1e9, dt}});
  }
  Deck& no_bulk_viscosity() { return key("CONTROL_BULK_VISCOSITY").card(1e-20, 1e-20); }
  Deck& node_set(int id, const std::vector<int>& nodes) {
    key("SET_NODE_LIST").card(id);
    for (int n : nodes) card(n);
    return *this;
  }
  // returns the id, 1, 2, ... in order
  int node(const Vec3d& x, int translation_code = 0, int rotation_code = 0) {
    nodes_ += fmt::format("{},{:.17g},{:.17g},{:.17g},{},{}\n", ++node_count, x.x, x.y, x.z,
                          translation_code, rotation_code);
    return node_count;
  }
  int solid(int part, const std::array<int, 8>& n) {
    solids_ += fmt::format("{},{},{}\n", ++solid_count, part, fmt::join(n, ","));
    return solid_count;
  }
  int shell(int part, const std::array<int, 4>& n) {
    shells_ += fmt::format("{},{},{}\n", ++shell_count, part, fmt::join(n, ","));
    return shell_count;
  }
  int spring(int part, int a, int b) {
    springs_ += fmt::format("{},{},{},{}\n", ++spring_count, part, a, b);
    return spring_count;
  }
  int beam(int part, int a, int b) {
    beams_ += fmt::format("{},{},{},{}\n", ++beam_count, part, a, b);
    return beam_count;
  }
  void mass(int node, double m) {
    masses_ += fmt::format("{},{},{:.17g}\n", ++mass_count, node, m);
  }
  std::string text() const {
    std::string t = "*KEYWORD\n" + text_;
    const auto add = [&](const char* name, const std::string& lines) {
      if (!lines.empty()) t += std::string("*") + name + "\n" + lines;
    };
    add("NODE", nodes_), add("ELEMENT_SOLID", solids_), add("ELEMENT_SHELL", shells_);
    add("ELEMENT_BEAM", beams_), add("ELEMENT_DISCRETE", springs_);
    add("ELEMENT_MASS", masses_);
    return t + "*END\n";
  }
  int node_count = 0, solid_count = 0, shell_count = 0, spring_count = 0, beam_count = 0,
      mass_count = 0;

 private:
  std::string text_, nodes_, solids_, shells_, springs_, beams_, masses_;
};

// a grid of bricks; place(i, j, k) is a point and its *NODE constraint code
struct Grid {
  int nx, ny, nz;
  std::vector<int> ids;
  std::vector<int> elements;  // ids, i fastest
  int at(int i, int j, int k) const { return ids[std::size_t((k * (ny + 1) + j) * (nx + 1) + i)]; }
  int element(int i, int j, int k) const { return elements[std::size_t((k * ny + j) * nx + i)]; }
};
template <class Place, class Code>
Grid bricks(Deck& deck, int nx, int ny, int nz, Place place, Code code, int part) {
  Grid g{nx, ny, nz, {}, {}};
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) g.ids.push_back(deck.node(place(i, j, k), code(i, j, k)));
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        g.elements.push_back(
            deck.solid(part, {g.at(i, j, k), g.at(i + 1, j, k), g.at(i + 1, j + 1, k),
                              g.at(i, j + 1, k), g.at(i, j, k + 1), g.at(i + 1, j, k + 1),
                              g.at(i + 1, j + 1, k + 1), g.at(i, j + 1, k + 1)}));
  return g;
}

struct Run {
  Diagnostics diagnostics;
  std::unique_ptr<Model> model;
  std::unique_ptr<Simulation> simulation;

  explicit Run(const Deck& deck, int threads = 1) {
    ReadOptions options;
    options.follow_includes = false;
    model = read_deck_text(deck.text(), "test", diagnostics, options);
    check();
    RunOptions run;
    run.threads = threads;
    simulation = std::make_unique<Simulation>(*model, run, diagnostics);
    check();
  }
  void check() const {
    for (const Diagnostic& d : diagnostics.list())
      if (d.severity != Severity::note) MESSAGE(diagnostics.format(d));
    REQUIRE(!diagnostics.has_errors());
  }
  const State& state() const { return simulation->state(); }
  double time() const { return state().time; }
  // of a node id
  const Vec3d& x(int id) const { return state().nodes[std::size_t(id - 1)].x; }
  const Vec3d& v(int id) const { return state().nodes[std::size_t(id - 1)].v; }
  Vec3d displacement(int id) const { return x(id) - model->nodes.x[std::size_t(id - 1)]; }
  // of an element id
  ElementReadout solid(int id) const {
    return simulation->tiles().read(*model, state(), Family::solid, id - 1);
  }
  ElementReadout shell(int id) const {
    return simulation->tiles().read(*model, state(), Family::shell, id - 1);
  }
  bool step(const Sampler& sampler = {}) {
    simulation->step(sampler);
    return simulation->ending() == Ending::running;
  }
  // all steps to the end time
  void finish() {
    while (step()) {
    }
    INFO(simulation->ending_text());
    REQUIRE(simulation->ending() == Ending::end_time);
  }
  // steps until the time is reached
  void until(double time) {
    while (this->time() < time) {
      const bool going = step();
      INFO(simulation->ending_text());
      REQUIRE((going || simulation->ending() == Ending::end_time));
    }
  }
};

}  // namespace fabrica::verification
