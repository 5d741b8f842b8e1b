#include "body/rig.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "body/materials.h"
#include "body/mesh/quality.h"
#include "body/mount.h"
#include "body/shapes.h"

using namespace fabrica;
using namespace fabrica::body;

namespace {

const std::string good = R"(end_time = 10
[[pot]]
name = "posterior"
bones = ["right.rib5"]
toward = [0, 2, 0]
depth = 20
free = ["rz"]
[[pot]]
name = "anterior"
bones = ["right.rib5"]
toward = [0.67, 0.71, -0.22]
depth = 20
motion = { along = "x", velocity = [[0, 0], [10, -1]] }
[[specimen]]
bone = "right.rib5"
along = ["posterior", "anterior"]
at = [7, 8, 9]
)";

Rig rig_of(const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() / "fabrica_rig_test.toml";
  std::ofstream(path) << text;
  return read_rig(path.string());
}

// what reading says of the good rig with one piece of text replaced
std::string refusal(const std::string& from, const std::string& to) {
  std::string text = good;
  text.replace(text.find(from), from.size(), to);
  try {
    rig_of(text);
  } catch (const BodyError& e) {
    const std::string message = e.what();
    return message.substr(message.find(".toml:") + 6);
  }
  return "";
}

Point mean_of(const PlacedBone& bone, const std::vector<int>& nodes) {
  Point sum{0, 0, 0};
  for (const int n : nodes) sum += bone.nodes[std::size_t(n)];
  return (1.0 / double(nodes.size())) * sum;
}

// the bones of a rig, laid into it
Body specimens_of(const Rig& rig) {
  BodyOptions options;
  options.only = rig.bones(), options.joints = rig.joined();
  Body body = build_body(options);
  place_specimens(rig, body);
  return body;
}

// bones laid into a rig and mounted, as a model
struct Mounted {
  explicit Mounted(const Rig& rig) : body(specimens_of(rig)) {
    Diagnostics diagnostics;
    Builder builder(diagnostics);
    AssembledBody assembled = assemble(body, {}, builder);
    parts = mount(rig, body, assembled, builder);
    model = builder.finish();
    for (const Diagnostic& d : diagnostics.list()) INFO(diagnostics.format(d));
    REQUIRE_FALSE(diagnostics.has_errors());
  }
  Body body;
  std::vector<MountedPart> parts;
  std::unique_ptr<Model> model;
};

// the good rig with other lines in place of some
Rig rig_with(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::string text = good;
  for (const auto& [from, to] : changes) text.replace(text.find(from), from.size(), to);
  return rig_of(text);
}

}  // namespace

