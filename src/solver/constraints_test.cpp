// Supports, prescribed nodal motions, loads, initial conditions, damping.
#include <doctest/doctest.h>

#include <cmath>

#include "solver/initial_conditions.h"
#include "solver/node_run_test.h"

using namespace fabrica;
using mechanism::Mechanism;
using mechanism::Run;

TEST_CASE("supports take out the initial velocity that they forbid, and no more") {
  Mechanism m;
  const int fixed = m.node({0, 0, 0}), slider = m.node({1, 0, 0}), free_node = m.node({2, 0, 0});
  m.model.nodes.translation_code = {7, 0, 0};
  const double c = std::cos(0.3), s = std::sin(0.3);
  CoordinateSystem system;
  system.axes = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
  m.model.coordinate_systems = {system};
  SinglePointConstraint spc;
  spc.nodes = {slider}, spc.fixed = {true, false, false, false, false, false}, spc.local_system = 0;
  m.model.constraints = {spc};
  m.start();
  for (NodeMotion& n : m.state.nodes) n.v = {3, -2, 5};
  NodeConstraints constraints(m.model, m.state, m.diagnostics);
  constraints.stop_supported(m.state);
  CHECK(norm(m.state.nodes[fixed].v) == 0);
  CHECK(norm(m.state.nodes[free_node].v - Vec3d{3, -2, 5}) == 0);
  // along the fixed axis nothing, across it all
  const Vec3d v = m.state.nodes[slider].v;
  CHECK(std::abs(c * v.x + s * v.y) < 1e-14);
  CHECK(std::abs(-s * v.x + c * v.y - (-s * 3 + c * -2)) < 1e-14);
  CHECK(v.z == 5);
}

TEST_CASE("free fall is exact") {
  Mechanism m;
  m.node({0, 0, 0});
  BodyLoad g;
  g.direction = {0, 0, 1}, g.scale = 9.81e-3;
  m.model.body_loads.push_back(g);
  m.start({2.0});
  Run run(m);
  const double dt = 1e-3;
  for (int i = 0; i < 100000; ++i) run.step(dt);
  const double t = 100000 * dt;
  CHECK(std::abs(m.state.nodes[0].x.z / (-0.5 * 9.81e-3 * t * t) - 1) < 1e-12);
  run.step(dt);  // books the work up to t
  CHECK(run.last_kinetic - run.first_kinetic ==
        doctest::Approx(m.state.energy.external_work).epsilon(1e-11));
}

TEST_CASE("supports hold their directions in a local system and report their force") {
  Mechanism m;
  const int a = m.node({0, 0, 0}), b = m.node({1, 0, 0});
  const double c = std::cos(0.3), s = std::sin(0.3);
  CoordinateSystem cs;
  cs.axes = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
  m.model.coordinate_systems.push_back(cs);
  SinglePointConstraint spc;
  spc.nodes = {a}, spc.local_system = 0, spc.fixed = {true, false, false, false, false, true};
  m.model.constraints.push_back(spc);
  m.model.nodes.translation_code[b] = 6;  // z and x
  m.start({2, 1}, 0.1);
  Run run(m);
  run.extra[a] = {3, 1, 2};
  run.extra[b] = {1, 2, 3};
  m.state.moment[a] = {0, 1, 5};
  for (int i = 0; i < 10; ++i) run.step(0.01);
  const Vec3d e{c, s, 0};
  CHECK(std::abs(dot(e, m.state.nodes[a].v)) < 1e-15);
  const Vec3d r = run.constraints.reactions()[0].force;
  CHECK(norm(r + dot(e, run.extra[a]) * e) < 1e-13);
  CHECK(norm(run.constraints.reactions()[0].moment - Vec3d{0, 0, -5}) < 1e-12);
  CHECK(m.state.spins[a].w.z == 0);
  CHECK(m.state.spins[a].w.y > 0);
  CHECK(m.state.nodes[b].x.x == 1);
  CHECK(m.state.nodes[b].x.z == 0);
  CHECK(norm(run.constraints.reactions()[1].force - Vec3d{-1, 0, -3}) < 1e-14);
  CHECK(m.state.energy.external_work == doctest::Approx(0).epsilon(1e-14));
}

