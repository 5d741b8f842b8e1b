#include "body/mount.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "body/cards.h"
#include "body/fixture.h"
#include "body/mesh/quality.h"
#include "body/rig_cards.h"

namespace fabrica::body {
namespace {

Point mean(const std::vector<Point>& points) {
  Point sum{0, 0, 0};
  for (const Point& p : points) sum += p;
  return (1.0 / double(points.size())) * sum;
}

// a direction of the bone's frame in the body; a left bone mirrors the right one, and so do its
// directions
Point in_body(const Point& direction, const PlacedBone& bone) {
  return bone.placement.R * (bone.side == Side::left ? mirror(direction) : direction);
}

// the point about which a pot turns
Point pivot_of(const RigPot& pot, const PlacedBone& bone) {
  if (pot.pivot_at)
    return bone.placement(bone.side == Side::left ? mirror(*pot.pivot_at) : *pot.pivot_at);
  const Point toward = in_body(pot.toward, bone);
  std::vector<Point> held;
  for (const int n : potted_nodes(pot, bone)) held.push_back(bone.nodes[std::size_t(n)]);
  if (!pot.pivot) return mean(held);
  double far = std::numeric_limits<double>::lowest();
  for (const Point& p : held) far = std::max(far, dot(p, toward));
  const double open_face = far - pot.depth, at = open_face + *pot.pivot;
  std::vector<Point> near;
  for (const Point& p : held)
    if (std::abs(dot(p, toward) - at) <= *pot.pivot) near.push_back(p);
  const Point centre = mean(near.empty() ? held : near);
  return centre + (at - dot(centre, toward)) * toward;
}

// the direction square to x in which points spread least
Point flattest(const std::vector<Point>& points, const Point& x) {
  const Point centre = mean(points);
  const Point a = unit(cross(x, std::abs(x.x) < 0.7 ? Point{1, 0, 0} : Point{0, 1, 0}));
  const Point b = cross(x, a);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Point& p : points) {
    const Eigen::Vector2d d(dot(p - centre, a), dot(p - centre, b));
    spread += d * d.transpose();
  }
  const Eigen::Vector2d least =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(0);
  return least[0] * a + least[1] * b;
}

// Lays a specimen into the rig's axes.
class Laying {
 public:
  Laying(const Rig& rig, const RigSpecimen& specimen, Body& body)
      : rig_(rig), specimen_(specimen), body_(body) {
    for (const BoneName& name : specimen.bones()) bones_.push_back(need_bone(rig, body, name));
  }

  void run() {
    const Placement to_rig = placement();
    for (const int b : bones_) {
      PlacedBone& bone = body_.bones[std::size_t(b)];
      bone.faster = specimen_.faster;
      bone.placement = {to_rig.R * bone.placement.R, to_rig(bone.placement.t)};
      for (Point& p : bone.nodes) p = to_rig(p);
    }
    if (specimen_.with.empty()) return;
    for (Piece& piece : body_.between.pieces)
      for (PieceNode& node : piece.nodes) node.x = to_rig(node.x);
  }

 private:
  const PlacedBone& lead() const { return body_.bones[std::size_t(bones_[0])]; }

  // the pot of that name and the bone that it holds
  std::pair<const RigPot*, const PlacedBone*> pot_named(const std::string& name) const {
    const std::vector<BoneName> names = specimen_.bones();
    for (const RigPot& pot : rig_.pots)
      for (std::size_t i = 0; i < names.size(); ++i)
        if (pot.name == name && holds(pot, names[i]))
          return {&pot, &body_.bones[std::size_t(bones_[i])]};
    throw BodyError(fmt::format("{}: {} has no pot '{}'", rig_.path, specimen_.bone.text, name));
  }

  void refuse_overlap() const {
    const auto [from, bone] = pot_named(specimen_.from);
    const auto [to, other] = pot_named(specimen_.to);
    if (bone != other) return;
    const std::vector<int> a = potted_nodes(*from, *bone);
    for (const int n : potted_nodes(*to, *bone))
      if (std::binary_search(a.begin(), a.end(), n))
        throw BodyError(fmt::format("{}: pots '{}' and '{}' of {} overlap; make them less deep",
                                    rig_.path, specimen_.from, specimen_.to, specimen_.bone.text));
  }

