// Edges against edges: beams and free edges of shells in *CONTACT_AUTOMATIC_GENERAL, and the latter
// with SOFT=2.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

#include "solver/contact_rig_test.h"

using namespace fabrica;

namespace {

// bars of radius 0.1 with `n` beams each
struct Bars : Rig {
  std::vector<int> lower, upper;
  Bars(Vec3d a0, Vec3d a1, Vec3d b0, Vec3d b1, int n) {
    Section s;
    s.area = M_PI * 0.01;
    model.sections.push_back(s);
    lower = add_bar(a0, a1, n), upper = add_bar(b0, b1, n);
    add_contact(ContactKind::automatic_general, {0, 1});
  }
  std::vector<int> add_bar(Vec3d from, Vec3d to, int n) {
    const int part = add_part();
    model.parts[part].section = 0;
    std::vector<int> nodes;
    for (int i = 0; i <= n; ++i) nodes.push_back(add_node(from + (double(i) / n) * (to - from)));
    for (int i = 0; i < n; ++i) {
      model.beams.id.push_back(model.beams.size() + 1);
      model.beams.part.push_back(part);
      model.beams.node.push_back({nodes[i], nodes[i + 1], -1});
    }
    return nodes;
  }
};

}  // namespace

// elastic impact of two equal masses that translate: they change velocities
TEST_CASE("crossing bars bounce, keep momentum and give their energy back") {
  for (int n : {1, 2, 5}) {  // with 2 the bars meet at shared nodes
    Bars rig({-1, 0, 0}, {1, 0, 0}, {0, -1, 0.25}, {0, 1, 0.25}, n);
    rig.start(0.02);
    for (int k : rig.upper) rig.state.nodes[k].v = {0, 0, -0.01};
    Team team(1);
    double stored = 0;
    for (int i = 0; i < 3000; ++i) {
      const auto before = rig.state.nodes;
      rig.step(team, 0.02, {rig.lower, rig.upper});
      CHECK(norm(total(rig.state.force)) < 1e-12);
      Vec3d moment{0, 0, 0};
      for (std::size_t k = 0; k < before.size(); ++k)
        moment += cross(before[k].x, rig.state.force[k]);
      CHECK(norm(moment) < 1e-12);
      stored = std::max(stored, rig.state.energy.contact);
    }
    CHECK(stored > 0);
    CHECK(rig.state.nodes[rig.lower[0]].v.z == doctest::Approx(-0.01).epsilon(0.0025));
    CHECK(std::abs(rig.state.nodes[rig.upper[0]].v.z) < 0.01 * 0.0025);
    CHECK(std::abs(rig.state.energy.contact) < 0.01 * stored);
    // what the two touched with: both radii
    CHECK(rig.contacts->checks().back().deepest.allowed == doctest::Approx(0.4));
  }
}

TEST_CASE("a bar that slides over the joints of another is pushed by one of its beams at a time") {
  Bars rig({-1, 0, 0}, {1, 0, 0}, {-0.9, -1, 0.19}, {-0.9, 1, 0.19}, 4);
  rig.start(0.02);
  Team team(1);
  // start clear of each other
  for (int k : rig.upper) rig.state.nodes[k].x.z = 0.3;
  rig.contacts->forces(rig.model, rig.state, team);
  for (int k : rig.upper) rig.state.nodes[k].x.z = 0.19;
  double low = 1e300, high = 0;
  for (int i = 0; i <= 180; ++i) {  // x from -0.9 to 0.9 passes the joints at -0.5, 0, 0.5
    rig.contacts->forces(rig.model, rig.state, team);
    double up = 0;
    for (int k : rig.upper) up += rig.state.interaction.get(k).z;
    rig.state.interaction.clear();
    // k = SOFSCL/2 m*/dt^2 over depth 0.01: m* between that of a node and of the middle of a beam,
    // on both bars
    low = std::min(low, up), high = std::max(high, up);
    for (int k : rig.upper) rig.state.nodes[k].x.x += 0.01;
  }
  // 1/m*: from 1/1 + 1/1 (both at nodes) to 1/2 + 1/1 (middle of a beam of the lower bar)
  const double unit = 0.5 * 0.1 / (0.02 * 0.02) * 0.01;
  CHECK(low == doctest::Approx(unit * 0.5).epsilon(0.01));
  CHECK(high == doctest::Approx(unit / 1.5).epsilon(0.01));
}

