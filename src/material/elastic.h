#pragma once
// Isotropic linear elasticity in rate form (*MAT_ELASTIC).
//   ds/dt = 2 G dev(D),   dp/dt = -K tr(D)                                   (1)
// s deviatoric stress, p pressure, D rate of deformation, G shear modulus, K bulk modulus. The
// element supplies the objective (Jaumann) part. Source: any text on hypoelasticity, e.g.
// Belytschko, Liu, Moran, ch. 5.
#include "material/point.h"

namespace fabrica {

struct ElasticLaw {
  static constexpr std::string_view keyword = "MAT_ELASTIC";
  static constexpr unsigned families = in_solids | in_shells | in_beams;
  static constexpr bool total = false, can_fail = false;
  static constexpr int rotated = 0;

  Real density;  // [mass/length^3]
  Real bulk;     // K [stress]
  Real shear;    // G [stress]

  template <class L>
  struct State {};

  static ElasticLaw from(const Parameters& p) {
    const Elastic e = Elastic::from_youngs(p.real("ro"), p.real("e"), p.real("pr"));
    return {Real(e.density), Real(e.bulk), Real(e.shear)};
  }
  Elastic elastic() const { return {density, bulk, shear}; }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>&, State<L>&) const {
    const L volumetric = trace(strain) * L(bulk - Real(2.0 / 3.0) * shear);
    return plus_sphere(old + L(2 * shear) * strain, volumetric);
  }

  // Plane stress: s_zz = 0 gives e_zz = -nu/(1-nu) (e_xx + e_yy); strain.zz is not read.
  template <class L>
  FABRICA_FN Sym3<L> plane_stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>&, State<L>&,
                                  L& dzz) const {
    const Real lame = bulk - Real(2.0 / 3.0) * shear, ratio = lame / (lame + 2 * shear);
    const L plane = strain.xx + strain.yy, twice = L(2 * shear);
    dzz = L(-ratio) * plane;
    const L both = L(2 * shear * ratio) * plane;
    return {old.xx + fma(twice, strain.xx, both),
            old.yy + fma(twice, strain.yy, both),
            L(0.0),
            fma(twice, strain.xy, old.xy),
            fma(twice, strain.yz, old.yz),
            fma(twice, strain.zx, old.zx)};
  }
  // Beam or truss fibre: s_yy = s_zz = s_yz = 0; strain.xx, xy, zx are read.
  template <class L>
  FABRICA_FN Sym3<L> uniaxial(const Sym3<L>& old, const Sym3<L>& strain, Point<L>&,
                              State<L>&) const {
    const L E = L(9 * bulk * shear / (3 * bulk + shear)), twice = L(2 * shear), zero = L(0.0);
    return {fma(E, strain.xx, old.xx),     zero, zero,
            fma(twice, strain.xy, old.xy), zero, fma(twice, strain.zx, old.zx)};
  }
};

}  // namespace fabrica