TEST_CASE("a rig is read, and what is wrong in it is said with its line") {
  const Rig rig = rig_of(good);
  CHECK(rig.bones() == std::vector<std::string>{"right.rib5"});
  CHECK(norm(rig.pots[0].toward) == doctest::Approx(1));
  CHECK(rig.pots[0].support.free[5]);
  REQUIRE(rig.pots[1].support.motions.size() == 1);
  CHECK(rig.pots[1].support.motions[0].kind == RigCurve::velocity);
  CHECK(rig.pots[1].support.motions[0].points[1].second == -1);
  CHECK(rig.pots[0].support.holds(0));
  CHECK_FALSE(rig.pots[0].support.holds(5));
  CHECK_FALSE(rig.pots[1].support.holds(0));

  CHECK(refusal("end_time = 10", "end_time = 0").starts_with("1: end_time is 0, which is not"));
  CHECK(refusal("depth = 20", "depht = 20").starts_with("2: pot[1].depth is missing"));
  CHECK(refusal("right.rib5", "right.rib55").starts_with("4: pot[1].bones 'right.rib55' is no"));
  CHECK(refusal("\"rz\"", "\"rw\"").starts_with("7: pot[1].free 'rw' is no degree of freedom"));
  CHECK(refusal("[10, -1]", "[0, -1]").starts_with("13: pot[2].motion.velocity goes back in time"));
  CHECK(refusal("velocity =", "speed =").starts_with("13: pot[2].motion.along wants velocity or"));
  CHECK(refusal("\"posterior\", \"ant", "\"rear\", \"ant").find("'rear' is no pot of") !=
        std::string::npos);

  CHECK(refusal("depth = 20", "depth = 20\npivot = 21")
            .starts_with("7: pot[1].pivot is 21 mm behind"));
  CHECK(refusal("depth = 20", "depth = 20\npivot = 2\npivot_at = [0, 0, 0]")
            .starts_with("8: pot[1].pivot_at and pivot say"));
  CHECK(refusal("bones = [\"right.rib5\"]", "bones = []").starts_with("4: pot[1].bones is empty"));
  CHECK(refusal("free = [\"rz\"]", "start_velocity = [0, 0, 1]")
            .starts_with("7: pot[1].start_velocity goes along z, which is held"));
  CHECK(refusal(
            "motion = { along = \"x\", velocity = [[0, 0], [10, -1]] }",
            "motion = [{ along = \"x\", velocity = [[0, 0], [1, 1]] }, { along = \"x\", velocity = "
            "[[0, 0], [1, 1]] }]")
            .starts_with("13: pot[2].motion moves x twice"));
  CHECK(refusal("motion =", "load = [{ along = \"x\", force = [[0, 0], [1, 1]] }]\nmotion =")
            .starts_with("13: pot[2].load pushes along x, which the motion moves"));
  CHECK(refusal("at = [7, 8, 9]", "with = [\"right.rib5\", \"rib66\"]")
            .starts_with("17: specimen[1].with 'rib66' is no bone"));
}

TEST_CASE("a specimen lies in the rig with its pots on the x axis, flat, unstrained") {
  const Rig rig = rig_of(good);
  Body body = specimens_of(rig);
  REQUIRE(body.bones.size() == 1);  // the left rib is gone
  const PlacedBone& rib = body.bones[0];
  const Point from = mean_of(rib, potted_nodes(rig.pots[0], rib)),
              to = mean_of(rib, potted_nodes(rig.pots[1], rib));
  CHECK(norm(from - Point{7, 8, 9}) < 1e-9);
  CHECK(std::abs(to.y - 8) < 1e-9);
  CHECK(std::abs(to.z - 9) < 1e-9);
  CHECK(to.x > 100);
  // distances stay, and so does the hand
  const auto& local = rib.mesh.nodes;
  for (std::size_t n = 0; n + 1 < local.size(); n += 7)
    CHECK(norm(rib.nodes[n + 1] - rib.nodes[n]) == doctest::Approx(norm(local[n + 1] - local[n])));
  const Mat3d& R = rib.placement.R;
  const Point x{R(0, 0), R(0, 1), R(0, 2)}, y{R(1, 0), R(1, 1), R(1, 2)},
      z{R(2, 0), R(2, 1), R(2, 2)};
  CHECK(norm(cross(x, y) - z) < 1e-12);
  // no turn about x makes it flatter: the spread across z is least
  const auto spread = [&](double angle) {
    double sum = 0, square = 0;
    for (const Point& p : rib.nodes) {
      const double h = std::cos(angle) * p.z + std::sin(angle) * p.y;
      sum += h, square += h * h;
    }
    return square - sum * sum / double(rib.nodes.size());
  };
  for (const double angle : {-0.3, -0.01, 0.01, 0.3, 1.5}) CHECK(spread(0) < spread(angle));
}

