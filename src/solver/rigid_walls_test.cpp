// Rigid walls: planes, finite and round ones, moving and driven ones.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

#include "solver/node_run_test.h"

using namespace fabrica;
using mechanism::Mechanism;
using mechanism::Run;

namespace {

RigidWall plane(const Vec3d& tail, const Vec3d& normal) {
  RigidWall w;
  w.tail = tail, w.head = tail + normal, w.all_nodes = true;
  return w;
}

}  // namespace

TEST_CASE("a moving wall and the nodes it stops share their momentum") {
  Mechanism m;
  const int a = m.node({0, 0, 1}), b = m.node({1, 0, 1.00005});
  RigidWall w = plane({0, 0, 0}, {0, 0, 1});
  w.moving = true, w.mass = 10;
  m.model.rigid_walls.push_back(w);
  m.start({2, 3});
  m.state.nodes[a].v = m.state.nodes[b].v = {0, 0, -5};
  Run run(m);
  double energy = 0.5 * 5 * 25;
  for (int i = 0; i < 3000; ++i) run.step(1e-4);
  const double v = -5 * 5.0 / 15;
  CHECK(std::abs(m.state.nodes[a].v.z / v - 1) < 1e-12);
  CHECK(std::abs(m.state.nodes[b].v.z / v - 1) < 1e-12);
  CHECK(std::abs(run.walls.velocity(0).z / v - 1) < 1e-12);
  run.step(1e-4);
  CHECK(std::abs((run.last_kinetic + m.state.energy.rigid_wall) / energy - 1) < 1e-12);
}

TEST_CASE("a fixed wall stops a node, friction slows it, and energy is accounted for") {
  for (const double mu : {0.0, 0.3, 1.0}) {
    Mechanism m;
    const int a = m.node({0, 0, 0.01});
    RigidWall w = plane({0, 0, 0}, {0, 0, 2});
    w.friction = mu;
    m.model.rigid_walls.push_back(w);
    BodyLoad g;
    g.direction = {0, 0, 1}, g.scale = 10;
    m.model.body_loads.push_back(g);
    m.start({2.0});
    m.state.nodes[a].v = {4, 0, -1};
    Run run(m);
    for (int i = 0; i < 1000; ++i) {
      run.step(1e-3);
      REQUIRE(m.state.nodes[a].x.z >= -1e-12);
      REQUIRE(std::abs(run.last_kinetic + m.state.energy.rigid_wall - m.state.energy.external_work -
                       run.first_kinetic) < 1e-11 * run.first_kinetic);
    }
    // resting on the wall: its force is the weight
    CHECK(run.walls.normal_force(0) == doctest::Approx(20).epsilon(1e-9));
    if (mu == 0) CHECK(m.state.nodes[a].v.x == 4);
    // the tangential velocity falls by mu times the normal impulse per mass, 1 + g t in total
    if (mu == 0.3)
      CHECK(m.state.nodes[a].v.x == doctest::Approx(4 - 0.3 * (1 + 10 * 0.9995)).epsilon(1e-9));
    if (mu == 1) CHECK(m.state.nodes[a].v.x == 0);
  }
}

