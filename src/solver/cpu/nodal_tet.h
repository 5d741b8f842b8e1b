#pragma once
// Driver of the nodal-pressure tetrahedron (ELFORM 13): see element/tet4.h. Two passes: rates to
// the nodes, then forces with the mean of the four nodal pressures.
#include "element/tet4.h"
#include "solver/cpu/kernel_of.h"

namespace fabrica {

template <class M>
class NodalTet : public KernelOf<Tet4, M> {
  using Base = KernelOf<Tet4, M>;
  using L = typename Base::L;
  static constexpr int W = Base::W;

 public:
  using Base::Base;
  bool nodal_pressure() const override { return true; }

  // leaves per node of the tile {sum V_e, sum V_e tr(D_e), 0} in view.force
  void nodal_rates(const ElementParameters&, Real dt_previous, TileView& t) const override {
    const int blocks = (t.count + block_size - 1) / block_size;
    for (int b = 0; b < blocks; ++b) {
      alignas(64) Real rows[4][block_size * 4];
      for (int k = 0; k < block_size / W; ++k) {
        const Corners<L, 4> c = Base::corners_of(t, b, k);
        const TetGradient<L> g(c.x);
        const Mat3<L> middle = mid_step_gradient(g.times(c.v), L(dt_previous));
        const L rate = middle.a[0][0] + middle.a[1][1] + middle.a[2][2];
        Vec3<L> share{g.volume(), g.volume() * rate, L(0.0)};
        const int valid = t.count - b * block_size - k * W;
        for (int i = 0; i < W; ++i)
          if (i >= valid) set(share.x, i, Real(0)), set(share.y, i, Real(0));
        for (int a = 0; a < 4; ++a) transpose_rows(share, rows[a] + 4 * W * k);
      }
      Base::template scatter<4>(t.connectivity + std::size_t(b) * 4 * block_size, rows, t.force);
    }
  }

 protected:
  void call(const ElementParameters& p, Real dt_previous, const TileView& t, int b, int k,
            const Corners<L, 4>& c, const StateView<L>& s, CornerForces<L, 4>& out,
            Totals<L>& totals) const override {
    const std::uint16_t* index = t.connectivity + std::size_t(b) * 4 * block_size + k * W;
    L rate = L(0.0), pressure = L(0.0);
    if (t.node_rate)
      for (int i = 0; i < W; ++i) {
        Real r = 0, q = 0;
        for (int a = 0; a < 4; ++a) {
          r += t.node_rate[index[a * block_size + i]];
          q += t.node_pressure[index[a * block_size + i]];
        }
        set(rate, i, Real(0.25) * r), set(pressure, i, Real(0.25) * q);
      }
    Tet4::compute<L, M, true>(this->material_, p, dt_previous, c, rate, pressure, s, out, totals);
  }
};

}  // namespace fabrica
