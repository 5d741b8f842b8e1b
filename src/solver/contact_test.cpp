// Contact driven by a small explicit integrator of its own: point masses and rigid translations, no
// elements.
#include "solver/contact.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <set>
#include <sstream>

#include "solver/contact_rig_test.h"

using namespace fabrica;

namespace {

// two bricks, the upper a little skew over the lower
struct Blocks : Rig {
  std::vector<int> lower, upper;
  explicit Blocks(ContactKind kind, double gap = 0.01) {
    const int a = add_part(), b = add_part();
    lower = add_brick(a, {0, 0, 0}, {1, 1, 1}, 3);
    upper = add_brick(b, {0.12, 0.17, 1 + gap}, {0.8, 0.7, 0.8}, 2);
    const bool single = kind == ContactKind::automatic_single_surface;
    Contact& c = single ? add_contact(kind, {a, b}) : add_contact(kind, {a}, {b});
    c.fs = 0;
  }
};

}  // namespace

TEST_CASE("contact keeps linear momentum and gives a frictionless bounce its energy back") {
  for (ContactKind kind :
       {ContactKind::automatic_single_surface, ContactKind::automatic_surface_to_surface,
        ContactKind::automatic_nodes_to_surface, ContactKind::surface_to_surface}) {
    Blocks rig(kind);
    rig.start(0.01);
    for (int n : rig.upper) rig.state.nodes[n].v = {0, 0, -0.01};
    Team team(1);
    double largest = 0, stored = 0;
    for (int i = 0; i < 2500; ++i) {
      rig.step(team, 0.02, {rig.lower, rig.upper});
      CHECK(norm(total(rig.state.force)) < 1e-10);
      for (const Vec3d& f : rig.state.force) largest = std::max(largest, norm(f));
      stored = std::max(stored, rig.state.energy.contact);
    }
    CHECK(largest > 0);
    const double mass_a = double(rig.lower.size()), mass_b = double(rig.upper.size());
    // elastic impact of two free masses
    const double expected_b = -0.01 * (mass_b - mass_a) / (mass_b + mass_a);
    CHECK(rig.state.nodes[rig.upper[0]].v.z / expected_b == doctest::Approx(1).epsilon(0.0025));
    // everything that was stored came back
    CHECK(std::abs(rig.state.energy.contact) < 0.01 * stored);
  }
}

TEST_CASE("work of contact is what the masses lose") {
  Blocks rig(ContactKind::automatic_surface_to_surface);
  rig.model.contacts[0].fs = 0.3, rig.model.contacts[0].vdc = 20;
  rig.start(0.01);
  for (int n : rig.upper) rig.state.nodes[n].v = {0.005, 0, -0.01};
  Team team(1);
  auto kinetic = [&] {
    double e = 0;
    for (const NodeMotion& n : rig.state.nodes) e += 0.5 * n.mass * dot(n.v, n.v);
    return e;
  };
  const double before = kinetic();
  for (int i = 0; i < 1500; ++i) rig.step(team, 0.02, {rig.lower, rig.upper});
  CHECK(kinetic() < 0.98 * before);
  CHECK((kinetic() + rig.state.energy.contact) / before == doctest::Approx(1).epsilon(1e-6));
  CHECK(rig.state.energy.contact_friction > 0);
  CHECK(rig.state.energy.contact > rig.state.energy.contact_friction);
}

TEST_CASE("block on an incline slides with g (sin - mu cos) and sticks below the friction angle") {
  const double g = 0.001, mu = 0.3;
  for (double angle : {30.0, 10.0}) {
    Rig rig;
    const int plane = rig.add_part(), block = rig.add_part();
    const double a = angle * M_PI / 180;
    const Vec3d down{std::cos(a), 0, -std::sin(a)}, normal{std::sin(a), 0, std::cos(a)};
    rig.add_plate(plane, {0, 0, 0}, 40.0 * down, {0, 4, 0}, 40, 4, 0.2);
    const auto nodes = rig.add_plate(block, 1.1 * down + Vec3d{0, 1.05, 0} + 0.2 * normal,
                                     2.0 * down, {0, 2, 0}, 2, 2, 0.2);
    Contact& c = rig.add_contact(ContactKind::automatic_nodes_to_surface, {block}, {plane});
    c.fs = mu, c.fd = mu, c.vdc = 20;
    rig.start(0.02);
    rig.load.assign(rig.model.nodes.size(), Vec3d{0, 0, 0});
    for (int n : nodes) rig.load[n] = {0, 0, -g};
    Team team(1);
    const double dt = 0.1;
    const Vec3d from = rig.state.nodes[nodes[0]].x;
    // let it settle first
    auto speed = [&] { return dot(rig.state.nodes[nodes[0]].v, down); };
    for (int i = 0; i < 500; ++i) rig.step(team, dt, {nodes});
    const double v0 = speed();
    for (int i = 0; i < 1000; ++i) rig.step(team, dt, {nodes});
    const double acceleration = (speed() - v0) / (1000 * dt);
    if (angle == 30.0) {
      CHECK(acceleration / (g * (std::sin(a) - mu * std::cos(a))) ==
            doctest::Approx(1).epsilon(0.0025));
      CHECK(rig.state.energy.contact_friction > 0);
    } else {
      CHECK(std::abs(acceleration) < 0.005 * g);
      // no more than the elastic slip of the penalty
      CHECK(norm(rig.state.nodes[nodes[0]].x - from) < 0.05);
    }
  }
}

