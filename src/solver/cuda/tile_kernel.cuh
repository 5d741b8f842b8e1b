#pragma once
// The CUDA kernel of one element and one law, and its launcher.
#include "solver/cuda/device_buffer.cuh"
#include "solver/cuda/gpu_laws.h"
#include "solver/cuda/tile_launcher.h"
#include "solver/cuda/tile_phases.h"

namespace fabrica {

inline constexpr int tile_threads = 256;

template <class E, class M>
__global__ void __launch_bounds__(tile_threads)
    tile_kernel(const __grid_constant__ GpuArrays g, const __grid_constant__ M law,
                const __grid_constant__ ElementParameters p, int first, int fields) {
  extern __shared__ __align__(64) unsigned char shared[];
  if (g.clock->ending != GpuEnding::running) return;
  const int index = first + int(blockIdx.x);
  const GpuTile t = g.tile[index];
  const TileMemory<E> memory(shared, t.node_count);
  const Lot lot{int(threadIdx.x), int(blockDim.x)};
  fill_nodes<E>(lot, g, t, memory);
  __syncthreads();
  element_forces<E>(lot, g, t, law, p, fields, memory);
  __syncthreads();
  sum_corners<E>(lot, g, t, memory);
  sum_lanes<E>(lot, t, memory);
  __syncthreads();
  sum_tile<E>(lot, memory, g.result[index]);
}

template <class E, class M>
class TileLauncherOf : public TileLauncher {
 public:
  TileLauncherOf(const M& law, const TileClassInput& input)
      : law_(law),
        element_(input.element),
        fields_(input.fields),
        bytes_(TileMemory<E>::bytes(input.most_nodes)) {
    check(cudaFuncSetAttribute(tile_kernel<E, M>, cudaFuncAttributeMaxDynamicSharedMemorySize,
                               int(bytes_)));
  }
  void launch(const GpuArrays& arrays, int first, int count, cudaStream_t stream) const override {
    tile_kernel<E, M>
        <<<count, tile_threads, bytes_, stream>>>(arrays, law_, element_, first, fields_);
    check(cudaGetLastError());
  }

 private:
  M law_;
  ElementParameters element_;
  int fields_;
  std::size_t bytes_;
};

template <class E, unsigned families>
std::unique_ptr<TileLauncher> make_tile_launcher(const TileClassInput& in) {
  return with_gpu_law<families>(in.keyword, in.parameters, in.eos,
                                [&]<class M>(const M& law) -> std::unique_ptr<TileLauncher> {
                                  return std::make_unique<TileLauncherOf<E, M>>(law, in);
                                });
}

}  // namespace fabrica
