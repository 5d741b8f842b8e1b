#pragma once
// The tables of data/anatomy/bones as shapes: which bones there are, how each is meshed, its
// surface as a distance field.
#include <optional>
#include <string>
#include <vector>

#include "body/mesh/distance_field.h"
#include "body/mesh/loft.h"
#include "body/tables.h"

namespace fabrica::body {

// a row of data/anatomy/bones/meshing.csv
struct BoneRecipe {
  std::string name;
  std::string maker;             // "overlay" or "loft"
  std::array<double, 3> edge{};  // [mm] of the bricks by resolution
  double growth = 0;             // of the field before cells are chosen, in edges
  double solid_cortex =
      0;  // [mm] least thickness of the cortex as bricks, from standard on; 0: shells
  std::array<int, 3> core{};      // bricks along the side of a loft's core, by resolution
  std::array<bool, 3> ring{};     // is there a ring around the core?
  std::optional<int> euler;       // of the boundary
  std::optional<int> open_euler;  // of the boundary with the foramina open that most grids close
  bool symmetric = false;         // a bone of the midline: made its own mirror image
  bool exact_distances = false;   // the field of that is made a distance again
  bool halfway = false;           // what ends between two slices ends halfway
  double spacing(Resolution r) const { return edge[std::size_t(r)]; }
};

// contours of a table of parallel slices in rising height; the column of their heights and up to
// which harmonic there are coefficients
std::vector<Slice> slices_of(const Table& table, const std::string& height_column, int harmonics);

const std::vector<BoneRecipe>& bone_recipes();
// throws BodyError with the nearest known name
const BoneRecipe& bone_recipe(const std::string& name);

struct BoneShape {
  DistanceField field;  // zero level: the surface of the table, moved outward so that it holds the
                        // table's volume
  std::optional<Loft> loft;
  double table_volume = 0;  // [mm3] that the table states, or of the surface where it states none
  Point low{}, high{};      // [mm] box of the solid in the bone frame
};

// grid: spacing of the field [mm]; margin around the surface [mm]
BoneShape bone_shape(const std::string& name, double grid, double margin);

}  // namespace fabrica::body
