// Prescribed motions about axes, by displacement and relative to a body; supports of rigid bodies.
#include <doctest/doctest.h>

#include <cmath>

#include "solver/mechanism_test.h"
#include "solver/node_constraints.h"

using namespace fabrica;
using mechanism::Mechanism;

namespace {

constexpr double pi = 3.14159265358979323846;

// free nodes under constraints alone, with bodies
struct Run {
  Mechanism& m;
  NodeConstraints constraints;
  double kinetic = 0;  // at t(n): 1/2 m v- . v+
  explicit Run(Mechanism& m_) : m(m_), constraints(m_.model, m_.state, m_.diagnostics) {}
  void step(double dt) {
    State& s = m.state;
    s.dt = dt;
    std::vector<Vec3d> before;
    for (const NodeMotion& n : s.nodes) before.push_back(n.v);
    for (int i = 0; i < m.model.nodes.size(); ++i)
      if (s.owner[i] == NodeOwner::free)
        s.nodes[i].v += (s.mean_dt() / s.nodes[i].mass) * s.force[i];
    constraints.apply(s);
    kinetic = 0;
    for (int i = 0; i < m.model.nodes.size(); ++i) {
      if (s.owner[i] != NodeOwner::free) continue;
      const Vec3d v = s.cycle == 0 ? 2.0 * before[i] - s.nodes[i].v : before[i];
      kinetic += 0.5 * s.nodes[i].mass * dot(v, s.nodes[i].v);
      s.nodes[i].x += dt * s.nodes[i].v;
    }
    m.step(dt);
  }
};

PrescribedMotion of_node(int node, int dof, int kind, int curve) {
  PrescribedMotion p;
  p.nodes = {node}, p.dof = dof, p.kind = kind, p.curve = curve;
  return p;
}

PrescribedMotion of_body(int part, int dof, int kind, int curve) {
  PrescribedMotion p;
  p.target = PrescribedMotion::Target::rigid_body;
  p.part = part, p.dof = dof, p.kind = kind, p.curve = curve;
  return p;
}

}  // namespace

// DOF 9, 10, 11: r(t) = R(angle) r0, angle = integral of the velocity, double integral of the
// acceleration, or the curve
TEST_CASE("a node turned about an axis stays on its circle and ends at the angle of the curve") {
  for (const int axis : {0, 1, 2})
    for (const int kind : {0, 1, 2}) {
      Mechanism m;
      Vec3d x{};
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      x[axis] = 7, x[a] = 5, x[b] = -1;
      const int n = m.node(x);
      PrescribedMotion p = of_node(n, 9 + axis, kind, m.curve({0, 2}, {0, 2}));
      p.offset = {2, 3};
      m.model.prescribed_motions.push_back(p);
      m.start({2.0});
      Run run(m);
      for (int i = 0; i < 200; ++i) run.step(0.01);
      const double angle = kind == 2 ? 2.0 : kind == 0 ? 2.0 : 8.0 / 6;
      const Vec3d end = m.state.nodes[n].x;
      // arm (3, -4) from the axis at (2, 3)
      const double c = std::cos(angle), s = std::sin(angle);
      const double u = 2 + 3 * c + 4 * s, v = 3 + 3 * s - 4 * c;
      // an acceleration is a rate over half steps: second order in dt
      const double tolerance = kind == 1 ? 5 * 0.01 * 0.01 : 1e-11;
      CHECK(std::abs(end[a] - u) < tolerance);
      CHECK(std::abs(end[b] - v) < tolerance);
      CHECK(std::hypot(end[a] - 2, end[b] - 3) == doctest::Approx(5).epsilon(1e-12));
      CHECK(end[axis] == 7);
    }
}

