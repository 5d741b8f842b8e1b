#pragma once
// Piecewise linear plasticity (024) whose shells may also fail at a strain in their plane, and at a
// number of layers (*MAT_MODIFIED_PIECEWISE_LINEAR_PLASTICITY, 123).
//   a layer fails where ep > FAIL, or where the greater principal strain in its plane
//   (e_xx + e_yy)/2 + sqrt((e_xx - e_yy)^2/4 + e_xy^2) > EPSMAJ                              (1)
//   e: strain increments summed in the axes of the shell
// An in-plane point fails with NUMINT layers.
// Solids: 024. Source: LS-DYNA manual (public), MAT_123.
#include <stdexcept>
#include <string>

#include "material/piecewise_linear_plasticity.h"

namespace fabrica {

struct ModifiedPiecewiseLinearPlasticity {
  static constexpr std::string_view keyword = "MAT_MODIFIED_PIECEWISE_LINEAR_PLASTICITY";
  static constexpr unsigned families = in_solids | in_shells;
  static constexpr bool total = false, can_fail = true;
  static constexpr int rotated = 0;

  PiecewiseLinearPlasticity plasticity;
  Real major_strain = 0;  // EPSMAJ; 0: none
  int failed_layers = 0;  // NUMINT; 0: all

  template <class L>
  struct State {
    L plastic_strain;  // ep
    L xx, yy, xy;      // e
  };

  static ModifiedPiecewiseLinearPlasticity from(const Parameters& p) {
    ModifiedPiecewiseLinearPlasticity m;
    m.plasticity = PiecewiseLinearPlasticity::from(p);
    m.major_strain = Real(p.real("epsmaj"));
    m.failed_layers = p.integer("numint");
    if (m.major_strain < 0 || m.failed_layers < 0)
      throw std::invalid_argument(std::string(keyword) +
                                  ": EPSMAJ filtered in time and NUMINT as a share (below 0) are "
                                  "not supported");
    return m;
  }
  Elastic elastic() const { return plasticity.elastic(); }
  bool may_fail() const { return plasticity.may_fail() || major_strain > 0; }
  // how many layers of an in-plane point take the others along; 0: each fails alone
  FABRICA_FN int layers_to_fail() const { return failed_layers; }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                            State<L>& state) const {
    PiecewiseLinearPlasticity::State<L> inner{state.plastic_strain};
    const Sym3<L> s = plasticity.stress(old, strain, point, inner);
    state.plastic_strain = inner.plastic_strain;
    return s;
  }

  template <class L>
  FABRICA_FN Sym3<L> plane_stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                                  State<L>& state, L& dzz) const {
    PiecewiseLinearPlasticity::State<L> inner{state.plastic_strain};
    const Sym3<L> s = plasticity.plane_stress(old, strain, point, inner, dzz);
    state.plastic_strain = inner.plastic_strain;
    if (major_strain > 0) {
      state.xx += strain.xx, state.yy += strain.yy, state.xy += strain.xy;
      const L half = L(0.5) * (state.xx - state.yy);
      const L major = L(0.5) * (state.xx + state.yy) + sqrt(fma(half, half, state.xy * state.xy));
      point.alive = select(major > L(major_strain), L(0.0), point.alive);
    }
    return s;
  }
};

}  // namespace fabrica