TEST_CASE("a specimen with an offset is turned in its plane") {
  std::string text = good;
  text.replace(text.find("at = [7"), 0, "offset = -60\n");
  const Rig straight = rig_of(good), turned = rig_of(text);
  Body a = specimens_of(straight), b = specimens_of(turned);
  const auto pivots = [](const Rig& rig, const Body& body) {
    return std::pair{mean_of(body.bones[0], potted_nodes(rig.pots[0], body.bones[0])),
                     mean_of(body.bones[0], potted_nodes(rig.pots[1], body.bones[0]))};
  };
  const auto [from, to] = pivots(turned, b);
  const double span = norm(pivots(straight, a).second - pivots(straight, a).first);
  CHECK(norm(from - Point{7, 8, 9}) < 1e-9);
  CHECK(norm(to - from - Point{std::sqrt(span * span - 60 * 60), -60, 0}) < 1e-9);
  // in its plane: heights stay
  for (std::size_t n = 0; n < a.bones[0].nodes.size(); n += 7)
    CHECK(std::abs(a.bones[0].nodes[n].z - b.bones[0].nodes[n].z) < 1e-9);

  text.replace(text.find("-60"), 3, "260");
  const Rig far = rig_of(text);
  CHECK_THROWS_AS(specimens_of(far), BodyError);
  CHECK(refusal("along = [\"posterior\", \"anterior\"]", "offset = 5")
            .starts_with("16: specimen[1].offset is that of the second pot"));
}

TEST_CASE("pots become rigid bodies whose section holds every element beside them") {
  const Rig rig = rig_of(good);
  const Mounted mounted(rig);
  const auto& pots = mounted.parts;
  const auto& model = mounted.model;
  REQUIRE(pots.size() == 2);
  CHECK(pots[0].name == "right.rib5 posterior");
  REQUIRE(model->cross_sections.size() == 2);
  const CrossSection& section = model->cross_sections[0];
  CHECK(section.nodes.size() == potted_nodes(rig.pots[0], mounted.body.bones[0]).size());
  // bricks with some but not all corners in the pot, counted from the mesh of the model
  std::vector<char> inside(model->nodes.size(), 0);
  for (const int n : section.nodes) inside[n] = 1;
  std::size_t crossing = 0;
  for (int e = 0; e < model->solids.size(); ++e) {
    int count = 0;
    for (const int n : model->solids.node[e]) count += inside[n];
    crossing += count > 0 && count < 8;
  }
  CHECK(crossing > 0);
  CHECK(section.solids.size() == crossing);
  CHECK(section.shells.size() > 0);
}

// Viscous forms, the default, dissipate what the hourglass modes take up.
TEST_CASE("cortical shells have the stiffness form of hourglass control") {
  const Mounted mounted(rig_of(good));
  int cortical = 0;
  for (const Part& part : mounted.model->parts) {
    if (!part.title.ends_with(".cortical")) continue;
    ++cortical;
    REQUIRE(part.hourglass);
    CHECK(part.hourglass->type == 4);
    CHECK(part.hourglass->coefficient == doctest::Approx(0.05));
  }
  CHECK(cortical == 1);
}

TEST_CASE("a pot turns about its pivot, with the mass of the bone in it") {
  std::vector<double> mass, distance;
  for (const Rig& r :
       {rig_of(good), rig_with({{"depth = 20", "depth = 20\npivot = 8\nmass = 0.5"}})}) {
    const Mounted mounted(r);
    const Point pivot = mounted.parts[0].pivot;
    const Part& pot =
        mounted.model->parts[std::size_t(mounted.model->part_index(mounted.parts[0].id))];
    REQUIRE(pot.inertia);
    CHECK(norm(pot.inertia->center - pivot) < 1e-9);
    mass.push_back(pot.inertia->mass);
    // how far the pivot lies behind the open face, along the direction of the pot
    const PlacedBone& rib = mounted.body.bones[0];
    const Point toward = rib.placement.R * r.pots[0].toward;
    double far = -1e30;
    for (const Point& p : rib.nodes) far = std::max(far, dot(p, toward));
    distance.push_back(dot(pivot, toward) - (far - r.pots[0].depth));
  }
  CHECK(mass[0] > 0);
  CHECK(mass[1] - mass[0] == doctest::Approx(0.5));
  CHECK(distance[1] == doctest::Approx(8));

  const Mounted at(rig_with({{"depth = 20", "depth = 20\npivot_at = [3, 4, 5]"},
                             {"end_time = 10", "end_time = 10\ndamping = 0.1"}}));
  CHECK(norm(at.parts[0].pivot - at.body.bones[0].placement(Point{3, 4, 5})) < 1e-9);
  CHECK(norm(at.parts[0].pivot - Point{7, 8, 9}) < 1e-9);  // where the specimen lays it
}

