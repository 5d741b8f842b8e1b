#include "body/mesh/bone_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/lane_math.h"
#include "body/mesh/skull.h"
#include "body/tables.h"

namespace fabrica::body {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int contour_harmonics = 6;
constexpr int contour_points = 72;
constexpr double most_offset = 1.0;  // [mm] of a surface to hold its table's volume

std::string path_of(const std::string& file) { return "anatomy/bones/" + file + ".csv"; }

std::vector<Slice> read_slices(const std::string& bone) {
  return slices_of(Table(path_of(bone + "_stack")), "height", contour_harmonics);
}

Point point(const Table& table, int row, const char* prefix) {
  const std::string p = prefix;
  return {table.number(row, p + "x"), table.number(row, p + "y"), table.number(row, p + "z")};
}

std::vector<LoftStation> read_sections(const std::string& file, const std::string& piece) {
  const Table table(path_of(file));
  std::vector<LoftStation> stations;
  for (int row = 0; row < table.rows(); ++row) {
    if (table.text(row, "piece") != piece) continue;
    LoftStation s;
    s.c = point(table, row, "c");
    s.n = point(table, row, "n");
    s.e1 = point(table, row, "e1");
    s.r0 = table.number(row, "r0");
    for (int k = 1; k <= loft_harmonics; ++k) {
      s.cosine[k - 1] = table.number(row, fmt::format("c{}", k));
      s.sine[k - 1] = table.number(row, fmt::format("s{}", k));
    }
    stations.push_back(s);
  }
  return stations;
}

// costal cartilages 8 to 10: ellipses, a along the body's length
std::vector<LoftStation> read_ellipses(const std::string& piece) {
  const Table table(path_of("costal_cartilage8_10_loft"));
  std::vector<LoftStation> stations;
  for (int row = 0; row < table.rows(); ++row) {
    if (table.text(row, "piece") != piece) continue;
    LoftStation s;
    s.c = point(table, row, "c");
    const double a = table.number(row, "a"), b = table.number(row, "b");
    s.r0 = 0.5 * (a + b);
    s.cosine[1] = 0.5 * (a - b);
    stations.push_back(s);
  }
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Point along =
        stations[std::min(i + 1, stations.size() - 1)].c - stations[i > 0 ? i - 1 : 0].c;
    LoftStation& s = stations[i];
    s.n = (1 / norm(along)) * along;
    const Point up = Point{0, 0, 1} - s.n.z * s.n;
    s.e1 = (1 / norm(up)) * up;
  }
  return stations;
}

bool is_ray(const std::string& bone) {
  return bone.starts_with("meta") || bone.find("_phalanx") != std::string::npos;
}

std::vector<LoftStation> read_stations(const std::string& bone) {
  const auto starts = [&](const char* prefix) { return bone.rfind(prefix, 0) == 0; };
  if (bone == "costal_cartilage8" || bone == "costal_cartilage9" || bone == "costal_cartilage10")
    return read_ellipses(bone);
  if (starts("metacarpal") || starts("hand_phalanx")) return read_sections("hand_rays_loft", bone);
  if (starts("metatarsal") || starts("foot_phalanx")) return read_sections("foot_rays_loft", bone);
  if (bone == "fibula") return read_sections("fibula_loft", "shaft");
  return read_sections(bone + "_loft", "main");
}

// Sections that mirror themselves: centred in the plane y = 0, r(phi) = r(pi - phi) the mean of the
// two halves; phi counts from the y axis.
void make_symmetric(std::vector<LoftStation>& stations) {
  for (LoftStation& s : stations) {
    s.c.y = 0;
    for (int k = 1; k <= loft_harmonics; ++k) (k % 2 ? s.cosine : s.sine)[k - 1] = 0;
  }
}

struct IndexRow {
  double volume = 0;  // [mm3]
  Axes axes;
  Point low{}, high{};  // [mm] box of the measured bone
};

IndexRow index_row(const std::string& bone) {
  const Table table(path_of("index"));
  IndexRow result;
  for (int row = 0; row < table.rows(); ++row) {
    if (table.text(row, "bone") != bone) continue;
    result.volume = 1000 * table.number(row, "volume");
    for (int i = 0; i < 3; ++i) {
      const std::string axis(1, "xyz"[i]);
      result.low[i] = table.number(row, axis + "min"),
      result.high[i] = table.number(row, axis + "max");
    }
    if (!table.text(row, "nx").empty()) {
      result.axes.n = point(table, row, "n");
      result.axes.e1 = point(table, row, "e1");
      result.axes.e2 = cross(result.axes.n, result.axes.e1);
    }
  }
  return result;
}

