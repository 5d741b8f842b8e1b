// Prints docs/body/bones.md: what the mesh of every bone measures at coarse and standard
// resolution.
//   cmake --build build --target bone_table && build/bone_table > docs/body/bones.md
// With a folder of the full tables, of which the shipped ones were thinned, it prints the distance
// of each vertebra's surface to either, mean / 95th percentile:
//   build/bone_table FOLDER
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <numeric>

#include "body/mesh/bone_mesh.h"
#include "body/mesh/bone_tables.h"
#include "body/mesh/quality.h"

using namespace fabrica::body;

namespace {

// [mm/ms] of a wave in cortical bone as brick: sqrt(E (1 - nu) / ((1 + nu)(1 - 2 nu) rho)), E = 17
// GPa, nu = 0.3, rho = 1.9e-6 kg/mm3; as shell: sqrt(E / (rho (1 - nu^2)))
constexpr double brick_speed = 3470, shell_speed = 3136;

const char* introduction =
    "# Bones as meshed\n\n"
    "Made by `build/bone_table > docs/body/bones.md` (target `bone_table`); right side and "
    "midline, the left is mirrored.\n\n"
    "* SJ: scaled Jacobian, smallest and the value that 99 % of the bricks exceed; 0.30 and 0.42 "
    "are demanded.\n"
    "* size: volume / largest face of the smallest brick; cortex: the smallest brick of solid "
    "cortex or shell (area / longest\n"
    "  side). 0.94 mm of bricks (0.85 mm of shells) of 17 GPa are crossed in 0.27 us, 2.8 mm (2.5 "
    "mm) in 0.8 us.\n"
    "* volume against the table; error: distance of the mesh's surface to the table's, mean / 95th "
    "percentile.\n"
    "* Euler: V - E + F of the boundary, 2 - 2 x (number of holes through). 2 and 0 are demanded "
    "where anatomy has no hole or\n"
    "  one. The transverse foramina of C1-C7 close in most grids (Euler 0); where they are open, "
    "-4 "
    "is as anatomy has it.\n"
    "  Of the sacrum's foramina and of the openings of the skull some close in the grid, so these "
    "two are reported and not\n"
    "  demanded.\n"
    "* skull: volume of the surface that is meshed, the measured vault thickened to literature "
    "values.\n";

void print(Resolution resolution, const char* title) {
  std::vector<MeshReport> reports;
  for (const std::string& name : bone_names())
    reports.push_back(report(mesh_bone({name, resolution})));
  fmt::print("\n## {}\n\n", title);
  fmt::print(
      "| bone | maker | bricks | nodes | SJ min | SJ 99 % | size mm | cortex mm | volume cm3 | off "
      "% | error mm | missing mm | offset mm | Euler |\n");
  fmt::print(
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const MeshReport& r : reports)
    fmt::print(
        "| {} | {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:+.1f} | {:.2f} / "
        "{:.2f} | {:.2f} | {:.2f} | {} |\n",
        r.name, r.maker, r.bricks, r.nodes, r.min_scaled_jacobian, r.p1_scaled_jacobian, r.min_size,
        r.min_cortex_size, r.volume / 1000, 100 * (r.volume / r.table_volume - 1), r.error_mean,
        r.error_p95, r.missing_p95, r.offset, r.euler);
  const auto least = [&](auto of) {
    return *std::min_element(reports.begin(), reports.end(),
                             [&](const auto& a, const auto& b) { return of(a) < of(b); });
  };
  const MeshReport jacobian = least([](const MeshReport& r) { return r.min_scaled_jacobian; });
  const MeshReport p1 = least([](const MeshReport& r) { return r.p1_scaled_jacobian; });
  const MeshReport error = least([](const MeshReport& r) { return -r.error_mean; });
  const MeshReport cortex = least([](const MeshReport& r) { return r.min_cortex_size; });
  const int bricks = std::accumulate(reports.begin(), reports.end(), 0,
                                     [](int n, const MeshReport& r) { return n + r.bricks; });
  fmt::print(
      "\n{} bones, {} bricks. Smallest scaled Jacobian {:.2f} ({}), smallest 99 % value {:.2f} "
      "({}), largest mean error\n"
      "{:.2f} mm ({}), smallest cortex {:.2f} mm ({}).\n",
      reports.size(), bricks, jacobian.min_scaled_jacobian, jacobian.name, p1.p1_scaled_jacobian,
      p1.name, error.error_mean, error.name, cortex.min_cortex_size, cortex.name);
  double step = 1e9;
  for (const MeshReport& r : reports)
    step = std::min(step,
                    r.min_cortex_size /
                        (r.maker.find("solid") != std::string::npos ? brick_speed : shell_speed));
  fmt::print("A cortex of 17 GPa everywhere would need a step of {:.2f} us.\n", 1000 * step);
  fmt::print("Bones whose cortex would need less than {} us: ",
             resolution == Resolution::coarse ? 0.8 : 0.27);
  std::string list;
  for (const MeshReport& r : reports) {
    const double speed = r.maker.find("solid") != std::string::npos ? brick_speed : shell_speed;
    if (1000 * r.min_cortex_size / speed < (resolution == Resolution::coarse ? 0.8 : 0.27))
      list += (list.empty() ? "" : ", ") + r.name;
  }
  fmt::print("{}.\n", list.empty() ? "none" : list);
}

// [mm] grid and margin as for the mesh itself
constexpr double grid = 0.8, margin = 6;

// distance of the mesh's surface to that of the full table, made its own mirror image as the mesh
// was
SurfaceError error_to_full(const std::string& name, Resolution resolution, const std::string& path,
                           std::ifstream& file) {
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const Axes axes = bone_shape(name, grid, margin).field.axes();
  const DistanceField field =
      DistanceField::of_slices(slices_of(Table(path, text), "s_mm", 8), axes, grid, margin);
  return surface_error(mesh_bone({name, resolution}), field.symmetric(true));
}

void print_against(const std::string& folder) {
  fmt::print(
      "| bone | coarse: shipped, full table mm | standard: shipped, full table mm |\n"
      "| --- | --- | --- |\n");
  for (const std::string& name : bone_names()) {
    if (!bone_recipe(name).exact_distances) continue;
    std::string line = fmt::format("| {} |", name);
    for (const Resolution resolution : {Resolution::coarse, Resolution::standard}) {
      const std::string path = fmt::format("{}/{}_stack.csv", folder, name);
      std::ifstream file(path);
      if (!file) break;
      const MeshReport shipped = report(mesh_bone({name, resolution}));
      const SurfaceError full = error_to_full(name, resolution, path, file);
      line += fmt::format(" {:.2f} / {:.2f}, {:.2f} / {:.2f} |", shipped.error_mean,
                          shipped.error_p95, full.mean, full.p95);
    }
    if (line.find(',') != std::string::npos) fmt::print("{}\n", line);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc == 2) return print_against(argv[1]), 0;
    fmt::print("{}", introduction);
    print(Resolution::coarse, "Coarse");
    print(Resolution::standard, "Standard");
  } catch (const std::exception& error) {
    fmt::print(stderr, "bone_table: {}\n", error.what());
    return 1;
  }
}
