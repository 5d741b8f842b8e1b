#include "body/joints/mend.h"

#include "body/mesh/polish.h"
#include "body/mesh/quality.h"

namespace fabrica::body {

void mend(const BoneMesh& mesh, std::vector<Point>& nodes, bool own, const BoneSurface& surface,
          const std::vector<PlaneNode>& planes) {
  constexpr double jacobian = 0.44;  // wish
  constexpr double surface_weight = 100;
  UntangleProblem problem;
  problem.bricks = mesh.bricks;
  if (own) problem.image = mesh.image;
  problem.spacing = 0;
  for (const Brick& brick : mesh.bricks)
    for (float l : edge_lengths(corners_of(nodes, brick)))
      problem.spacing += l / (3.0 * double(mesh.bricks.size()));
  for (std::size_t q = 0; q < mesh.cortex.size(); ++q)
    if (mesh.cortex[q] > 0) problem.shells.push_back(mesh.surface[q]);
  for (int n : surface.nodes())
    problem.planes.push_back(
        {n, nodes[std::size_t(n)], surface.node_normal(n), surface_weight, false});
  problem.planes.insert(problem.planes.end(), planes.begin(), planes.end());
  PolishOptions options;
  options.jacobian = jacobian;
  options.size = 0.25 * problem.spacing;
  options.shell_size = problem.shells.empty() ? 0 : mesh.shell_wish;
  options.sweeps = 30;
  polish(problem, nodes, options);
}

std::vector<PlaneNode> planes_of(const std::vector<Touch>& touches, int bone, int twin,
                                 const std::vector<PlacedBone>& bones) {
  constexpr double weight = 2000;
  std::vector<PlaneNode> planes;
  for (const Touch& t : touches) {
    if (t.a != bone && t.a != twin) continue;
    Point place = t.gap * t.normal;
    for (std::size_t i = 0; i < 4; ++i)
      place += t.weight[i] * bones[std::size_t(t.b)].nodes[std::size_t(t.quad[i])];
    const bool image = t.a == twin;
    planes.push_back(
        {t.node, image ? mirror(place) : place, image ? mirror(t.normal) : t.normal, weight, true});
  }
  return planes;
}

}  // namespace fabrica::body
