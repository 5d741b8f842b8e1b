// Oriented contact, friction by part, the check of penetrations, segments against segments.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

#include "solver/contact_rig_test.h"

using namespace fabrica;

namespace {

// a plate of the second part that lies `height` over a larger plate of the first
struct Plates : Rig {
  std::vector<int> lower, upper;
  Plates(ContactKind kind, double height, double thickness = 0.2) {
    const int a = add_part(), b = add_part();
    lower = add_plate(a, {0, 0, 0}, {6, 0, 0}, {0, 6, 0}, 6, 6, thickness);
    upper = add_plate(b, {1.6, 1.7, height}, {3, 0, 0}, {0, 3, 0}, 4, 4, thickness);
    add_contact(kind, {b}, {a});
  }
  Contact& contact() { return model.contacts[0]; }
  double kinetic() const {
    double e = 0;
    for (const NodeMotion& n : state.nodes) e += 0.5 * n.mass * dot(n.v, n.v);
    return e;
  }
};

// forces at rest with the upper group moved by u since the start
std::vector<Vec3d> forces_after(Rig& rig, const std::vector<int>& moved, const Vec3d& u) {
  Team team(1);
  const double dt = 0.01;
  rig.contacts->forces(rig.model, rig.state, team);
  for (std::size_t i = 0; i < rig.state.nodes.size(); ++i) rig.state.interaction.take(i);
  rig.state.dt = dt;
  for (int n : moved) rig.state.nodes[n].x += u, rig.state.nodes[n].v = (1 / dt) * u;
  rig.contacts->forces(rig.model, rig.state, team);
  std::vector<Vec3d> f;
  for (std::size_t i = 0; i < rig.state.nodes.size(); ++i)
    f.push_back(rig.state.interaction.take(i));
  return f;
}

// F_t / F_n of the upper plate while it slides and sinks in
double friction_when_sliding(Plates& rig) {
  rig.start(0.01);
  REQUIRE(!rig.diagnostics.has_errors());
  Team team(1);
  for (int n : rig.upper) rig.state.nodes[n].v = {1, 0, -0.1};
  rig.step(team, 0.01, {});
  rig.contacts->forces(rig.model, rig.state, team);
  for (std::size_t i = 0; i < rig.state.nodes.size(); ++i) rig.state.interaction.take(i);
  for (int n : rig.upper) rig.state.nodes[n].x += Vec3d{0.01, 0, -0.001};
  rig.contacts->forces(rig.model, rig.state, team);
  Vec3d f{0, 0, 0};
  for (int n : rig.upper) f += rig.state.interaction.take(n);
  CHECK(f.z > 0);
  return -f.x / f.z;
}

}  // namespace

// Old kinds hold what comes from the side the normal points to, however far behind the surface it
// already is.
TEST_CASE("oriented shells turn to each other and push back what crossed them") {
  for (bool reversed : {false, true}) {
    Plates rig(ContactKind::surface_to_surface, 0.05);
    rig.contact().oriented = true;
    if (reversed)  // every second shell the other way round
      for (int e = 0; e < rig.model.shells.size(); e += 2)
        std::swap(rig.model.shells.node[e][1], rig.model.shells.node[e][3]);
    rig.start(0.01);
    // 0.6 behind: farther than any thickness
    const auto f = forces_after(rig, rig.upper, {0, 0, -0.65});
    double up = 0, largest_side = 0;
    for (int n : rig.upper)
      up += f[n].z, largest_side = std::max(largest_side, std::hypot(f[n].x, f[n].y));
    CHECK(up > 0);
    CHECK(largest_side < 1e-9 * up);
    CHECK(norm(total(f)) < 1e-10 * up);
    for (const ContactSegment& s : rig.contacts->passes()[0]->reference().segments) {
      const auto& x = rig.model.nodes.x;
      CHECK(cross(x[s.node[2]] - x[s.node[0]], x[s.node[3]] - x[s.node[1]]).z > 0);
    }
  }
}