TEST_CASE("free edges of crossed upright plates meet; the friction of edges is limited by mu F") {
  Rig rig;
  const int a = rig.add_part(), b = rig.add_part();
  rig.add_plate(a, {0, 0, 0}, {4, 0, 0}, {0, 0, 2}, 4, 2, 0.2);
  const auto upper = rig.add_plate(b, {1.7, -1.3, 2.25}, {0, 3, 0}, {0, 0, 2}, 3, 2, 0.2);
  Contact& c = rig.add_contact(ContactKind::automatic_general, {a, b});
  c.fs = 0.3;
  rig.start(0.02);
  for (int n : upper) rig.state.nodes[n].v = {0.05, 0, -0.01};
  Team team(1);
  double ratio = 0;
  for (int i = 0; i < 1500; ++i) {
    rig.step(team, 0.02, {upper});
    Vec3d f{0, 0, 0};
    for (int n : upper) f += rig.state.force[n];
    if (f.z > 1e-9) ratio = std::max(ratio, std::hypot(f.x, f.y) / f.z);
  }
  CHECK(rig.state.nodes[upper[0]].v.z > 0.009);  // it came back
  CHECK(ratio == doctest::Approx(0.3).epsilon(1e-3));
  CHECK(rig.state.energy.contact_friction > 0);
}

namespace {

// upright plates whose edges cross in the middle of elements, no node near the other plate; the
// upper one falls
struct CrossedPlates : Rig {
  int a, b;
  std::vector<int> lower, upper;
  CrossedPlates() {
    a = add_part(), b = add_part();
    lower = add_plate(a, {0, 0, 0}, {4, 0, 0}, {0, 0, 2}, 4, 2, 0.2);
    upper = add_plate(b, {1.7, -1.3, 2.25}, {0, 3, 0}, {0, 0, 2}, 3, 2, 0.2);
  }
  void fall(int steps) {
    start(0.02);
    for (int n : upper) state.nodes[n].v = {0, 0, -0.01};
    Team team(1);
    for (int i = 0; i < steps; ++i) step(team, 0.02, {upper});
  }
};

}  // namespace

// Rims catch the plate where DEPTH asks for edges, and it comes back as fast as it came; without
// edges nothing is in its way.
TEST_CASE("SOFT=2: edges touch edges with a DEPTH that ends in 5, and only then") {
  for (const bool two_surfaces : {false, true})
    for (const int depth : {2, 5, 13, 25, 35}) {
      CrossedPlates rig;
      Contact& c =
          two_surfaces
              ? rig.add_contact(ContactKind::automatic_surface_to_surface, {rig.a}, {rig.b})
              : rig.add_contact(ContactKind::automatic_single_surface, {rig.a, rig.b});
      c.soft = 2, c.depth = depth;
      rig.fall(1500);
      CAPTURE(depth);
      const double v = rig.state.nodes[rig.upper[0]].v.z;
      CHECK(v == doctest::Approx(depth % 10 == 5 ? 0.01 : -0.01).epsilon(0.0025));
      // free edges alone: nothing is left out
      CHECK(rig.diagnostics.list().empty());
    }
}