// the resin's springs add up to its foundation times the depth, in each of three directions
TEST_CASE("a foundation joins the bone to its pot by springs") {
  const Mounted held(rig_of(good));
  const Mounted mounted(rig_with({{"depth = 20", "depth = 20\nmass = 0.3\nfoundation = 2"}}));
  const auto& model = *mounted.model;
  const auto& springs = model.discretes;
  REQUIRE(springs.size() > 0);
  REQUIRE(springs.size() % 3 == 0);
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < springs.size(); ++i) {
    const Vec3d a = model.nodes.x[std::size_t(springs.node[i][0])],
                b = model.nodes.x[std::size_t(springs.node[i][1])];
    CHECK(norm(a - b) == 0);
    sum[i % 3] += springs.scale[i];
  }
  for (const double s : sum) CHECK(s == doctest::Approx(1));
  double stiffness = 0;
  for (const auto& card : model.cards)
    if (card->schema->name == "MAT_SPRING_ELASTIC") stiffness = card->real("k");
  CHECK(stiffness == doctest::Approx(2 * 20));
  // the pot weighs what its cup does, without the bone
  const auto mass = [](const Mounted& m) {
    return m.model->parts[std::size_t(m.model->part_index(m.parts[0].id))].inertia->mass;
  };
  CHECK(mass(mounted) == doctest::Approx(0.3));
  CHECK(mass(held) > 0);
  // numbers of pots and the section stay
  CHECK(mounted.parts[0].id == held.parts[0].id);
  CHECK(mounted.parts[1].id == held.parts[1].id);
  CHECK(model.cross_sections[0].solids == held.model->cross_sections[0].solids);
  CHECK(refusal("depth = 20", "depth = 20\nfoundation = 2").find("mass of cup and resin") !=
        std::string::npos);
}

TEST_CASE("a run faster than its test has laws with higher rates") {
  const auto constant = [](const Mounted& m) {
    double c = 0;
    for (const auto& card : m.model->cards)
      if (card->schema->name == "MAT_MODIFIED_PIECEWISE_LINEAR_PLASTICITY") c = card->real("c");
    return c;
  };
  const Mounted slow(rig_of(good)),
      fast(rig_with({{"at = [7, 8, 9]", "at = [7, 8, 9]\nfaster = 10"}}));
  CHECK(constant(slow) > 0);
  CHECK(constant(fast) == doctest::Approx(10 * constant(slow)));
}

namespace {

// the good rig with a fixture above the flat rib, which may slide along z
std::string with_fixture(const std::string& shape) {
  return good + "[[fixture]]\nname = \"press\"\n" + shape +
         "\nmass = 2\ngap = 0.25\nelement = 6\ntouches = [\"right.rib5\"]\nfree = [\"z\"]\n"
         "start_velocity = [0, 0, -3]\n";
}

// nodes of the elements of a part
std::vector<Point> nodes_of(const Model& model, std::int64_t part) {
  std::vector<Point> out;
  for (int e = 0; e < model.solids.size(); ++e)
    if (model.solids.part[std::size_t(e)] == model.part_index(part))
      for (std::size_t k = 0; k < 8; ++k)
        out.push_back(model.nodes.x[std::size_t(model.solids.node[std::size_t(e)][k])]);
  return out;
}

}  // namespace

