#pragma once
// The work of one GPU block: the element forces of one tile, as phases with a barrier after each.
//   fill_nodes      node records relative to the anchor node, in the number type of the kernels
//   element_forces  one element per thread, scalar lane; corner forces to the block's memory
//   sum_corners     one node per thread: its corners in the order of the CPU driver, one partial
//   sum per tile node sum_lanes, sum_tile   energies lane by lane as the CPU driver adds them, the
//   smallest step and volume
// A phase reads only what earlier phases wrote, so a host that runs the threads one after another
// does the same work: the unit test does that and asks for the CPU driver's bits.
#include "solver/cuda/gpu_arrays.h"

namespace fabrica {

// The memory that the threads of a block share.
template <class E>
struct TileMemory {
  static constexpr int capacity = tile_capacity<E>, corners = E::corners;
  static constexpr int forces = 3 * corners * capacity;
  static constexpr int totals = 5 * capacity;  // internal, hourglass, damping, time step, volume

  NodeRecord* nodes;
  SpinRecord* spins;
  Real* force;  // [component][corner][element]
  Real* moment;
  Real* total;  // [quantity][element]

  FABRICA_FN static std::size_t bytes(int nodes) {
    const int vectors = E::rotations ? 2 : 1;
    return nodes * (sizeof(NodeRecord) + (E::rotations ? sizeof(SpinRecord) : 0)) +
           std::size_t(vectors * forces + totals) * sizeof(Real);
  }
  FABRICA_FN TileMemory(void* memory, int node_count) {
    nodes = static_cast<NodeRecord*>(memory);
    spins = reinterpret_cast<SpinRecord*>(nodes + node_count);
    force =
        E::rotations ? reinterpret_cast<Real*>(spins + node_count) : reinterpret_cast<Real*>(spins);
    moment = force + (E::rotations ? forces : 0);
    total = moment + forces;
  }
};

// the thread's number in its block and their number
struct Lot {
  int thread, threads;
};

template <class E>
FABRICA_FN void fill_nodes(Lot lot, const GpuArrays& g, const GpuTile& t, const TileMemory<E>& m) {
  const NodeMotion& anchor = g.nodes[t.anchor];
  for (int k = lot.thread; k < t.node_count; k += lot.threads) {
    const int global = g.node[t.node_first + k];
    const NodeMotion& n = g.nodes[global];
    for (int d = 0; d < 3; ++d) {
      m.nodes[k].value[d] = Real(n.x[d] - anchor.x[d]);
      m.nodes[k].value[3 + d] = Real(n.v[d] - anchor.v[d]);
    }
    if constexpr (E::rotations)
      for (int d = 0; d < 3; ++d) m.spins[k].value[d] = Real(g.spins[global].w[d]);
  }
}

template <class E>
FABRICA_FN void gather_corners(const std::uint16_t* index, const TileMemory<E>& m,
                               Corners<Real, E::corners>& c) {
  for (int a = 0; a < E::corners; ++a) {
    const int k = index[a * block_size];
    for (int d = 0; d < 3; ++d) {
      c.x[a][d] = m.nodes[k].value[d];
      c.v[a][d] = m.nodes[k].value[3 + d];
      if constexpr (E::rotations) c.w[a][d] = m.spins[k].value[d];
    }
  }
}

// fields: Reals of history per element. Padding repeats the tile's last element; only its history
// counts.
template <class E, class M>
FABRICA_FN void element_forces(Lot lot, const GpuArrays& g, const GpuTile& t, const M& law,
                               const ElementParameters& p, int fields, const TileMemory<E>& m) {
  constexpr int N = E::corners, T = TileMemory<E>::capacity;
  const Real dt = Real(g.clock->dt);
  const int padded = (t.count + block_size - 1) / block_size * block_size;
  for (int e = lot.thread; e < padded; e += lot.threads) {
    const int block = e / block_size, lane = e % block_size;
    Corners<Real, N> c;
    gather_corners<E>(g.connectivity + t.connectivity + std::size_t(block) * N * block_size + lane,
                      m, c);
    const StateView<Real> s{g.state + t.state + std::size_t(block) * fields * block_size + lane};
    CornerForces<Real, N> out;
    Totals<Real> totals;
    E::template forces<Real, M>(law, p, dt, c, s, out, totals);
    if constexpr (M::can_fail)
      if (!(totals.alive > 0)) {
        totals.time_step = totals.volume = Real(1e30);
        // without volume its force is no number
        for (int a = 0; a < N; ++a) {
          out.f[a] = {};
          if constexpr (E::rotations) out.m[a] = {};
        }
      }
    const bool counts = e < t.count;
    m.total[e] = counts ? totals.internal : Real(0);
    m.total[T + e] = counts ? totals.hourglass : Real(0);
    m.total[2 * T + e] = counts ? totals.damping : Real(0);
    m.total[3 * T + e] = totals.time_step, m.total[4 * T + e] = totals.volume;
    for (int a = 0; a < N; ++a)
      for (int d = 0; d < 3; ++d) {
        m.force[(d * N + a) * T + e] = out.f[a][d];
        if constexpr (E::rotations) m.moment[(d * N + a) * T + e] = out.m[a][d];
      }
  }
}

template <class E>
FABRICA_FN ForceRecord sum_of_corners(const Real* corner_force, const std::uint16_t* place,
                                      int count) {
  constexpr int stride = E::corners * TileMemory<E>::capacity;
  ForceRecord sum{};
  for (int k = 0; k < count; ++k)
    for (int d = 0; d < 3; ++d) sum.value[d] += corner_force[d * stride + place[k]];
  return sum;
}

template <class E>
FABRICA_FN void sum_corners(Lot lot, const GpuArrays& g, const GpuTile& t, const TileMemory<E>& m) {
  for (int k = t.node_first + lot.thread; k < t.node_first + t.node_count; k += lot.threads) {
    const int first = g.corner_first[k], count = g.corner_first[k + 1] - first;
    g.force[k] = sum_of_corners<E>(m.force, g.corner + first, count);
    if constexpr (E::rotations)
      g.moment[k] = sum_of_corners<E>(m.moment, g.corner + first, count);
    else if (g.moment)
      g.moment[k] = ForceRecord{};
  }
}

// one thread per lane of a block of elements: its sum over the tile's blocks, left in the first
// block
template <class E>
FABRICA_FN void sum_lanes(Lot lot, const GpuTile& t, const TileMemory<E>& m) {
  constexpr int T = TileMemory<E>::capacity;
  const int blocks = (t.count + block_size - 1) / block_size;
  for (int i = lot.thread; i < block_size; i += lot.threads) {
    for (int q = 0; q < 3; ++q) {
      Real sum = 0;
      for (int b = 0; b < blocks; ++b) sum += m.total[q * T + b * block_size + i];
      m.total[q * T + i] = sum;
    }
    for (int q = 3; q < 5; ++q) {
      Real least = Real(1e30);
      for (int b = 0; b < blocks; ++b) least = min(least, m.total[q * T + b * block_size + i]);
      m.total[q * T + i] = least;
    }
  }
}

// the first thread alone
template <class E>
FABRICA_FN void sum_tile(Lot lot, const TileMemory<E>& m, TileResult& r) {
  constexpr int T = TileMemory<E>::capacity;
  if (lot.thread != 0) return;
  double sum[3] = {0, 0, 0};
  Real least[2] = {Real(1e30), Real(1e30)};
  for (int i = 0; i < block_size; ++i) {
    for (int q = 0; q < 3; ++q) sum[q] += double(m.total[q * T + i]);
    for (int q = 0; q < 2; ++q) least[q] = min(m.total[(3 + q) * T + i], least[q]);
  }
  r.internal = sum[0], r.hourglass = sum[1], r.damping = sum[2];
  r.internal_sum += sum[0], r.hourglass_sum += sum[1], r.damping_sum += sum[2];
  r.time_step = least[0], r.smallest_volume = least[1];
}

}  // namespace fabrica
