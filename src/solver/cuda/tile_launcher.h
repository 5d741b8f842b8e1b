#pragma once
// The kernel of one tile class, as the GPU driver launches it: one block per tile.
#include <memory>

#include "model/model.h"
#include "solver/cuda/gpu_arrays.h"

struct CUstream_st;

namespace fabrica {

class TileLauncher {
 public:
  virtual ~TileLauncher() = default;
  // Queues the forces of tiles [first, first + count).
  virtual void launch(const GpuArrays& arrays, int first, int count, CUstream_st* stream) const = 0;
};

// What a launcher is made from.
struct TileClassInput {
  const std::string& keyword;
  const Parameters& parameters;
  const Parameters* eos;
  const ElementParameters& element;
  int fields;      // Reals of history per element
  int most_nodes;  // of any tile of the class
};

// Throw std::invalid_argument with the reason where the law has no GPU form.
std::unique_ptr<TileLauncher> make_brick_launcher(const TileClassInput& input, bool exact);
std::unique_ptr<TileLauncher> make_tet_launcher(const TileClassInput& input);
std::unique_ptr<TileLauncher> make_shell_launcher(const TileClassInput& input);

}  // namespace fabrica
