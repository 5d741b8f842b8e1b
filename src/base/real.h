#pragma once
// The number type of the element kernels and the function markers that both compilers understand.
//
// Real is float in the default (mixed) build and double in the `double` preset. Master copies of
// positions, velocities, rotations, masses and energies are double in every build.

#if defined(__CUDACC__)
#define FABRICA_FN __host__ __device__ __forceinline__
#else
#define FABRICA_FN inline __attribute__((always_inline))
#endif

namespace fabrica {

#ifdef FABRICA_DOUBLE
using Real = double;
#else
using Real = float;
#endif

// Elements that share one cache line per state field: the memory layout of element state on every
// target.
inline constexpr int block_size = 64 / int(sizeof(Real));

}  // namespace fabrica
