#include "body/rig.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "body/materials.h"
#include "body/mount.h"

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
  options.only = rig.bones(), options.joints = false;
  Body body = build_body(options);
  place_specimens(rig, body);
  return body;
}

}  // namespace

TEST_CASE("a rig is read, and what is wrong in it is said with its line") {
  const Rig rig = rig_of(good);
  CHECK(rig.bones() == std::vector<std::string>{"rib5"});
  CHECK(norm(rig.pots[0].toward) == doctest::Approx(1));
  CHECK(rig.pots[0].free[5]);
  CHECK(rig.pots[1].motion->velocity);
  CHECK(rig.pots[1].motion->points[1].second == -1);

  CHECK(refusal("end_time = 10", "end_time = 0").starts_with("1: end_time is 0, which is not"));
  CHECK(refusal("depth = 20", "depht = 20").starts_with("2: pot[1].depth is missing"));
  CHECK(refusal("right.rib5", "right.rib55").starts_with("4: pot[1].bones 'right.rib55' is no"));
  CHECK(refusal("\"rz\"", "\"rw\"").starts_with("7: pot[1].free 'rw' is no degree of freedom"));
  CHECK(refusal("[10, -1]", "[0, -1]").starts_with("13: pot[2].motion.velocity goes back in time"));
  CHECK(refusal("velocity =", "speed =").starts_with("13: pot[2].motion.along wants either"));
  CHECK(refusal("\"posterior\", \"ant", "\"rear\", \"ant").find("'rear' is no pot of") !=
        std::string::npos);
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

TEST_CASE("pots become rigid bodies whose section holds every element beside them") {
  const Rig rig = rig_of(good);
  Body body = specimens_of(rig);
  Diagnostics diagnostics;
  Builder builder(diagnostics);
  AssembledBody assembled = assemble(body, {}, builder);
  const auto pots = mount(rig, body, assembled, builder);
  const auto model = builder.finish();
  REQUIRE_FALSE(diagnostics.has_errors());
  REQUIRE(pots.size() == 2);
  CHECK(pots[0].name == "right.rib5 posterior");
  REQUIRE(model->cross_sections.size() == 2);
  const CrossSection& section = model->cross_sections[0];
  CHECK(section.nodes.size() == potted_nodes(rig.pots[0], body.bones[0]).size());
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
