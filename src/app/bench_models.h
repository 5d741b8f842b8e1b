#pragma once
// Models for timing, built in memory through Builder: a brick block on a wall, a block of
// tetrahedra, a shell plate, two brick blocks in contact. Units mm, ms, kg, kN, GPa.
#include <memory>

#include "model/model.h"

namespace fabrica {

// about `elements` one-point bricks of steel (J2) that hit a rigid wall at 10 mm/ms
std::unique_ptr<Model> bench_bricks(int elements, Diagnostics& diagnostics);
// about `elements` tetrahedra (six per cell), elastic
std::unique_ptr<Model> bench_tets(int elements, Diagnostics& diagnostics);
// about `elements` Belytschko-Tsay shells, 5 points, J2, a plate clamped at one edge and moving at
// the other
std::unique_ptr<Model> bench_shells(int elements, Diagnostics& diagnostics);
// two blocks of `elements` / 2 bricks each that meet at 10 mm/ms
std::unique_ptr<Model> bench_contact(int elements, Diagnostics& diagnostics);

}  // namespace fabrica