TEST_CASE("SOFT=2 with edges between two surfaces: their force is that of the sides") {
  for (const bool turned : {false, true}) {
    CrossedPlates rig;
    Contact& c = rig.add_contact(ContactKind::automatic_surface_to_surface,
                                 {turned ? rig.b : rig.a}, {turned ? rig.a : rig.b});
    c.soft = 2, c.depth = 5;
    rig.start(0.02);
    for (int n : rig.upper) rig.state.nodes[n].v = {0, 0, -0.01};
    Team team(1);
    double largest = 0;
    for (int i = 0; i < 600; ++i) {
      rig.step(team, 0.02, {rig.upper});
      Vec3d f{0, 0, 0};
      for (int n : rig.upper) f += rig.state.force[n];
      const Contacts::Resultant r = rig.contacts->resultants()[0];
      const Vec3d on_upper = turned ? r.side_a : r.side_b, on_lower = turned ? r.side_b : r.side_a;
      CHECK(norm(on_upper - f) < 1e-10);
      CHECK(norm(on_upper + on_lower) == 0);
      largest = std::max(largest, f.z);
    }
    CHECK(largest > 0);
  }
}

// A part that stands on both sides of a contact: each pair of edges once, as in a single surface.
TEST_CASE("SOFT=2 with edges between surfaces that share parts pushes every pair once") {
  double force[2] = {0, 0};
  for (const bool two_surfaces : {false, true}) {
    CrossedPlates rig;
    const std::vector<int> both{rig.a, rig.b};
    Contact& c = two_surfaces
                     ? rig.add_contact(ContactKind::automatic_surface_to_surface, both, both)
                     : rig.add_contact(ContactKind::automatic_single_surface, both);
    c.soft = 2, c.depth = 5;
    rig.start(0.02);
    Team team(1);
    rig.contacts->forces(rig.model, rig.state, team);
    rig.state.interaction.clear();
    for (int n : rig.upper) rig.state.nodes[n].x.z -= 0.06;
    rig.contacts->forces(rig.model, rig.state, team);
    for (int n : rig.upper) force[two_surfaces] += rig.state.interaction.get(n).z;
  }
  CHECK(force[0] > 0);
  CHECK(force[1] == doctest::Approx(force[0]).epsilon(1e-12));
}

TEST_CASE("SOFT=2: edges that DEPTH asks for and that do not touch are named") {
  for (const int depth : {2, 5}) {
    Rig rig;
    const int a = rig.add_part();
    rig.add_brick(a, {0, 0, 0}, {1, 1, 1}, 2);
    Contact& c = rig.add_contact(ContactKind::automatic_single_surface, {a});
    c.soft = 2, c.depth = depth, c.where = Location{0, 12};
    rig.start(0.02);
    // twelve edges of a cube, two elements along each
    const bool said = !rig.diagnostics.list().empty();
    CHECK(said == (depth == 5));
    if (!said) continue;
    const Diagnostic& d = rig.diagnostics.list()[0];
    CHECK(d.name == "contact-edges");
    CHECK(d.field == "depth");
    CHECK(d.where.line == 12);
    CHECK(d.message.find(" 24 others") != std::string::npos);
  }
}

TEST_CASE("edges: same bits after save and load") {
  auto run = [](bool restart) {
    Bars rig({-1, 0, 0}, {1, 0, 0}, {0, -1, 0.25}, {0.3, 1, 0.25}, 3);
    rig.model.contacts[0].fs = 0.2;
    rig.start(0.02);
    for (int k : rig.upper) rig.state.nodes[k].v = {0.01, 0, -0.01};
    Team team(1);
    for (int i = 0; i < 600; ++i) {
      if (restart && i == 300) {
        std::stringstream file;
        rig.contacts->save(file);
        rig.contacts = std::make_unique<Contacts>(rig.model, rig.state, rig.input, rig.diagnostics);
        rig.contacts->load(file);
      }
      rig.step(team, 0.02, {rig.lower, rig.upper});
    }
    CHECK(rig.state.energy.contact != 0);
    return std::string(reinterpret_cast<const char*>(rig.state.nodes.data()),
                       rig.state.nodes.size() * sizeof(NodeMotion));
  };
  CHECK(run(false) == run(true));
}
