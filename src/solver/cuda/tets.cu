// GPU kernels of the one-point tetrahedron.
#include "element/tet4.h"
#include "solver/cuda/tile_kernel.cuh"

namespace fabrica {

std::unique_ptr<TileLauncher> make_tet_launcher(const TileClassInput& input) {
  return make_tile_launcher<Tet4, in_solids>(input);
}

}  // namespace fabrica