// DOF -9: a bead on a rod that turns at w: r'' = w^2 r, r = r0 cosh(w t); it is not bound along the
// axis
TEST_CASE("a node on a turning ray flies out as a bead on a rod does") {
  double error[2];
  for (const int fine : {0, 1}) {
    Mechanism m;
    const int n = m.node({0, 3, 1});
    PrescribedMotion p = of_node(n, -9, 0, m.curve({0, 1}, {2, 2}));
    p.offset = {1, 1};
    m.model.prescribed_motions.push_back(p);
    m.start({2.0});
    m.state.nodes[n].v = {0.5, 0, 4};  // turning already
    Run run(m);
    const double dt = fine ? 5e-4 : 1e-3;
    while (m.state.time < 1 - dt / 2) run.step(dt);
    const double r = std::hypot(m.state.nodes[n].x.y - 1, m.state.nodes[n].x.z - 1);
    const double angle = std::atan2(m.state.nodes[n].x.z - 1, m.state.nodes[n].x.y - 1);
    error[fine] = std::abs(r / (2 * std::cosh(2.0)) - 1);
    CHECK(angle == doctest::Approx(2).epsilon(1e-12));
    CHECK(m.state.nodes[n].x.x == doctest::Approx(0.5).epsilon(1e-12));
    // the work of the motion is the energy that the node gained
    const double work = m.state.energy.external_work, first = 0.5 * 2 * (0.25 + 16);
    run.step(dt);
    CHECK(run.kinetic - first == doctest::Approx(m.state.energy.external_work).epsilon(4 * dt));
    CHECK(work > 0);
  }
  MESSAGE("radius off by " << error[0] << " and at half the step " << error[1]);
  CHECK(error[0] < 1e-5);
  CHECK(error[1] < 0.3 * error[0]);  // second order
}

TEST_CASE("motion along a vector holds what is across it only with a negative DOF") {
  for (const int dof : {4, -4}) {
    Mechanism m;
    const int n = m.node({1, 2, 3});
    PrescribedMotion p = of_node(n, dof, 2, m.curve({0, 1}, {0, 6}));
    p.direction = {2, 4, 4};
    m.model.prescribed_motions.push_back(p);
    m.start();
    Run run(m);
    m.state.force[n] = {1, 1, -5};
    for (int i = 0; i < 100; ++i) run.step(0.01);
    const Vec3d d{1.0 / 3, 2.0 / 3, 2.0 / 3}, u = m.state.nodes[n].x - m.model.nodes.x[n];
    CHECK(dot(u, d) == doctest::Approx(6).epsilon(1e-12));
    CHECK((norm(u - dot(u, d) * d) < 1e-12) == (dof < 0));
  }
}

// VAD = 3, v = 1 + u: u = e^t - 1
TEST_CASE("a velocity given by the displacement grows as its equation says") {
  Mechanism m;
  const int n = m.node({0, 0, 0}), b = m.node({5, 0, 0}), c = m.node({6, 0, 0});
  const int part = m.part({b, c});
  m.inertia(part, 3, {5.5, 0, 0}, {1, 1, 1});
  const int curve = m.curve({0, 10}, {1, 11});
  m.model.prescribed_motions.push_back(of_node(n, 2, 3, curve));
  m.model.prescribed_motions.push_back(of_body(part, 3, 3, curve));
  m.start();
  Run run(m);
  for (int i = 0; i < 1000; ++i) run.step(1e-3);
  // midpoint rule: e^t t dt^2 / 6
  CHECK(std::abs(m.state.nodes[n].x.y - (std::exp(1.0) - 1)) < 1e-6);
  CHECK(std::abs((*m.bodies)[0].displacement().z - (std::exp(1.0) - 1)) < 1e-6);
}

// VAD = 4 along the line of the centres: |x - x_lead| = start + f(t), and the lead feels nothing
TEST_CASE("a body follows another at the distance of a curve, whichever comes first") {
  for (const bool lead_first : {true, false}) {
    Mechanism m;
    const Vec3d ends[2] = {{0, 0, 0}, {3, 4, 0}};
    const int first = m.part({m.node(ends[0])}), second = m.part({m.node(ends[1])});
    m.inertia(first, 2, ends[0], {1, 1, 1});
    m.inertia(second, 5, ends[1], {1, 1, 1});
    const int lead = lead_first ? first : second, follower = lead_first ? second : first;
    PrescribedMotion p = of_body(follower, 1, 4, m.curve({0, 1}, {0, 2}));
    p.lead = lead;
    m.model.prescribed_motions.push_back(p);
    m.start();
    REQUIRE(!m.diagnostics.has_errors());
    Run run(m);
    const double dt = 1e-3;
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
      m.bodies->add_force(lead, {0, 30, -10}, {});
      run.step(dt);
      const double apart = norm((*m.bodies)[follower].motion.x - (*m.bodies)[lead].motion.x);
      worst = std::max(worst, std::abs(apart - (5 + 2 * m.state.time)));
    }
    const double mass = lead_first ? 2 : 5;
    const Vec3d u = (*m.bodies)[lead].displacement();
    CHECK(norm(u - Vec3d{0, 15 / mass, -5 / mass}) < 1e-9);  // 1/2 a t^2
    MESSAGE("distance off by at most " << worst);
    CHECK(worst < 1e-9);
  }
}

