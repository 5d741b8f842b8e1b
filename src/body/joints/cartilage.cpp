#include "body/joints/cartilage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "body/joints/bone_surfaces.h"
#include "body/joints/joint_law.h"
#include "body/joints/layer.h"
#include "body/joints/ligaments.h"
#include "body/joints/meniscus.h"
#include "body/joints/piece_builder.h"
#include "body/mesh/distance_field.h"
#include "body/mesh/quality.h"

namespace fabrica::body {

namespace {

constexpr double contact_gap = 0.1;      // [mm] left between layers of cartilage
constexpr double tied_gap = 0.05;        // [mm] left between a layer and the bone it is tied to
constexpr double thinnest = 0.15;        // [mm] of a layer
constexpr double under_meniscus = 1;     // [mm] of a layer that leaves room for a meniscus
constexpr double least_jacobian = 0.36;  // of its bricks
constexpr double capsule_length = 8;     // [mm] reference length of capsules without a row

// What the nearest point of the other bone faces: its quad's normal, or the way back from it, which
// at an edge is a normal between those of both sides.
enum class Facing { quad, edge };

// faces of one bone that look at another
struct Patch {
  std::vector<int> quads;  // of the bone's surface
  double gap = 1e30;       // [mm] least
};

class ArticulationMaker {
 public:
  ArticulationMaker(const std::vector<PlacedBone>& bones, BetweenBones& between)
      : bones_(bones), between_(between), surface_(bones) {}
  ArticulationReport add(const Articulation& joint);

 private:
  bool belongs(const Articulation& joint, int bone, const Point& centre) const;
  Patch patch(const Articulation& joint, int bone, int other, double reach, Facing facing);
  void go_around(const Articulation& joint, Patch& patch) const;
  std::vector<std::array<PieceNode, 4>> layer(const Articulation& joint, int bone, int other,
                                              const Patch& patch, double cartilage,
                                              double& gap_left);
  void sliding(const Articulation& joint, const Patch& a, const Patch& b,
               ArticulationReport& report);
  void joined(const Articulation& joint, ArticulationReport& report);
  void grown(const Articulation& joint, const Patch& a, ArticulationReport& report);
  void symphysis(const Articulation& joint, const Patch& a);
  void capsule(const Articulation& joint, const Patch& a, const Patch& b);
  std::vector<int> nodes_of(int bone, const Patch& patch) const;
  std::array<PieceNode, 4> quad_of(int bone, int quad) const;
  SurfacePatch faces_around(int bone, const std::vector<PieceNode>& nodes);
  const PlacedBone& bone(int index) const { return bones_[std::size_t(index)]; }
  std::string name(const Articulation& joint) const {
    return fmt::format("{}.{}.{}", name_of(bone(joint.a).region), name_of(joint.side), joint.name);
  }