TEST_CASE("a fixture stands clear of the bone by its gap and the reach of the shells") {
  // over the middle of the rib, as high as the bone lets it
  const std::string at = "at = [77, -40, 500]";
  const Mounted box(rig_of(with_fixture("shape = \"box\"\nsize = [80, 120, 10]\n" + at)));
  double top = -1e30;
  for (const Point& p : box.body.bones[0].nodes)
    if (std::abs(p.y + 40) < 40 && std::abs(p.x - 77) < 60) top = std::max(top, p.z);
  double low = 1e30;
  for (const Point& p : nodes_of(*box.model, box.parts.back().id)) low = std::min(low, p.z);
  // cortex of ribs: at most 2 mm thick
  CHECK(low - top >= 0.25);
  CHECK(low - top <= 0.25 + 1.0);
  CHECK(box.parts.back().pivot.z == doctest::Approx(low + 5));
  // its contact holds the bone's parts and itself; it flies
  bool found = false;
  for (const auto& contact : box.model->contacts)
    found = found || contact.id == box.parts.back().id;
  CHECK(found);

  for (const std::string shape :
       {"shape = \"ball\"\nradius = 60\n", "shape = \"cylinder\"\nradius = 60\nlength = 160\n"}) {
    const Mounted round(rig_of(with_fixture(shape + at)));
    const bool ball = shape.find("ball") != std::string::npos;
    double nearest = 1e30;
    for (const Point& p : round.body.bones[0].nodes) {
      const Point r = p - round.parts.back().pivot;
      if (!ball && std::abs(r.y) > 80) continue;
      nearest = std::min(nearest, (ball ? norm(r) : std::hypot(r.x, r.z)) - 60);
    }
    // along the slide the gap is kept exactly; square to the surface it is a little less
    CHECK(nearest > 0.1);
    CHECK(nearest < 0.25 + 1.0);
  }
}

TEST_CASE("a fixture that passes the bone by is refused") {
  const Rig rig = rig_of(with_fixture("shape = \"ball\"\nradius = 3\nat = [-500, 0, 0]"));
  CHECK_THROWS_WITH_AS(Mounted{rig}, doctest::Contains("fixture 'press' passes right.rib5 by"),
                       BodyError);
}

TEST_CASE("a pad lies between the fixture and the bone and shares its face") {
  const Mounted press(rig_of(with_fixture(
      "shape = \"box\"\nsize = [24, 48, 10]\nat = [77, -75, 0]\npad = { thickness = 6, density = "
      "1.5e-8, modulus = 1, compression = [[0, 0], [1, 0.1]] }")));
  const std::vector<Point> rigid = nodes_of(*press.model, press.parts.back().id),
                           pad = nodes_of(*press.model, press.parts.back().id + 1);
  REQUIRE(!pad.empty());
  double low = 1e30, pad_low = 1e30, pad_top = -1e30;
  for (const Point& p : rigid) low = std::min(low, p.z);
  for (const Point& p : pad) pad_low = std::min(pad_low, p.z), pad_top = std::max(pad_top, p.z);
  CHECK(pad_top == doctest::Approx(low));
  CHECK(pad_low == doctest::Approx(low - 6));
  // 4 x 8 bricks a layer, two layers in the box and two in the pad, all turned the right way
  CHECK(rigid.size() == 8 * 4 * 8 * 2);
  CHECK(pad.size() == 8 * 4 * 8 * 2);
}

TEST_CASE("shapes hold their volume with bricks of the right hand") {
  const double pi = 3.14159265358979;
  CHECK(box_mesh({20, 30, 10}, 5).volume() == doctest::Approx(6000));
  CHECK(box_mesh({20, 30, 10}, 5, 4).volume() == doctest::Approx(6000));
  CHECK(cylinder_mesh(10, 40, 1).volume() == doctest::Approx(pi * 100 * 40).epsilon(0.01));
  CHECK(ball_mesh(10, 1).volume() == doctest::Approx(4.0 / 3 * pi * 1000).epsilon(0.01));
  for (const ShapeMesh& mesh :
       {box_mesh({20, 30, 10}, 5, 4), cylinder_mesh(10, 40, 4), ball_mesh(10, 3)})
    for (const auto& brick : mesh.bricks) CHECK(volume_of(corners_of(mesh.nodes, brick)) > 0);
}