// Put back once found behind: the node rests within the way of one step. Held against g it is found
// in every second step, with half of the velocity that it would have there, so that the force is
// the weight in the mean and friction half of Coulomb's.
TEST_CASE("a plane that puts nodes back brakes them by the velocity with which they come") {
  Mechanism m;
  const int a = m.node({0, 0, 0.01}), deep = m.node({0, 0, -0.5});
  RigidWall w = plane({0, 0, 0}, {0, 0, 2});
  w.friction = 0.3;
  m.model.rigid_walls.push_back(w);
  BodyLoad g;
  g.direction = {0, 0, 1}, g.scale = 10;
  m.model.body_loads.push_back(g);
  m.start({2.0, 1.0});
  m.state.nodes[a].v = {4, 0, -1};
  Run run(m, WallMethod::constraint);
  double came = 0, impulse = 0;
  int arrived = 0;
  for (int i = 0; i < 1000; ++i) {
    const double before = m.state.nodes[a].v.z, x = m.state.nodes[a].x.z;
    run.step(1e-3);
    const bool held = x < 0;
    if (held) CHECK(std::abs(m.state.nodes[a].x.z) < 1e-12);
    if (held && arrived == 0) arrived = i, came = -before;
    if (arrived > 0) impulse += 1e-3 * run.walls.normal_force(0);
    REQUIRE(m.state.nodes[a].x.z > -1.1e-3 * 1.1);
    REQUIRE(std::abs(run.last_kinetic + m.state.energy.rigid_wall - m.state.energy.external_work -
                     run.first_kinetic) < 1e-11 * run.first_kinetic);
  }
  CHECK(came == doctest::Approx(std::sqrt(1 + 2 * 10 * 0.01)).epsilon(0.02));
  const double held = 1e-3 * (1000 - arrived);
  CHECK(impulse == doctest::Approx(2 * came + 3 * 10 * held).epsilon(2e-3));
  CHECK(m.state.nodes[a].v.x == doctest::Approx(4 - 0.3 * (came + 10 * held / 2)).epsilon(2e-3));
  // what starts behind goes no deeper, and is not pushed out
  CHECK(std::abs(m.state.nodes[deep].x.z + 0.5) < 1e-4);
}

// FRIC 2 and 3: a node faster than WVEL is welded, a slower one may leave; the wall takes part
TEST_CASE("walls weld the nodes that come fast enough") {
  for (const double fric : {2.0, 3.0}) {
    Mechanism m;
    const int fast = m.node({0, 0, 0.01}), slow = m.node({5, 0, 0.01});
    RigidWall w = plane({0, 0, 0}, {0, 0, 1});
    w.friction = fric, w.velocity_limit = 3, w.moving = true, w.mass = 7;
    m.model.rigid_walls.push_back(w);
    m.start({2, 1});
    m.state.nodes[fast].v = {1, 0, -5}, m.state.nodes[slow].v = {1, 0, -2};
    Run run(m);
    for (int i = 0; i < 100; ++i) run.step(1e-3);
    run.extra[fast] = {0, 0, 4}, run.extra[slow] = {0, 0, 4};
    for (int i = 0; i < 1000; ++i) run.step(1e-3);
    const double wall = run.walls.velocity(0).z;
    CHECK(m.state.nodes[fast].v.z == doctest::Approx(wall).epsilon(1e-12));
    CHECK(m.state.nodes[slow].v.z > wall + 1);
    // momentum: what nodes had and the forces gave, to rounding
    const double p = 2 * m.state.nodes[fast].v.z + m.state.nodes[slow].v.z + 7 * wall;
    CHECK(p == doctest::Approx(-12 + 8 * 1000 * 1e-3).epsilon(1e-10));
    CHECK(m.state.nodes[fast].v.x == doctest::Approx(fric == 2 ? 1 : 0));
    run.step(1e-3);
    CHECK(run.last_kinetic + m.state.energy.rigid_wall - run.first_kinetic ==
          doctest::Approx(run.extra_work).epsilon(1e-9));
  }
}