TEST_CASE(
    "prescribed nodal motions end at the integrals of their curves, and a freed node flies on") {
  for (const int kind : {0, 1, 2}) {
    Mechanism m;
    const int a = m.node({0.5, 0, 0});
    PrescribedMotion pm;
    pm.nodes = {a}, pm.dof = 1, pm.kind = kind, pm.birth = 0.1, pm.death = 1.095;
    pm.curve = m.curve({0, 0.35, 1}, {0, 0.7, 0.2});
    m.model.prescribed_motions.push_back(pm);
    m.start({2.0});
    Run run(m);
    for (int i = 0; i < 110; ++i) run.step(0.01);
    const double area = 0.5 * 0.35 * 0.7 + 0.5 * 0.9 * 0.65, y = 0.7 - 0.5 / 0.65 * 0.645;
    const double u = m.state.nodes[a].x.x - 0.5, v = m.state.nodes[a].v.x;
    if (kind == 0) CHECK(u == doctest::Approx(area).epsilon(1e-12));
    if (kind == 2) CHECK(u == doctest::Approx(0.2).epsilon(1e-12));
    if (kind == 1)
      CHECK(v == doctest::Approx(0.5 * 0.35 * 0.7 + 0.5 * (0.7 + y) * 0.645).epsilon(1e-12));
    const double last = v;
    for (int i = 0; i < 5; ++i) run.step(0.01);
    CHECK(m.state.nodes[a].v.x == last);
    // work of the motion is the kinetic energy it gave
    CHECK(m.state.energy.external_work == doctest::Approx(0.5 * 2 * last * last).epsilon(1e-11));
  }
}

TEST_CASE("nodal loads, followers and pressures do the work they should") {
  Mechanism m;
  const int a = m.node({0, 0, 0}), b = m.node({2, 0, 0}), c = m.node({2, 3, 0}),
            d = m.node({0, 3, 0}), e = m.node({9, 9, 9});
  const int p = m.part({e});
  const int curve = m.curve({0, 1}, {1, 3});
  NodalLoad l;
  l.nodes = {a}, l.dof = 2, l.curve = curve, l.scale = 2;
  m.model.nodal_loads.push_back(l);
  l.nodes = {b}, l.dof = 4, l.curve = -1, l.scale = 5, l.follower = {a, b, c};
  m.model.nodal_loads.push_back(l);
  l = {};
  l.part = p, l.dof = 3, l.scale = 7;
  m.model.nodal_loads.push_back(l);
  PressureLoad pr;
  pr.segments = {{a, b, c, d}}, pr.scale = 4, pr.arrival = 0;
  m.model.pressure_loads.push_back(pr);
  m.start();
  Run run(m);
  run.step(1e-3);
  CHECK(norm(m.state.force[a] - Vec3d{0, 2, -6}) < 1e-9);
  CHECK(norm(m.state.force[b] - Vec3d{0, 0, 5 - 6.0}) < 1e-9);
  CHECK(norm(m.state.force[d] - Vec3d{0, 0, -6}) < 1e-9);
  CHECK((*m.bodies)[0].motion.v.z == doctest::Approx(7 * 0.5e-3));
  for (int i = 0; i < 300; ++i) run.step(1e-3);
  const double body = 0.5 * std::pow(7 * m.state.time - 7 * 1e-3, 2);
  CHECK(run.last_kinetic - run.first_kinetic + body ==
        doctest::Approx(m.state.energy.external_work).epsilon(1e-9));
}