TEST_CASE("penetration at the start is not pushed back, shells keep their thickness apart") {
  Rig rig;
  const int a = rig.add_part(), b = rig.add_part();
  rig.add_plate(a, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 4, 4, 0.2);
  const auto upper =
      rig.add_plate(b, {0.6, 0.7, 0.13}, {2, 0, 0}, {0, 2, 0}, 3, 3, 0.1);  // 0.02 too deep
  rig.add_contact(ContactKind::automatic_single_surface, {a, b});
  rig.start(0.01);
  Team team(1);
  rig.contacts->forces(rig.model, rig.state, team);
  for (std::size_t i = 0; i < rig.state.nodes.size(); ++i)
    CHECK(norm(rig.state.interaction.take(i)) == 0);
  const InitialReport& report = rig.contacts->initial_report();
  CHECK(report.penetrating_nodes >= 16);
  CHECK(report.largest_penetration == doctest::Approx(0.02));
  // moved out and back in: the whole thickness counts now
  for (int n : upper) rig.state.nodes[n].x.z = 0.16;
  rig.contacts->forces(rig.model, rig.state, team);
  for (std::size_t i = 0; i < rig.state.nodes.size(); ++i)
    CHECK(norm(rig.state.interaction.take(i)) == 0);
  // they come with the velocity of that motion: depth without approach would be taken for a change
  // of segment
  rig.state.dt = 0.01;
  for (int n : upper) rig.state.nodes[n].x.z = 0.149, rig.state.nodes[n].v.z = -0.011 / 0.01;
  rig.contacts->forces(rig.model, rig.state, team);
  double up = 0;
  for (int n : upper) up += rig.state.interaction.take(n).z;
  CHECK(up > 0);
}

// A slab of 1 x 1 x 0.1: nodes may be 0.05 behind its top, 0.5 behind its sides. One stands 0.3
// above the top and 0.05 inside of a side: it touches nothing.
TEST_CASE("a node above a thin slab is not behind the slab's side") {
  Rig rig;
  const int a = rig.add_part(), b = rig.add_part();
  rig.add_brick(a, {0, 0, 0}, {1, 1, 0.1}, 1);
  const auto above = rig.add_brick(b, {0.05, 0.3, 0.4}, {0.2, 0.2, 0.2}, 1);
  rig.add_contact(ContactKind::automatic_surface_to_surface, {a}, {b});
  rig.start(0.01);
  Team team(1);
  rig.contacts->forces(rig.model, rig.state, team);
  CHECK(rig.contacts->initial_report().penetrating_nodes == 0);
  // it touches the top when it comes down
  rig.state.dt = 0.01;
  for (int n : above) rig.state.nodes[n].x.z -= 0.31, rig.state.nodes[n].v.z = -31;
  rig.contacts->forces(rig.model, rig.state, team);
  double up = 0;
  for (int n : above) up += rig.state.interaction.take(n).z;
  CHECK(up > 0);
}

