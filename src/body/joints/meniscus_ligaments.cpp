#include <fmt/format.h>

#include <cmath>

#include "body/joints/ligament_law.h"
#include "body/joints/meniscus_mesh.h"
#include "body/tables.h"

namespace fabrica::body {

namespace {

constexpr double farthest = 25;  // [mm] of an end from its bone

class StrandMaker {
 public:
  StrandMaker(const std::vector<PlacedBone>& bones, const Knee& knee, const Table& table, int row,
              BetweenBones& between)
      : bones_(bones), knee_(knee), table_(table), row_(row), between_(between), builder_(bones) {}
  void root(const MeniscusMesh& mesh);
  void coronary(const MeniscusMesh& mesh);
  void across(const MeniscusMesh& from, const MeniscusMesh& to);
  void finish();

 private:
  // nodes of the section at an end
  std::vector<int> section(const MeniscusMesh& mesh) const;
  const Point& place(const MeniscusMesh& mesh, int node) const {
    return between_.pieces[std::size_t(mesh.piece)].nodes[std::size_t(node)].x;
  }
  int own(const MeniscusMesh& mesh, int node) {
    return builder_.of_piece(between_.pieces, mesh.piece, node);
  }
  void strand(int from, int to, double stiffness) {
    builder_.piece.lines.push_back({from, to});
    builder_.piece.line_scale.push_back(stiffness);
  }

  const std::vector<PlacedBone>& bones_;
  const Knee& knee_;
  const Table& table_;
  int row_;
  BetweenBones& between_;
  PieceBuilder builder_;
};

std::vector<int> StrandMaker::section(const MeniscusMesh& mesh) const {
  const bool anterior = table_.text(row_, "end") == "anterior";
  if (!anterior && table_.text(row_, "end") != "posterior")
    table_.fail(row_, "end is \"" + table_.text(row_, "end") + "\": anterior or posterior");
  std::vector<int> nodes;
  // the first section that was meshed
  for (int n = 0; n <= mesh.along && nodes.empty(); ++n)
    for (int j = 0; j <= mesh.across; ++j)
      for (int k = 0; k <= mesh.layers; ++k)
        if (const int node = mesh.at(anterior ? n : mesh.along - n, j, k); node >= 0)
          nodes.push_back(node);
  return nodes;
}

// every node of the section to the node of the bone nearest to the root, half as far from its
// middle
void StrandMaker::root(const MeniscusMesh& mesh) {
  const int index = table_.text(row_, "bone") == "femur" ? knee_.femur : knee_.tibia;
  const PlacedBone& bone = bones_[std::size_t(index)];
  Point p{table_.number(row_, "x"), table_.number(row_, "y"), table_.number(row_, "z")};
  for (int i = 0; i < 3; ++i) p[i] *= bone.mesh.scale[i];
  if (knee_.side == Side::left) p.y = -p.y;
  p = bone.placement(p);
  const std::vector<int> nodes = section(mesh);
  Point middle{0, 0, 0};
  for (const int n : nodes) middle += (1.0 / double(nodes.size())) * place(mesh, n);
  const BoneSurface surface(bone.nodes, bone.mesh.surface);
  const double stiffness = 1e-3 * table_.number(row_, "stiffness") / double(nodes.size());
  for (const int n : nodes) {
    double distance;
    const int there = surface.nearest_node(p + 0.5 * (place(mesh, n) - middle), distance);
    if (distance > farthest)
      table_.fail(row_, fmt::format("its end lies {:.1f} mm from its bone, at most {} is possible",
                                    distance, farthest));
    strand(own(mesh, n), builder_.of_bone(index, there), stiffness);
  }
}

// the lower edge of the rim to the nearest nodes of the tibia, k = c b / L with the breadth b
void StrandMaker::coronary(const MeniscusMesh& mesh) {
  const PlacedBone& tibia = bones_[std::size_t(knee_.tibia)];
  const BoneSurface surface(tibia.nodes, tibia.mesh.surface);
  const double from = table_.number(row_, "from"), to = table_.number(row_, "to");
  for (int i = 0; i <= mesh.along; ++i) {
    if (i * mesh.ds < from || i * mesh.ds > to) continue;
    const int node = mesh.at(i, mesh.across, 0);
    if (node < 0) continue;
    double breadth = 0, distance;
    for (const int n : {i - 1, i + 1})
      if (n >= 0 && n <= mesh.along && mesh.at(n, mesh.across, 0) >= 0)
        breadth += 0.5 * norm(place(mesh, mesh.at(n, mesh.across, 0)) - place(mesh, node));
    // outside and below the rim: seen from the middle of the sweep outwards, half the way down
    const int there = surface.nearest_node(place(mesh, node), distance);
    strand(own(mesh, node), builder_.of_bone(knee_.tibia, there),
           1e-3 * table_.number(row_, "stiffness") * breadth / std::max(distance, 1.0));
  }
}

// node by node between the sections of two menisci
void StrandMaker::across(const MeniscusMesh& from, const MeniscusMesh& to) {
  const std::vector<int> a = section(from), b = section(to);
  const std::size_t count = std::min(a.size(), b.size());
  for (std::size_t n = 0; n < count; ++n)
    strand(own(from, a[n]), own(to, b[n]), 1e-3 * table_.number(row_, "stiffness") / double(count));
}

void StrandMaker::finish() {
  if (builder_.piece.lines.empty()) return;  // of a stretch without a brick
  const PlacedBone& tibia = bones_[std::size_t(knee_.tibia)];
  builder_.piece.name = fmt::format("{}.{}.{}", name_of(tibia.region), name_of(knee_.side),
                                    table_.text(row_, "name"));
  builder_.piece.region = tibia.region;
  builder_.piece.kind = PieceKind::spring;
  builder_.piece.law = pull_only(table_.text(row_, "source"), table_.text(row_, "flag"));
  builder_.piece.source = table_.text(row_, "source");
  builder_.piece.bone_a = part_name(tibia, "");
  builder_.piece.bone_b = table_.text(row_, "bone") == "femur"
                              ? part_name(bones_[std::size_t(knee_.femur)], "")
                              : builder_.piece.bone_a;
  between_.pieces.push_back(std::move(builder_.piece));
}

}  // namespace

void add_meniscus_ligaments(const std::vector<PlacedBone>& bones, const Knee& knee,
                            const std::vector<std::pair<MeniscusPlan, MeniscusMesh>>& menisci,
                            BetweenBones& between) {
  const Table table("anatomy/joints/meniscus_ligaments.csv");
  for (int row = 0; row < table.rows(); ++row) {
    const MeniscusMesh *of = nullptr, *other = nullptr;
    for (const auto& [plan, mesh] : menisci)
      (plan.name() == table.text(row, "meniscus") ? of : other) = &mesh;
    if (!of) table.fail(row, "no meniscus \"" + table.text(row, "meniscus") + "\"");
    StrandMaker maker(bones, knee, table, row, between);
    const std::string& kind = table.text(row, "kind");
    if (kind == "root")
      maker.root(*of);
    else if (kind == "coronary")
      maker.coronary(*of);
    else if (kind == "between" && other)
      maker.across(*of, *other);
    else
      table.fail(row, "kind is \"" + kind + "\": one of root, coronary, between");
    maker.finish();
  }
}

}  // namespace fabrica::body
