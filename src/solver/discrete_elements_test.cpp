// Springs and discrete beams in their own small central difference harness.
#include "solver/discrete_elements.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "element/discrete.h"

namespace fabrica {
namespace {
constexpr double pi = std::numbers::pi;

// A model written by hand: n nodes, laws with their parameters, one part per law.
struct Bench {
  std::vector<std::unique_ptr<KeywordSchema>> schemas;
  std::vector<std::unique_ptr<Card>> cards;
  Model model;
  State state;
  Diagnostics diagnostics;
  double energy_now = 0;  // of the discrete elements at t(n)

  int node(Vec3d x, double mass, Vec3d v = {0, 0, 0}, double inertia = 0) {
    model.nodes.id.push_back(model.nodes.size() + 1);
    model.nodes.x.push_back(x);
    state.nodes.push_back({x, v, mass, 1 / mass});
    state.spins.push_back({{0, 0, 0}, inertia, {1, 0, 0, 0}});
    return model.nodes.size() - 1;
  }
  int part(std::string law, const std::vector<std::pair<std::string, double>>& values,
           Section section = {}) {
    auto schema = std::make_unique<KeywordSchema>();
    auto card = std::make_unique<Card>();
    schema->name = law;
    schema->cards.emplace_back();
    for (const auto& [name, value] : values) {
      FieldSchema f;
      f.name = name;
      schema->cards[0].fields.push_back(f);
      card->values.push_back(value);
      card->values_given.push_back(1);
      card->texts.emplace_back();
    }
    card->card_lines = {1};
    card->schema = schema.get();
    Material m;
    m.law = law;
    m.card = card.get();
    schemas.push_back(std::move(schema));
    cards.push_back(std::move(card));
    model.materials.push_back(m);
    model.sections.push_back(section);
    Part p;
    p.id = std::int64_t(model.parts.size()) + 1;
    p.material = int(model.materials.size()) - 1;
    p.section = int(model.sections.size()) - 1;
    model.parts.push_back(p);
    return int(model.parts.size()) - 1;
  }
  void spring(int part, int a, int b, int orientation = -1, double scale = 1, double offset = 0) {
    Discretes& d = model.discretes;
    d.id.push_back(d.size() + 1);
    d.part.push_back(part);
    d.node.push_back({a, b});
    d.orientation.push_back(orientation);
    d.scale.push_back(scale);
    d.offset.push_back(offset);
  }
  void beam(int part, int a, int b) {
    model.beams.id.push_back(model.beams.size() + 1);
    model.beams.part.push_back(part);
    model.beams.node.push_back({a, b, -1});
  }
  DiscreteElements build(double force_scale = 1) {
    state.force.resize(state.nodes.size());
    state.moment.resize(state.spins.size());
    state.interaction.resize(state.nodes.size(), FixedScale::of(force_scale));
    state.interaction_moment.resize(state.spins.size(), FixedScale::of(force_scale));
    return DiscreteElements(model, state, diagnostics);
  }
  // Forces at t(n), then velocities, positions and work towards t(n+1). Nodes in `held` keep their
  // motion.
  void step(DiscreteElements& elements, double dt, Team& team, int held = -1) {
    elements.forces(model, state, team);
    energy_now = state.energy.discrete;
    const double mean = state.cycle == 0 ? 0.5 * dt : 0.5 * (dt + state.dt_previous);
    for (int i = 0; i < int(state.nodes.size()); ++i) {
      NodeMotion& n = state.nodes[i];
      NodeSpin& s = state.spins[i];
      state.force[i] = state.interaction.take(i);
      state.moment[i] = state.interaction_moment.take(i);
      if (i != held) n.v += (mean * n.inverse_mass) * state.force[i];
      if (s.inertia > 0) s.w += (mean / s.inertia) * state.moment[i];
      n.x += dt * n.v;
    }
    state.dt = dt;
    elements.account(state);
    state.time += dt, state.dt_previous = dt, ++state.cycle;
  }
};

const std::vector<std::pair<std::string, double>> beam066(double k, double c, double kr,
                                                          double cr) {
  std::vector<std::pair<std::string, double>> r;
  for (const char* a : {"r", "s", "t"}) {
    r.emplace_back(std::string("tk") + a, k), r.emplace_back(std::string("td") + a, c);
    r.emplace_back(std::string("rk") + a, kr), r.emplace_back(std::string("rd") + a, cr);
    r.emplace_back(std::string("fo") + a, 0), r.emplace_back(std::string("mo") + a, 0);
  }
  return r;
}
Section discrete_beam(double scoor) {
  Section s;
  s.family = Family::beam;
  s.formulation = 6;
  s.scoor = scoor;
  return s;
}
}  // namespace

// V02: period / exact period = (w dt / 2) / asin(w dt / 2) for w dt = 0.1
TEST_CASE("spring-mass: the period is that of the central difference scheme") {
  Bench b;
  const double k = 4, m = 2, w = std::sqrt(k * (1 / m + 1 / m)), dt = 0.1 / w;
  const int n1 = b.node({0, 0, 0}, m, {-0.001, 0, 0}), n2 = b.node({10, 0, 0}, m, {0.001, 0, 0});
  b.spring(b.part("MAT_SPRING_ELASTIC", {{"k", k}}), n1, n2);
  DiscreteElements e = b.build(0.01);
  Team team(1);
  // zero crossings of the elongation by linear interpolation, first and last
  double before = 0, first = 0, last = 0;
  int crossings = 0;
  for (int i = 0; i < 20000; ++i) {
    b.step(e, dt, team);
    const double d = b.state.nodes[1].x.x - b.state.nodes[0].x.x - 10;
    if (i > 2 && before < 0 && d >= 0) {
      // between the states the solution is A sin(theta n + phi): solve for the crossing exactly
      const double theta = 2 * std::asin(0.05);
      const double back = std::atan2(std::sin(theta), std::cos(theta) - before / d);
      last = b.state.time - dt * back / theta;
      if (crossings++ == 0) first = last;
    }
    before = d;
  }
  const double period = (last - first) / (crossings - 1);
  CHECK(period / (2 * pi / w) == doctest::Approx(0.05 / std::asin(0.05)).epsilon(1e-8));
  CHECK(std::fabs(0.05 / std::asin(0.05) - 0.99958304) < 1e-8);
}

// V03: the reported step is the stability limit: bounded at 0.999 of it, growing at 1.001; without
// damping w dt = 2, with xi = 0.1 and 0.25 it is 1.80998 and 1.56155.
TEST_CASE("spring-mass: the time step is the onset of instability") {
  for (const auto& [xi, limit] : {std::pair{0.0, 2.0}, {0.1, 1.80998}, {0.25, 1.56155}}) {
    const double k = 4, m = 2, w = std::sqrt(k / m);
    for (const double factor : {0.999, 1.001}) {
      Bench b;
      const int n = b.node({1, 0, 0}, m, {1e-3, 0, 0});
      b.model.sd_orientations.push_back({1, 0, {1, 0, 0}});
      b.spring(b.part("MAT_SPRING_ELASTIC", {{"k", k}}), n, -1, 0);
      b.spring(b.part("MAT_DAMPER_VISCOUS", {{"dc", 2 * xi * m * w}}), n, -1, 0);
      DiscreteElements e = b.build(1);
      Team team(1);
      e.forces(b.model, b.state, team);
      b.state.interaction.clear();
      const double dt = e.time_step(b.state);
      CHECK(w * dt == doctest::Approx(limit).epsilon(1e-5));
      double largest = 0;
      for (int i = 0; i < 2000; ++i) {
        b.step(e, factor * dt, team);
        largest = std::max(largest, std::fabs(b.state.nodes[0].v.x));
      }
      CHECK((largest < 0.1) == (factor < 1));
    }
  }
}

// A chain: the bound with shared node masses must not exceed the exact limit 2 / w_max (and be near
// it).
TEST_CASE("spring chain: the time step is safe and sharp") {
  Bench b;
  const int count = 40;
  for (int i = 0; i <= count; ++i) b.node({double(i), 0, 0}, i == 0 || i == count ? 0.5 : 1.0);
  const int part = b.part("MAT_SPRING_ELASTIC", {{"k", 9}});
  for (int i = 0; i < count; ++i) b.spring(part, i, i + 1);
  DiscreteElements e = b.build(1);
  Team team(1);
  e.forces(b.model, b.state, team);
  // uniform chain with half masses at the ends: w_max = 2 sqrt(k / m)
  CHECK(e.time_step(b.state) == doctest::Approx(2 / (2 * std::sqrt(9.0))).epsilon(1e-12));
}

// Two springs on one body: the body's rates add up, whatever its nodes weigh.
TEST_CASE("springs on a body: the time step takes the body's mass") {
  Bench b;
  b.node({0, 0, 0}, 1e-6), b.node({0, 0, 0}, 1e-6);
  b.model.sd_orientations.push_back({1, 0, {1, 0, 0}});
  const int part = b.part("MAT_SPRING_ELASTIC", {{"k", 8}});
  b.spring(part, 0, -1, 0), b.spring(part, 1, -1, 0);
  DiscreteElements e = b.build(1);
  Team team(1);
  e.forces(b.model, b.state, team);
  CHECK(e.time_step(b.state) == doctest::Approx(2 / std::sqrt(8 / 1e-6)));
  e.use_mass(0, 5, 4, 1), e.use_mass(1, 5, 4, 1);
  CHECK(e.time_step(b.state) == doctest::Approx(2 / std::sqrt(16.0 / 4)));
}

// The discrete identity KE(n) = 1/2 m v(n-1/2).v(n+1/2) and the accounted work close to round-off
// for any forces.
TEST_CASE("discrete elements: energy closes to round-off") {
  Bench b;
  b.node({0, 0, 0}, 1, {1, 0.2, 0}, 0.5), b.node({1, 0.5, 0}, 2, {-1, 0, 0.3}, 0.4);
  b.node({0.3, 2, 1}, 1.5, {0, -2, 0.1}, 0.3), b.node({1, 1, 3}, 1, {0.5, 0, -1}, 0.6);
  const int spring = b.part("MAT_SPRING_ELASTOPLASTIC", {{"k", 5}, {"kt", 1}, {"fy", 0.3}});
  const int damper = b.part("MAT_DAMPER_VISCOUS", {{"dc", 0.1}});
  Section twist;
  twist.torsional = 1;
  const int torsion = b.part("MAT_SPRING_ELASTIC", {{"k", 2}}, twist);
  Section play;
  play.clearance = 0.05, play.deflection_limit_tension = 0.2;
  const int stopped =
      b.part("MAT_SPRING_MAXWELL", {{"k0", 3}, {"ki", 1}, {"beta", 2}, {"tc", 0}, {"fc", 0}}, play);
  const int joint =
      b.part("MAT_LINEAR_ELASTIC_DISCRETE_BEAM", beam066(6, 0.1, 0.8, 0.02), discrete_beam(2));
  b.model.sd_orientations.push_back({1, 1, {0, 0, 1}});
  b.spring(spring, 0, 1), b.spring(damper, 1, 2), b.spring(torsion, 2, 3),
      b.spring(spring, 3, -1, 0);
  b.spring(stopped, 0, 3, -1, 1.5, 0.02);
  b.beam(joint, 0, 2), b.beam(joint, 1, 3);
  DiscreteElements e = b.build(10);
  REQUIRE(!b.diagnostics.has_errors());
  Team team(1);
  std::vector<NodeMotion> before;
  std::vector<NodeSpin> spin_before;
  const auto kinetic = [&] {
    double r = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      r += 0.5 * b.state.nodes[i].mass * dot(before[i].v, b.state.nodes[i].v) +
           0.5 * b.state.spins[i].inertia * dot(spin_before[i].w, b.state.spins[i].w);
    return r;
  };
  double start = 0;
  for (int i = 0; i < 3000; ++i) {
    before.assign(b.state.nodes.begin(), b.state.nodes.end());
    spin_before.assign(b.state.spins.begin(), b.state.spins.end());
    b.step(e, 0.005, team);
    // KE(n) needs both half-step velocities: from the first full step on
    if (i == 1) start = kinetic() + b.energy_now;
    if (i > 1 && i % 100 == 0) CHECK(std::fabs(kinetic() + b.energy_now - start) < 1e-10);
  }
  CHECK(b.state.energy.discrete > 0.5);  // plastic and viscous work has been taken
}

// V49: a zero-length beam between two nodes that turn together; the stretch is fixed in the turning
// frame.
TEST_CASE("discrete beam: the force follows the turning frame") {
  for (const double scoor : {-1.0, 0.0, 1.0}) {
    Bench b;
    b.node({0, 0, 0}, 1), b.node({0, 0, 0}, 1);
    auto values = beam066(0, 0, 0, 0);
    for (auto& [name, value] : values)
      if (name == "tkr") value = 7;
    b.beam(b.part("MAT_LINEAR_ELASTIC_DISCRETE_BEAM", values, discrete_beam(scoor)), 0, 1);
    DiscreteElements e = b.build(1);
    REQUIRE(!b.diagnostics.has_errors());
    Team team(1);
    const Vec3d w{0.3, -0.4, 1.2};
    const double dt = 0.01, stretch = 0.02;
    for (int i = 0; i <= 500; ++i) {
      const double t = i * dt;
      b.state.dt_previous = i == 0 ? 0 : dt;
      for (NodeSpin& s : b.state.spins) s.w = w;
      const Vec3d axis = turned(Vec3d{1, 0, 0}, t * w);
      b.state.nodes[1].x = stretch * axis;
      e.forces(b.model, b.state, team);
      const Vec3d f1 = b.state.interaction.take(0), f2 = b.state.interaction.take(1);
      CHECK(norm(f1 - (7 * stretch) * axis) < 1e-6 * 7 * stretch);
      CHECK(norm(f1 + f2) == 0);
    }
  }
}

// |SCOOR| = 2: forces and moments of a finite beam are in balance about any point.
TEST_CASE("discrete beam: a finite beam gives no net moment with SCOOR 2") {
  Bench b;
  b.node({0, 0, 0}, 1), b.node({1, 2, 3}, 1);
  b.beam(b.part("MAT_LINEAR_ELASTIC_DISCRETE_BEAM", beam066(7, 0, 2, 0), discrete_beam(2)), 0, 1);
  DiscreteElements e = b.build(1);
  Team team(1);
  b.state.dt_previous = 0.1;
  b.state.spins[0].w = {0.1, 0.2, -0.1}, b.state.spins[1].w = {-0.3, 0.4, 0.2};
  b.state.nodes[1].x = {1.2, 1.9, 3.1};
  e.forces(b.model, b.state, team);
  const Vec3d f2 = b.state.interaction.get(1);
  const Vec3d net = b.state.interaction_moment.get(0) + b.state.interaction_moment.get(1) +
                    cross(b.state.nodes[1].x - b.state.nodes[0].x, f2);
  CHECK(norm(f2) > 0.1);
  CHECK(norm(net) < 1e-11);
}

// IOP 0 to 3, offset, scale, ground, clearance, failure: forces by hand.
TEST_CASE("spring: axes, offset, scale, clearance and failure") {
  Bench b;
  b.node({0, 0, 0}, 1), b.node({3, 0, 4}, 1), b.node({0, 0, 0}, 1), b.node({0, 0, 2}, 1);
  b.model.sd_orientations = {
      {1, 0, {2, 0, 0}}, {2, 1, {0, 0, 1}}, {3, 2, {}, {2, 3}}, {4, 3, {}, {2, 3}}};
  const int part = b.part("MAT_SPRING_ELASTIC", {{"k", 2}});
  Section gap, weak;
  gap.clearance = 0.5, weak.failure_deflection = 0.5;
  const int gapped = b.part("MAT_SPRING_ELASTIC", {{"k", 2}}, gap);
  const int failing = b.part("MAT_SPRING_ELASTIC", {{"k", 2}}, weak);
  for (int o = -1; o < 4; ++o) b.spring(part, 0, 1, o);
  b.spring(part, 0, 1, -1, 3, 0.25), b.spring(part, 1, -1, 0);
  b.spring(gapped, 0, 1, 0), b.spring(failing, 0, 1, 0);
  DiscreteElements e = b.build(1);
  Team team(1);
  e.forces(b.model, b.state, team);
  for (int i = 0; i < 5; ++i) CHECK(e.force(i) == doctest::Approx(0));
  CHECK(e.force(5) == doctest::Approx(3 * 2 * 0.25));  // tension from a positive offset
  b.state.nodes[1].x = {6, 0, 8};
  e.forces(b.model, b.state, team);
  CHECK(e.force(0) == doctest::Approx(2 * 5));
  CHECK(e.force(1) == doctest::Approx(2 * 3));
  CHECK(e.force(2) == doctest::Approx(2 * 3));
  CHECK(e.force(3) == doctest::Approx(2 * 4));
  CHECK(e.force(4) == doctest::Approx(2 * 3));
  CHECK(e.force_vector(4).z == 0);
  CHECK(e.force_vector(3).x == 0);
  CHECK(e.force(6) == doctest::Approx(2 * 3));
  CHECK(e.force_vector(6).x == doctest::Approx(-6));  // node 1 is pulled back to the ground
  CHECK(e.force(7) == 0);                             // no tension with play
  CHECK(!e.alive(8));
  b.state.nodes[1].x = {2, 0, 4};
  e.forces(b.model, b.state, team);
  CHECK(e.force(7) == doctest::Approx(-2 * 0.5));  // shortened by 1, play 0.5
  CHECK(e.force(8) == 0);                          // stays failed
}

TEST_CASE("spring: an unsupported law is an error that names it") {
  Bench b;
  b.node({0, 0, 0}, 1), b.node({1, 0, 0}, 1);
  b.spring(b.part("MAT_SPRING_TRILINEAR_DEGRADING", {}), 0, 1);
  b.build();
  REQUIRE(b.diagnostics.has_errors());
  CHECK(b.diagnostics.list()[0].name == "unsupported-discrete-law");
}

TEST_CASE("spring: an orientation without its nodes is an error") {
  Bench b;
  b.node({0, 0, 0}, 1), b.node({1, 0, 0}, 1);
  b.model.sd_orientations = {{1, 2, {1, 0, 0}}};
  b.spring(b.part("MAT_SPRING_ELASTIC", {{"k", 2}}), 0, 1, 0);
  b.build();
  REQUIRE(b.diagnostics.has_errors());
  CHECK(b.diagnostics.list()[0].name == "unsupported-orientation");
}

namespace {
// a cloud of springs and beams after some steps: positions of all nodes
std::vector<Vec3d> run_cloud(int threads, int steps, int restart_at) {
  Bench b;
  for (int i = 0; i < 200; ++i)
    b.node({std::sin(1.1 * i), std::cos(2.3 * i), 0.05 * i}, 1, {std::sin(7.0 * i), 0.3, 0}, 0.2);
  const int spring = b.part("MAT_SPRING_ELASTOPLASTIC", {{"k", 5}, {"kt", 1}, {"fy", 0.3}});
  const int joint =
      b.part("MAT_LINEAR_ELASTIC_DISCRETE_BEAM", beam066(2, 0.1, 0.8, 0.02), discrete_beam(0));
  for (int i = 0; i < 1000; ++i) b.spring(spring, i % 200, (i * 7 + 3) % 199);
  for (int i = 0; i < 199; ++i) b.beam(joint, i, i + 1);
  DiscreteElements e = b.build(10);
  Team team(threads);
  for (int i = 0; i < steps; ++i) {
    if (i == restart_at) {
      std::stringstream record;
      e.save(record);
      // what a new process would have: the model at its first positions
      State first = b.state;
      for (int n = 0; n < 200; ++n) first.nodes[n].x = b.model.nodes.x[n];
      e = DiscreteElements(b.model, first, b.diagnostics);
      e.load(record);
    }
    b.step(e, 0.01, team);
  }
  std::vector<Vec3d> x;
  for (const NodeMotion& n : b.state.nodes) x.push_back(n.x);
  return x;
}
bool same_bits(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (a[i][k] != b[i][k]) return false;
  return a.size() == b.size();
}
}  // namespace

TEST_CASE("discrete elements: the same bits for any thread count and after a restart") {
  const auto one = run_cloud(1, 60, -1);
  CHECK(same_bits(one, run_cloud(2, 60, -1)));
  CHECK(same_bits(one, run_cloud(5, 60, -1)));
  CHECK(same_bits(one, run_cloud(2, 60, 31)));
}

}  // namespace fabrica