TEST_CASE("no pair within reach is missed while particles move") {
  Rig rig;
  const int a = rig.add_part(), b = rig.add_part();
  rig.add_plate(a, {0, 0, 0}, {6, 0, 0}, {0, 6, 0}, 6, 6, 0.1);
  rig.add_plate(b, {0, 0, 1}, {5, 0.5, 0}, {0, 5, 1}, 6, 6, 0.1);
  rig.add_contact(ContactKind::automatic_single_surface, {a, b});
  rig.start(0.01);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1, 1);
  for (NodeMotion& n : rig.state.nodes)
    n.v = {1 + 0.2 * u(random), 0.2 * u(random), 0.2 * u(random)};
  Team team(1);
  const ContactPass& pass = *rig.contacts->passes()[0];
  int near_pairs = 0, missed = 0;
  for (int step = 0; step < 300; ++step) {
    for (NodeMotion& n : rig.state.nodes) {
      n.x += 0.01 * n.v;
      if (step % 20 == 0) n.v += 0.1 * Vec3d{u(random), u(random), u(random)};
    }
    rig.contacts->forces(rig.model, rig.state, team);
    rig.state.interaction.clear();
    const auto list = pass.candidate_pairs();
    const std::set<std::pair<int, int>> candidates(list.begin(), list.end());
    for (const ContactNode& n : pass.tracked().nodes)
      for (int s = 0; s < int(pass.reference().segments.size()); ++s) {
        const ContactSegment& g = pass.reference().segments[s];
        if (std::find(g.node, g.node + 4, n.node) != g.node + 4) continue;
        Vec3d X[4];
        for (int i = 0; i < 4; ++i) X[i] = rig.state.nodes[g.node[i]].x;
        const Vec3d x = rig.state.nodes[n.node].x;
        const double distance = norm(x - closest_point_quad(X, x, 0, 0).x);
        if (distance > n.half_thickness + g.half_thickness) continue;
        ++near_pairs;
        missed += !candidates.count({n.node, s});
      }
  }
  CHECK(near_pairs > 20);
  CHECK(missed == 0);
  // far fewer searches than steps
  CHECK(pass.searches() < 150);
}

TEST_CASE("same bits for any number of threads, and after save and load") {
  auto run = [](int threads, bool restart) {
    Blocks rig(ContactKind::automatic_single_surface);
    rig.model.contacts[0].fs = 0.2, rig.model.contacts[0].soft = 1;
    rig.start(0.01);
    for (int n : rig.upper) rig.state.nodes[n].v = {0.003, 0.001, -0.01};
    Team team(threads);
    for (int i = 0; i < 400; ++i) {
      if (restart && i == 150) {
        std::stringstream file;
        rig.contacts->save(file);
        rig.contacts = std::make_unique<Contacts>(rig.model, rig.state, rig.input, rig.diagnostics);
        rig.contacts->load(file);
      }
      rig.step(team, 0.02, {rig.lower, rig.upper});
    }
    std::string bits(reinterpret_cast<const char*>(rig.state.nodes.data()),
                     rig.state.nodes.size() * sizeof(NodeMotion));
    bits.append(reinterpret_cast<const char*>(&rig.state.energy.contact), sizeof(double));
    CHECK(rig.state.energy.contact != 0);
    return bits;
  };
  const std::string one = run(1, false);
  CHECK(one == run(2, false));
  CHECK(one == run(4, false));
  CHECK(one == run(2, true));
}

TEST_CASE("ties keep linear and angular momentum and do no work") {
  for (bool offset : {false, true}) {
    Rig rig;
    const int a = rig.add_part(), b = rig.add_part();
    const auto lower = rig.add_plate(b, {0, 0, 0}, {4, 0, 0}, {0, 4, 1}, 4, 4, 0.2);
    const auto upper = rig.add_plate(a, {0.6, 0.7, 0.255}, {2, 0, 0}, {0, 2, 0.5}, 3, 3, 0.2);
    Contact& c = rig.add_contact(ContactKind::tied_nodes_to_surface, {a}, {b});
    c.constrained_offset = offset;
    rig.start(0.01);
    CHECK(rig.contacts->initial_report().tied_nodes == 16);
    CHECK(rig.contacts->initial_report().untied_nodes.empty());
    std::mt19937 random(5);
    std::uniform_real_distribution<double> u(-1, 1);
    double mass = 0;
    for (NodeMotion& n : rig.state.nodes) {
      n.v = {u(random), u(random), u(random)};
      mass += n.mass;
    }
    CHECK(mass == doctest::Approx(double(rig.model.nodes.size())).epsilon(1e-12));
    Team team(1);
    rig.contacts->place_tied_nodes(rig.state, team);
    for (Vec3d& f : rig.state.force) f = {u(random), u(random), u(random)};
    auto moment = [&] {
      Vec3d m{0, 0, 0};
      for (std::size_t i = 0; i < rig.state.nodes.size(); ++i)
        m += cross(rig.state.nodes[i].x, rig.state.force[i]);
      return m;
    };
    auto power = [&] {
      double p = 0;
      for (std::size_t i = 0; i < rig.state.nodes.size(); ++i)
        p += dot(rig.state.nodes[i].v, rig.state.force[i]);
      return p;
    };
    const Vec3d f = total(rig.state.force), m = moment();
    const double p = power();
    rig.contacts->transfer_tied_forces(rig.state, team);
    CHECK(norm(total(rig.state.force) - f) < 1e-12);
    CHECK(norm(moment() - m) < 1e-11);
    CHECK(power() == doctest::Approx(p).epsilon(1e-12));
    for (int n : upper) CHECK(norm(rig.state.force[n]) == 0);
    // on the surface, or still at its distance
    const double height = offset ? 0.255 - (0.7 - 0.0) * 0.25 : 0;
    const NodeMotion& first = rig.state.nodes[upper[0]];
    CHECK(first.x.z - 0.25 * first.x.y == doctest::Approx(height).epsilon(1e-9));
    (void)lower;
  }
}

