// Joints, merges, prescribed motions, nodal rigid bodies and welds.
#include "solver/rigid_bodies.h"

#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

#include "solver/mechanism_test.h"

using namespace fabrica;
using mechanism::Mechanism;

namespace {

constexpr double pi = 3.14159265358979323846;

int add_joint(Mechanism& m, JointKind kind, std::array<int, 6> nodes) {
  Joint j;
  j.id = std::int64_t(m.model.joints.size()) + 1;
  j.kind = kind, j.node = nodes;
  m.model.joints.push_back(j);
  return int(m.model.joints.size()) - 1;
}

// a body that stands still
int ground(Mechanism& m, const std::vector<int>& nodes) {
  const int p = m.part(nodes);
  m.inertia(p, 1, m.model.nodes.x[nodes[0]], {1, 1, 1});
  m.model.materials[m.model.parts[p].material].cmo = 1;
  m.model.materials[m.model.parts[p].material].con1 = 7;
  m.model.materials[m.model.parts[p].material].con2 = 7;
  return p;
}

PrescribedMotion motion(int part, int dof, int kind, int curve) {
  PrescribedMotion m;
  m.target = PrescribedMotion::Target::rigid_body;
  m.part = part, m.dof = dof, m.kind = kind, m.curve = curve;
  return m;
}

}  // namespace

TEST_CASE("a pendulum on a revolute joint swings through 90 degrees with the exact period") {
  Mechanism m;
  const int g1 = m.node({0, 0, 0}), g2 = m.node({0, 0, 0.1}), p1 = m.node({0, 0, 0}),
            p2 = m.node({0, 0, 0.1}), tip = m.node({1, 0, 0});
  ground(m, {g1, g2});
  const int p = m.part({p1, p2, tip});
  m.inertia(p, 1, {1, 0, 0}, {0.1, 0.1, 0.1});
  add_joint(m, JointKind::revolute, {g1, p1, g2, p2, -1, -1});
  m.gravity = {0, -9.81, 0};
  m.start();
  REQUIRE(!m.diagnostics.has_errors());
  const double dt = 2e-4;
  double last = 0, gap = 0;
  std::vector<double> crossings;
  while (m.state.time < 8) {
    m.step(dt);
    const double x = m.state.nodes[tip].x.x;
    if (x * last < 0) crossings.push_back(m.state.time - dt * x / (x - last));
    last = x;
    gap = std::max(gap, m.joints->largest_gap(*m.bodies));
  }
  // quarter period at the first crossing, then half periods
  REQUIRE(crossings.size() >= 5);
  const double period = (crossings[4] - crossings[0]) / 2;
  MESSAGE("period " << period << ", gap " << gap);
  // 2.367842 s for a point mass; the inertia about the centre adds a tenth
  CHECK(period == doctest::Approx(2.367842 * std::sqrt(1.1)).epsilon(1e-5));
  CHECK(gap < 1e-12);
}