TEST_CASE("joined bones keep their places beside each other, with what joins them") {
  const std::string unit = R"(end_time = 10
[[pot]]
name = "lower"
bones = ["L4"]
toward = [0, 0, -1]
depth = 300
[[pot]]
name = "upper"
bones = ["L3"]
toward = [0, 0, 1]
depth = 300
free = ["x", "y", "z", "ry"]
load = [{ along = "ry", force = [[0, 0], [10, 10]] }]
[[specimen]]
bone = "L4"
with = ["L3"]
at = [1, 2, 3]
)";
  const Rig rig = rig_of(unit);
  REQUIRE(rig.joined());
  BodyOptions options;
  options.only = rig.bones();
  const Body before = build_body(options);
  const Mounted mounted(rig);
  const Body& body = mounted.body;
  REQUIRE(body.bones.size() == 2);
  const PlacedBone& lead = body.bones[std::size_t(find_bone(body.bones, "L4", Side::midline))];
  CHECK(norm(lead.placement.t - Point{1, 2, 3}) < 1e-9);
  for (int i = 0; i < 3; ++i) CHECK(lead.placement.R(i, i) == doctest::Approx(1));
  CHECK(norm(body.bones[0].nodes[5] - body.bones[1].nodes[7]) ==
        doctest::Approx(norm(before.bones[0].nodes[5] - before.bones[1].nodes[7])));
  // the disc goes with them
  int own = 0;
  for (std::size_t p = 0; p < body.between.pieces.size(); ++p)
    for (std::size_t n = 0; n < body.between.pieces[p].nodes.size(); ++n) {
      const PieceNode &moved = body.between.pieces[p].nodes[n],
                      &was = before.between.pieces[p].nodes[n];
      if (moved.bone >= 0 || moved.piece >= 0) continue;
      ++own;
      CHECK(norm(moved.x - body.bones[0].nodes[0]) ==
            doctest::Approx(norm(was.x - before.bones[0].nodes[0])).epsilon(1e-9));
    }
  CHECK(own > 0);

  REQUIRE(mounted.parts.size() == 2);
  CHECK(mounted.model->cross_sections.empty());  // bones that are potted whole have none
}

// e_p + s(e_p) / E = e in closed form: for a straight line e_p = (e - SIGY / E) / (1 + H / E) with
// H = E ETAN / (E - ETAN)
TEST_CASE("plastic strain at a strain at fracture") {
  Diagnostics diagnostics;
  Builder builder(diagnostics);
  Card& line = builder.add_card("MAT_PIECEWISE_LINEAR_PLASTICITY");
  line.set("e", 10).set("sigy", 0.1).set("etan", 1);
  const double H = 10.0 * 1 / (10 - 1);
  CHECK(plastic_strain_at(line, 0.03) == doctest::Approx((0.03 - 0.01) / (1 + H / 10)));
  CHECK(plastic_strain_at(line, 0.005) == 0);
  // a curve of two pieces: strain 0.02 + 0.2 / 10 = 0.04 at its corner, beyond it flat
  Card& curve = builder.add_card("MAT_PIECEWISE_LINEAR_PLASTICITY");
  curve.set("e", 10).set("sigy", 0.1);
  curve.set("eps2", 0.02).set("eps3", 1).set("es1", 0.1).set("es2", 0.2).set("es3", 0.2);
  CHECK(plastic_strain_at(curve, 0.04) == doctest::Approx(0.02));
  CHECK(plastic_strain_at(curve, 0.025) == doctest::Approx(0.01));
  CHECK(plastic_strain_at(curve, 0.05) == doctest::Approx(0.03));
}