TEST_CASE("without orientation (ORIEN=3) shells of the old kinds keep the side of their normals") {
  Plates rig(ContactKind::surface_to_surface, -0.05);  // the other plate lies behind
  rig.contact().oriented = true;
  rig.model.controls.contact_orientation = 3;
  rig.start(0.01);
  // it was behind at the start: allowed; farther behind is pushed back
  double up = 0;
  for (const Vec3d& f : forces_after(rig, rig.upper, {0, 0, -0.02})) up += std::abs(f.z);
  CHECK(up > 0);
  Plates faced(ContactKind::surface_to_surface, -0.05);
  faced.contact().oriented = true;
  faced.start(0.01);
  double turned = 0;
  for (const Vec3d& f : forces_after(faced, faced.upper, {0, 0, -0.02})) turned += std::abs(f.z);
  CHECK(turned == 0);
}

// A segment's corners say where its outside is, also where the shell under it is numbered the other
// way. The plate comes to a stop in front of a set whose normals face it; behind them it would lie
// in the surface from the start, which is allowed.
TEST_CASE(
    "segments of a set keep the outside of their own corners on shells turned the other way") {
  for (const bool triangles : {false, true}) {
    Plates rig(ContactKind::surface_to_surface, 0.05);
    rig.contact().oriented = true;
    rig.model.segment_sets.resize(2);
    const auto& x = rig.model.nodes.x;
    for (int e = 0; e < rig.model.shells.size(); ++e) {
      auto& n = rig.model.shells.node[e];
      if (triangles) n[3] = n[2];
      const int part = rig.model.shells.part[e];
      std::array<int, 4> segment{n[0], n[1], n[2], n[3]};
      // the lower plate's outside is up, the upper one's down
      if (part == 1) segment = {n[0], n[2], n[1], n[1]};
      if (part == 1 && !triangles) segment = {n[0], n[3], n[2], n[1]};
      rig.model.segment_sets[std::size_t(part)].segments.push_back(segment);
      // shells of both plates look away from each other
      if (part == 0) std::swap(n[1], n[triangles ? 2 : 3]);
      if (triangles) n[3] = n[2];
    }
    rig.contact().a.kind = rig.contact().b.kind = ContactSide::Kind::segments;
    rig.contact().a.set = 1, rig.contact().b.set = 0;
    rig.start(0.01);
    CHECK(rig.contacts->passes()[0]->initial_penetrations().empty());
    for (const auto& pass : rig.contacts->passes())
      for (const ContactSegment& s : pass->reference().segments) {
        const Vec3d d = x[s.node[s.triangle ? 1 : 2]] - x[s.node[0]];
        const Vec3d b = s.triangle ? x[s.node[2]] - x[s.node[0]] : x[s.node[3]] - x[s.node[1]];
        CHECK(cross(d, b).z * (s.part == 0 ? 1 : -1) > 0);
      }
    const auto f = forces_after(rig, rig.upper, {0, 0, -0.1});
    double up = 0;
    for (const int n : rig.upper) up += f[std::size_t(n)].z;
    CHECK(up > 0);
    CHECK(norm(total(f)) < 1e-10 * up);
  }
}

// |F_t| = (mu_a + mu_b)/2 F_n once it slides
TEST_CASE("FS=-1 takes the mean of the friction of the two parts") {
  for (int soft : {1, 2}) {
    Plates rig(ContactKind::automatic_surface_to_surface, 0.2);
    rig.contact().fs = -1, rig.contact().soft = soft;
    rig.model.parts[0].contact = PartContact{0.1, 0.1};
    rig.model.parts[1].contact = PartContact{0.5, 0.5};
    CHECK(friction_when_sliding(rig) == doctest::Approx(0.3).epsilon(1e-6));
  }
}

// the pair's own coefficient, in either order; the table's default for other pairs; FSF scales both
TEST_CASE("FS=-2 takes the friction of the pair of parts from *DEFINE_FRICTION") {
  struct Case {
    double part_i, part_j, scale, expected;
  };
  for (int soft : {1, 2})
    for (const Case& c : {Case{1, 2, 1, 0.4}, {2, 1, 1, 0.4}, {1, 1, 1, 0.15}, {1, 2, 0.5, 0.2}}) {
      Plates rig(ContactKind::automatic_surface_to_surface, 0.2);
      rig.contact().fs = -2, rig.contact().fsf = c.scale, rig.contact().soft = soft;
      for (const double id : {7, 8}) {
        auto card = std::make_unique<Card>("DEFINE_FRICTION");
        card->set("id", id).set("fs_d", id == 7 ? 0.15 : 0.7);
        card->add_row({c.part_i, c.part_j, id == 7 ? 0.4 : 0.9});
        rig.model.cards.push_back(std::move(card));
      }
      rig.contact().fd = 7;
      CHECK(friction_when_sliding(rig) == doctest::Approx(c.expected).epsilon(1e-6));
    }
}

