#include "body/joints/ligaments.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "body/joints/bone_surfaces.h"
#include "body/joints/joint_law.h"
#include "body/joints/piece_builder.h"
#include "body/tables.h"

namespace fabrica::body {

namespace {

constexpr double farthest = 25;  // [mm] of an end from its bone
// A ligament that winds around a head and glides on it pulls at the head's axis: it ends in a node
// there that spokes hold, one to the nearest node of the bone in each octant.
constexpr double nearest_spoke = 3, farthest_spoke = 25;  // [mm]
constexpr double spoke_area = 10;                         // [mm2]

struct End {
  int bone;
  Point place;  // global, of the table
};

class LigamentMaker {
 public:
  LigamentMaker(const std::vector<PlacedBone>& bones, BetweenBones& between)
      : bones_(bones), between_(between), surface_(bones) {}

  void add(const Table& table, int row, Side side);
  std::vector<LigamentReport> reports;

 private:
  int bone_of(std::string name, Side side) const {
    if (name.ends_with("_L")) {
      name.resize(name.size() - 2);
      side = Side::left;
    }
    const int sided = find_bone(bones_, name, side);
    return sided >= 0 ? sided : find_bone(bones_, name, Side::midline);
  }
  End end(const Table& table, int row, Side side, const char* number) const;
  // piece whose node 0 is the middle of spokes in a bone, made once
  int hub(const End& end, const std::string& name, const std::string& source);