// along two nodes of the lead, which turns: e(t) . (x - x_lead) = start + f(t)
TEST_CASE("a relative motion along two nodes of a turning body turns with them") {
  Mechanism m;
  const int a = m.node({0, 0, 0}), b = m.node({1, 0, 0}), c = m.node({0, 1, 0}),
            d = m.node({2, 0.5, 0});
  const int lead = m.part({a, b, c}), follower = m.part({d});
  m.inertia(lead, 4, {0, 0, 0}, {1, 1, 1});
  m.inertia(follower, 2, {2, 0.5, 0}, {1, 1, 1});
  PrescribedMotion p = of_body(follower, 1, 4, m.curve({0, 1}, {0, 0.5}));
  p.lead = lead, p.node = {a, b};
  m.model.prescribed_motions.push_back(p);
  m.start();
  m.bodies->set_velocity(0, {1, 0, 0}, {0, 0, pi / 2});
  Run run(m);
  for (int i = 0; i < 1000; ++i) run.step(1e-3);
  const Vec3d e = m.state.nodes[b].x - m.state.nodes[a].x;
  CHECK(norm(e - Vec3d{0, 1, 0}) < 1e-9);
  const Vec3d apart = (*m.bodies)[1].motion.x - (*m.bodies)[0].motion.x;
  CHECK(std::abs(dot(e, apart) - 2.5) < 1e-11);
  CHECK(norm((*m.bodies)[0].motion.v - Vec3d{1, 0, 0}) < 1e-14);
}

// supports of a node of a body hold the centre and the rotation of the body
TEST_CASE("supports of nodes of a rigid body hold its centre while they last") {
  Mechanism m;
  const int a = m.node({0, 0, 0}), b = m.node({2, 0, 0}), c = m.node({0, 2, 0});
  const int part = m.part({a, b, c});
  m.inertia(part, 2, {0.5, 0.5, 0}, {1, 1, 1});
  m.model.nodes.translation_code[a] = 1;  // x
  SinglePointConstraint spc;
  spc.nodes = {b, c}, spc.fixed = {false, true, false, false, false, true}, spc.death = 0.5;
  spc.where = {0, 12};
  m.model.constraints.push_back(spc);
  m.start();
  // the warning names the first card, although the code of a node came before it
  CHECK(m.diagnostics.count(Severity::warning) == 1);
  CHECK(m.diagnostics.list()[0].where.line == 12);
  CHECK(m.diagnostics.list()[0].keyword == "BOUNDARY_SPC");
  Run run(m);
  CHECK(run.constraints.size() == 0);
  const auto push = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      m.bodies->add_force(0, {4, 4, 4}, {0, 2, 3});
      run.step(1e-3);
    }
  };
  push(500);
  const RigidBody& body = (*m.bodies)[0];
  CHECK(norm(body.displacement() - Vec3d{0, 0, 0.25}) < 1e-9);  // 1/2 F/M t^2
  CHECK(std::abs(body.motion.w.z) < 1e-13);
  CHECK(body.motion.w.y == doctest::Approx(2 * (0.5 - 0.5e-3)));  // T t / I at the half step
  CHECK(m.state.energy.external_work == doctest::Approx(0).epsilon(1e-12));
  // x stays held, y and the rotation about z are free
  push(500);
  CHECK(std::abs(body.displacement().x) < 1e-13);
  CHECK(body.displacement().y == doctest::Approx(0.25).epsilon(1e-3));
  CHECK(body.motion.w.z > 1);
}