  const std::vector<PlacedBone>& bones_;
  BetweenBones& between_;
  BoneSurfaces surface_;
  std::set<std::pair<int, int>> tied_;  // bone, node
};

// lowest and highest of some nodes of a bone, in its own frame
std::array<double, 2> heights(const PlacedBone& bone, const std::vector<int>& nodes) {
  double low = 1e30, high = -1e30;
  for (int n : nodes) {
    const double z = bone.placement.inverse(bone.nodes[std::size_t(n)]).z;
    low = std::min(low, z), high = std::max(high, z);
  }
  return {low, high};
}

// Facets: behind the body and beside the midline; arches: behind the body. Other joints take every
// face.
bool ArticulationMaker::belongs(const Articulation& joint, int index, const Point& centre) const {
  if (joint.kind != ArticulationKind::facet && joint.kind != ArticulationKind::arch) return true;
  const Point local = bone(index).placement.inverse(centre);
  // the sacrum's frame is the pelvis: its facets lie behind the promontory
  const double behind = bone(index).mesh.name == "sacrum" ? -33 : -6;
  if (joint.kind == ArticulationKind::arch) return local.x < behind * bone(index).mesh.scale.x;
  const double beside = joint.side == Side::left ? local.y : -local.y;
  return local.x < behind * bone(index).mesh.scale.x && beside > 4;
}

Patch ArticulationMaker::patch(const Articulation& joint, int index, int other, double reach,
                               Facing facing) {
  Patch found;
  const PlacedBone &here = bone(index), &first = bone(joint.a);
  // where two bones meet at both ends, the quarter of the first that the joint is in
  std::array<double, 2> z{0, 0};
  if (joint.end != BoneEnd::any) z = heights(first, surface_[joint.a].nodes());
  const auto beyond_end = [&](const Point& place) {
    if (joint.end == BoneEnd::any) return false;
    const double way = (first.placement.inverse(place).z - z[0]) / (z[1] - z[0]);
    return joint.end == BoneEnd::upper ? way <= 0.75 : way >= 0.25;
  };
  for (std::size_t q = 0; q < here.mesh.surface.size(); ++q) {
    const auto& s = here.mesh.surface[q];
    const Point x[4] = {here.nodes[std::size_t(s[0])], here.nodes[std::size_t(s[1])],
                        here.nodes[std::size_t(s[2])], here.nodes[std::size_t(s[3])]};
    const Point centre = 0.25 * (x[0] + x[1] + x[2] + x[3]);
    const SurfacePoint there = surface_[other].nearest(centre, reach);
    if (there.quad < 0 || beyond_end(centre) || !belongs(joint, index, centre)) continue;
    const Point back =
        facing == Facing::edge && there.distance > 0 ? unit(centre - there.point) : there.normal;
    if (dot(quad_normal(x[0], x[1], x[2], x[3]), back) > -0.4) continue;
    found.quads.push_back(int(q));
    found.gap = std::min(found.gap, there.distance);
  }
  return found;
}

// Adds to the faces of a head that look at its notch those all around it at their level: turned, it
// shows them.
void ArticulationMaker::go_around(const Articulation& joint, Patch& patch) const {
  const PlacedBone& head = bone(joint.a);
  const auto local = [&](int n) { return head.placement.inverse(head.nodes[std::size_t(n)]); };
  const auto [low, high] = heights(head, nodes_of(joint.a, patch));
  std::set<int> quads(patch.quads.begin(), patch.quads.end());
  for (std::size_t q = 0; q < head.mesh.surface.size(); ++q) {
    const auto& s = head.mesh.surface[q];
    const Point x[4] = {local(s[0]), local(s[1]), local(s[2]), local(s[3])};
    const double level = 0.25 * (x[0].z + x[1].z + x[2].z + x[3].z);
    if (level > low && level < high && std::abs(quad_normal(x[0], x[1], x[2], x[3]).z) < 0.5)
      quads.insert(int(q));
  }
  patch.quads.assign(quads.begin(), quads.end());
}

std::vector<int> ArticulationMaker::nodes_of(int index, const Patch& patch) const {
  std::set<int> nodes;
  for (int q : patch.quads)
    for (int n : bone(index).mesh.surface[std::size_t(q)]) nodes.insert(n);
  return {nodes.begin(), nodes.end()};
}

std::array<PieceNode, 4> ArticulationMaker::quad_of(int index, int quad) const {
  std::array<PieceNode, 4> corners;
  for (std::size_t i = 0; i < 4; ++i)
    corners[i] = bone_node(bones_, index, bone(index).mesh.surface[std::size_t(quad)][i]);
  return corners;
}

// One layer of bricks on the patch, towards the other bone; gives its free faces.
std::vector<std::array<PieceNode, 4>> ArticulationMaker::layer(const Articulation& joint, int index,
                                                               int other, const Patch& patch,
                                                               double cartilage, double& gap) {
  std::vector<std::array<PieceNode, 4>> faces;
  if (cartilage <= 0) {  // bone on bone
    for (int q : patch.quads) faces.push_back(quad_of(index, q));
    return faces;
  }
  const PlacedBone& here = bone(index);
  LayerPlan plan{layer_normals(here.nodes, here.mesh.surface, patch.quads), {}};
  std::optional<MeniscusRoom> menisci;
  if (joint.kind == ArticulationKind::meniscal) menisci.emplace(bone(joint.a), bone(joint.b));
  std::map<int, double> distances;
  for (const auto& [node, normal] : plan.normal) {
    const Point& p = here.nodes[std::size_t(node)];
    const SurfacePoint there = surface_[other].nearest(p, 4 * joint.reach);
    const double distance = there.quad < 0 ? 2 * joint.reach : there.distance;
    distances[node] = distance;
    const double room = joint.kind == ArticulationKind::grown ? distance - tied_gap
                                                              : 0.5 * (distance - contact_gap);
    if (room < thinnest) continue;  // no room for two layers: no cartilage, no contact there
    const double meniscus = menisci ? menisci->height(p) : 0;
    const double beside =
        meniscus > 0 ? std::max(room - 0.5 * meniscus, under_meniscus) : cartilage;
    plan.thickness[node] = std::clamp(std::min(room, beside), thinnest, cartilage);
  }
  if (joint.thickest > cartilage)
    fill_room(here.nodes, here.mesh.surface, patch.quads, surface_[other], contact_gap,
              joint.thickest, plan);
  PieceBuilder builder(bones_);
  std::map<int, Point> top;
  std::map<int, int> top_node;  // made when a brick needs it
  for (const auto& [node, thickness] : plan.thickness) {
    gap = std::min(gap, distances.at(node) - 2 * thickness);
    top[node] = here.nodes[std::size_t(node)] + thickness * plan.normal.at(node);
  }
  std::vector<int> covered;
  for (int q : patch.quads) {
    const auto& s = here.mesh.surface[std::size_t(q)];
    if (std::any_of(s.begin(), s.end(), [&](int n) { return !top.count(n); })) continue;
    Corners corners;
    for (std::size_t i = 0; i < 4; ++i)
      corners[i] = here.nodes[std::size_t(s[i])], corners[i + 4] = top[s[i]];
    if (scaled_jacobian(corners) < least_jacobian)
      continue;  // folds at a sharp rim: the bone stays bare
    covered.push_back(q);
  }
  if (joint.kind != ArticulationKind::facet) leave_out_tiles(here.mesh.surface, covered);
  for (int q : covered) {
    const auto& s = here.mesh.surface[std::size_t(q)];
    std::array<int, 8> brick;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!top_node.count(s[i])) top_node[s[i]] = builder.own(top[s[i]]);
      brick[i] = builder.of_bone(index, s[i]);
      brick[i + 4] = top_node[s[i]];
    }
    builder.piece.bricks.push_back(brick);
  }
  const int number = int(between_.pieces.size());
  builder.piece.name = name(joint) + ".cartilage_" + here.mesh.name;
  builder.piece.region = here.region;
  builder.piece.kind = PieceKind::brick;
  builder.piece.law = joint_law(joint.kind == ArticulationKind::grown ? joint.name : "cartilage");
  builder.piece.bone_a = builder.piece.bone_b = part_name(here, "");
  builder.piece.source = joint.source;
  for (const auto& brick : builder.piece.bricks) {
    std::array<PieceNode, 4> face;
    for (std::size_t i = 0; i < 4; ++i) face[i] = piece_node(builder.piece, number, brick[i + 4]);
    faces.push_back(face);
  }
  if (!builder.piece.bricks.empty()) between_.pieces.push_back(std::move(builder.piece));
  return faces;
}

