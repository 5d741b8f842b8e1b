#include "body/mesh/mesher.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "body/mesh/polish.h"

namespace fabrica::body {
namespace {

double solid_volume(const BoneMesh& mesh) {
  double volume = 0;
  for (const Brick& brick : mesh.bricks) volume += volume_of(corners_of(mesh.nodes, brick));
  return volume;
}

double surface_area(const BoneMesh& mesh) {
  double area = 0;
  for (const Quad& q : mesh.surface)
    area +=
        0.5 * norm(cross(mesh.nodes[q[2]] - mesh.nodes[q[0]], mesh.nodes[q[3]] - mesh.nodes[q[1]]));
  return area;
}

}  // namespace

BoneMesh cells_of(const DistanceField& field, const CellOptions& options) {
  const Point shifts[] = {
      {0, 0, 0}, {0.25, 0.25, 0.25}, {0.5, 0, 0.25}, {0, 0.5, 0.5}, {0.5, 0.5, 0}};
  std::string found;
  for (const double more : {0.0, 0.1, -0.1, 0.2, 0.3}) {
    std::optional<BoneMesh> open;
    for (const Point& shift : shifts) {
      const double growth = std::max(0.0, options.growth + more) * options.spacing;
      CellGrid grid = rasterise(field, options.spacing, growth, shift, options.symmetric);
      if (!repair(grid)) continue;
      BoneMesh mesh = bricks_of(grid);
      const int euler = euler_number(mesh.surface);
      if (!mesh.bricks.empty() && euler == options.euler.value_or(euler)) return mesh;
      if (!mesh.bricks.empty() && euler == options.open_euler && !open) open = std::move(mesh);
      found += fmt::format(" {}", euler);
    }
    if (open) return *open;
  }
  throw BodyError(
      fmt::format("{}: the boundary should have the Euler number {}; grids of {} mm gave{}",
                  options.name, options.euler.value_or(0), options.spacing, found));
}

UntangleProblem problem_of(const BoneMesh& mesh, const DistanceField& field, double spacing) {
  UntangleProblem problem;
  problem.bricks = mesh.bricks;
  problem.shells = mesh.surface;
  problem.image = mesh.image;
  problem.spacing = spacing;
  std::vector<bool> on_surface(mesh.nodes.size(), false);
  for (const Quad& quad : mesh.surface)
    for (const int n : quad) on_surface[n] = true;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (on_surface[n]) problem.surface.push_back({int(n), &field, 0});
  return problem;
}

void fit(BoneMesh& mesh, DistanceField& field, const UntangleProblem& problem,
         const FitOptions& options) {
  constexpr int iterations = 40, passes = 3;
  constexpr double most_offset = 0.5;  // [mm] a pass
  for (const double weight : {0.3, 2.0, 10.0, 40.0})
    untangle(problem, mesh.nodes, weight, iterations);
  const double table_offset = field.offset;
  for (int pass = 0; pass < passes; ++pass) {
    const double missing = (options.volume - solid_volume(mesh)) / surface_area(mesh);
    field.offset += std::clamp(missing, -most_offset, most_offset);
    untangle(problem, mesh.nodes, options.end_weight, iterations);
  }
  PolishOptions local;
  local.jacobian = options.jacobian;
  local.size = options.least_size;
  // a round bar of radius r has V / A = r / 2 and, with eight shells around it, shells of 0.75 r:
  // slender bones have no room for larger ones
  local.shell_size =
      std::min(options.least_shell, options.shell_room * options.volume / surface_area(mesh));
  local.weight = options.local_weight;
  mesh.shell_wish = local.shell_size;
  // on small bones the local stage takes room for its wishes: where that is more than 1 % of the
  // volume, it starts again with the surface moved in by as much
  const std::vector<Point> before = mesh.nodes;
  for (int attempt = 0; attempt < passes; ++attempt) {
    mesh.nodes = before;
    polish(problem, mesh.nodes, local);
    const double excess = solid_volume(mesh) - options.volume;
    if (std::abs(excess) < 0.01 * options.volume) break;
    field.offset -= std::clamp(excess / surface_area(mesh), -most_offset, most_offset);
  }
  field.offset = table_offset;
}

BoneMesh mesh_solid(DistanceField& field, const CellOptions& options, const FitOptions& fitting) {
  BoneMesh mesh = cells_of(field, options);
  UntangleProblem problem = problem_of(mesh, field, options.spacing);
  const float h = float(options.spacing);
  problem.target.assign(mesh.bricks.size(), {h, h, h});
  fit(mesh, field, problem, fitting);
  return mesh;
}

}  // namespace fabrica::body
