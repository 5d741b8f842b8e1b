// GPU kernels of the Belytschko-Tsay shell.
#include "element/shell_bt.h"
#include "solver/cuda/tile_kernel.cuh"

namespace fabrica {

std::unique_ptr<TileLauncher> make_shell_launcher(const TileClassInput& input) {
  return make_tile_launcher<ShellBT, in_shells>(input);
}

}  // namespace fabrica
