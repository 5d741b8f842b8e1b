#include "body/joints/articulation.h"

#include <algorithm>

#include "body/tables.h"

namespace fabrica::body {

namespace {

ArticulationKind kind_of(const Table& table, int row) {
  const std::string& kind = table.text(row, "kind");
  if (kind == "sliding") return ArticulationKind::sliding;
  if (kind == "pivot") return ArticulationKind::pivot;
  if (kind == "meniscal") return ArticulationKind::meniscal;
  if (kind == "facet") return ArticulationKind::facet;
  if (kind == "arch") return ArticulationKind::arch;
  if (kind == "joined") return ArticulationKind::joined;
  if (kind == "grown") return ArticulationKind::grown;
  if (kind == "symphysis") return ArticulationKind::symphysis;
  table.fail(row, "kind is \"" + kind +
                      "\": one of sliding, pivot, meniscal, facet, arch, joined, grown, symphysis");
}

BoneEnd end_of(const Table& table, int row) {
  const std::string& end = table.text(row, "end");
  if (end.empty()) return BoneEnd::any;
  if (end == "upper") return BoneEnd::upper;
  if (end == "lower") return BoneEnd::lower;
  table.fail(row, "end is \"" + end + "\": upper, lower or nothing");
}

// a bone of one side, else of the midline; "_L" at the end of a name asks for the left one
int bone_of_side(const std::vector<PlacedBone>& bones, std::string name, Side side) {
  if (name.ends_with("_L")) {
    name.resize(name.size() - 2);
    side = Side::left;
  }
  const int sided = find_bone(bones, name, side);
  return sided >= 0 ? sided : find_bone(bones, name, Side::midline);
}

}  // namespace

std::vector<Articulation> articulations(const std::vector<PlacedBone>& bones) {
  const Table table("anatomy/joints/articulations.csv");
  std::vector<Articulation> joints;
  for (int row = 0; row < table.rows(); ++row) {
    Articulation joint{table.text(row, "name"),
                       Side::right,
                       -1,
                       -1,
                       kind_of(table, row),
                       table.number(row, "cartilage1"),
                       table.number(row, "cartilage2"),
                       table.number(row, "thickest"),
                       table.number(row, "reach"),
                       end_of(table, row),
                       int(table.number(row, "strands")),
                       1e-3 * table.number(row, "stiffness"),
                       table.text(row, "source")};
    for (Side side : {Side::right, Side::left}) {
      joint.side = side;
      joint.a = bone_of_side(bones, table.text(row, "bone1"), side);
      joint.b = bone_of_side(bones, table.text(row, "bone2"), side);
      if (joint.a < 0 || joint.b < 0 || joint.a == joint.b) continue;
      const auto midline = [&](int bone) { return bones[std::size_t(bone)].side == Side::midline; };
      // two midline bones meet at both sides only where the row says so
      if (midline(joint.a) && midline(joint.b) && joint.kind != ArticulationKind::facet) {
        if (side == Side::left) continue;
        joint.side = Side::midline;
      }
      if (joint.kind == ArticulationKind::symphysis) {
        if (side == Side::left) continue;
        joint.side = Side::midline;
      }
      joints.push_back(joint);
    }
  }
  return joints;
}

double wanted_gap(const Articulation& joint) {
  const double contact = 0.2;  // between the two layers of cartilage
  const double room = 1.4;     // a bone gives way by 0.8 mm at most: half of room and contact
  if (joint.kind == ArticulationKind::joined || joint.kind == ArticulationKind::symphysis)
    return 0.05;
  // bone on bone: contact keeps half the thickness of either cortex between the surfaces
  if (joint.cartilage_a + joint.cartilage_b <= 0) return contact + 1.2;
  return contact + std::min(joint.cartilage_a + joint.cartilage_b, room);
}

double plateau_gap(const Articulation& joint) {
  return 0.1 + joint.cartilage_a + joint.cartilage_b;
}

}  // namespace fabrica::body