  const std::vector<PlacedBone>& bones_;
  BetweenBones& between_;
  BoneSurfaces surface_;
  std::map<int, std::vector<int>> hubs_;  // of a bone: pieces whose node 0 is the hub
};

End LigamentMaker::end(const Table& table, int row, Side side, const char* number) const {
  const std::string n = number;
  const int bone = bone_of(table.text(row, "bone" + n), side);
  if (bone < 0) return {-1, {}};
  const PlacedBone& b = bones_[std::size_t(bone)];
  Point p{table.number(row, "x" + n), table.number(row, "y" + n), table.number(row, "z" + n)};
  if (side == Side::left) p.y = -p.y;
  for (int i = 0; i < 3; ++i) p[i] *= b.mesh.scale[i];
  return {bone, b.placement(p)};
}

int LigamentMaker::hub(const End& end, const std::string& name, const std::string& source) {
  for (int made : hubs_[end.bone])
    if (norm(between_.pieces[std::size_t(made)].nodes[0].x - end.place) < 1) return made;
  const PlacedBone& bone = bones_[std::size_t(end.bone)];
  std::array<int, 8> nearest;
  nearest.fill(-1);
  std::array<double, 8> distance;
  distance.fill(farthest_spoke);
  const Point place = bone.placement.inverse(end.place);
  for (std::size_t n = 0; n < bone.nodes.size(); ++n) {
    const Point d = bone.placement.inverse(bone.nodes[n]) - place;
    const std::size_t octant = std::size_t((d.x > 0) + 2 * (d.y > 0) + 4 * (d.z > 0));
    if (norm(d) < nearest_spoke || norm(d) >= distance[octant]) continue;
    nearest[octant] = int(n), distance[octant] = norm(d);
  }
  PieceBuilder builder(bones_);
  builder.own(end.place);
  for (int n : nearest)
    if (n >= 0) builder.piece.lines.push_back({0, builder.of_bone(end.bone, n)});
  builder.piece.name = name + "_hub";
  builder.piece.region = bone.region;
  builder.piece.kind = PieceKind::truss;
  builder.piece.area = spoke_area;
  builder.piece.law = joint_law("spokes");
  builder.piece.bone_a = builder.piece.bone_b = part_name(bone, "");
  builder.piece.source = source;
  between_.pieces.push_back(std::move(builder.piece));
  hubs_[end.bone].push_back(int(between_.pieces.size()) - 1);
  return hubs_[end.bone].back();
}

LigamentStiffness stiffness_of(const Table& table, int row) {
  LigamentStiffness law;
  law.length = table.number(row, "length");
  law.k1 = 1e-3 * table.number(row, "k1");
  if (!table.text(row, "strain1").empty()) {
    law.strain1 = table.number(row, "strain1");
    law.k2 = 1e-3 * table.number(row, "k2");
  }
  if (!table.text(row, "toe").empty()) {
    law.toe = table.number(row, "toe");
    law.toe_force = 1e-3 * table.number(row, "toe_force");
    if (law.toe <= 0 || law.toe_force <= 0 || law.k1 * law.toe < law.toe_force)
      table.fail(
          row, "a toe has a length, a force, and at its end a slope k1 of at least force / length");
  }
  return law;
}

// places of n strands across the ligament
std::vector<Point> spread(const Point& centre, const Point& lateral, int n, double breadth) {
  std::vector<Point> places;
  for (int i = 0; i < n; ++i)
    places.push_back(centre + (n == 1 ? 0.0 : breadth * (i / (n - 1.0) - 0.5)) * lateral);
  return places;
}

// a line between two nodes of the piece; two strands on one pair are one of double force
void add_strand(Piece& piece, const std::array<int, 2>& ends) {
  const auto line = std::find(piece.lines.begin(), piece.lines.end(), ends);
  if (line == piece.lines.end())
    piece.lines.push_back(ends), piece.line_scale.push_back(1);
  else
    piece.line_scale[std::size_t(line - piece.lines.begin())] += 1;
}

// strands of one piece between the surface nodes nearest to the given places
void tie_strands(PieceBuilder& builder, const BoneSurface& a, const BoneSurface& b, End from,
                 End to, const std::vector<Point>& starts, const std::vector<Point>& ends) {
  for (std::size_t i = 0; i < starts.size(); ++i) {
    double distance;
    const int start = builder.of_bone(from.bone, a.nearest_node(starts[i], distance));
    const int end = builder.of_bone(to.bone, b.nearest_node(ends[i], distance));
    add_strand(builder.piece, {start, end});
  }
}

// strands of one piece between the surface nodes nearest to the given places and a hub
void tie_to_hub(PieceBuilder& builder, const BoneSurface& a, End from,
                const std::vector<Point>& starts, const std::vector<Piece>& pieces, int hub) {
  for (const Point& place : starts) {
    double distance;
    const int start = builder.of_bone(from.bone, a.nearest_node(place, distance));
    const int end = builder.of_piece(pieces, hub, 0);
    add_strand(builder.piece, {start, end});
  }
}

void LigamentMaker::add(const Table& table, int row, Side side) {
  const End from = end(table, row, side, "1"), to = end(table, row, side, "2");
  if (from.bone < 0 || to.bone < 0) return;
  const PlacedBone &bone_a = bones_[std::size_t(from.bone)], &bone_b = bones_[std::size_t(to.bone)];
  LigamentStiffness law = stiffness_of(table, row);
  const int strands = int(table.number(row, "strands"));

  // across the ligament, along the bone it starts from
  const Point along = to.place - from.place;
  double start_distance, end_distance;
  const int start_node = surface_[from.bone].nearest_node(from.place, start_distance);
  surface_[to.bone].nearest_node(to.place, end_distance);
  const Point& normal = surface_[from.bone].node_normal(start_node);
  Point lateral = cross(norm(along) > 1 ? along : Point{0, 0, 1}, normal);
  lateral = norm(lateral) > 1e-6 ? (1 / norm(lateral)) * lateral : Point{0, 1, 0};
  const double breadth = table.number(row, "spread") * bone_a.mesh.scale.y;

  PieceBuilder builder(bones_);
  LigamentReport report;
  const std::string side_name = name_of(table.text(row, "side") == "M" ? Side::midline : side);
  report.name = fmt::format("{}.{}.{}", name_of(bone_a.region), side_name, table.text(row, "name"));
  report.distance = std::max(start_distance, end_distance);
  const std::vector<Point> starts = spread(from.place, lateral, strands, breadth);
  if (table.text(row, "attach") == "around")
    tie_to_hub(builder, surface_[from.bone], from, starts, between_.pieces,
               hub(to, report.name, table.text(row, "source")));
  else
    tie_strands(builder, surface_[from.bone], surface_[to.bone], from, to, starts,
                spread(to.place, lateral, strands, breadth));
  if (report.distance > farthest && table.text(row, "attach") != "muscle")
    table.fail(row, fmt::format("an end lies {:.1f} mm from its bone, at most {} is possible",
                                report.distance, farthest));
  const double size = (bone_a.mesh.scale.x + bone_a.mesh.scale.y + bone_a.mesh.scale.z) / 3;
  report.reference = law.length * size;
  report.length = norm(along);
  law.slack = std::max(report.reference - std::max(report.length, 4.0), 0.0);
  law.length = report.reference;
  law.toe *= size, law.toe_force *= size;
  report.strands = int(builder.piece.lines.size());
  report.slack = law.slack, report.stiffness = law.k1;

  builder.piece.name = report.name;
  builder.piece.region = bone_a.region;
  builder.piece.kind = PieceKind::spring;
  builder.piece.law =
      ligament_curve(law, strands, table.text(row, "source"), table.text(row, "confidence"));
  builder.piece.bone_a = part_name(bone_a, ""), builder.piece.bone_b = part_name(bone_b, "");
  builder.piece.source = table.text(row, "source");
  between_.pieces.push_back(std::move(builder.piece));
  reports.push_back(report);
}

}  // namespace

std::vector<LigamentReport> add_ligaments(const std::vector<PlacedBone>& bones,
                                          BetweenBones& between) {
  const Table table("anatomy/joints/ligaments.csv");
  LigamentMaker maker(bones, between);
  for (int row = 0; row < table.rows(); ++row) {
    if (table.text(row, "attach") == "facet") continue;  // made with the joint
    maker.add(table, row, Side::right);
    if (table.text(row, "side") == "R") maker.add(table, row, Side::left);
  }
  return std::move(maker.reports);
}

CapsuleLaw facet_capsule(const std::string& upper, const std::string& lower) {
  const Table table("anatomy/joints/ligaments.csv");
  const std::string name = "CL_" + upper + "_" + (lower == "sacrum" ? "S1" : lower);
  const std::string instead = upper == "L5" ? "CL_L4_L5" : "CL_C3_C4";
  int found = -1;
  for (int row = 0; row < table.rows(); ++row) {
    if (table.text(row, "name") == name) found = row;
    if (found < 0 && table.text(row, "name") == instead) found = row;
  }
  if (found < 0) throw BodyError("ligaments.csv: no facet capsule " + name);
  return {stiffness_of(table, found), int(table.number(found, "strands")),
          table.text(found, "source"), table.text(found, "confidence")};
}

}  // namespace fabrica::body
