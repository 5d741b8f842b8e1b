#include <algorithm>
#include <set>

#include "body/joints/meniscus_mesh.h"
#include "body/mesh/shell_layer.h"

namespace fabrica::body {

Knee::Faces knee_faces(const std::vector<PlacedBone>& bones, int index, const BetweenBones& between,
                       const std::string& cartilage) {
  Knee::Faces faces;
  std::set<std::array<int, 4>> covered;
  const auto sorted = [](std::array<int, 4> q) {
    std::sort(q.begin(), q.end());
    return q;
  };
  for (std::size_t p = 0; p < between.pieces.size(); ++p) {
    const Piece& piece = between.pieces[p];
    if (piece.name != cartilage) continue;
    for (const auto& brick : piece.bricks) {
      std::array<int, 4> base;
      std::array<PieceNode, 4> face;
      for (std::size_t i = 0; i < 4; ++i) {
        base[i] = piece.nodes[std::size_t(brick[i])].node;
        face[i] = piece_node(piece, int(p), brick[i + 4]);
      }
      covered.insert(sorted(base));
      faces.patch.push_back(face);
      faces.shell.push_back(0), faces.corner_shell.push_back({0, 0, 0, 0});
    }
  }
  const BoneMesh& mesh = bones[std::size_t(index)].mesh;
  std::vector<double> shell;
  if (!mesh.cortex.empty()) shell = shell_thickness(mesh, mesh.cortex);
  shell.resize(mesh.surface.size(), 0);
  std::vector<double> around(mesh.nodes.size(), 0);
  for (std::size_t q = 0; q < mesh.surface.size(); ++q)
    for (const int n : mesh.surface[q])
      around[std::size_t(n)] = std::max(around[std::size_t(n)], 0.5 * shell[q]);
  for (std::size_t q = 0; q < mesh.surface.size(); ++q) {
    if (covered.count(sorted(mesh.surface[q]))) continue;
    std::array<PieceNode, 4> face;
    for (std::size_t i = 0; i < 4; ++i) face[i] = bone_node(bones, index, mesh.surface[q][i]);
    faces.patch.push_back(face);
    faces.shell.push_back(0.5 * shell[q]);
    std::array<double, 4>& corners = faces.corner_shell.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) corners[i] = around[std::size_t(mesh.surface[q][i])];
  }
  for (const auto& face : faces.patch) {
    std::array<int, 4> quad;
    for (std::size_t i = 0; i < 4; ++i) {
      quad[i] = int(faces.nodes.size());
      faces.nodes.push_back(face[i].x);
    }
    faces.quads.push_back(quad);
  }
  return faces;
}

bool clear_of(const std::array<PieceNode, 4>& face, double shell,
              const std::array<double, 4>& corner_shell,
              const std::vector<std::array<PieceNode, 4>>& others) {
  const auto places = [](const std::array<PieceNode, 4>& f) {
    return std::array<Point, 4>{f[0].x, f[1].x, f[2].x, f[3].x};
  };
  const std::array<Point, 4> here = places(face);
  return std::none_of(others.begin(), others.end(), [&](const auto& other) {
    const std::array<Point, 4> there = places(other);
    for (std::size_t i = 0; i < 4; ++i)
      if (behind(here[i], there, corner_shell[i] + touching) ||
          behind(there[i], here, shell + touching))
        return true;
    return false;
  });
}

}  // namespace fabrica::body
