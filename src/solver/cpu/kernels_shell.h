#pragma once
// What the shell kernels' instantiations share: reading stress, thickness and resultants for
// output.
#include "element/shell.h"
#include "solver/cpu/kernel_of.h"
#include "solver/cpu/make.h"

namespace fabrica {

// the layers that output shows; ELFORM 16 shows its first in-plane point
template <class E, class M>
StateView<Real> shown_layers(const ElementParameters& p, StateView<Real> s) {
  if constexpr (requires { E::template layers<M>(p, s, 0); })
    return E::template layers<M>(p, s, 0);
  else
    return E::template layers<Real>(s);
}

// life, and rotation of local stress into global axes
template <class M>
void put_layer(const Mat3d& turn, int q, const Sym3<Real>& t, Real plastic_strain,
               ElementReadout& out) {
  const Sym3<double> local{double(t.xx), double(t.yy), double(t.zz),
                           double(t.xy), double(t.yz), double(t.zx)};
  out.stress[q] = rotate(turn, local);
  out.plastic_strain[q] = double(plastic_strain);
}

template <class E>
Mat3d shell_turn(const Vec3d* x) {
  Vec3<double> corner[E::corners];
  for (int a = 0; a < E::corners; ++a) corner[a] = x[a];
  return E::template frame<double>(corner).rotation();
}

template <class E, class M>
void read_shell(const ElementParameters& p, const Real* block, int lane, const Vec3d* x,
                ElementReadout& out) {
  const StateView<Real> s{const_cast<Real*>(block) + lane};
  const StateView<Real> l = shown_layers<E, M>(p, s);
  const Mat3d turn = shell_turn<E>(x);
  out.layers = p.layers;
  out.thickness = double(s.load(E::thickness_field));
  out.alive = M::can_fail ? 0 : 1;
  for (int q = 0; q < p.layers; ++q) {
    put_layer<M>(turn, q, ShellLayers<M>::template stress<Real>(l, q),
                 ShellLayers<M>::plastic_strain(l, q), out);
    if constexpr (M::can_fail)
      out.alive =
          std::max(out.alive, double(l.load(q * ShellLayers<M>::stride + ShellLayers<M>::alive)));
  }
  ShellLayers<M>::resultants(p, Real(out.thickness), l, out.resultants);
}

}  // namespace fabrica