// A moment turns the body wherever it acts: I w' = M, and its work is what the body has.
TEST_CASE("a moment on a node of a rigid body turns it, also where nothing else has rotations") {
  for (const double spin_inertia : {0.0, 0.5}) {
    Mechanism m;
    const int a = m.node({1, 0, 0}), b = m.node({-1, 0, 0});
    const int p = m.part({a, b});
    m.inertia(p, 2, {0, 0, 0}, {3, 4, 5});
    NodalLoad l;
    l.nodes = {a}, l.dof = 7, l.scale = 6;
    m.model.nodal_loads.push_back(l);
    m.start({}, spin_inertia);
    if (spin_inertia > 0) m.state.interaction_moment.resize(2, FixedScale::of(1e3));
    Run run(m);
    CHECK(m.diagnostics.list().empty());
    for (int i = 0; i < 400; ++i) {
      if (spin_inertia > 0) m.state.moment[a] = {0, 0, 6}, m.state.moment[b] = {};
      run.step(1e-3);
    }
    // the first step is half a step
    const double w = (6 / 5.0) * (m.state.time - 0.5e-3);
    CHECK((*m.bodies)[0].motion.w.z == doctest::Approx(w).epsilon(1e-9));
    if (spin_inertia > 0) continue;
    // kinetic energy at t(n): 1/2 w- . I w+; at the start w- = -w+
    const double before = w - 1e-3 * 6 / 5.0, first = 0.5e-3 * 6 / 5.0;
    CHECK(m.state.energy.external_work ==
          doctest::Approx(0.5 * 5 * (before * w + first * first)).epsilon(1e-9));
  }
}

// What acts on nodes and cannot be: each named by its card, with the nodes counted.
TEST_CASE("conditions and loads that nodes cannot follow are not supported") {
  Mechanism m;
  const int a = m.node({0, 0, 0}), b = m.node({1, 0, 0}), c = m.node({2, 0, 0}),
            d = m.node({3, 0, 0}), e = m.node({4, 0, 0});
  m.part({d, e});
  const int curve = m.curve({0, 1}, {1, 1});
  const auto motion = [&](std::vector<int> nodes, int dof, int line) {
    PrescribedMotion p;
    p.nodes = std::move(nodes), p.dof = dof, p.curve = curve, p.where = Location{0, line};
    p.direction = {0, 0, 1};
    m.model.prescribed_motions.push_back(p);
  };
  motion({a, d, e}, -4, 10);  // three conditions a node
  motion({a, b}, 1, 20);
  motion({a, c}, 6, 30);
  motion({a}, 2, 40);
  SinglePointConstraint s;
  s.nodes = {a}, s.fixed = {true, true, true}, s.where = Location{0, 50};
  m.model.constraints.push_back(s);
  s.nodes = {b, c}, s.fixed = {false, false, true}, s.where = Location{0, 60};
  m.model.constraints.push_back(s);
  NodalLoad l;
  l.nodes = {d, a, c}, l.dof = 5, l.where = Location{0, 70};
  m.model.nodal_loads.push_back(l);
  m.start();
  m.state.owner[b] = NodeOwner::tied;
  const std::size_t before = m.diagnostics.list().size();
  Run run(m);
  struct Expected {
    const char *name, *message;
    int line;
  };
  const Expected expected[] = {{"moment-without-rotation", "on 2 nodes", 70},
                               {"support-of-tied-node", "1 nodes", 60},
                               {"motion-of-rigid-node", "2 nodes", 10},
                               {"motion-of-tied-node", "1 nodes", 20},
                               {"rotation-of-node-without", "2 nodes", 30}};
  REQUIRE(m.diagnostics.list().size() == before + 5);
  for (int i = 0; i < 5; ++i) {
    const Diagnostic& x = m.diagnostics.list()[before + std::size_t(i)];
    CAPTURE(x.message);
    CHECK(x.severity == Severity::unsupported);
    CHECK(x.name == expected[i].name);
    CHECK(x.message.find(expected[i].message) != std::string::npos);
    CHECK(x.where.line == expected[i].line);
  }
}

