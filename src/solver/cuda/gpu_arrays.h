#pragma once
// What the device holds of a model: plain arrays and the records that kernels read. Both compilers
// see this header.
#include <cstdint>
#include <vector>

#include "base/kahan.h"
#include "model/state.h"
#include "solver/kernel.h"

namespace fabrica {

class Tiles;

// One tile; the offsets point into the arrays of Tiles.
struct GpuTile {
  int count, node_first, node_count, anchor;
  std::size_t connectivity, state;
  bool solid;  // a volume <= 0 ends the run
};

// What a tile reports of one step, and its energies since the upload.
struct TileResult {
  double internal, hourglass, damping;  // increments of the last step
  double internal_sum, hourglass_sum, damping_sum;
  Real time_step, smallest_volume;
};

enum class GpuEnding : int { running, not_a_number, negative_volume };

// Time on the device: no kernel takes a time or a step as an argument, so a step needs no word from
// the host.
struct GpuClock {
  double dt, dt_previous;  // the step to t(n+1), and the one before
  KahanSum time;
  std::int64_t cycle;
  GpuEnding ending;
};

// How the step is chosen: the smallest element step times `scale`, growing by at most 5 % a cycle;
// or `fixed`.
struct GpuStepping {
  double scale = 0.9;
  double fixed = 0;  // 0: chosen
};

// Pointers into device memory (or, in tests, into the host's).
struct GpuArrays {
  const GpuTile* tile = nullptr;
  const int* node = nullptr;                    // tile nodes, as Tiles::node
  const std::uint16_t* connectivity = nullptr;  // as Tiles::connectivity
  const int* corner_first = nullptr;            // per tile node and one more: range in `corner`
  const std::uint16_t* corner =
      nullptr;                         // places of a tile's corner forces in the order of the sum
  const int* partial_first = nullptr;  // as Tiles::partial_first
  const int* partial = nullptr;
  Real* state = nullptr;
  ForceRecord* force = nullptr;   // partial sums per tile node
  ForceRecord* moment = nullptr;  // null: no rotations
  NodeMotion* nodes = nullptr;
  NodeSpin* spins = nullptr;  // null: no rotations
  TileResult* result = nullptr;
  GpuClock* clock = nullptr;
  int tiles = 0, node_count = 0;
};

// elements that a block's memory has room for: the tile sizes of solver/tiles.cpp
template <class E>
inline constexpr int tile_capacity = E::corners == 4 && !E::rotations ? 512 : 256;

// The lists that the host makes once: tile records, and for each tile node the corners that meet
// there.
struct GpuLayout {
  explicit GpuLayout(const Tiles& tiles);
  std::vector<GpuTile> tile;
  std::vector<int> corner_first;
  std::vector<std::uint16_t> corner;
};

}  // namespace fabrica