// ORTHO: a and b of the plane brake with their own coefficients, mu = fd + (fs - fd) exp(-c |v|)
TEST_CASE("a wall with orthotropic friction brakes along its axes") {
  Mechanism m;
  const int a = m.node({0, 0, 0}), b = m.node({9, 0, 0}), c = m.node({20, 0, 0});
  RigidWall w = plane({0, 0, 0}, {0, 0, 1});
  w.ortho = RigidWall::Ortho{0.1, 0.5, 0.1, 0.2, 0, 2, {-1, -1}, {1, 1, 3}};
  m.model.rigid_walls.push_back(w);
  BodyLoad g;
  g.direction = {0, 0, 1}, g.scale = 10;
  m.model.body_loads.push_back(g);
  m.start({2, 1, 1});
  const double h = std::sqrt(0.5);
  // along a, along b, and slow along b
  m.state.nodes[a].v = {4 * h, 4 * h, 0}, m.state.nodes[b].v = {-40 * h, 40 * h, 0};
  m.state.nodes[c].v = {-0.1 * h, 0.1 * h, 0};
  Run run(m);
  run.step(1e-3);
  const double braked = 0.1 - norm(m.state.nodes[c].v);
  // half a step of gravity at the start, mu = 0.2 + 0.3 exp(-0.2)
  CHECK(braked == doctest::Approx((0.2 + 0.3 * std::exp(-0.2)) * 10 * 0.5e-3).epsilon(1e-9));
  for (int i = 0; i < 999; ++i) run.step(1e-3);
  CHECK(norm(m.state.nodes[a].v) == doctest::Approx(4 - 0.1 * 10 * 0.9995).epsilon(1e-9));
  CHECK(norm(m.state.nodes[b].v) == doctest::Approx(40 - 0.2 * 10 * 0.9995).epsilon(1e-9));
  CHECK(norm(m.state.nodes[c].v) == 0);
}

TEST_CASE("a plane with an offset holds only what is near it at the start") {
  Mechanism m;
  const int near = m.node({0, 0, 0.5}), behind = m.node({1, 0, -0.5}), far = m.node({2, 0, 1.5});
  RigidWall w = plane({0, 0, 0}, {0, 0, 1});
  w.offset = 1;
  m.model.rigid_walls.push_back(w);
  m.start();
  for (NodeMotion& n : m.state.nodes) n.v = {0, 0, -1};
  Run run(m);
  for (int i = 0; i < 3000; ++i) run.step(1e-3);
  CHECK(m.state.nodes[near].x.z >= 0);
  CHECK(m.state.nodes[behind].x.z == doctest::Approx(-0.5));
  CHECK(m.state.nodes[far].x.z == doctest::Approx(-1.5));
}

TEST_CASE("finite, round and driven walls act where they are") {
  Mechanism m;
  const int on = m.node({0.5, 0.5, 0.1}), beside = m.node({1.5, 0.5, 0.1}),
            ball = m.node({5, 0, 2}), pole = m.node({10.1, 3, 2}), piston = m.node({0, 0, 20.2});
  RigidWall w = plane({0, 0, 0}, {0, 0, 1});
  w.edge = {1, 0, 0}, w.length_l = 1, w.length_m = 1;
  m.model.rigid_walls.push_back(w);
  RigidWall s = plane({5, 0, 0}, {0, 0, 1});
  s.shape = RigidWall::Shape::sphere, s.radius = 1;
  m.model.rigid_walls.push_back(s);
  RigidWall c = plane({10, 0, 0}, {0, 1, 0});
  c.shape = RigidWall::Shape::cylinder, c.radius = 1, c.length = 5;
  m.model.rigid_walls.push_back(c);
  RigidWall d = plane({0, 0, 20}, {0, 0, 1});
  d.motion_curve = m.curve({0, 1}, {0, 1}), d.motion_option = 1, d.motion_direction = {0, 0, 1};
  d.all_nodes = false, d.nodes = {piston};
  m.model.rigid_walls.push_back(d);
  m.start();
  for (int n : {on, beside, ball, pole}) m.state.nodes[n].v = {0, 0, -1};
  Run run(m);
  for (int i = 0; i < 1000; ++i) {
    run.step(1e-3);
    const Vec3d r = m.state.nodes[ball].x - Vec3d{5, 0, 0};
    REQUIRE(norm(r) > 1 - 1e-9);
    const Vec3d p = m.state.nodes[pole].x;
    REQUIRE(std::hypot(p.x - 10, p.z) > 1 - 1e-9);
  }
  CHECK(m.state.nodes[on].v.z == 0);
  CHECK(m.state.nodes[on].x.z >= 0);
  CHECK(m.state.nodes[beside].x.z == doctest::Approx(-0.9));
  for (int i = 0; i < 1000; ++i) run.step(1e-3);
  CHECK(m.state.nodes[pole].v.x > 0);
  CHECK(run.walls.displacement(3).z == doctest::Approx(1).epsilon(1e-12));
  CHECK(m.state.nodes[piston].x.z >= 21 - 1e-12);
}

