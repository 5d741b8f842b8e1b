#pragma once
// KernelOf<E, M>: the CPU driver of one element and one law. A tile is a loop over blocks of one
// cache line per state field; a block is one pack or two, and its corner forces are added half
// block by half block, corner by corner, lane by lane, so that the sums have the same bits for
// every lane width.
#include "solver/cpu/gather.h"

namespace fabrica {

// elements per half block: the unit of the fixed summation order
inline constexpr int half_block = block_size / 2;

template <class E, class M>
class KernelOf : public Kernel {
 public:
  static constexpr int W = native_width < block_size ? native_width : block_size;
  static constexpr int N = E::corners;
  using L = Pack<Real, W>;

  explicit KernelOf(M material) : material_(material) {}
  int corners() const override { return N; }
  bool rotations() const override { return E::rotations; }
  bool can_fail() const override {
    if constexpr (M::can_fail)
      return material_.may_fail();
    else
      return false;
  }
  int state_fields(const ElementParameters& p) const override {
    return E::template state_fields<M>(p);
  }
  Elastic elastic() const override { return material_.elastic(); }

  void initialise(const ElementParameters& p, TileView& t) const override {
    const int fields = state_fields(p), blocks = (t.count + block_size - 1) / block_size;
    for (int b = 0; b < blocks; ++b)
      for (int part = 0; part < block_size / W; ++part) {
        const Corners<L, N> c = corners_of(t, b, part);
        const StateView<L> s{t.state + std::size_t(b) * fields * block_size + part * W};
        E::template initialise<L, M>(material_, p, c, given(t, b, part), s);
      }
  }

  void forces(const ElementParameters& p, Real dt_previous, TileView& t) const override {
    const int fields = state_fields(p), blocks = (t.count + block_size - 1) / block_size;
    L internal[block_size / W], hourglass[block_size / W], damping[block_size / W];
    L step[block_size / W], volume[block_size / W];
    for (int k = 0; k < block_size / W; ++k)
      internal[k] = hourglass[k] = damping[k] = L(0.0), step[k] = volume[k] = L(1e30);
    for (int b = 0; b < blocks; ++b) {
      if (b + 1 < blocks) fetch_history(t.state + std::size_t(b + 1) * fields * block_size, fields);
      t.ahead.fetch(b, blocks);
      alignas(64) Real force_rows[N][block_size * 4];
      alignas(64) Real moment_rows[E::rotations ? N : 1][block_size * 4];
      for (int k = 0; k < block_size / W; ++k) {
        const Corners<L, N> c = corners_of(t, b, k);
        const StateView<L> s{t.state + std::size_t(b) * fields * block_size + k * W};
        CornerForces<L, N> out;
        Totals<L> totals;
        call(p, dt_previous, t, b, k, c, s, out, totals);
        if (b == blocks - 1 && t.count % block_size != 0)
          drop_padding(t.count - b * block_size - k * W, out, totals);
        if constexpr (M::can_fail) {
          if (t.element_energy) keep_energies(t, b, k, totals);
          drop_failed(out, totals);
        }
        internal[k] += totals.internal, hourglass[k] += totals.hourglass,
            damping[k] += totals.damping;
        if constexpr (M::can_fail)
          totals.time_step = select(totals.alive > L(0.0), totals.time_step, L(1e30)),
          totals.volume = select(totals.alive > L(0.0), totals.volume, L(1e30));
        step[k] = min(step[k], totals.time_step), volume[k] = min(volume[k], totals.volume);
        if (t.element_time_step)
          totals.time_step.store(t.element_time_step + b * block_size + k * W);
        if (t.element_alive) totals.alive.store(t.element_alive + b * block_size + k * W);
        for (int a = 0; a < N; ++a) {
          transpose_rows(out.f[a], force_rows[a] + 4 * W * k);
          if constexpr (E::rotations) transpose_rows(out.m[a], moment_rows[a] + 4 * W * k);
        }
      }
      scatter<N>(t.connectivity + std::size_t(b) * N * block_size, force_rows, t.force);
      if constexpr (E::rotations)
        scatter<N>(t.connectivity + std::size_t(b) * N * block_size, moment_rows, t.moment);
    }
    t.internal = sum(internal), t.hourglass = sum(hourglass), t.damping = sum(damping);
    t.time_step = least(step), t.smallest_volume = least(volume);
  }

  void lump(const ElementParameters& p, const Vec3d* x, const double* thickness,
            const Vec3d& orientation, double* mass, double* inertia) const override {
    Corners<double, N> c{};
    Given<double> g{};
    for (int a = 0; a < N; ++a) c.x[a] = x[a];
    for (int k = 0; k < 4; ++k) g.thickness[k] = thickness[k];
    g.orientation = orientation;
    double m[N] = {}, j[N] = {};
    E::lump(p, c, g, m, j);
    for (int a = 0; a < N; ++a) mass[a] = m[a], inertia[a] = j[a];
  }

