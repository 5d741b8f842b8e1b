#include "body/joints/join_bones.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "body/joints/symphysis.h"

namespace fabrica::body {

namespace {

// disjoint sets: bones first, then pieces
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int root(int i) {
    while (parent_[std::size_t(i)] != i) i = parent_[std::size_t(i)];
    return i;
  }
  void join(int i, int j) { parent_[std::size_t(root(i))] = root(j); }

 private:
  std::vector<int> parent_;
};

}  // namespace

BetweenBones join_bones(std::vector<PlacedBone>& bones, JoinReport& report) {
  BetweenBones between;
  report.endplate_shift = fit_endplates(bones);
  report.symphysis_shift = fit_symphysis(bones);
  report.clearance = clear_bones(bones);
  report.discs = add_discs(bones, between);
  report.articulations = add_articulations(bones, between);
  report.menisci = add_menisci(bones, between);
  report.ligaments = add_ligaments(bones, between);
  return between;
}

std::vector<std::string> unconnected(const std::vector<PlacedBone>& bones,
                                     const BetweenBones& between) {
  const int first_piece = int(bones.size());
  Groups groups(bones.size() + between.pieces.size());
  const auto owner = [&](const PieceNode& n) {
    return n.bone >= 0 ? n.bone : n.piece >= 0 ? first_piece + n.piece : -1;
  };
  for (std::size_t k = 0; k < between.pieces.size(); ++k)
    for (const PieceNode& n : between.pieces[k].nodes)
      if (owner(n) >= 0) groups.join(first_piece + int(k), owner(n));
  const auto join_sides = [&](const auto& a, const auto& b) {
    if (owner(a) >= 0 && owner(b) >= 0) groups.join(owner(a), owner(b));
  };
  // a tie holds; a contact alone would let a part fall out and does not count
  for (const Tie& tie : between.ties)
    if (!tie.a.empty() && !tie.b.quads.empty()) join_sides(tie.a.front(), tie.b.quads.front()[0]);

  std::map<int, int> size;
  const int count = first_piece + int(between.pieces.size());
  for (int i = 0; i < count; ++i) ++size[groups.root(i)];
  int largest = -1, most = 0;
  for (const auto& [root, members] : size)
    if (members > most) most = members, largest = root;
  std::vector<std::string> alone;
  for (int i = 0; i < count; ++i)
    if (groups.root(i) != largest)
      alone.push_back(i < first_piece ? part_name(bones[std::size_t(i)], "")
                                      : between.pieces[std::size_t(i - first_piece)].name);
  return alone;
}

}  // namespace fabrica::body