TEST_CASE("a rigid body bounces off a wall and gets its energy back") {
  Mechanism m;
  std::vector<int> nodes;
  for (int i = 0; i < 8; ++i)
    nodes.push_back(m.node({double(i & 1), double(i >> 1 & 1), 0.05 + double(i >> 2)}));
  m.part(nodes);
  m.model.rigid_walls.push_back(plane({0, 0, 0}, {0, 0, 1}));
  m.start();
  m.bodies->set_velocity(0, {0, 0, -1}, {});
  m.bodies->give_velocity_to_nodes(m.state);
  Run run(m);
  for (int i = 0; i < 400; ++i) run.step(1e-3);
  CHECK((*m.bodies)[0].motion.v.z == doctest::Approx(1).epsilon(0.02));
  const double kinetic = m.bodies->kinetic_energy();
  CHECK(kinetic + m.state.energy.rigid_wall == doctest::Approx(4.0).epsilon(1e-9));
}

TEST_CASE("walls of many nodes give the same bits for any team, and after a restart") {
  WallMethod method = WallMethod::impulse;
  SUBCASE("impulse") {}
  SUBCASE("constraint") { method = WallMethod::constraint; }
  auto build = [](Mechanism& m) {
    for (int i = 0; i < 5000; ++i)
      m.node({std::sin(1.3 * i), std::cos(0.7 * i), 0.001 * (i % 97) + 0.0005 * i});
    RigidWall w = plane({0, 0, 0}, {0.1, 0, 1});
    w.moving = true, w.mass = 100, w.friction = 0.2, w.velocity = 0.5;
    m.model.rigid_walls.push_back(w);
    m.start();
    for (NodeMotion& n : m.state.nodes) n.v = {0.3 * n.x.y, 0, -2 - n.x.x};
  };
  Mechanism a, b, c;
  build(a), build(b), build(c);
  Team t1(1), t3(3);
  // a restart keeps the method of its file
  RigidWalls wa(a.model, a.state, a.diagnostics, method),
      wb(b.model, b.state, b.diagnostics, method), wc(c.model, c.state, c.diagnostics);
  auto drive = [](Mechanism& m, RigidWalls& w, Team& t, int steps) {
    for (int i = 0; i < steps; ++i) {
      m.state.dt = 1e-3;
      w.apply(m.state, t);
      for (NodeMotion& n : m.state.nodes) n.x += 1e-3 * n.v;
      m.state.dt_previous = 1e-3, m.state.time += 1e-3;
    }
  };
  drive(a, wa, t1, 200), drive(b, wb, t3, 200);
  std::stringstream data;
  wa.save(data), wc.load(data);
  c.state.nodes = a.state.nodes, c.state.energy = a.state.energy;
  c.state.time = a.state.time, c.state.dt_previous = a.state.dt_previous;
  drive(a, wa, t1, 200), drive(b, wb, t3, 200), drive(c, wc, t3, 200);
  REQUIRE(wa.displacement(0).z != 0);
  CHECK(a.state.energy.rigid_wall == b.state.energy.rigid_wall);
  CHECK(a.state.energy.rigid_wall == c.state.energy.rigid_wall);
  for (int i = 0; i < 5000; ++i) {
    REQUIRE(norm(a.state.nodes[i].x - b.state.nodes[i].x) == 0);
    REQUIRE(norm(a.state.nodes[i].x - c.state.nodes[i].x) == 0);
    const Vec3d n = (1 / std::sqrt(1.01)) * Vec3d{0.1, 0, 1};
    // none has passed the wall, even where chunks were skipped
    REQUIRE(dot(a.state.nodes[i].x - wa.displacement(0), n) >
            std::min(0.0, dot(a.model.nodes.x[i], n)) -
                (method == WallMethod::impulse ? 1e-9 : 1e-2));
  }
}