  Placement placement() const {
    const Placement& frame = lead().placement;
    if (specimen_.from.empty())
      return {transpose(frame.R), specimen_.at - transpose(frame.R) * frame.t};
    refuse_overlap();
    const auto pivot = [&](const std::string& name) {
      const auto [pot, bone] = pot_named(name);
      return pivot_of(*pot, *bone);
    };
    const Point from = pivot(specimen_.from), span = pivot(specimen_.to) - from, x = unit(span);
    if (std::abs(specimen_.offset) >= norm(span))
      throw BodyError(fmt::format("{}: offset of {} is {:g} mm, but its pivots are {:.1f} mm apart",
                                  rig_.path, specimen_.bone.text, specimen_.offset, norm(span)));
    std::vector<Point> all;
    for (const int b : bones_)
      all.insert(all.end(), body_.bones[std::size_t(b)].nodes.begin(),
                 body_.bones[std::size_t(b)].nodes.end());
    Point z = specimen_.up ? in_body(*specimen_.up, lead()) : flattest(all, x);
    if (!specimen_.up && dot(z, frame.R * Point{0, 0, 1}) < 0) z = -1.0 * z;
    z = z - dot(z, x) * x;
    if (norm(z) < 1e-6)
      throw BodyError(
          fmt::format("{}: 'up' of {} is the direction from pot to pot; give one "
                      "across",
                      rig_.path, specimen_.bone.text));
    z = unit(z);
    // turned about z, so that `to` stands off the x axis by `offset`
    const double sine = specimen_.offset / norm(span), cosine = std::sqrt(1 - sine * sine);
    const Point y = cross(z, x), along = cosine * x - sine * y, across = sine * x + cosine * y;
    const Mat3d R{{{along.x, along.y, along.z}, {across.x, across.y, across.z}, {z.x, z.y, z.z}}};
    return {R, specimen_.at - R * from};
  }

  const Rig& rig_;
  const RigSpecimen& specimen_;
  Body& body_;
  std::vector<int> bones_;  // the first leads
};

class Mounting {
 public:
  Mounting(const Rig& rig, const Body& body, AssembledBody& assembled, Builder& builder)
      : rig_(rig),
        body_(body),
        assembled_(assembled),
        builder_(builder),
        cards_(assembled, builder) {}

  std::vector<MountedPart> run() {
    if (std::any_of(rig_.pots.begin(), rig_.pots.end(), [](auto& p) { return p.foundation > 0; }))
      axes();
    for (const RigPot& pot : rig_.pots) {
      const RigCards::Curves curves = cards_.curves(pot.name, pot.support);
      for (const BoneName& bone : pot.bones) add(pot, bone, curves);
    }
    for (const RigFixture& fixture : rig_.fixtures)
      mounted_.push_back(add_fixture(rig_, fixture, body_, assembled_, builder_, cards_));
    if (rig_.damping > 0) builder_.add_card("DAMPING_GLOBAL").set("valdmp", rig_.damping);
    for (const char* database : {"DATABASE_SECFORC", "DATABASE_RBDOUT"})
      builder_.add_card(database).set("dt", rig_.output_every);
    return std::move(mounted_);
  }

 private:
  static constexpr int first_axis = 8000001;      // ids of the orientations of springs
  static constexpr int resin_parts = 10000;       // from the number of a pot to that of its resin
  static constexpr double brick_density = 2e-6;   // [kg/mm3] of the pot's own brick
  static constexpr double bone_density = 1.5e-6;  // [kg/mm3] between trabecular and cortical bone

  // what the bone in a pot weighs, about the pivot; the cup, if it has a mass, stands at the pivot
  // as a ball of 30 mm
  static RigidMass mass_of(const RigPot& pot, const PlacedBone& bone, const std::vector<int>& held,
                           const Point& pivot) {
    std::vector<double> volume(bone.nodes.size(), 0);
    for (const auto& brick : bone.mesh.bricks) {
      const double share = volume_of(corners_of(bone.nodes, brick)) / 8;
      for (const int n : brick) volume[std::size_t(n)] += share;
    }
    RigidMass mass{0, pivot, {}};
    for (const int n : held)
      mass.add(bone_density * volume[std::size_t(n)], bone.nodes[std::size_t(n)]);
    mass.mass += pot.mass;
    const double ball = 0.4 * pot.mass * 30 * 30;
    for (const std::size_t k : {0, 3, 5}) mass.inertia[k] += ball;
    return mass;
  }

