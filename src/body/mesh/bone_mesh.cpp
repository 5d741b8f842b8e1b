#include "body/mesh/bone_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <mutex>
#include <set>

#include "body/materials.h"
#include "body/mesh/bone_tables.h"
#include "body/mesh/cortex.h"
#include "body/mesh/mesher.h"
#include "body/mesh/skull.h"

namespace fabrica::body {
namespace {

constexpr double least_jacobian = 0.30;

// [mm] a wave crosses 2.6 mm of cortical bone (17 GPa) in 0.8 us, 1.2 mm in 0.37 us; 0 where no
// shells will lie
double shell_wish(const std::string& bone, Resolution resolution) {
  if (resolution == Resolution::coarse && bone_material(bone).rigid_at_coarse) return 0;
  return resolution == Resolution::coarse ? 2.6 : resolution == Resolution::standard ? 1.2 : 0.8;
}

CellOptions cell_options(const BoneRecipe& recipe, double h) {
  return {recipe.name, h, recipe.growth, recipe.euler, recipe.symmetric, recipe.open_euler};
}

// The cortex as a layer of bricks of the thickness that the table gives, at least `least` mm.
BoneMesh solid_cortex_mesh(const BoneRecipe& recipe, BoneShape& shape, double h, double least) {
  BoneMesh mesh = cells_of(shape.field, cell_options(recipe, h));
  const CortexTable table(recipe.name, shape);
  const auto thickness = [&](int node) {
    return std::max(least, table.at(mesh.nodes[node], Point{0, 0, 1}));
  };
  UntangleProblem problem = problem_of(mesh, shape.field, h);
  problem.target.assign(mesh.bricks.size(), {float(h), float(h), float(h)});
  for (const auto& [outer, twin] :
       add_pillow(mesh, std::vector<char>(mesh.bricks.size(), 1), 0.3 * h))
    problem.surface.push_back({twin, &shape.field, thickness(outer)});
  for (std::size_t e = problem.target.size(); e < mesh.bricks.size(); ++e) {
    double mean = 0;
    for (int c = 4; c < 8; ++c) mean += 0.25 * thickness(mesh.bricks[e][c]);
    problem.target.push_back({float(h), float(h), float(mean)});
  }
  problem.bricks = mesh.bricks;
  fit(mesh, shape.field, problem, {shape.table_volume, 150, 1.0, 0, 0, 0.45, 75});
  return mesh;
}

BoneMesh loft_mesh(const BoneRecipe& recipe, BoneShape& shape, double h, Resolution resolution) {
  const std::size_t level = std::size_t(resolution);
  BoneMesh mesh = shape.loft->bricks(recipe.core[level], recipe.ring[level], h);
  UntangleProblem problem = problem_of(mesh, shape.field, 0.5 * h);
  for (const Brick& brick : mesh.bricks)
    problem.target.push_back(edge_lengths(corners_of(mesh.nodes, brick)));
  fit(mesh, shape.field, problem,
      {shape.table_volume, 100, 0.06 * h, shell_wish(recipe.name, resolution), 1.3, 0.50, 100});
  return mesh;
}

// no shell where the brick behind a quad is a table of the vault
void clear_where_solid(BoneMesh& mesh) {
  std::set<Quad> solid;
  for (std::size_t e = 0; e < mesh.bricks.size(); ++e) {
    if (mesh.brick_layer[e] != 1 && mesh.brick_layer[e] != 3) continue;
    const Brick& b = mesh.bricks[e];
    solid.insert(sorted({b[4], b[5], b[6], b[7]}));
  }
  for (std::size_t q = 0; q < mesh.surface.size(); ++q)
    if (solid.count(sorted(mesh.surface[q]))) mesh.cortex[q] = 0;
}

// each quad and its mirror image get the mean of their thicknesses
void mirror_cortex(BoneMesh& mesh) {
  std::map<Quad, std::size_t> at;
  for (std::size_t q = 0; q < mesh.surface.size(); ++q) at[sorted(mesh.surface[q])] = q;
  const std::vector<double> before = mesh.cortex;
  for (std::size_t q = 0; q < before.size(); ++q) {
    Quad other = mesh.surface[q];
    for (int& n : other) n = mesh.image[n];
    mesh.cortex[q] = 0.5 * (before[q] + before[at.at(sorted(other))]);
  }
}

// what every mesh must reach; throws BodyError with the first figure that fails
void check_gates(const MeshReport& r, Resolution resolution) {
  constexpr double least_p1 = 0.42, volume_tolerance = 0.10;
  const double most_error = resolution == Resolution::coarse ? 1.5 : 0.8;  // [mm]
  const auto refuse = [&](const std::string& what) {
    throw BodyError(fmt::format("{}, after {}: {}", r.name, r.maker, what));
  };
  if (r.min_scaled_jacobian < least_jacobian)
    refuse(fmt::format("a brick has the scaled Jacobian {:.3f}, at least {} is needed",
                       r.min_scaled_jacobian, least_jacobian));
  if (r.p1_scaled_jacobian < least_p1)
    refuse(fmt::format("1 % of the bricks have a scaled Jacobian below {:.3f}, {} is needed",
                       r.p1_scaled_jacobian, least_p1));
  if (r.euler != r.expected_euler)
    refuse(fmt::format("the boundary has the Euler number {}, the bone has {}", r.euler,
                       r.expected_euler));
  if (r.table_volume > 0 && std::abs(r.volume / r.table_volume - 1) > volume_tolerance)
    refuse(fmt::format("the volume is {:.2f} cm3, the table says {:.2f}", r.volume / 1000,
                       r.table_volume / 1000));
  if (r.error_mean > most_error)
    refuse(fmt::format("the surface is {:.2f} mm off on average, {} mm is allowed", r.error_mean,
                       most_error));
}

// unequal factors shear bricks: the one gate that scaling can breach
void check_scaled(const BoneMesh& mesh) {
  const double least = measure(mesh).min_scaled_jacobian;
  if (least < least_jacobian)
    throw BodyError(
        fmt::format("{}, scaled by ({:.3f}, {:.3f}, {:.3f}): a brick has the scaled Jacobian "
                    "{:.3f}, at least {} is "
                    "needed; take factors closer to each other",
                    mesh.name, mesh.scale.x, mesh.scale.y, mesh.scale.z, least, least_jacobian));
}

double thread_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

struct Made {
  BoneMesh mesh;
  MeshReport report;
};

Made make(const std::string& name, Resolution resolution) {
  const double start = thread_seconds();
  const BoneRecipe& recipe = bone_recipe(name);
  const double h = recipe.spacing(resolution);
  BoneShape shape =
      bone_shape(name, std::clamp(h / 5, 0.4, 1.2), recipe.maker == "loft" ? 4.0 : 1.3 * h + 2);
  Made made;
  const bool solid = recipe.solid_cortex > 0 && resolution != Resolution::coarse;
  made.mesh = recipe.maker == "loft"    ? loft_mesh(recipe, shape, h, resolution)
              : recipe.maker == "skull" ? skull_mesh(shape, cell_options(recipe, h), resolution)
              : solid
                  ? solid_cortex_mesh(recipe, shape, h, recipe.solid_cortex)
                  : mesh_solid(shape.field, cell_options(recipe, h),
                               {shape.table_volume, 200, 0.3 * h, shell_wish(name, resolution)});
  made.mesh.name = name;
  made.mesh.resolution = resolution;
  if (!solid) made.mesh.cortex = cortex_of(made.mesh, name, shape);
  if (recipe.symmetric) mirror_cortex(made.mesh);
  if (recipe.maker == "skull") clear_where_solid(made.mesh);
  made.report = measure(made.mesh);
  made.report.maker = solid ? "overlay with solid cortex" : recipe.maker;
  made.report.expected_euler = made.report.euler == recipe.open_euler
                                   ? made.report.euler
                                   : recipe.euler.value_or(made.report.euler);
  made.report.table_volume = shape.table_volume;
  const SurfaceError error = surface_error(made.mesh, shape.field);
  made.report.error_mean = error.mean;
  made.report.error_p95 = error.p95;
  made.report.missing_p95 = missing_p95(made.mesh, shape.field);
  made.report.offset = shape.field.offset;
  made.report.seconds = thread_seconds() - start;
  check_gates(made.report, resolution);
  return made;
}

// Each bone is made once at unit scale; scaling moves its nodes. Several threads may make different
// bones.
const Made& made(const std::string& name, Resolution resolution) {
  struct Entry {
    std::once_flag once;
    Made made;
  };
  static std::map<std::pair<std::string, Resolution>, Entry> cache;  // entries never move
  static std::mutex mutex;
  Entry* entry = nullptr;
  {
    const std::lock_guard lock(mutex);
    entry = &cache[{name, resolution}];
  }
  std::call_once(entry->once, [&] { entry->made = make(name, resolution); });
  return entry->made;
}

}  // namespace

BoneMesh mesh_bone(const BoneRequest& request) {
  BoneMesh mesh = made(request.name, request.resolution).mesh;
  mesh.scale = request.scale;
  for (Point& p : mesh.nodes)
    p = {p.x * request.scale.x, p.y * request.scale.y, p.z * request.scale.z};
  check_scaled(mesh);
  return mesh;
}

MeshReport report(const BoneMesh& mesh) {
  const MeshReport& unit = made(mesh.name, mesh.resolution).report;
  MeshReport report = measure(mesh);
  report.maker = unit.maker;
  report.expected_euler = unit.expected_euler;
  report.table_volume = unit.table_volume * mesh.scale.x * mesh.scale.y * mesh.scale.z;
  const double scale = std::cbrt(mesh.scale.x * mesh.scale.y * mesh.scale.z);
  report.error_mean = unit.error_mean * scale;
  report.error_p95 = unit.error_p95 * scale;
  report.missing_p95 = unit.missing_p95 * scale;
  report.offset = unit.offset;
  report.seconds = unit.seconds;
  return report;
}

const std::vector<std::string>& bone_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const BoneRecipe& recipe : bone_recipes()) list.push_back(recipe.name);
    return list;
  }();
  return names;
}

BoneMesh mirrored(const BoneMesh& mesh) {
  BoneMesh other = mesh;
  for (Point& p : other.nodes) p.y = -p.y;
  for (Brick& b : other.bricks) b = {b[3], b[2], b[1], b[0], b[7], b[6], b[5], b[4]};
  for (Quad& q : other.surface) q = {q[0], q[3], q[2], q[1]};  // keeps the diagonal
  return other;
}

}  // namespace fabrica::body