TEST_CASE("FS=-2 without its table is an error") {
  for (const int tables : {0, 2}) {  // two, and FD does not say which
    Plates rig(ContactKind::automatic_surface_to_surface, 0.2);
    rig.contact().fs = -2;
    for (int i = 0; i < tables; ++i) {
      rig.model.cards.push_back(std::make_unique<Card>("DEFINE_FRICTION"));
      rig.model.cards.back()->set("id", 7 + i);
    }
    rig.start(0.01);
    REQUIRE(rig.diagnostics.has_errors());
    CHECK(rig.diagnostics.list()[0].name == "missing-friction-table");
  }
}

TEST_CASE(
    "the check tells the deepest penetration, when and where, and how often a node was let go") {
  Plates rig(ContactKind::automatic_nodes_to_surface, 0.25);
  rig.start(0.01);
  Team team(1);
  rig.contacts->forces(rig.model, rig.state, team);
  rig.state.dt = 1;
  auto move = [&](double z, double time) {
    for (int n : rig.upper)
      rig.state.nodes[n].v = {0, 0, z - rig.state.nodes[n].x.z}, rig.state.nodes[n].x.z = z;
    rig.state.time = time;
    rig.contacts->forces(rig.model, rig.state, team);
    rig.state.interaction.clear();
  };
  move(0.1, 1), move(0.15, 2);
  ContactCheck c = rig.contacts->checks()[0];
  CHECK(c.initial_nodes == 0);
  CHECK(c.deepest.depth == doctest::Approx(0.1));
  CHECK(c.deepest.time == 1);
  CHECK(c.deepest.released == 0);
  CHECK(c.deepest.allowed ==
        doctest::Approx(0.2 + 0.25));  // both half thicknesses and a quarter of the edge
  // all 25 through the plate and out of its reach
  move(-0.2, 3), move(-0.6, 4);
  c = rig.contacts->checks()[0];
  CHECK(c.deepest.time == 3);
  CHECK(c.deepest.released == 25);
}

// A layer of 0.4 on a brick of 4 x 4 x 4: pressed in by 0.3, deeper than half of itself, a node
// still touches its face, down to a quarter of the edge. Alone, its far face takes the node.
TEST_CASE("a thin layer on a block holds a node deeper than half of the layer") {
  for (const bool backed : {true, false}) {
    Rig rig;
    const int block = rig.add_part(), layer = rig.add_part(), upper = rig.add_part();
    rig.add_brick(block, {0, 0, 0}, {4, 4, 4}, 1);
    rig.add_brick(layer, {0, 0, 4}, {4, 4, 0.4}, 1);
    const auto above = rig.add_brick(upper, {1, 1, 4.45}, {2, 2, 2}, 1);
    if (backed)
      for (std::size_t i = 0; i < 4; ++i)
        rig.model.solids.node[1][i] = rig.model.solids.node[0][4 + i];
    rig.add_contact(ContactKind::automatic_nodes_to_surface, {upper}, {layer});
    rig.start(0.01);
    Team team(1);
    rig.contacts->forces(rig.model, rig.state, team);
    rig.state.dt = 1;
    const auto move = [&](double z, double time) {
      for (int n : above) rig.state.nodes[n].v = {0, 0, -z}, rig.state.nodes[n].x.z -= z;
      rig.state.time = time;
      rig.contacts->forces(rig.model, rig.state, team);
      rig.state.interaction.clear();
    };
    move(0.2, 1), move(0.15, 2);
    const ContactCheck c = rig.contacts->checks()[0];
    CHECK(c.deepest.depth == doctest::Approx(backed ? 0.3 : 0.15));
    CHECK(c.deepest.allowed == doctest::Approx(backed ? 1.0 : 0.2));
  }
}

