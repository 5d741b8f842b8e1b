#include "body/mount.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "body/id_rows.h"

namespace fabrica::body {
namespace {

const RigPot& pot_named(const Rig& rig, const std::string& name, const BoneName& bone) {
  for (const RigPot& pot : rig.pots)
    if (pot.name == name)
      for (const BoneName& b : pot.bones)
        if (b.text == bone.text) return pot;
  throw BodyError(fmt::format("{}: {} has no pot '{}'", rig.path, bone.text, name));
}

int need_bone(const Rig& rig, const Body& body, const BoneName& name) {
  const int index = find_bone(body.bones, name.bone, name.side);
  if (index < 0)
    throw BodyError(
        fmt::format("{}: the body has no '{}'; write the side where a bone has two: "
                    "right.{}",
                    rig.path, name.text, name.bone));
  return index;
}

Point mean(const std::vector<Point>& nodes, const std::vector<int>& some) {
  Point sum{0, 0, 0};
  for (const int n : some) sum += nodes[std::size_t(n)];
  return (1.0 / double(some.size())) * sum;
}

Point unit(const Point& p) { return (1 / norm(p)) * p; }

// the direction square to x in which nodes spread least
Point flattest(const std::vector<Point>& nodes, const Point& x) {
  Point centre{0, 0, 0};
  for (const Point& p : nodes) centre += p;
  centre = (1.0 / double(nodes.size())) * centre;
  const Point a = unit(cross(x, std::abs(x.x) < 0.7 ? Point{1, 0, 0} : Point{0, 1, 0}));
  const Point b = cross(x, a);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Point& p : nodes) {
    const Eigen::Vector2d d(dot(p - centre, a), dot(p - centre, b));
    spread += d * d.transpose();
  }
  const Eigen::Vector2d least =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(0);
  return least[0] * a + least[1] * b;
}

// turns and shifts a bone so that its pots lie on the x axis of the rig
void lay(const Rig& rig, const RigSpecimen& specimen, PlacedBone& bone) {
  const std::vector<Point>& local = bone.mesh.nodes;
  const auto pivot = [&](const std::string& name) {
    return mean(local, potted_nodes(pot_named(rig, name, specimen.bone), bone));
  };
  const Point from = pivot(specimen.from), x = unit(pivot(specimen.to) - from);
  Point z = specimen.up ? *specimen.up : flattest(local, x);
  if (!specimen.up && z.z < 0) z = -1.0 * z;
  z = z - dot(z, x) * x;
  if (norm(z) < 1e-6)
    throw BodyError(fmt::format("{}: 'up' of {} is the direction from pot to pot; give one across",
                                rig.path, specimen.bone.text));
  z = unit(z);
  const Point y = cross(z, x);
  const Mat3d R{{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
  bone.placement = {R, specimen.at - R * from};
  for (std::size_t n = 0; n < local.size(); ++n) bone.nodes[n] = bone.placement(local[n]);
}

// the code by which supports name a choice of x, y, z
int support_code(bool x, bool y, bool z) {
  static constexpr int code[8] = {0, 1, 2, 4, 3, 6, 5, 7};
  return code[int(x) + 2 * int(y) + 4 * int(z)];
}

class Mounting {
 public:
  Mounting(const Rig& rig, const Body& body, AssembledBody& assembled, Builder& builder)
      : rig_(rig), body_(body), assembled_(assembled), builder_(builder) {}

  std::vector<MountedPot> run() {
    builder_.add_card("SECTION_SOLID").set("secid", double(pot_section)).set("elform", 1);
    for (const RigPot& pot : rig_.pots) {
      const std::int64_t curve = pot.motion ? motion_curve(pot) : 0;
      for (const BoneName& bone : pot.bones) add(pot, bone, curve);
    }
    for (const char* database : {"DATABASE_SECFORC", "DATABASE_RBDOUT"})
      builder_.add_card(database).set("dt", rig_.output_every);
    return std::move(mounted_);
  }

 private:
  static constexpr std::int64_t pot_section = 8000001;
  static constexpr double pot_density = 2e-6;  // [kg/mm3] of the brick, 16 mg

  std::int64_t set(const char* keyword, const std::string& title,
                   const std::vector<std::int64_t>& ids) {
    Card& card = builder_.add_card(keyword);
    card.options = {"TITLE"};
    card.title = title;
    card.set("sid", double(++assembled_.next_set));
    add_ids(card, ids.size(), [&](std::size_t i) { return ids[i]; });
    return assembled_.next_set;
  }

  std::int64_t motion_curve(const RigPot& pot) {
    Card& curve = builder_.add_card("DEFINE_CURVE");
    curve.options = {"TITLE"};
    curve.title = pot.name;
    curve.set("lcid", double(++last_curve_));
    for (const auto& [time, value] : pot.motion->points) curve.add_row({time, value});
    return last_curve_;
  }

  void add(const RigPot& pot, const BoneName& name, std::int64_t curve) {
    const std::size_t b = std::size_t(need_bone(rig_, body_, name));
    const PlacedBone& bone = body_.bones[b];
    const std::vector<int> held = potted_nodes(pot, bone);
    std::vector<std::int64_t> nodes;
    for (const int n : held) nodes.push_back(assembled_.bone_node[b][std::size_t(n)]);
    const std::string title = name.text + " " + pot.name;
    const std::int64_t node_set = set("SET_NODE_LIST", title, nodes), id = assembled_.next_part++;
    rigid(pot, id, node_set, title, mean(bone.nodes, held));
    if (pot.motion) move(pot, id, title, curve);
    section(id, node_set, title, held, b);
    mounted_.push_back({id, title, mean(bone.nodes, held)});
  }

  void rigid(const RigPot& pot, std::int64_t id, std::int64_t nodes, const std::string& title,
             const Point& pivot) {
    std::array<bool, 6> held{};
    for (std::size_t d = 0; d < 6; ++d)
      held[d] = !pot.free[d] && !(pot.motion && std::size_t(pot.motion->dof) == d);
    Card& law = builder_.add_card("MAT_RIGID");
    law.options = {"TITLE"};
    law.title = title;
    law.set("mid", double(id)).set("ro", pot_density).set("e", 70).set("pr", 0.3).set("cmo", 1);
    law.set("con1", support_code(held[0], held[1], held[2]));
    law.set("con2", support_code(held[3], held[4], held[5]));
    Card& part = builder_.add_card("PART");
    part.title = "rig." + title;
    part.set("pid", double(id)).set("secid", double(pot_section)).set("mid", double(id));
    cube(id, pivot);
    builder_.add_card("CONSTRAINED_EXTRA_NODES_SET").add_row({double(id), double(nodes), 0});
  }

  // a brick of 2 mm at the pivot: the rigid part that the nodes of the pot join
  void cube(std::int64_t part, const Point& centre) {
    std::array<std::int64_t, 8> corner{};
    for (std::size_t k = 0; k < 8; ++k) {
      const double x = (k & 3) == 1 || (k & 3) == 2 ? 1 : -1, y = (k & 2) ? 1 : -1;
      corner[k] = assembled_.next_node++;
      builder_.add_node(corner[k], centre + Point{x, y, k < 4 ? -1.0 : 1.0});
    }
    builder_.add_solid(assembled_.next_element++, part, corner.data(), 8);
  }

  void move(const RigPot& pot, std::int64_t id, const std::string& title, std::int64_t curve) {
    Card& motion = builder_.add_card("BOUNDARY_PRESCRIBED_MOTION_RIGID");
    motion.options = {"ID"};
    motion.set("id", double(id)).set("heading", title).set("pid", double(id));
    motion.set("dof", pot.motion->dof < 3 ? pot.motion->dof + 1 : pot.motion->dof + 2);
    motion.set("vad", pot.motion->velocity ? 0 : 2).set("lcid", double(curve)).set("sf", 1);
  }

  // the elements that join the pot to the rest of the bone, and their force on it
  void section(std::int64_t id, std::int64_t node_set, const std::string& title,
               const std::vector<int>& held, std::size_t b) {
    const BoneMesh& mesh = body_.bones[b].mesh;
    std::vector<char> inside(mesh.nodes.size(), 0);
    for (const int n : held) inside[std::size_t(n)] = 1;
    const auto crosses = [&](const auto& corners) {
      int count = 0;
      for (const int n : corners) count += inside[std::size_t(n)];
      return count > 0 && count < int(corners.size());
    };
    std::vector<std::int64_t> bricks, shells;
    for (std::size_t e = 0; e < mesh.bricks.size(); ++e)
      if (crosses(mesh.bricks[e])) bricks.push_back(assembled_.bone_brick[b][e]);
    for (std::size_t q = 0; q < assembled_.bone_shell[b].size(); ++q)
      if (assembled_.bone_shell[b][q] != 0 && crosses(mesh.surface[q]))
        shells.push_back(assembled_.bone_shell[b][q]);
    const std::int64_t solid_set = bricks.empty() ? 0 : set("SET_SOLID", title, bricks);
    const std::int64_t shell_set = shells.empty() ? 0 : set("SET_SHELL_LIST", title, shells);
    Card& card = builder_.add_card("DATABASE_CROSS_SECTION_SET");
    card.options = {"ID"};
    card.set("csid", double(id)).set("heading", title).set("nsid", double(node_set));
    card.set("hsid", double(solid_set)).set("ssid", double(shell_set));
  }

  const Rig& rig_;
  const Body& body_;
  AssembledBody& assembled_;
  Builder& builder_;
  std::int64_t last_curve_ = 8000000;
  std::vector<MountedPot> mounted_;
};

}  // namespace

std::vector<int> potted_nodes(const RigPot& pot, const PlacedBone& bone) {
  // a left bone mirrors the right one, and so does the direction of its end
  const Point toward = bone.side == Side::left ? mirror(pot.toward) : pot.toward;
  double far = std::numeric_limits<double>::lowest();
  for (const Point& p : bone.mesh.nodes) far = std::max(far, dot(p, toward));
  std::vector<int> nodes;
  for (std::size_t n = 0; n < bone.mesh.nodes.size(); ++n)
    if (dot(bone.mesh.nodes[n], toward) >= far - pot.depth) nodes.push_back(int(n));
  return nodes;
}

void place_specimens(const Rig& rig, Body& body) {
  std::erase_if(body.bones, [&](const PlacedBone& bone) { return !rig.tests(bone); });
  for (const RigSpecimen& specimen : rig.specimens) {
    PlacedBone& bone = body.bones[std::size_t(need_bone(rig, body, specimen.bone))];
    const auto a = potted_nodes(pot_named(rig, specimen.from, specimen.bone), bone);
    for (const int n : potted_nodes(pot_named(rig, specimen.to, specimen.bone), bone))
      if (std::binary_search(a.begin(), a.end(), n))
        throw BodyError(fmt::format("{}: pots '{}' and '{}' of {} overlap; make them less deep",
                                    rig.path, specimen.from, specimen.to, specimen.bone.text));
    lay(rig, specimen, bone);
  }
}

std::vector<MountedPot> mount(const Rig& rig, const Body& body, AssembledBody& assembled,
                              Builder& builder) {
  return Mounting(rig, body, assembled, builder).run();
}

}  // namespace fabrica::body