int letters_apart(const std::string& a, const std::string& b) {  // Levenshtein
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = int(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = int(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::vector<Slice> slices_of(const Table& table, const std::string& height_column, int harmonics) {
  std::vector<Slice> slices;
  for (int row = 0; row < table.rows(); ++row) {
    const double height = table.number(row, height_column);
    if (slices.empty() || height != slices.back().height) slices.push_back({height, {}});
    std::vector<std::array<double, 2>> loop(contour_points, {0, 0});
    for (int k = -harmonics; k <= harmonics; ++k) {
      const double re = table.number(row, fmt::format("re{}", k)),
                   im = table.number(row, fmt::format("im{}", k));
      for (int m = 0; m < contour_points; ++m) {
        const double t = 2 * pi * k * m / contour_points, c = cos(t), s = sin(t);
        loop[m][0] += re * c - im * s;
        loop[m][1] += re * s + im * c;
      }
    }
    slices.back().loops.push_back(std::move(loop));
  }
  return slices;
}

const std::vector<BoneRecipe>& bone_recipes() {
  static const std::vector<BoneRecipe> recipes = [] {
    const Table table(path_of("meshing"));
    std::vector<BoneRecipe> list;
    for (int row = 0; row < table.rows(); ++row) {
      BoneRecipe r;
      r.name = table.text(row, "bone");
      r.maker = table.text(row, "maker");
      r.edge = {table.number(row, "coarse"), table.number(row, "standard"),
                table.number(row, "fine")};
      r.growth = table.number(row, "growth");
      if (!table.text(row, "solid_cortex").empty())
        r.solid_cortex = table.number(row, "solid_cortex");
      if (r.maker == "loft")
        for (int level = 0; level < 3; ++level) {
          const char* columns[] = {"core_coarse", "core_standard", "core_fine"};
          const std::string& core = table.text(row, columns[level]);  // "2" or, with a ring, "2+"
          r.ring[level] = core.ends_with('+');
          r.core[level] = core.front() - '0';
          if (r.core[level] < 1 || r.core[level] > 9)
            table.fail(row, fmt::format("the core '{}' should be like 2 or 2+", core));
        }
      r.symmetric = table.text(row, "symmetric") == "yes";
      r.exact_distances = table.text(row, "distances") == "exact";
      r.halfway = table.text(row, "distances") == "halfway";
      if (!table.text(row, "euler").empty()) r.euler = int(table.number(row, "euler"));
      if (!table.text(row, "open_euler").empty())
        r.open_euler = int(table.number(row, "open_euler"));
      list.push_back(r);
    }
    return list;
  }();
  return recipes;
}

const BoneRecipe& bone_recipe(const std::string& name) {
  const BoneRecipe* nearest = &bone_recipes().front();
  for (const BoneRecipe& r : bone_recipes()) {
    if (r.name == name) return r;
    if (letters_apart(name, r.name) < letters_apart(name, nearest->name)) nearest = &r;
  }
  throw BodyError(
      fmt::format("no bone is called '{}'; the nearest name is '{}'", name, nearest->name));
}

BoneShape bone_shape(const std::string& name, double grid, double margin) {
  const IndexRow index = index_row(name);
  if (name == "skull")
    return skull_shape(DistanceField::of_slices(read_slices(name), index.axes, grid, margin), grid,
                       margin);
  std::optional<Loft> loft;
  const bool stacked = bone_recipe(name).maker != "loft" && has_data_file(path_of(name + "_stack"));
  if (!stacked) {
    std::vector<LoftStation> stations = read_stations(name);
    if (bone_recipe(name).symmetric) make_symmetric(stations);
    loft.emplace(std::move(stations), 0.8);
  }
  if (loft && is_ray(name))
    loft->fit_ends(index.low, index.high, index.volume);
  else if (loft && index.volume > 0)
    loft->match_volume(index.volume);
  BoneShape shape{stacked ? DistanceField::of_slices(read_slices(name), index.axes, grid, margin,
                                                     bone_recipe(name).halfway)
                          : DistanceField::of_triangles(loft->surface(36, 3.0), grid, margin),
                  loft,
                  index.volume,
                  {},
                  {}};
  if (const BoneRecipe& recipe = bone_recipe(name); recipe.symmetric)
    shape.field = shape.field.symmetric(recipe.exact_distances);
  if (index.volume > 0)
    shape.field.match_volume(index.volume, most_offset);
  else
    shape.table_volume = shape.field.volume();
  const Box box = shape.field.box();
  const Point a = shape.field.axes().to_bone(box.low), b = shape.field.axes().to_bone(box.high);
  for (int d = 0; d < 3; ++d)
    shape.low[d] = std::min(a[d], b[d]), shape.high[d] = std::max(a[d], b[d]);
  return shape;
}

}  // namespace fabrica::body