// Takes out the faces with a corner behind the other side's faces: a contact starts without
// penetration.
void take_out_penetrating(std::vector<std::array<PieceNode, 4>>& faces,
                          const std::vector<std::array<PieceNode, 4>>& others) {
  std::erase_if(faces, [&](const std::array<PieceNode, 4>& face) {
    return std::any_of(face.begin(), face.end(), [&](const PieceNode& n) {
      return std::any_of(others.begin(), others.end(), [&](const auto& other) {
        return behind(n.x, {other[0].x, other[1].x, other[2].x, other[3].x}, touching);
      });
    });
  });
}

void ArticulationMaker::sliding(const Articulation& joint, const Patch& a, const Patch& b,
                                ArticulationReport& report) {
  report.contact_gap = 1e30;
  ContactPair contact;
  contact.name = name(joint);
  contact.friction = 0.02;
  contact.source = joint.kind == ArticulationKind::arch
                       ? "friction of bone on bone as of cartilage, 0.02; estimated"
                       : "friction of cartilage on cartilage 0.02; estimated";
  contact.a.quads = layer(joint, joint.a, joint.b, a, joint.cartilage_a, report.contact_gap);
  contact.b.quads = layer(joint, joint.b, joint.a, b, joint.cartilage_b, report.contact_gap);
  if (!contact.b.quads.empty()) take_out_penetrating(contact.a.quads, contact.b.quads);
  if (!contact.a.quads.empty()) take_out_penetrating(contact.b.quads, contact.a.quads);
  if (!contact.a.quads.empty() && !contact.b.quads.empty())
    between_.contacts.push_back(std::move(contact));
  capsule(joint, a, b);
}

// faces of a bone with a corner of those that are nearest to the nodes
SurfacePatch ArticulationMaker::faces_around(int index, const std::vector<PieceNode>& nodes) {
  const auto& quads = bone(index).mesh.surface;
  std::set<int> around;
  for (const PieceNode& n : nodes) {
    const int quad = surface_[index].nearest(n.x, 30).quad;
    around.insert(quads[std::size_t(quad)].begin(), quads[std::size_t(quad)].end());
  }
  SurfacePatch faces;
  for (std::size_t q = 0; q < quads.size(); ++q)
    if (std::any_of(quads[q].begin(), quads[q].end(), [&](int n) { return around.count(n) > 0; }))
      faces.quads.push_back(quad_of(index, int(q)));
  return faces;
}