// p = kappa d everywhere: each node gets p times its tributary area, on meshes that do not match
TEST_CASE("contact patch: equal pressure between blocks whose meshes do not match") {
  Rig rig;
  const int a = rig.add_part(), b = rig.add_part();
  const auto lower = rig.add_brick(a, {0, 0, 0}, {6, 6, 6}, 3);
  const auto upper = rig.add_brick(b, {0, 0, 6.001}, {6, 6, 6}, 4);
  rig.add_contact(ContactKind::automatic_surface_to_surface, {b}, {a}).soft = 2;
  for (int p : {a, b}) {
    Material m;
    m.density = p == a ? 1 : 3;
    rig.model.materials.push_back(m), rig.model.parts[p].material = p;
  }
  rig.start(0.01);
  // share of a node of a face of `count` x `count` segments
  auto edge = [](double q) { return q < 1e-6 || q > 6 - 1e-6 ? 0.5 : 1.0; };
  auto share = [&](const Vec3d& x, int count) { return edge(x.x) * edge(x.y) / (count * count); };
  const auto f = forces_after(rig, upper, {0, 0, -0.011});
  double whole = 0;
  for (int n : upper) whole += f[n].z;
  CHECK(whole > 0);
  for (const auto& [nodes, count, height] : {std::tuple{upper, 4, 5.99}, std::tuple{lower, 3, 6.0}})
    for (int n : nodes) {
      const Vec3d x = rig.state.nodes[n].x;
      if (std::abs(x.z - height) > 1e-6) {
        CHECK(norm(f[n]) == 0);
        continue;
      }
      CHECK(std::abs(f[n].x) < 1e-9 * whole);
      CHECK(std::abs(f[n].z) / whole == doctest::Approx(share(x, count)).epsilon(1e-9));
    }
}

TEST_CASE(
    "segments against segments keep linear and angular momentum and give a bounce its energy "
    "back") {
  for (bool single : {false, true}) {
    Rig rig;
    const int a = rig.add_part(), b = rig.add_part();
    const auto lower = rig.add_brick(a, {0, 0, 0}, {1, 1, 1}, 3);
    const auto upper = rig.add_brick(b, {0.12, 0.17, 1.01}, {0.8, 0.7, 0.8}, 2);
    if (single)
      rig.add_contact(ContactKind::automatic_single_surface, {a, b}).soft = 2;
    else
      rig.add_contact(ContactKind::automatic_surface_to_surface, {a}, {b}).soft = 2;
    rig.start(0.02);
    for (int n : upper) rig.state.nodes[n].v = {0, 0, -0.01};
    Team team(1);
    double largest = 0, stored = 0;
    for (int i = 0; i < 3000; ++i) {
      const auto before = rig.state.nodes;
      rig.step(team, 0.02, {lower, upper});
      CHECK(norm(total(rig.state.force)) < 1e-10);
      Vec3d moment{0, 0, 0};
      for (std::size_t n = 0; n < before.size(); ++n)
        moment += cross(before[n].x, rig.state.force[n]);
      CHECK(norm(moment) < 1e-10);
      for (const Vec3d& f : rig.state.force) largest = std::max(largest, norm(f));
      stored = std::max(stored, rig.state.energy.contact);
    }
    CHECK(largest > 0);
    const double mass_a = double(lower.size()), mass_b = double(upper.size());
    CHECK(rig.state.nodes[upper[0]].v.z / (-0.01 * (mass_b - mass_a) / (mass_b + mass_a)) ==
          doctest::Approx(1).epsilon(0.0025));
    CHECK(std::abs(rig.state.energy.contact) < 0.01 * stored);
  }
}