TEST_CASE("a penalty tie holds a node in place and keeps momentum") {
  Rig rig;
  const int a = rig.add_part(), b = rig.add_part();
  const auto lower = rig.add_plate(b, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 4, 4, 0.2);
  const auto upper = rig.add_plate(a, {0.6, 0.7, 0.15}, {2, 0, 0}, {0, 2, 0}, 3, 3, 0.2);
  Contact& c = rig.add_contact(ContactKind::tied_nodes_to_surface, {a}, {b});
  c.offset = true;
  rig.start(0.01);
  for (int n : upper) rig.state.nodes[n].v = {0, 0, 0.01};
  Team team(1);
  double stored = 0;
  for (int i = 0; i < 2000; ++i) {
    rig.step(team, 0.02, {lower, upper});
    CHECK(norm(total(rig.state.force)) < 1e-10);
    stored = std::max(stored, rig.state.energy.contact);
  }
  double kinetic = 0;
  for (const NodeMotion& n : rig.state.nodes) kinetic += 0.5 * n.mass * dot(n.v, n.v);
  const double gap = rig.state.nodes[upper[0]].x.z - rig.state.nodes[lower[0]].x.z;
  CHECK(stored > 0);
  // travel of the spring: v sqrt(m/k)
  CHECK(std::abs(gap - 0.15) < 0.05);
  CHECK((kinetic + rig.state.energy.contact) / (0.5 * 16 * 1e-4) ==
        doctest::Approx(1).epsilon(0.005));
}

TEST_CASE("a penalty tie at a distance does no work around a closed path") {
  for (const bool triangles : {false, true}) {
    CAPTURE(triangles);
    Rig rig;
    const int a = rig.add_part(), b = rig.add_part();
    const auto lower = rig.add_plate(b, {0, 0, 0}, {4, 0, 0.3}, {0.5, 4, 0}, 2, 2, 0.2);
    rig.add_plate(a, {0.6, 0.7, 3}, {2, 0, 0}, {0, 2, 0.5}, 2, 2, 0.2);
    if (triangles)
      for (std::size_t i = 0; i < 4; ++i) rig.model.shells.node[i][3] = rig.model.shells.node[i][2];
    rig.model.nodes.x[std::size_t(lower[4])] += Vec3d{0.2, -0.1, 0.3};  // warped segments
    Contact& c = rig.add_contact(ContactKind::tied_nodes_to_surface, {a}, {b});
    c.offset = true, c.sst = -9;
    rig.start(0.01);
    CHECK(rig.contacts->initial_report().tied_nodes == 9);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u(-0.3, 0.3);
    const std::vector<Vec3d>& at = rig.model.nodes.x;
    std::vector<Vec3d> cosine, sine;
    for (std::size_t i = 0; i < at.size(); ++i)
      cosine.push_back({u(random), u(random), u(random)}),
          sine.push_back({u(random), u(random), u(random)});
    Team team(1);
    double work = 0, size = 0;
    const int steps = 200;  // of a periodic path: the sum is as good as the integral
    for (int k = 0; k < steps; ++k) {
      const double s = 2 * M_PI * k / steps;
      for (std::size_t i = 0; i < at.size(); ++i)
        rig.state.nodes[i].x = at[i] + std::cos(s) * cosine[i] + std::sin(s) * sine[i];
      rig.contacts->forces(rig.model, rig.state, team);
      for (std::size_t i = 0; i < at.size(); ++i) {
        const Vec3d along = std::cos(s) * sine[i] - std::sin(s) * cosine[i];
        const double power = dot(rig.state.interaction.take(int(i)), along);
        work += power, size += std::abs(power);
      }
    }
    CHECK(size > 1);
    CHECK(std::abs(work) < 1e-8 * size);
  }
}