// A layer on a whose outer nodes follow the faces of b.
void ArticulationMaker::grown(const Articulation& joint, const Patch& a,
                              ArticulationReport& report) {
  report.contact_gap = 1e30;
  Tie tie;
  tie.name = name(joint);
  std::set<int> seen;
  for (const auto& face : layer(joint, joint.a, joint.b, a, joint.cartilage_a, report.contact_gap))
    for (const PieceNode& n : face)
      if (seen.insert(n.node).second) tie.a.push_back(n);
  if (tie.a.empty()) {
    report.omitted = "no room for its layer";
    return;
  }
  tie.b = faces_around(joint.b, tie.a);
  between_.ties.push_back(std::move(tie));
}

// The nodes of a that lie nearest to b (within 3 mm of the nearest, at least six) follow the faces
// of b that lie nearest to them.
void ArticulationMaker::joined(const Articulation& joint, ArticulationReport& report) {
  std::vector<std::pair<double, int>> near;
  for (int node : surface_[joint.a].nodes()) {
    const SurfacePoint there =
        surface_[joint.b].nearest(bone(joint.a).nodes[std::size_t(node)], 30);
    if (there.quad >= 0) near.emplace_back(there.distance, node);
  }
  std::sort(near.begin(), near.end());
  Tie tie;
  tie.name = name(joint);
  for (std::size_t i = 0; i < near.size(); ++i) {
    const auto [distance, node] = near[i];
    if (i >= 6 && distance > near.front().first + 3) break;
    if (!tied_.insert({joint.a, node}).second) continue;  // a node follows one surface
    tie.a.push_back(bone_node(bones_, joint.a, node));
  }
  tie.b = faces_around(joint.b, tie.a);
  report.faces_a = int(tie.a.size()), report.faces_b = int(tie.b.quads.size());
  if (tie.a.empty()) {
    report.omitted = "no nodes within 30 mm";
    return;
  }
  report.gap = near.front().first;
  between_.ties.push_back(std::move(tie));
}

// The left hip bone is the mirror image of the right one node by node: bricks between a face and
// its image.
void ArticulationMaker::symphysis(const Articulation& joint, const Patch& a) {
  constexpr int layers = 2;
  PieceBuilder builder(bones_);
  const auto place = [&](int node, int k) {
    const double t = double(k) / layers;
    return (1 - t) * bone(joint.a).nodes[std::size_t(node)] +
           t * bone(joint.b).nodes[std::size_t(node)];
  };
  std::map<std::pair<int, int>, int> made;  // node of the bone, layer -> node of the piece
  const auto level = [&](int node, int k) {
    const auto [at, fresh] = made.try_emplace({node, k}, -1);
    if (fresh)
      at->second = k == 0        ? builder.of_bone(joint.a, node)
                   : k == layers ? builder.of_bone(joint.b, node)
                                 : builder.own(place(node, k));
    return at->second;
  };
  for (int q : a.quads) {
    const auto& s = bone(joint.a).mesh.surface[std::size_t(q)];
    Corners corners;
    for (std::size_t i = 0; i < 4; ++i)
      corners[i] = place(s[i], 0), corners[i + 4] = place(s[i], layers);
    if (scaled_jacobian(corners) < least_jacobian) continue;  // askew at the rim
    for (int k = 0; k < layers; ++k) {
      std::array<int, 8> brick;
      for (std::size_t i = 0; i < 4; ++i)
        brick[i] = level(s[i], k), brick[i + 4] = level(s[i], k + 1);
      builder.piece.bricks.push_back(brick);
    }
  }
  builder.piece.name = name(joint) + ".disc";
  builder.piece.region = bone(joint.a).region;
  builder.piece.kind = PieceKind::brick;
  builder.piece.law = joint_law("symphysis");
  // pubic bones shift on it: one-point bricks would give way in modes that strain nothing
  builder.piece.formulation = -1;
  builder.piece.bone_a = part_name(bone(joint.a), "");
  builder.piece.bone_b = part_name(bone(joint.b), "");
  builder.piece.source = joint.source;
  between_.pieces.push_back(std::move(builder.piece));
}