TEST_CASE("generation gives nodes, spins and bodies one rotation") {
  Mechanism m;
  const int a = m.node({1, 0, 0}), b = m.node({0, 2, 0}), c = m.node({0, 0, 3}),
            d = m.node({1, 1, 1}), f = m.node({2, 2, 2});
  const int p = m.part({a, b, c, d});
  InitialVelocity iv;
  iv.nodes = {a, b, c, d, f}, iv.parts = {p};
  iv.velocity = {1, 2, 3}, iv.angular_velocity = {0.1, -0.2, 0.4}, iv.about_axis = true,
  iv.point = {0, 1, 0};
  for (const bool by_part : {true, false}) {
    m.model.initial_velocities = {iv};
    if (!by_part) m.model.initial_velocities[0].parts.clear();
    m.state = State{};
    m.start({1, 2, 3, 4, 5}, 0.1);
    apply_initial_conditions(m.model, m.state, *m.bodies);
    const RigidBody& body = (*m.bodies)[0];
    auto v_at = [&](const Vec3d& x) {
      return iv.velocity + cross(iv.angular_velocity, x - iv.point);
    };
    CHECK(norm(body.motion.v - v_at(body.motion.x)) < 1e-14);
    CHECK(norm(body.motion.w - iv.angular_velocity) < 1e-14);
    for (int n : {a, b, c, d, f}) {
      CHECK(norm(m.state.nodes[n].v - v_at(m.model.nodes.x[n])) < 1e-14);
      CHECK(norm(m.state.spins[n].w - iv.angular_velocity) < 1e-14);
    }
  }
  // a given inertia keeps its velocities unless overridden
  m.inertia(p, 10, {0, 0, 0}, {1, 2, 3});
  m.model.parts[p].inertia->velocity = {9, 0, 0};
  for (const bool override_it : {false, true}) {
    m.model.initial_velocities = {iv};
    m.model.initial_velocities[0].override_inertia = override_it;
    m.state = State{};
    m.start({1, 2, 3, 4, 5}, 0.1);
    apply_initial_conditions(m.model, m.state, *m.bodies);
    const Vec3d v = (*m.bodies)[0].motion.v;
    CHECK(norm(v - (override_it ? iv.velocity + cross(iv.angular_velocity, -iv.point)
                                : Vec3d{9, 0, 0})) < 1e-14);
  }
}

TEST_CASE("mass damping decays as its formula and books what it takes") {
  Mechanism m;
  const int a = m.node({0, 0, 0}), b = m.node({1, 0, 0}), c = m.node({1, 1, 0});
  m.part({b, c});
  Damping d;
  d.value = 3, d.scale = {1, 0.5, 1, 1, 1, 1};
  m.model.global_damping.push_back(d);
  m.start({2, 1, 1});
  m.state.nodes[a].v = {1, 1, 0};
  m.bodies->set_velocity(0, {2, 0, 0}, {});
  m.state.dt_previous = 0.01, m.state.cycle = 1;  // in full swing
  Run run(m);
  double work0 = 0, e0 = 0;
  for (int i = 0; i < 200; ++i) {
    const double body_before = (*m.bodies)[0].motion.v.x;
    run.step(0.01);
    const double total =
        run.last_kinetic + body_before * (*m.bodies)[0].motion.v.x + m.state.energy.damping;
    if (i == 0) e0 = total, work0 = m.state.energy.damping;
    REQUIRE(std::abs(total - e0) < 1e-12 * e0);
  }
  CHECK(m.state.energy.damping > work0);
  const double factor = (1 - 0.015) / (1 + 0.015);
  CHECK(m.state.nodes[a].v.x == doctest::Approx(std::pow(factor, 200)).epsilon(1e-11));
  CHECK(m.state.nodes[a].v.y ==
        doctest::Approx(std::pow((1 - 0.0075) / (1 + 0.0075), 200)).epsilon(1e-11));
  CHECK((*m.bodies)[0].motion.v.x == doctest::Approx(2 * std::pow(factor, 200)).epsilon(1e-11));
}