TEST_CASE("a double pendulum on spherical joints follows its equation of motion") {
  // point masses 1 at length 1, both horizontal at the start
  Mechanism m;
  const int g = m.node({0, 0, 0}), a1 = m.node({0, 0, 0}), a2 = m.node({1, 0, 0}),
            b1 = m.node({1, 0, 0}), b2 = m.node({2, 0, 0});
  ground(m, {g});
  const int pa = m.part({a1, a2}), pb = m.part({b1, b2});
  m.inertia(pa, 1, {1, 0, 0}, {1e-8, 1e-8, 1e-8});
  m.inertia(pb, 1, {2, 0, 0}, {1e-8, 1e-8, 1e-8});
  add_joint(m, JointKind::spherical, {g, a1, -1, -1, -1, -1});
  add_joint(m, JointKind::spherical, {a2, b1, -1, -1, -1, -1});
  m.gravity = {0, -9.81, 0};
  m.start();
  // reference: Runge-Kutta of the planar equations, angles from the downward vertical
  auto rate = [](const std::array<double, 4>& s) {
    const double g0 = 9.81, d = s[0] - s[1], c = std::cos(d), sn = std::sin(d);
    // 2 a'' + c b'' = -sn b'^2 - 2 g sin a;  c a'' + b'' = sn a'^2 - g sin b
    const double r1 = -sn * s[3] * s[3] - 2 * g0 * std::sin(s[0]),
                 r2 = sn * s[2] * s[2] - g0 * std::sin(s[1]);
    const double D = 2 - c * c;
    return std::array<double, 4>{s[2], s[3], (r1 - c * r2) / D, (2 * r2 - c * r1) / D};
  };
  std::array<double, 4> s{pi / 2, pi / 2, 0, 0};
  const double h = 1e-4;
  for (int i = 0; i < 20000; ++i) {
    auto at = [&](const std::array<double, 4>& k, double f) {
      std::array<double, 4> r = s;
      for (int j = 0; j < 4; ++j) r[j] += f * k[j];
      return r;
    };
    const auto k1 = rate(s), k2 = rate(at(k1, h / 2)), k3 = rate(at(k2, h / 2)),
               k4 = rate(at(k3, h));
    for (int j = 0; j < 4; ++j) s[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
  }
  const double dt = 1e-4;
  double gap = 0;
  for (int i = 0; i < 20000; ++i) m.step(dt), gap = std::max(gap, m.joints->largest_gap(*m.bodies));
  const Vec3d exact{std::sin(s[0]) + std::sin(s[1]), -std::cos(s[0]) - std::cos(s[1]), 0};
  const double error = norm(m.state.nodes[b2].x - exact);
  MESSAGE("position error " << error << ", gap " << gap);
  CHECK(error < 1e-5);
  CHECK(gap < 1e-12);
}

TEST_CASE("a slider-crank keeps its geometry") {
  // crank r = 1 turned by a prescribed rotation, rod l = 3, slider on a translational joint along x
  Mechanism m;
  const int g1 = m.node({0, 0, 0}), g2 = m.node({0, 0, 0.5}), c1 = m.node({0, 0, 0}),
            c2 = m.node({0, 0, 0.5}), c3 = m.node({1, 0, 0}), c4 = m.node({1, 0, 0.5}),
            r1 = m.node({1, 0, 0}), r2 = m.node({1, 0, 0.5}), r3 = m.node({4, 0, 0}),
            r4 = m.node({4, 0, 0.5}), s1 = m.node({4, 0, 0}), s2 = m.node({4, 0, 0.5}),
            s3 = m.node({5, 0, 0}), q1 = m.node({4, 0, 0}), q2 = m.node({5, 0, 0});
  ground(m, {g1, g2, q1, q2});
  const int crank = m.part({c1, c2, c3, c4}), rod = m.part({r1, r2, r3, r4}),
            slider = m.part({s1, s2, s3});
  m.inertia(crank, 1, {0.5, 0, 0}, {0.1, 0.2, 0.2});
  m.inertia(rod, 1, {2.5, 0, 0}, {0.1, 0.8, 0.8});
  m.inertia(slider, 2, {4, 0, 0}, {0.1, 0.1, 0.1});
  add_joint(m, JointKind::revolute, {g1, c1, g2, c2, -1, -1});
  add_joint(m, JointKind::revolute, {c3, r1, c4, r2, -1, -1});
  add_joint(m, JointKind::revolute, {r3, s1, r4, s2, -1, -1});
  add_joint(m, JointKind::translational, {q1, s1, q2, s3, -1, -1});
  const int curve = m.curve({0, 10}, {0, 10});
  m.model.prescribed_motions.push_back(motion(crank, 7, 2, curve));
  m.start();
  REQUIRE(!m.diagnostics.has_errors());
  double worst = 0, gap = 0;
  for (int i = 0; i < 5000; ++i) {
    m.step(1e-3);
    const double a = m.state.time;
    const double exact = std::cos(a) + std::sqrt(9 - std::sin(a) * std::sin(a));
    worst = std::max(worst, std::abs(m.state.nodes[s1].x.x - exact));
    gap = std::max(gap, m.joints->largest_gap(*m.bodies));
  }
  MESSAGE("slider error " << worst << ", gap " << gap);
  CHECK(worst < 1e-6);
  CHECK(gap < 1e-10);
}

TEST_CASE("joints keep linear and angular momentum") {
  Mechanism m;
  const int a0 = m.node({-1, 0.2, 0}), a1 = m.node({0, 0, 0}), a2 = m.node({0, 0, 1}),
            b1 = m.node({0, 0, 0}), b2 = m.node({0, 0, 1}), b3 = m.node({1, -0.3, 0.4}),
            b4 = m.node({1, 0.5, 0.1}), a3 = m.node({-1, 0.5, 0.6});
  m.part({a0, a1, a2, a3}), m.part({b1, b2, b3, b4});
  for (const JointKind kind : {JointKind::spherical, JointKind::revolute, JointKind::cylindrical,
                               JointKind::planar, JointKind::translational, JointKind::locking}) {
    m.model.joints.clear();
    m.state = State{};
    add_joint(m, kind, {a1, b1, a2, b2, -1, -1});
    m.start();
    // an impact on one body
    m.state.force[b3] = {30, -20, 10};
    m.step(1e-3);
    m.state.force[b3] = {};
    m.step(1e-3);
    const Vec3d p = m.momentum(), l = m.angular_momentum();
    double energy0 = m.bodies->kinetic_energy(), energy1 = 0;
    for (int i = 0; i < 5000; ++i) m.step(1e-3);
    energy1 = m.bodies->kinetic_energy();
    const double dp = norm(m.momentum() - p) / norm(p),
                 dl = norm(m.angular_momentum() - l) / norm(l);
    MESSAGE("joint " << int(kind) << ": dP " << dp << " dL " << dl << " dE "
                     << energy1 / energy0 - 1 << " gap " << m.joints->largest_gap(*m.bodies));
    CHECK(dp < 1e-12);
    CHECK(dl < 1e-12);
    CHECK(std::abs(energy1 / energy0 - 1) < 1e-5);
    CHECK(m.joints->largest_gap(*m.bodies) < 1e-12);
  }
}

TEST_CASE("a universal joint turns unevenly as its kinematics say") {
  // shafts in ground bearings at an angle b: tan(out) = cos b tan(in) or its inverse, by the start
  // position
  const double b = 0.5;
  const Vec3d e{std::cos(b), std::sin(b), 0};
  Mechanism m;
  const int g0 = m.node({-1, 0, 0}), g1 = m.node({-2, 0, 0}), h0 = m.node(e), h1 = m.node(2.0 * e),
            in0 = m.node({-1, 0, 0}), in1 = m.node({-2, 0, 0}), inc = m.node({0, 0, 0}),
            inp = m.node({0, 0, 1}), out0 = m.node(e), out1 = m.node(2.0 * e),
            outc = m.node({0, 0, 0}), outp = m.node({-std::sin(b), std::cos(b), 0});
  ground(m, {g0, g1, h0, h1});
  const int in = m.part({in0, in1, inc, inp}), out = m.part({out0, out1, outc, outp});
  m.inertia(in, 1, {-1, 0, 0}, {1, 1, 1});
  m.inertia(out, 1, e, {1, 1, 1});
  add_joint(m, JointKind::revolute, {g0, in0, g1, in1, -1, -1});
  add_joint(m, JointKind::cylindrical, {h0, out0, h1, out1, -1, -1});
  add_joint(m, JointKind::universal, {inc, outc, inp, outp, -1, -1});
  m.model.prescribed_motions.push_back(motion(in, 5, 2, m.curve({0, 10}, {0, 10})));
  m.start();
  REQUIRE(!m.diagnostics.has_errors());
  double worst = 0;
  const Vec3d u{-std::sin(b), std::cos(b), 0}, v{0, 0, 1};
  for (int i = 0; i < 6000; ++i) {
    m.step(1e-3);
    // cross pin of the input: p = (0, -sin t, cos t); the output's pin is normal to it and to e
    const double t = m.state.time;
    const Vec3d p{0, -std::sin(t), std::cos(t)};
    Vec3d q = cross(p, e);
    q = (1 / norm(q)) * q;
    const Vec3d actual = m.state.nodes[outp].x - m.state.nodes[outc].x;
    if (dot(q, actual) < 0) q = -q;
    worst = std::max(worst, norm(q - actual));
    REQUIRE(std::abs(dot(actual, u) * dot(actual, u) + dot(actual, v) * dot(actual, v) - 1) < 1e-9);
  }
  MESSAGE("universal joint error " << worst);
  CHECK(worst < 1e-6);
}

TEST_CASE("merged bodies add their mass and inertia, and given inertia replaces it") {
  Mechanism m;
  const int a = m.node({0, 0, 0}), b = m.node({2, 0, 0}), c = m.node({0, 2, 0}),
            d = m.node({0, 0, 4});
  const int p = m.part({a, b}), q = m.part({c, d});
  m.model.rigid_merges.push_back({p, q});
  m.start({1, 2, 3, 4});
  const RigidBody& body = (*m.bodies)[0];
  CHECK(m.bodies->size() == 1);
  CHECK(m.bodies->body_of_part(q) == 0);
  CHECK(body.motion.mass == 10);
  CHECK(norm(body.motion.x - Vec3d{0.4, 0.6, 1.6}) < 1e-15);
  // sum of squares less m c^2: Ixx = 3*4 + 4*16 - 10 (.36 + 2.56), ...
  const Mat3d R = matrix_of(body.motion.q);
  const Vec3d ix = inertia_times(R, body.motion.inertia, {1, 0, 0});
  CHECK(ix.x == doctest::Approx(12 + 64 - 29.2).epsilon(1e-13));
  CHECK(ix.y == doctest::Approx(10 * 0.4 * 0.6).epsilon(1e-13));
  CHECK(ix.z == doctest::Approx(10 * 0.4 * 1.6).epsilon(1e-13));
  // twice the mass given: half the acceleration
  m.inertia(p, 20, {0.4, 0.6, 1.6}, {1, 2, 3});
  m.model.parts[p].inertia->velocity = {1, 0, 0};
  m.state = State{};
  m.start({1, 2, 3, 4});
  CHECK(m.bodies->body_of_node(d) == 0);
  m.state.dt_previous = 0.1;
  for (int n : {a, b, c, d}) m.state.force[n] = {0, 5, 0};
  m.step(0.1);
  CHECK(norm((*m.bodies)[0].motion.v - Vec3d{1, 0.1, 0}) < 1e-15);
}

TEST_CASE("prescribed rigid motions end at the integrals of their curves") {
  for (const int kind : {0, 1, 2})
    for (const int dof : {1, 4, 6, 8}) {
      Mechanism m;
      const int a = m.node({0, 0, 0}), b = m.node({1, 0, 0}), c = m.node({0, 1, 0}),
                d = m.node({0, 0, 1});
      const int p = m.part({a, b, c, d});
      const int curve = m.curve({0, 0.35, 1}, {0, 0.7, 0.2});
      PrescribedMotion pm = motion(p, dof, kind, curve);
      pm.birth = 0.0, pm.death = 0.995, pm.scale = 2, pm.direction = {0, 3, 4};
      m.model.prescribed_motions.push_back(pm);
      m.start();
      m.state.force[b] = {0, 1, 2};
      for (int i = 0; i < 100; ++i) m.step(0.01);
      const RigidBody& body = (*m.bodies)[0];
      const Vec3d axis = dof == 4 || dof == 8 ? Vec3d{0, 0.6, 0.8}
                         : dof == 1           ? Vec3d{1, 0, 0}
                                              : Vec3d{0, 1, 0};
      // integral of the curve: triangle and trapezium
      const double area = 0.5 * 0.35 * 0.7 + 0.5 * 0.9 * 0.65;
      const Vec3d u = dof < 5 ? body.displacement() : body.rotation,
                  v = dof < 5 ? body.motion.v : body.motion.w;
      if (kind == 0) CHECK(dot(u, axis) == doctest::Approx(2 * area).epsilon(1e-12));
      if (kind == 2) CHECK(dot(u, axis) == doctest::Approx(0.4).epsilon(1e-12));
      if (kind == 1) {
        // velocity at 0.995
        const double y = 0.7 - 0.5 / 0.65 * 0.645;
        CHECK(dot(v, axis) ==
              doctest::Approx(2 * (0.5 * 0.35 * 0.7 + 0.5 * (0.7 + y) * 0.645)).epsilon(1e-12));
      }
      CHECK(m.bodies->motion_reaction(0) != 0);
    }
}

TEST_CASE("a motion of a body axis turns with the body") {
  Mechanism m;
  const int a = m.node({0, 0, 0}), b = m.node({1, 0, 0}), c = m.node({0, 2, 0}),
            d = m.node({0, 0, 3});
  const int p = m.part({a, b, c, d});
  m.inertia(p, 2, {0, 0, 0}, {1, 2, 3});
  PrescribedMotion pm = motion(p, 5, 0, m.curve({0, 1}, {2, 2}));
  pm.local = true;
  m.model.prescribed_motions.push_back(pm);
  m.start();
  m.bodies->set_velocity(0, {}, {2, 0.5, 0.1});
  const double dt = 1e-3;
  for (int i = 0; i < 1000; ++i) {
    const Quaternion q0 = (*m.bodies)[0].motion.q;
    m.step(dt);
    const Vec3d w = (*m.bodies)[0].motion.w;
    const Quaternion half = exponential((0.5 * dt) * w) * q0;
    // the axis that was x of the principal frame closest to global x at the start
    const Mat3d R = matrix_of(half * m.bodies->operator[](0).start_q.conjugate());
    const Vec3d axis = R * (matrix_of((*m.bodies)[0].start_q) * Vec3d{1, 0, 0});
    REQUIRE(std::abs(dot(axis, w) - 2) < 1e-12);
  }
}

TEST_CASE("two coincident nodes with rotary inertia make a body that turns") {
  Mechanism m;
  const int a = m.node({1, 1, 1}), b = m.node({1, 1, 1});
  NodalRigidBody nrb;
  nrb.id = 7, nrb.nodes = {a, b};
  m.model.nodal_rigid_bodies.push_back(nrb);
  m.start({1, 3}, 0.5);
  CHECK((*m.bodies)[0].motion.mass == 4);
  CHECK((*m.bodies)[0].motion.inertia.x == doctest::Approx(1.0).epsilon(1e-15));
  m.state.moment[a] = {0, 0, 2};
  m.state.force[b] = {8, 0, 0};
  m.state.dt_previous = 0.1;
  m.step(0.1);
  CHECK(m.state.spins[b].w.z == doctest::Approx(0.2).epsilon(1e-14));
  CHECK(m.state.nodes[a].v.x == doctest::Approx(0.2).epsilon(1e-14));
  CHECK(norm(m.state.nodes[a].x - m.state.nodes[b].x) == 0);
}

TEST_CASE("a spotweld fails at its force") {
  for (const double pull : {9.9, 10.1}) {
    Mechanism m;
    const int a = m.node({0, 0, 0}), b = m.node({1, 0, 0});
    NodalRigidBody weld;
    weld.nodes = {a, b}, weld.kind = NodalRigidBody::Kind::spotweld;
    weld.normal_force = 10, weld.shear_force = 100;
    m.model.nodal_rigid_bodies.push_back(weld);
    m.start({1, 3});
    // opposite forces: the weld carries all
    m.state.force[a] = {-pull, 0, 0}, m.state.force[b] = {pull, 0, 0};
    m.step(0.01);
    const bool failed = !(*m.bodies)[0].active;
    CHECK(failed == (pull > 10));
    CHECK((m.state.owner[a] == NodeOwner::free) == failed);
  }
}

TEST_CASE("a restart of bodies and joints continues with the same bits, for any team") {
  auto build = [](Mechanism& m) {
    std::vector<int> first, second;
    for (int i = 0; i < 3000; ++i)
      first.push_back(m.node({std::sin(i * 1.7), std::cos(i * 0.3), 0.001 * i}));
    first.push_back(m.node({3, 0, 0}));
    second.push_back(m.node({3, 0, 0}));
    for (int i = 0; i < 2000; ++i)
      second.push_back(m.node({4 + std::sin(i * 1.1), std::cos(i * 0.7), 0.002 * i}));
    m.part(first), m.part(second);
    add_joint(m, JointKind::spherical, {first.back(), second.front(), -1, -1, -1, -1});
    m.start();
  };
  auto drive = [](Mechanism& m, Team& team, int steps) {
    for (int s = 0; s < steps; ++s) {
      for (int i = 0; i < m.model.nodes.size(); ++i)
        m.state.force[i] = {std::sin(i + m.state.time), 0.1,
                            std::cos(2 * i + m.state.nodes[i].x.x)};
      m.state.dt = 1e-3;
      m.bodies->gather(m.state, team);
      m.bodies->integrate(m.state, m.joints.get());
      m.bodies->place_nodes(m.state, team);
      m.state.time += 1e-3, m.state.dt_previous = 1e-3;
    }
  };
  Mechanism one, three, resumed;
  build(one), build(three), build(resumed);
  Team t1(1), t3(3);
  drive(one, t1, 10);
  drive(three, t3, 10);
  std::stringstream data;
  one.bodies->save(data), one.joints->save(data);
  resumed.bodies->load(data), resumed.joints->load(data);
  resumed.state.nodes = one.state.nodes;
  resumed.state.time = one.state.time, resumed.state.dt_previous = one.state.dt_previous;
  resumed.state.energy = one.state.energy;
  drive(one, t1, 10), drive(three, t3, 10), drive(resumed, t3, 10);
  for (int i = 0; i < one.model.nodes.size(); ++i) {
    REQUIRE(norm(one.state.nodes[i].x - three.state.nodes[i].x) == 0);
    REQUIRE(norm(one.state.nodes[i].x - resumed.state.nodes[i].x) == 0);
    REQUIRE(norm(one.state.nodes[i].v - resumed.state.nodes[i].v) == 0);
  }
  CHECK(one.state.energy.joint == resumed.state.energy.joint);
}

TEST_CASE("constraint codes hold a body in global and in local directions") {
  const double c = std::cos(0.4), s = std::sin(0.4);
  for (const int cmo : {1, -1}) {
    Mechanism m;
    const int a = m.node({0, 0, 0}), b = m.node({1, 0, 0}), d = m.node({0, 1, 0}),
              e = m.node({0, 0, 1});
    const int p = m.part({a, b, d, e});
    CoordinateSystem cs;
    cs.axes = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
    m.model.coordinate_systems.push_back(cs);
    Material& mat = m.model.materials[m.model.parts[p].material];
    mat.cmo = cmo, mat.local_system = cmo < 0 ? 0 : -1;
    // global: y and z, rotation about x; local: x, rotations about x and z
    mat.con1 = cmo > 0 ? 5 : 0, mat.con2 = cmo > 0 ? 1 : 100101;
    m.start();
    for (int i = 0; i < 50; ++i) {
      m.state.force[b] = {1, 2, -3}, m.state.force[e] = {0.5, -1, 2};
      m.step(0.01);
      const RigidMotion& body = (*m.bodies)[0].motion;
      const Vec3d x{c, s, 0};
      if (cmo > 0) {
        REQUIRE(std::abs(body.v.y) + std::abs(body.v.z) + std::abs(body.w.x) < 1e-14);
      } else {
        REQUIRE(std::abs(dot(body.v, x)) + std::abs(dot(body.w, x)) + std::abs(body.w.z) < 1e-14);
      }
    }
    const RigidBody& body = (*m.bodies)[0];
    CHECK(norm(body.motion.v) > 0.1);
    CHECK(norm(body.motion.w) > 0.1);
    // the constraint takes up the force along what it holds
    if (cmo > 0) CHECK(norm(body.constraint_force - Vec3d{0, -1, 1}) < 1e-12);
    CHECK(std::abs(body.constraint_force.x + (cmo > 0 ? 0 : (1.5 * c + s) * c)) < 1e-12);
  }
}

TEST_CASE("a weld ends at its time and its nodes fly on") {
  Mechanism m;
  const int a = m.node({0, 0, 0}), b = m.node({1, 0, 0});
  NodalRigidBody weld;
  weld.nodes = {a, b}, weld.failure_time = 0.055;
  m.model.nodal_rigid_bodies.push_back(weld);
  m.start();
  CHECK(m.diagnostics.count(Severity::warning) == 1);  // nodes on a line
  m.bodies->set_velocity(0, {0, 0, 1}, {0, 2, 0});
  for (int i = 0; i < 6; ++i) m.step(0.01);
  CHECK(m.state.owner[a] == NodeOwner::rigid);
  const Vec3d v = m.state.nodes[a].v, x = m.state.nodes[a].x;
  m.step(0.01);
  CHECK(m.state.owner[a] == NodeOwner::free);
  CHECK(m.bodies->body_of_node(a) == -1);
  CHECK(norm(m.state.nodes[a].v - v) == 0);
  CHECK(norm(m.state.nodes[a].x - x) == 0);
}
