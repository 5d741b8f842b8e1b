#pragma once
// Mooney-Rivlin rubber (*MAT_MOONEY-RIVLIN_RUBBER, 027).
//   W = A (I1 - 3) + B (I2 - 3) + C (I3^-2 - 1) + D (I3 - 1)^2 (1) C = A/2 + B,  D = (A (5 nu - 2)
//   + B (11 nu - 5)) / (2 (1 - 2 nu)),  G = 2 (A + B) sigma = (1/J) (2A b + 2B (I1 b - b^2) + 2 I3
//   (-2C I3^-3 + 2D (I3 - 1)) I),  b = F F^T                  (2)
// evaluated with c = b - I, so that small strains do not cancel. I3 = J^2.
// A uniaxial test (LCID, specimen SGL, SW, ST) is fitted by least squares of nominal stress:
//   P = 2 (lam - lam^-2) (A + B / lam).
// Source: Mooney 1940; Rivlin 1948; LS-DYNA theory manual (public), MAT_027.
#include <cmath>
#include <stdexcept>

#include "material/point.h"

namespace fabrica {

struct MooneyRivlin {
  static constexpr std::string_view keyword = "MAT_MOONEY-RIVLIN_RUBBER";
  static constexpr unsigned families = in_solids;
  static constexpr bool total = true, can_fail = false;
  static constexpr int rotated = 0;

  Real density, A, B, C, D, bulk;

  template <class L>
  struct State {};

  static MooneyRivlin from(const Parameters& p) {
    double A = p.real("a"), B = p.real("b");
    const double nu = p.real("pr");
    if (const CurveView test = p.curve("lcid")) fit(p, test, A, B);
    const double C = A / 2 + B, D = (A * (5 * nu - 2) + B * (11 * nu - 5)) / (2 * (1 - 2 * nu));
    const double G = 2 * (A + B), K = 2 * G * (1 + nu) / (3 * (1 - 2 * nu));
    return {Real(p.real("ro")), Real(A), Real(B), Real(C), Real(D), Real(K)};
  }
  Elastic elastic() const { return {density, bulk, 2.0 * (A + B)}; }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Mat3<L>& F, Point<L>& point, State<L>&) const {
    const Sym3<L> c = strain_of(F), cc = square(c);
    const L t = trace(c), J = point.volume_ratio, per_volume = L(1.0) / J;
    const L w = (J - L(1.0)) * (J + L(1.0)), I3 = fma(w, L(1.0), L(1.0));

    // I1 b - b^2 has the deviator (I1 - 2) dev(c) - dev(c^2)
    const L linear = fma(L(2 * B), t + L(1.0), L(2 * A));
    const Sym3<L> s = deviator(linear * c - L(2 * B) * cc);
    // mean stress; the constants cancel because 2A + 4B = 4C
    const L second = L(0.5) * (t * t - trace(cc));
    const L shear_part =
        fma(L(Real(2.0 / 3.0) * A), t, L(Real(4.0 / 3.0) * B) * fma(L(2.0), t, second));
    const L volume_part = w * fma(L(4 * D), I3, L(4 * C) * (L(2.0) + w) / (I3 * I3));
    tangent(c, point);
    return per_volume * plus_sphere(s, shear_part + volume_part);
  }

  // strain energy per initial volume, equation (1)
  template <class L>
  FABRICA_FN L energy(const Mat3<L>& F, const L& J) const {
    const Sym3<L> c = strain_of(F);
    const L t = trace(c), w = (J - L(1.0)) * (J + L(1.0)), I3 = L(1.0) + w;
    const L second = L(0.5) * (t * t - trace(square(c)));
    return L(A) * t + L(B) * fma(L(2.0), t, second) - L(C) * w * (L(2.0) + w) / (I3 * I3) +
           L(D) * w * w;
  }

 private:
  // c = b - I = H + H^T + H H^T, H = F - I
  template <class L>
  FABRICA_FN static Sym3<L> strain_of(const Mat3<L>& F) {
    Mat3<L> H = F;
    for (int i = 0; i < 3; ++i) H.a[i][i] = H.a[i][i] - L(1.0);
    return L(2.0) * sym(H) + left_cauchy_green(H);
  }
  // Bounds of the acoustic tensor: 2A n.b.n + 2B |d cof F|^2 for shear, and J U'' with U the part
  // of J.
  template <class L>
  FABRICA_FN void tangent(const Sym3<L>& c, Point<L>& point) const {
    const L J = point.volume_ratio, e = L(1.0) + sqrt(ddot(c, c));
    const L a = L(A > 0 ? A : -A), b = L(B > 0 ? B : -B), square = J * J;
    const L isochoric = fma(L(4.0) * b, e, L(2.0) * a) * e / J;
    const L inverse = L(1.0) / square;
    const L volumetric =
        J * fma(L(20 * C) * inverse * inverse, inverse, L(4 * D) * fma(L(3.0), square, L(-1.0)));
    point.modulus = max(point.modulus, isochoric + max(volumetric, L(0.0)));
    point.shear = max(point.shear, fma(L(2.0) * b, e, L(2.0) * a) * e / J);
  }
  static void fit(const Parameters& p, const CurveView& test, double& A, double& B) {
    auto or_one = [&](std::string_view field) { return p.real(field) > 0 ? p.real(field) : 1.0; };
    const double gauge = or_one("sgl"), area = or_one("sw") * or_one("st");
    double aa = 0, ab = 0, bb = 0, ap = 0, bp = 0;
    for (int i = 0; i < test.n; ++i) {
      const double lam = 1 + test.x[i] / gauge, P = test.y[i] / area;
      if (lam <= 0) continue;
      const double f = 2 * (lam - 1 / (lam * lam)), g = f / lam;
      aa += f * f, ab += f * g, bb += g * g, ap += f * P, bp += g * P;
    }
    const double determinant = aa * bb - ab * ab;
    if (!(determinant > 1e-12 * aa * bb))
      throw std::invalid_argument(
          "MAT_MOONEY-RIVLIN_RUBBER: curve LCID does not determine A and B");
    A = (ap * bb - bp * ab) / determinant, B = (aa * bp - ab * ap) / determinant;
  }
};

}  // namespace fabrica
