#pragma once
// Fills a piece: nodes of its own, of a bone or of an earlier piece, each listed once.
#include <map>
#include <tuple>

#include "body/piece.h"

namespace fabrica::body {

class PieceBuilder {
 public:
  explicit PieceBuilder(const std::vector<PlacedBone>& bones) : bones_(bones) {}

  int own(const Point& x) {
    piece.nodes.push_back({x, -1, -1, -1});
    return int(piece.nodes.size()) - 1;
  }
  int of_bone(int bone, int node) {
    return shared({bones_[std::size_t(bone)].nodes[std::size_t(node)], bone, -1, node});
  }
  int of_piece(const std::vector<Piece>& pieces, int index, int node) {
    const PieceNode& there = pieces[std::size_t(index)].nodes[std::size_t(node)];
    if (there.bone >= 0) return of_bone(there.bone, there.node);
    return shared({there.x, -1, index, node});
  }
  const Point& at(int node) const { return piece.nodes[std::size_t(node)].x; }

  Piece piece;

 private:
  int shared(const PieceNode& node) {
    const auto [it, fresh] =
        index_.try_emplace({node.bone, node.piece, node.node}, int(piece.nodes.size()));
    if (fresh) piece.nodes.push_back(node);
    return it->second;
  }
  const std::vector<PlacedBone>& bones_;
  std::map<std::tuple<int, int, int>, int> index_;
};

// a node of a bone as the corner of a patch
inline PieceNode bone_node(const std::vector<PlacedBone>& bones, int bone, int node) {
  return {bones[std::size_t(bone)].nodes[std::size_t(node)], bone, -1, node};
}
// node `node` of piece `index` as the corner of a patch
inline PieceNode piece_node(const Piece& piece, int index, int node) {
  const PieceNode& n = piece.nodes[std::size_t(node)];
  return n.bone >= 0 || n.piece >= 0 ? n : PieceNode{n.x, -1, index, node};
}

}  // namespace fabrica::body