  void add(const RigPot& pot, const BoneName& name, const RigCards::Curves& curves) {
    const std::size_t b = std::size_t(need_bone(rig_, body_, name));
    const PlacedBone& bone = body_.bones[b];
    const std::vector<int> held = potted_nodes(pot, bone);
    std::vector<std::int64_t> nodes;
    for (const int n : held) nodes.push_back(assembled_.bone_node[b][std::size_t(n)]);
    const std::string title = name.text + " " + pot.name;
    const std::int64_t node_set = cards_.set("SET_NODE_LIST", title, nodes);
    const Point pivot = pivot_of(pot, bone);
    // a foundation keeps the bone apart from the rigid part
    const std::vector<int>& rigid = pot.foundation > 0 ? none_ : held;
    const std::int64_t id = cards_.rigid_part(title, brick_density, pot.support, curves,
                                              mass_of(pot, bone, rigid, pivot));
    // a brick of 2 mm at the pivot: the rigid part that the nodes of the pot join
    add_shape(box_mesh({2, 2, 2}, 2), id, id, {identity3<double>(), pivot}, assembled_, builder_);
    const std::int64_t joined = pot.foundation > 0 ? resin(pot, title, id, b, held) : node_set;
    builder_.add_card("CONSTRAINED_EXTRA_NODES_SET").add_row({double(id), double(joined), 0});
    section(id, node_set, title, held, b);
    mounted_.push_back({id, title, pivot});
  }

  // orientations of springs along x, y and z
  void axes() {
    int id = first_axis;
    for (const Point& axis : {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}})
      builder_.add_card("DEFINE_SD_ORIENTATION")
          .set("vid", double(id++))
          .set("iop", 0)
          .set("xt", axis.x)
          .set("yt", axis.y)
          .set("zt", axis.z);
  }

  // Springs between the surface of the bone in a pot and nodes of the cup at the same places, along
  // x, y and z: a foundation K per length on the area A of a depth d is K d / A per area. Returns
  // the set of the nodes of the cup.
  std::int64_t resin(const RigPot& pot, const std::string& title, std::int64_t pot_id,
                     std::size_t b, const std::vector<int>& held) {
    const PlacedBone& bone = body_.bones[b];
    std::map<int, double> area;  // node of the bone
    for (const auto& quad : bone.mesh.surface) {
      const auto in_pot = [&](int n) { return std::binary_search(held.begin(), held.end(), n); };
      if (!std::all_of(quad.begin(), quad.end(), in_pot)) continue;
      const auto& x = bone.nodes;
      const Point diagonal = x[std::size_t(quad[2])] - x[std::size_t(quad[0])];
      const double size = norm(cross(diagonal, x[std::size_t(quad[3])] - x[std::size_t(quad[1])]));
      for (const int n : quad) area[n] += size / 8;
    }
    double sum = 0;
    for (const auto& [node, size] : area) sum += size;
    const double id = double(pot_id + resin_parts);
    titled(builder_, "SECTION_DISCRETE", title).set("secid", id).set("dro", 0);
    titled(builder_, "MAT_SPRING_ELASTIC", title)
        .set("mid", id)
        .set("k", pot.foundation * pot.depth);
    Card& part = builder_.add_card("PART");
    part.title = "rig." + title + " resin";
    part.set("pid", id).set("secid", id).set("mid", id);
    std::vector<std::int64_t> cup;
    for (const auto& [n, size] : area) {
      const std::int64_t own = assembled_.next_node++;
      builder_.add_node(own, to_field(bone.nodes[std::size_t(n)]));
      cup.push_back(own);
      for (int axis = 0; axis < 3; ++axis)
        builder_.add_discrete(assembled_.next_element++, std::int64_t(id),
                              assembled_.bone_node[b][std::size_t(n)], own, first_axis + axis,
                              size / sum, 0);
    }
    return cards_.set("SET_NODE_LIST", title + " cup", cup);
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
    if (bricks.empty() && shells.empty()) return;  // a bone that is potted whole
    const std::int64_t solid_set = bricks.empty() ? 0 : cards_.set("SET_SOLID", title, bricks);
    const std::int64_t shell_set = shells.empty() ? 0 : cards_.set("SET_SHELL_LIST", title, shells);
    Card& card = builder_.add_card("DATABASE_CROSS_SECTION_SET");
    card.options = {"ID"};
    card.set("csid", double(id)).set("heading", title).set("nsid", double(node_set));
    card.set("hsid", double(solid_set)).set("ssid", double(shell_set));
  }

  const Rig& rig_;
  const Body& body_;
  AssembledBody& assembled_;
  Builder& builder_;
  RigCards cards_;
  std::vector<MountedPart> mounted_;
  const std::vector<int> none_;
};

}  // namespace

int need_bone(const Rig& rig, const Body& body, const BoneName& name) {
  const int index = find_bone(body.bones, name.bone, name.side);
  if (index < 0)
    throw BodyError(
        fmt::format("{}: the body has no '{}'; write the side where a bone has two: "
                    "right.{}",
                    rig.path, name.text, name.bone));
  return index;
}

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
  for (const RigSpecimen& specimen : rig.specimens) Laying(rig, specimen, body).run();
}

std::vector<MountedPart> mount(const Rig& rig, const Body& body, AssembledBody& assembled,
                               Builder& builder) {
  return Mounting(rig, body, assembled, builder).run();
}

}  // namespace fabrica::body
