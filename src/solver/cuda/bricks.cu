// GPU kernels of the one-point bricks.
#include "element/hex8.h"
#include "solver/cuda/tile_kernel.cuh"

namespace fabrica {

std::unique_ptr<TileLauncher> make_brick_launcher(const TileClassInput& input, bool exact) {
  return exact ? make_tile_launcher<Hex8<true>, in_solids>(input)
               : make_tile_launcher<Hex8<false>, in_solids>(input);
}

}  // namespace fabrica