// Strands around the joint: the node of a's faces that lies farthest out in each sector about their
// middle, to the nearest node of b's faces.
void ArticulationMaker::capsule(const Articulation& joint, const Patch& a, const Patch& b) {
  CapsuleLaw law{
      {capsule_length, joint.stiffness, 0, 0, 0}, joint.strands, joint.source, "estimated"};
  if (joint.kind == ArticulationKind::facet)
    law = facet_capsule(bone(joint.a).mesh.name, bone(joint.b).mesh.name);
  if (law.strands == 0) return;

  const std::vector<int> nodes_a = nodes_of(joint.a, a), nodes_b = nodes_of(joint.b, b);
  Point centre{0, 0, 0}, normal{0, 0, 0};
  for (int n : nodes_a) {
    centre += (1.0 / double(nodes_a.size())) * bone(joint.a).nodes[std::size_t(n)];
    normal += surface_[joint.a].node_normal(n);
  }
  normal = norm(normal) > 1e-9 ? (1 / norm(normal)) * normal : Point{0, 0, 1};
  const Point first = std::abs(normal.x) < 0.7 ? Point{1, 0, 0} : Point{0, 1, 0};
  Point e1 = cross(normal, first);
  e1 = (1 / norm(e1)) * e1;
  const Point e2 = cross(normal, e1);

  std::vector<int> chosen(std::size_t(law.strands), -1);
  std::vector<double> radius(std::size_t(law.strands), -1);
  for (int n : nodes_a) {
    const Point d = bone(joint.a).nodes[std::size_t(n)] - centre;
    const double angle = std::atan2(dot(d, e2), dot(d, e1)) + M_PI;
    const std::size_t sector =
        std::size_t(std::min(int(angle / (2 * M_PI) * law.strands), law.strands - 1));
    if (norm(d) > radius[sector]) radius[sector] = norm(d), chosen[sector] = n;
  }
  PieceBuilder builder(bones_);
  for (int n : chosen) {
    if (n < 0) continue;
    const Point& p = bone(joint.a).nodes[std::size_t(n)];
    const int m = *std::min_element(nodes_b.begin(), nodes_b.end(), [&](int i, int j) {
      return norm(bone(joint.b).nodes[std::size_t(i)] - p) <
             norm(bone(joint.b).nodes[std::size_t(j)] - p);
    });
    builder.piece.lines.push_back({builder.of_bone(joint.a, n), builder.of_bone(joint.b, m)});
  }
  // empty sectors: the others carry their share
  const int strands = int(builder.piece.lines.size());
  builder.piece.name = name(joint) + ".capsule";
  builder.piece.region = bone(joint.a).region;
  builder.piece.kind = PieceKind::spring;
  builder.piece.law = ligament_curve(law.stiffness, strands, law.source, law.flag);
  builder.piece.bone_a = part_name(bone(joint.a), "");
  builder.piece.bone_b = part_name(bone(joint.b), "");
  builder.piece.source = law.source;
  between_.pieces.push_back(std::move(builder.piece));
}

ArticulationReport ArticulationMaker::add(const Articulation& joint) {
  ArticulationReport report;
  report.name = name(joint);
  if (joint.kind == ArticulationKind::joined) {
    joined(joint, report);
    return report;
  }
  Patch a, b;
  const auto look = [&](double factor, Facing facing) {
    report.reach = factor * joint.reach;
    a = patch(joint, joint.a, joint.b, report.reach, facing);
    b = patch(joint, joint.b, joint.a, report.reach, facing);
    return a.quads.size() >= 2 && b.quads.size() >= 2;
  };
  // Bones that stand farther apart than the table says are looked for farther. The round head of a
  // bent finger is a few coarse faces, which may all look past the other bone: their edges do not.
  const auto found = [&](Facing facing) {
    return look(1, facing) || look(1.5, facing) || look(2, facing) || look(3, facing);
  };
  if (!found(Facing::quad) && (a.quads.empty() || b.quads.empty())) found(Facing::edge);
  if (joint.kind == ArticulationKind::pivot && !a.quads.empty()) go_around(joint, a);
  report.faces_a = int(a.quads.size()), report.faces_b = int(b.quads.size());
  report.gap = std::min(a.gap, b.gap);
  if (a.quads.empty() || b.quads.empty()) {
    report.omitted = fmt::format("no faces look at each other within {:g} mm", report.reach);
    return report;
  }
  if (joint.kind == ArticulationKind::symphysis)
    symphysis(joint, a);
  else if (joint.kind == ArticulationKind::grown)
    grown(joint, a, report);
  else
    sliding(joint, a, b, report);
  return report;
}

}  // namespace

std::vector<ArticulationReport> add_articulations(const std::vector<PlacedBone>& bones,
                                                  BetweenBones& between) {
  ArticulationMaker maker(bones, between);
  std::vector<ArticulationReport> reports;
  for (const Articulation& joint : articulations(bones)) reports.push_back(maker.add(joint));
  return reports;
}

}  // namespace fabrica::body