TEST_CASE("work of segments against segments, with friction and damping, is what the masses lose") {
  Plates rig(ContactKind::automatic_surface_to_surface, 0.21);
  rig.contact().soft = 2, rig.contact().fs = 0.3, rig.contact().vdc = 20;
  rig.start(0.02);
  for (int n : rig.upper) rig.state.nodes[n].v = {0.02, 0.01, -0.01};
  const double before = rig.kinetic();
  Team team(1);
  for (int i = 0; i < 2000; ++i) rig.step(team, 0.02, {rig.lower, rig.upper});
  CHECK(rig.kinetic() < 0.95 * before);
  CHECK((rig.kinetic() + rig.state.energy.contact) / before == doctest::Approx(1).epsilon(1e-6));
  CHECK(rig.state.energy.contact_friction > 0);
}

// a = g (sin - mu cos), and rest below the friction angle, over many segment borders
TEST_CASE("SOFT=2: a plate slides down an incline with g (sin - mu cos)") {
  const double g = 0.001, mu = 0.3;
  for (double angle : {30.0, 10.0}) {
    Rig rig;
    const int plane = rig.add_part(), block = rig.add_part();
    const double a = angle * M_PI / 180;
    const Vec3d down{std::cos(a), 0, -std::sin(a)}, normal{std::sin(a), 0, std::cos(a)};
    rig.add_plate(plane, {0, 0, 0}, 40.0 * down, {0, 4, 0}, 40, 4, 0.2);
    const auto nodes = rig.add_plate(block, 1.1 * down + Vec3d{0, 1.05, 0} + 0.2 * normal,
                                     2.0 * down, {0, 2, 0}, 2, 2, 0.2);
    Contact& c = rig.add_contact(ContactKind::automatic_surface_to_surface, {block}, {plane});
    c.fs = mu, c.fd = mu, c.vdc = 20, c.soft = 2;
    rig.start(0.1);
    rig.load.assign(rig.model.nodes.size(), Vec3d{0, 0, 0});
    for (int n : nodes) rig.load[n] = {0, 0, -g};
    Team team(1);
    auto speed = [&] { return dot(rig.state.nodes[nodes[0]].v, down); };
    for (int i = 0; i < 500; ++i) rig.step(team, 0.1, {nodes});
    const double v0 = speed();
    for (int i = 0; i < 1000; ++i) rig.step(team, 0.1, {nodes});
    const double acceleration = (speed() - v0) / 100;
    if (angle == 30.0)
      CHECK(acceleration / (g * (std::sin(a) - mu * std::cos(a))) ==
            doctest::Approx(1).epsilon(0.005));
    else
      CHECK(std::abs(acceleration) < 0.005 * g);
  }
}

TEST_CASE("SOFT=2: the edge of an upright plate is held by the plate it meets") {
  Rig rig;
  const int a = rig.add_part(), b = rig.add_part();
  rig.add_plate(a, {0, 0, 0}, {6, 0, 0}, {0, 6, 0}, 6, 6, 0.2);
  const auto upright = rig.add_plate(b, {1.6, 2.7, 0.25}, {3, 0, 0}, {0, 0, 2}, 4, 3, 0.2);
  rig.add_contact(ContactKind::automatic_surface_to_surface, {b}, {a}).soft = 2;
  rig.start(0.02);
  for (int n : upright) rig.state.nodes[n].v = {0, 0, -0.01};
  Team team(1);
  for (int i = 0; i < 3000; ++i) rig.step(team, 0.02, {upright});
  CHECK(rig.state.nodes[upright[0]].v.z == doctest::Approx(0.01).epsilon(0.0025));
  CHECK(rig.contacts->checks()[0].deepest.released == 0);
}

TEST_CASE("SOFT=2: same bits for any number of threads, and after save and load") {
  auto run = [](int threads, bool restart) {
    Plates rig(ContactKind::automatic_surface_to_surface, 0.21);
    rig.contact().soft = 2, rig.contact().fs = 0.2;
    rig.start(0.02);
    for (int n : rig.upper) rig.state.nodes[n].v = {0.013, 0.011, -0.01};
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
    CHECK(rig.state.energy.contact != 0);
    std::string bits(reinterpret_cast<const char*>(rig.state.nodes.data()),
                     rig.state.nodes.size() * sizeof(NodeMotion));
    return bits.append(reinterpret_cast<const char*>(&rig.state.energy.contact), sizeof(double));
  };
  const std::string one = run(1, false);
  CHECK(one == run(3, false));
  CHECK(one == run(2, true));
}
