#pragma once
// General hyperelastic rubber (*MAT_HYPERELASTIC_RUBBER, 077_H).
//   W = sum_pq C_pq x^p y^q + K/2 (J - 1)^2,  x = J1 - 3,  y = J2 - 3                          (1)
//   J1 = tr b*,  J2 = (tr^2 b* - tr b*^2) / 2,  b* = J^(-2/3) F F^T
//   G = 2 (C10 + C01),  K = 2 G (1 + nu) / (3 (1 - 2 nu))
//   J sigma = 2 dev(Wx b* + Wy (J1 b* - b*^2)) + J K (J - 1) I                                 (2)
// C10, C01, C11, C20, C02, C30. Evaluated with g = b* - I, so that small strains do not cancel:
//   x = tr g,  y = 2 tr g + (tr^2 g - tr g^2) / 2.
// Source: Rivlin and Saunders 1951; James, Green, Simpson 1975; LS-DYNA theory manual (public),
// MAT_077.
#include <cmath>
#include <stdexcept>

#include "base/lane_math.h"
#include "material/point.h"

namespace fabrica {

struct HyperelasticRubber {
  static constexpr std::string_view keyword = "MAT_HYPERELASTIC_RUBBER";
  static constexpr unsigned families = in_solids;
  static constexpr bool total = true, can_fail = false;
  static constexpr int rotated = 0;

  Real density, C10, C01, C11, C20, C02, C30, bulk;

  template <class L>
  struct State {};

  static HyperelasticRubber from(const Parameters& p) {
    if (p.real("n") > 0)
      throw std::invalid_argument(
          "MAT_HYPERELASTIC_RUBBER: fitting a test curve (N > 0) is not supported; give C10 to "
          "C30");
    if (p.real("g") > 0)
      throw std::invalid_argument(
          "MAT_HYPERELASTIC_RUBBER: frictional damping (G, SIGF) is not supported");
    if (p.rows() > 0)
      throw std::invalid_argument(
          "MAT_HYPERELASTIC_RUBBER: viscoelastic terms (GI, BETAI) are not supported");
    const double nu = p.real("pr"), G = 2 * (p.real("c10") + p.real("c01"));
    if (!(G > 0))
      throw std::invalid_argument(
          "MAT_HYPERELASTIC_RUBBER: the initial shear modulus 2 (C10 + C01) is not positive");
    return {Real(p.real("ro")),  Real(p.real("c10")),
            Real(p.real("c01")), Real(p.real("c11")),
            Real(p.real("c20")), Real(p.real("c02")),
            Real(p.real("c30")), Real(2 * G * (1 + nu) / (3 * (1 - 2 * nu)))};
  }
  Elastic elastic() const { return {density, bulk, 2.0 * (double(C10) + double(C01))}; }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Mat3<L>& F, Point<L>& point, State<L>&) const {
    const L J = point.volume_ratio, per_volume = L(1.0) / J;
    const Sym3<L> g = isochoric_strain(F, J), gg = square(g);
    const L t = trace(g), y = second(t, gg);
    const L Wx = fma(L(C11), y, fma(t, fma(L(3 * C30), t, L(2 * C20)), L(C10)));
    const L Wy = fma(L(C11), t, fma(L(2 * C02), y, L(C01)));

    // J1 b* - b*^2 has the deviator (1 + t) dev(g) - dev(g^2)
    const Sym3<L> dx = deviator(g), dy = deviator((L(1.0) + t) * g - gg);
    tangent(g, t, Wx, Wy, dx, dy, point);
    return plus_sphere((L(2.0) * per_volume) * (Wx * dx + Wy * dy), L(bulk) * (J - L(1.0)));
  }

  // strain energy per initial volume, equation (1)
  template <class L>
  FABRICA_FN L energy(const Mat3<L>& F, const L& J) const {
    const Sym3<L> g = isochoric_strain(F, J);
    const L x = trace(g), y = second(x, square(g)), v = J - L(1.0);
    return x * fma(x, fma(L(C30), x, L(C20)), L(C10)) + y * fma(L(C02), y, L(C01)) +
           L(C11) * x * y + L(0.5 * bulk) * v * v;
  }

 private:
  // g = m I + (1 + m) (b - I),  1 + m = J^(-2/3)
  template <class L>
  FABRICA_FN static Sym3<L> isochoric_strain(const Mat3<L>& F, const L& J) {
    Mat3<L> H = F;
    for (int i = 0; i < 3; ++i) H.a[i][i] = H.a[i][i] - L(1.0);
    const L m = expm1(L(-2.0 / 3.0) * log1p(J - L(1.0)));
    return plus_sphere((L(1.0) + m) * (L(2.0) * sym(H) + left_cauchy_green(H)), m);
  }
  // y from tr g and g^2
  template <class L>
  FABRICA_FN static L second(const L& t, const Sym3<L>& gg) {
    return fma(L(2.0), t, L(0.5) * (t * t - trace(gg)));
  }
  // Bounds of the acoustic tensor: first derivatives of W times what the isochoric invariants curve
  // by, second derivatives times the squares of their slopes 2 dx, 2 dy.
  template <class L>
  FABRICA_FN void tangent(const Sym3<L>& g, const L& t, const L& Wx, const L& Wy, const Sym3<L>& dx,
                          const Sym3<L>& dy, Point<L>& point) const {
    const L J = point.volume_ratio, e = L(1.0) + sqrt(ddot(g, g));
    const L xx = ddot(dx, dx), yy = ddot(dy, dy);
    const L curved = L(4.0) * (L(2.0) * abs(L(C11)) * sqrt(xx * yy) +
                               abs(fma(L(6 * C30), t, L(2 * C20))) * xx + abs(L(2 * C02)) * yy);
    const L shear_now = (L(2.0) * fma(L(2.0) * abs(Wy), e, abs(Wx)) * e + curved) * (L(1.0) / J);
    point.modulus = max(point.modulus, fma(L(bulk), J, L(4.0 / 3.0) * shear_now));
    point.shear = max(point.shear, shear_now);
  }
};

}  // namespace fabrica
