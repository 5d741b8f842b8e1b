// Models built by hand: references, defaults and diagnostics of Builder::finish(), and the numbers
// of the check.
#include <doctest/doctest.h>

#include <cmath>

#include "model/check.h"

using namespace fabrica;

namespace {

// a unit cube of density 2 and modulus 8 (nu = 0): V / A = 1, c = 2
struct Cube {
  Diagnostics diagnostics;
  Builder builder{diagnostics};

  explicit Cube(bool inverted = false) {
    for (int k = 0; k < 8; ++k)
      builder.add_node(k + 1,
                       {double(k % 4 == 1 || k % 4 == 2), double(k % 4 >= 2), double(k / 4)});
    const std::int64_t up[8] = {1, 2, 3, 4, 5, 6, 7, 8}, down[8] = {5, 6, 7, 8, 1, 2, 3, 4};
    builder.add_solid(1, 10, inverted ? down : up, 8);
    builder.add_card("SECTION_SOLID").set("secid", 3).set("elform", 1);
    builder.add_card("MAT_ELASTIC").set("mid", 4).set("ro", 2).set("e", 8).set("pr", 0);
    builder.add_card("PART").set("pid", 10).set("secid", 3).set("mid", 4);
    builder.add_card("CONTROL_TERMINATION").set("endtim", 1);
  }
  bool has(std::string_view name) const {
    for (const Diagnostic& d : diagnostics.list())
      if (d.name == name) return true;
    return false;
  }
};

}  // namespace

TEST_CASE("resolve: a cube becomes indices without complaint") {
  Cube cube;
  const auto model = cube.builder.finish();
  CHECK(cube.diagnostics.list().empty());
  CHECK(model->solids.node[0][7] == 7);
  CHECK(model->solids.part[0] == 0);
  CHECK(model->parts[0].family == Family::solid);
  CHECK(model->materials[model->parts[0].material].law == "MAT_ELASTIC");
  CHECK(model->node_index(8) == 7);
  CHECK(model->node_index(9) == -1);
  CHECK(model->controls.time_step_scale == 0.9);
}

TEST_CASE("erosion by time step is not claimed where DTMIN would ask for it, in either order") {
  for (const bool erode : {false, true})
    for (const bool limit : {false, true}) {
      Cube before, after;
      const auto step = [&](Cube& c) {
        c.builder.add_card("CONTROL_TIMESTEP").set("erode", erode);
      };
      const auto end = [&](Cube& c) {
        c.builder.add_card("CONTROL_TERMINATION").set("endtim", 1).set("dtmin", limit ? 0.1 : 0);
      };
      step(before), end(before), before.builder.finish();
      end(after), step(after), after.builder.finish();
      CHECK(before.has("unsupported-erosion") == (erode && limit));
      CHECK(after.has("unsupported-erosion") == (erode && limit));
    }
}

// m = rho V = 2, c = sqrt((K + 4G/3) / rho) = sqrt(E / rho) = 2 at nu = 0, dt = L / c = 1/2
TEST_CASE("check: mass, centre, time step and kinetic energy of a cube") {
  Cube cube;
  cube.builder.add_card("INITIAL_VELOCITY").set("vx", 3);
  const auto model = cube.builder.finish();
  const CheckReport r = check_model(*model, cube.diagnostics);
  CHECK(r.mass == doctest::Approx(2));
  CHECK(r.moving_mass == doctest::Approx(2));
  CHECK(r.kinetic_energy == doctest::Approx(9));
  for (int k = 0; k < 3; ++k) CHECK(r.center[k] == doctest::Approx(0.5));
  REQUIRE(r.smallest.size() == 1);
  CHECK(r.smallest[0].time_step == doctest::Approx(0.5));
  CHECK(r.parts.at(0).time_step == doctest::Approx(0.5));
  const std::string text = format_check(r, cube.diagnostics);
  CHECK(text.ends_with("check: 0 errors, 0 unsupported, 0 ignored, 0 warnings\n"));
}

