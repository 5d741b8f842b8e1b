#pragma once
// Fluid without shear stiffness (*MAT_NULL, 009) with a linear polynomial equation of state.
//   p = C0 + C1 m + C2 m^2 + C3 m^3 + (C4 + C5 m + C6 m^2) e,   m = 1/V - 1,  C2 = C6 = 0 for m < 0
//   (1) de = -p dV + V s:dev(D) dt   per initial volume, p at mid step: (1) is linear in e and
//   solved exactly    (2) s = 2 MU dev(D),   p >= PC rho0 c^2 = C1 + 2 C2 m + 3 C3 m^2 + (C5 + 2 C6
//   m) e + p V^2 (C4 + C5 m + C6 m^2)                        (3)
// V relative volume (V0 at the start), e energy per initial volume (E0 at the start). Without an
// equation of state there is no stress (contact skins). A point fails beyond TEROD in expansion and
// CEROD in compression. Source: LS-DYNA theory manual (public), equation of state form 1.
#include "material/point.h"
#include "material/relaxation.h"

namespace fabrica {

struct Null {
  static constexpr std::string_view keyword = "MAT_NULL";
  static constexpr unsigned families = in_solids | in_shells | in_beams;
  static constexpr bool total = false, can_fail = true;
  static constexpr int rotated = 0;

  Real density, bulk, shear;
  Real cutoff;               // PC <= 0 [stress]
  Real viscosity;            // MU [stress time]
  Real expansion, collapse;  // TEROD, CEROD: relative volumes; 0: none
  bool state_equation;
  Real c[7];
  Real start_energy, start_volume;  // E0, V0

  template <class L>
  struct State {
    L energy;         // e - E0
    L volume_change;  // V / V0 - 1 at the end of the last step
  };

  static Null from(const Parameters& material) { return from(material, nullptr); }
  // eos: the card of *EOS_LINEAR_POLYNOMIAL, or none
  static Null from(const Parameters& material, const Parameters* eos) {
    Null m{};
    const Elastic e =
        Elastic::from_youngs(material.real("ro"), material.real("ym"), material.real("pr"));
    m.density = Real(e.density), m.bulk = Real(e.bulk), m.shear = Real(e.shear);
    m.cutoff = Real(material.real("pc"));
    m.viscosity = Real(material.real("mu"));
    m.expansion = Real(material.real("terod")), m.collapse = Real(material.real("cerod"));
    m.state_equation = eos != nullptr;
    m.start_volume = 1;
    if (!eos) return m;
    const std::string_view names[7] = {"c0", "c1", "c2", "c3", "c4", "c5", "c6"};
    for (int i = 0; i < 7; ++i) m.c[i] = Real(eos->real(names[i]));
    m.start_energy = Real(eos->real("e0"));
    if (eos->real("v0") > 0) m.start_volume = Real(eos->real("v0"));
    m.shear = 0;
    m.bulk = m.stiffness<Real>(1 / m.start_volume - 1, m.start_energy, Real(0), m.start_volume);
    return m;
  }
  Elastic elastic() const { return {density, bulk, shear}; }
  bool may_fail() const { return expansion > 0 || collapse > 0; }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Sym3<L>& old, const Sym3<L>& strain, Point<L>& point,
                            State<L>& state) const {
    const L zero = L(0.0), half = L(0.5);
    if (!state_equation) return {zero, zero, zero, zero, zero, zero};
    const Sym3<L> e = deviator(strain);
    const Sym3<L> s = (L(2 * viscosity) / max(point.dt, L(1e-30))) * e;
    const L old_pressure = trace(old) * L(-1.0 / 3.0);

    // energy before the second half of the volume work, equation (2)
    const L change = point.volume_ratio - L(1.0);
    const L dV = L(start_volume) * (change - state.volume_change),
            V = L(start_volume) * point.volume_ratio;
    const L work = half * V * ddot(s + deviator(old), e);
    const L energy = L(start_energy) + state.energy - half * dV * old_pressure + work;
    const L m = (L(1 - start_volume) - L(start_volume) * change) / V;
    L A, B;
    parts(m, A, B);
    const L pressure = max((A + B * energy) / fma(B, half * dV, L(1.0)), L(cutoff));
    state.energy += work - half * dV * (old_pressure + pressure);
    state.volume_change = change;

    // dt: equation (3), and the viscosity
    const L total = L(start_energy) + state.energy;
    const L modulus = max(stiffness(m, total, pressure, V) / min(V, L(1.0)), L(bulk));
    const L impedance = sqrt(modulus * L(density) / point.volume_ratio) * point.length;
    point.modulus =
        damped_modulus(modulus, L(Real(4.0 / 3.0) * viscosity) / max(impedance, L(1e-30)));
    if (expansion > 0) point.alive = select(point.volume_ratio > L(expansion), zero, point.alive);
    if (collapse > 0) point.alive = select(point.volume_ratio < L(collapse), zero, point.alive);
    return plus_sphere(s, -pressure);
  }

  // Null shells carry mass and contact only.
  template <class L>
  FABRICA_FN Sym3<L> plane_stress(const Sym3<L>&, const Sym3<L>&, Point<L>&, State<L>&,
                                  L& dzz) const {
    const L zero = L(0.0);
    dzz = zero;
    return {zero, zero, zero, zero, zero, zero};
  }
  template <class L>
  FABRICA_FN Sym3<L> uniaxial(const Sym3<L>&, const Sym3<L>&, Point<L>&, State<L>&) const {
    const L zero = L(0.0);
    return {zero, zero, zero, zero, zero, zero};
  }

 private:
  // p = A + B e of equation (1)
  template <class L>
  FABRICA_FN void parts(const L& m, L& A, L& B) const {
    const L squeezed = select(m < L(0.0), L(0.0), m);
    A = fma(m, fma(m * m, L(c[3]), L(c[1])), L(c[0])) + L(c[2]) * squeezed * squeezed;
    B = fma(m, L(c[5]), L(c[4])) + L(c[6]) * squeezed * squeezed;
  }
  // rho0 c^2 of equation (3)
  template <class L>
  FABRICA_FN L stiffness(const L& m, const L& energy, const L& pressure, const L& V) const {
    const L squeezed = select(m < L(0.0), L(0.0), m);
    L A, B;
    parts(m, A, B);
    return L(c[1]) + L(2 * c[2]) * squeezed + L(3 * c[3]) * m * m +
           fma(L(2 * c[6]), squeezed, L(c[5])) * energy + pressure * V * V * B;
  }
};

}  // namespace fabrica