  void read(const ElementParameters& p, const Real* block, int lane, const Vec3d* x,
            ElementReadout& out) const override;

 protected:
  M material_;

  virtual void call(const ElementParameters& p, Real dt_previous, const TileView&, int, int,
                    const Corners<L, N>& c, const StateView<L>& s, CornerForces<L, N>& out,
                    Totals<L>& totals) const {
    E::template forces<L, M>(material_, p, dt_previous, c, s, out, totals);
  }

  static Corners<L, N> corners_of(const TileView& t, int b, int k) {
    Corners<L, N> c;
    const std::uint16_t* index = t.connectivity + std::size_t(b) * N * block_size + k * W;
    for (int a = 0; a < N; ++a) {
      gather<W>(t.nodes, index + a * block_size, c.x[a], c.v[a]);
      if constexpr (E::rotations) gather_spin<W>(t.spins, index + a * block_size, c.w[a]);
    }
    return c;
  }

  static Given<L> given(const TileView& t, int b, int k) {
    Given<L> g{};
    for (int i = 0; i < W; ++i) {
      int e = b * block_size + k * W + i;
      e = e < t.count ? e : t.count - 1;
      for (int a = 0; a < 4; ++a)
        set(g.thickness[a], i, t.thickness ? Real(t.thickness[4 * e + a]) : Real(0));
      for (int a = 0; a < 3; ++a)
        set(g.orientation[a], i, t.orientation ? Real(t.orientation[e][a]) : Real(0));
    }
    return g;
  }

  // lanes at and beyond `valid` repeat the last element: they count for nothing
  static void drop_padding(int valid, CornerForces<L, N>& out, Totals<L>& totals) {
    L keep = L(0.0);
    for (int i = 0; i < W; ++i) set(keep, i, i < valid ? Real(1) : Real(0));
    const auto live = keep > L(0.0);
    for (int a = 0; a < N; ++a)
      for (int d = 0; d < 3; ++d) {
        out.f[a][d] = select(live, out.f[a][d], L(0.0));
        if constexpr (E::rotations) out.m[a][d] = select(live, out.m[a][d], L(0.0));
      }
    totals.internal = select(live, totals.internal, L(0.0));
    totals.hourglass = select(live, totals.hourglass, L(0.0));
    totals.damping = select(live, totals.damping, L(0.0));
  }

  // Adds to the energies of each element. One that has failed takes up nothing more; what one held
  // that fails now is handed out.
  static void keep_energies(TileView& t, int b, int k, Totals<L>& totals) {
    ElementEnergy* const element = t.element_energy + b * block_size + k * W;
    const int valid = std::min(W, t.count - b * block_size - k * W);
    for (int i = 0; i < valid; ++i) {
      ElementEnergy& e = element[i];
      if (e.failed) {
        set(totals.internal, i, Real(0)), set(totals.hourglass, i, Real(0)),
            set(totals.damping, i, Real(0));
        continue;
      }
      e.internal += double(get(totals.internal, i)),
          e.hourglass += double(get(totals.hourglass, i));
      if (get(totals.alive, i) > 0) continue;
      e.failed = true, ++t.failed;
      t.eroded_internal += e.internal, t.eroded_hourglass += e.hourglass;
    }
  }

  // A failed element is still computed beside those of its pack; its nodes go where they want, and
  // once it has no volume its force is no number, of which nothing may reach the nodes it shares.
  static void drop_failed(CornerForces<L, N>& out, const Totals<L>& totals) {
    const auto lives = totals.alive > L(0.0);
    const auto keep = [&](Vec3<L>& f) {
      f = {select(lives, f.x, L(0.0)), select(lives, f.y, L(0.0)), select(lives, f.z, L(0.0))};
    };
    for (int a = 0; a < N; ++a) {
      keep(out.f[a]);
      if constexpr (E::rotations) keep(out.m[a]);
    }
  }

  template <int C>
  static void scatter(const std::uint16_t* connectivity, const Real (*rows)[block_size * 4],
                      ForceRecord* sum) {
    for (int half = 0; half < 2; ++half)
      for (int a = 0; a < C; ++a) {
        const std::uint16_t* index = connectivity + a * block_size + half * half_block;
        const Real* f = rows[a] + 4 * half * half_block;
        for (int i = 0; i < half_block; ++i) add_record(sum[index[i]], f + 4 * i);
      }
  }

  static double sum(const L* lanes) {
    double s = 0;
    for (int k = 0; k < block_size / W; ++k)
      for (int i = 0; i < W; ++i) s += double(get(lanes[k], i));
    return s;
  }
  static Real least(const L* lanes) {
    Real m = Real(1e30);
    for (int k = 0; k < block_size / W; ++k)
      for (int i = 0; i < W; ++i) m = get(lanes[k], i) < m ? get(lanes[k], i) : m;
    return m;
  }
};

}  // namespace fabrica