TEST_CASE("resolve: every wrong reference has its own diagnostic") {
  SUBCASE("node") {
    Cube cube;
    const std::int64_t n[4] = {1, 2, 3, 99};
    cube.builder.add_shell(1, 10, n, 4);
    cube.builder.finish();
    CHECK(cube.has("missing-node"));
    CHECK(cube.has("section-family-mismatch"));
  }
  SUBCASE("part") {
    Cube cube;
    const std::int64_t n[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    cube.builder.add_solid(2, 11, n, 8);
    cube.builder.finish();
    CHECK(cube.has("missing-part"));
  }
  SUBCASE("section and material") {
    Cube cube;
    cube.builder.add_card("PART").set("pid", 11).set("secid", 77).set("mid", 78);
    cube.builder.finish();
    CHECK(cube.has("missing-section"));
    CHECK(cube.has("missing-material"));
  }
  SUBCASE("curve") {
    Cube cube;
    cube.builder.add_card("LOAD_BODY_Z").set("lcid", 5);
    cube.builder.finish();
    CHECK(cube.has("missing-curve"));
  }
  SUBCASE("set") {
    Cube cube;
    cube.builder.add_card("BOUNDARY_SPC_SET").set("nsid", 5).set("dofx", 1);
    cube.builder.finish();
    CHECK(cube.has("missing-set"));
  }
  SUBCASE("duplicate") {
    Cube cube;
    cube.builder.add_node(8, {0, 0, 0});
    cube.builder.finish();
    CHECK(cube.has("duplicate-id"));
  }
  SUBCASE("inverted") {
    Cube cube(true);
    cube.builder.finish();
    CHECK(cube.has("negative-volume"));
  }
  SUBCASE("termination") {
    Diagnostics d;
    Builder(d).finish();
    REQUIRE(d.list().size() == 1);
    CHECK(d.list()[0].name == "no-termination");
  }
  SUBCASE("joint off rigid bodies, its nodes apart") {
    Cube cube;
    cube.builder.add_card("CONSTRAINED_JOINT_SPHERICAL").set("n1", 1).set("n2", 2);
    cube.builder.finish();
    CHECK(cube.has("joint-not-on-rigid-bodies"));
    CHECK(cube.has("joint-nodes-apart"));
  }
}

TEST_CASE("resolve: a motion of nodes of a rigid body is not supported, and named by its card") {
  for (const bool by_set : {false, true}) {
    Cube cube;
    Builder& b = cube.builder;
    const std::int64_t n[8] = {11, 12, 13, 14, 15, 16, 17, 18};
    for (int k = 0; k < 8; ++k)
      b.add_node(n[k], {double(k % 4 == 1 || k % 4 == 2), double(k % 4 >= 2), 5 + double(k / 4)});
    b.add_solid(2, 11, n, 8);
    b.add_card("MAT_RIGID").set("mid", 5).set("ro", 2).set("e", 8).set("pr", 0);
    b.add_card("PART").set("pid", 11).set("secid", 3).set("mid", 5);
    b.add_card("DEFINE_CURVE").set("lcid", 1).add_row({0, 0}).add_row({1, 1});
    b.add_card("SET_NODE_LIST").set("sid", 1).add_row({12, 1, 13, 0, 0, 0, 0, 0});
    const char *keyword =
                   by_set ? "BOUNDARY_PRESCRIBED_MOTION_SET" : "BOUNDARY_PRESCRIBED_MOTION_NODE",
               *field = by_set ? "nsid" : "nid";
    Card motion(keyword);
    motion.set(field, by_set ? 1 : 14).set("dof", 1).set("vad", 0).set("lcid", 1);
    motion.where = Location{0, 40};
    b.add_card(std::move(motion));
    // node 1 is on no body
    b.add_card("BOUNDARY_PRESCRIBED_MOTION_NODE").set("nid", 1).set("dof", 2).set("lcid", 1);
    b.finish();
    CHECK(cube.diagnostics.count(Severity::unsupported) == 1);
    for (const Diagnostic& d : cube.diagnostics.list()) {
      CAPTURE(d.message);
      REQUIRE(d.name == "motion-of-rigid-node");
      CHECK(d.severity == Severity::unsupported);
      CHECK(d.where.line == 40);
      CHECK(d.keyword == keyword);
      CHECK(d.field == field);
      CHECK(d.message.find(by_set ? "2 of 3 nodes" : "1 of 1 nodes") == 0);
      CHECK(d.remedy.find("BOUNDARY_PRESCRIBED_MOTION_RIGID") != std::string::npos);
    }
  }
}

TEST_CASE("resolve: zero means default where the format says so") {
  Cube cube;
  cube.builder.add_card("SET_PART_LIST").set("sid", 1).add_row({10, 0, 0, 0, 0, 0, 0, 0});
  cube.builder.add_card("CONTACT_AUTOMATIC_SINGLE_SURFACE")
      .set("ssid", 1)
      .set("sstyp", 2)
      .set("sfs", 0);
  cube.builder.add_card("RIGIDWALL_PLANAR").set("zh", 1);
  cube.builder.add_card("SECTION_SHELL").set("secid", 9).set("nip", 0).set("shrf", 0).set("t1", 2);
  const auto model = cube.builder.finish();
  REQUIRE(model->contacts.size() == 1);
  CHECK(model->contacts[0].sfs == 1);
  CHECK(model->contacts[0].death == 1e28);
  CHECK(model->contacts[0].a.parts == std::vector<int>{0});
  REQUIRE(model->rigid_walls.size() == 1);
  CHECK(model->rigid_walls[0].nodes.size() == 8);
  const Section& s = model->sections[1];
  CHECK(s.through_thickness_points == 2);
  CHECK(s.shear_factor == 1);
  CHECK(s.thickness[3] == 2);
}

TEST_CASE("resolve: general sets add and take out in order") {
  Cube cube;
  Card& set = cube.builder.add_card("SET_NODE_GENERAL");
  set.set("sid", 1);
  set.add_row("PART", {10, 0, 0, 0, 0, 0, 0});
  set.add_row("DNODE", {3, 5, 0, 0, 0, 0, 0});
  Card& faces = cube.builder.add_card("SET_SEGMENT_GENERAL");
  faces.set("sid", 2);
  faces.add_row("PART", {10, 0, 0, 0, 0, 0, 0});
  const auto model = cube.builder.finish();
  REQUIRE(model->node_sets.size() == 1);
  CHECK(model->node_sets[0].nodes == std::vector<int>{0, 1, 3, 5, 6, 7});
  REQUIRE(model->segment_sets.size() == 1);
  CHECK(model->segment_sets[0].segments.size() == 6);

  // outward normals: the flux of x through a closed surface is three times its volume
  double flux = 0;
  for (const auto& s : model->segment_sets[0].segments) {
    const auto& x = model->nodes.x;
    const Vec3d area = 0.5 * cross(x[s[2]] - x[s[0]], x[s[3]] - x[s[1]]);
    flux += 0.25 * dot(x[s[0]] + x[s[1]] + x[s[2]] + x[s[3]], area);
  }
  CHECK(flux == doctest::Approx(3));
}

// y rises from 0 to 2 over [1, 3]: the integral over [0, 4] is 0 + 2 + 2
TEST_CASE("curve: values, integral and end values") {
  Curve c;
  c.x = {1, 3};
  c.y = {0, 2};
  CHECK(c.at(2) == doctest::Approx(1));
  CHECK(c.at(0) == 0);
  CHECK(c.at(9) == 2);
  CHECK(c.slope_integral(0, 4) == doctest::Approx(4));
  CHECK(c.slope_integral(4, 0) == doctest::Approx(-4));
  CHECK(c.slope_integral(1.5, 2.5) == doctest::Approx(1));
}

TEST_CASE("resolve: curves are scaled after the offset and points put in order") {
  Cube cube;
  Card& card = cube.builder.add_card("DEFINE_CURVE");
  card.set("lcid", 1).set("sfa", 2).set("offa", 1).set("sfo", 3).set("offo", 0.5);
  card.add_row({0, 1}).add_row({2, 3}).add_row({1, 2});
  const auto model = cube.builder.finish();
  CHECK(cube.has("curve-not-ascending"));
  CHECK(model->curves[0].x == std::vector<double>{2, 4, 6});
  CHECK(model->curves[0].y == std::vector<double>{4.5, 7.5, 10.5});
}
