#include "body/mesh/skull.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "body/mesh/cortex.h"
#include "body/mesh/skull_vault.h"

namespace fabrica::body {
namespace {

// [mm] z in frame head. Below `whole` the vault's wall tapers off until it is gone at `gone`,
// joined to the stack, whose temporal squama is too thin for bricks there; above `alone` the stack
// counts no more.
constexpr double gone = 48, whole = 61, alone = 78;
constexpr double cut = 68;  // [mm] z from which bricks belong to the vault

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// bricks above z
std::vector<char> above(const BoneMesh& mesh, double z) {
  std::vector<char> region;
  for (const Brick& brick : mesh.bricks) {
    double centre = 0;
    for (const int n : brick) centre += 0.125 * mesh.nodes[n].z;
    region.push_back(centre > z);
  }
  return region;
}

// is the boundary of a region a manifold, each edge with two faces and each node with one fan of
// faces?
bool is_manifold(const BoneMesh& mesh, const std::vector<char>& region) {
  std::vector<Brick> members;
  for (std::size_t e = 0; e < region.size(); ++e)
    if (region[e]) members.push_back(mesh.bricks[e]);
  std::vector<std::array<int, 2>> edges;
  for (const Quad& q : boundary_quads(members))
    for (int a = 0; a < 4; ++a)
      edges.push_back({std::min(q[a], q[(a + 1) % 4]), std::max(q[a], q[(a + 1) % 4])});
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size(); i += 2)
    if (i + 1 >= edges.size() || edges[i] != edges[i + 1] ||
        (i + 2 < edges.size() && edges[i] == edges[i + 2]))
      return false;
  return true;
}

}  // namespace

BoneShape skull_shape(const DistanceField& stack, double grid, double margin) {
  const VaultSurface outer("outer"), inner("inner");
  const auto distance = [&](const Point& p) {
    if (p.z <= gone) return stack.value(p);
    const Point from = p - vault_centre;
    const double r = std::max(norm(from), 1e-6);
    const Point direction = (1 / r) * from;
    const double out = outer.radius(direction), in = inner.radius(direction);
    const double taper = 0.5 * (out - in) * std::max(0.0, (whole - p.z) / (whole - gone));
    const double vault = std::max(r - out, in - r) + taper;
    const double share = smooth_step((p.z - whole) / (alone - whole));
    return share == 1 ? vault : (1 - share) * std::min(stack.value(p), vault) + share * vault;
  };
  Box box = stack.box();
  box.high.z = std::max(box.high.z, vault_centre.z + outer.radius({0, 0, 1}));
  BoneShape shape{DistanceField::of_function(box, grid, margin, distance), std::nullopt, 0, box.low,
                  box.high};
  shape.field.divide_by_gradient();
  shape.table_volume = shape.field.volume();
  return shape;
}

BoneMesh skull_mesh(BoneShape& shape, const CellOptions& options, Resolution resolution) {
  const double h = options.spacing;
  BoneMesh mesh = cells_of(shape.field, options);
  UntangleProblem problem = problem_of(mesh, shape.field, h);
  problem.target.assign(mesh.bricks.size(), {float(h), float(h), float(h)});
  std::vector<char> vault;
  for (const double up : {0.0, 1.0, -1.0, 2.0, -2.0}) {
    vault = above(mesh, cut + up * h);
    if (is_manifold(mesh, vault)) break;
    vault.clear();
  }
  if (vault.empty())
    throw BodyError(fmt::format("{}: no plane near z = {} mm parts the vault from the base",
                                options.name, cut));
  for (std::size_t e = 0; e < vault.size(); ++e) mesh.brick_layer[e] = vault[e] ? 2 : 0;

  if (resolution != Resolution::coarse) {
    const double outer_table = table_thickness("skull_outer_table"),
                 inner_table = table_thickness("skull_inner_table");
    std::vector<char> side(mesh.nodes.size(), 0);  // 1 outer, 3 inner surface, 0 inside
    for (const SurfaceNode& s : problem.surface) {
      Point direction;
      shape.field.value(mesh.nodes[s.node], direction);
      side[s.node] = dot(direction, mesh.nodes[s.node] - vault_centre) > 0 ? 1 : 3;
    }
    const auto thickness = [&](int node) { return side[node] == 1 ? outer_table : inner_table; };
    for (const auto& [node, twin] : add_pillow(mesh, vault, 0.25 * h))
      if (side[node]) problem.surface.push_back({twin, &shape.field, thickness(node)});
    for (std::size_t e = vault.size(); e < mesh.bricks.size(); ++e) {
      const Brick& b = mesh.bricks[e];
      int outer = 0, inner = 0;
      for (int c = 4; c < 8; ++c) outer += side[b[c]] == 1, inner += side[b[c]] == 3;
      const bool on_surface = outer + inner == 4;  // else it lies on the cut
      mesh.brick_layer[e] = !on_surface ? 2 : outer > inner ? 1 : 3;
      problem.target.push_back({float(h), float(h),
                                float(!on_surface     ? 0.5 * h
                                      : outer > inner ? outer_table
                                                      : inner_table)});
    }
    problem.bricks = mesh.bricks;
  }
  const bool coarse = resolution == Resolution::coarse;
  fit(mesh, shape.field, problem,
      {shape.table_volume, 100, coarse ? 2.0 : 1.0, coarse ? 2.4 : 1.1});
  return mesh;
}

}  // namespace fabrica::body
