#pragma once
// Ogden rubber with optional viscoelasticity (*MAT_OGDEN_RUBBER, 077_O).
//   tau_i = sum_j mu_j (lam*_i^alpha_j - 1/3 sum_k lam*_k^alpha_j) + K (J - 1),  lam* = lam
//   J^(-1/3)         (1) sigma = (1/J) sum_i tau_i n_i n_i,   G = 1/2 sum mu_j alpha_j,   K = 2 G
//   (1 + nu) / (3 (1 - 2 nu)) sigma_v = (1/J) F S F^T,  S = sum_i h_i,  h_i driven by 2 G_i dev(dE)
//   and fading with beta_i              (2)
// lam_i, n_i principal stretches and axes of b = F F^T, E Green strain. Evaluated with ln(lam) and
// e^x - 1, so that small strains do not cancel. Source: Ogden 1972; LS-DYNA theory manual (public),
// MAT_077.
#include <stdexcept>
#include <string>

#include "base/eigen3.h"
#include "material/point.h"
#include "material/relaxation.h"

namespace fabrica {

inline constexpr int ogden_terms = 8, ogden_branches = 6;

// The two laws of the keyword differ only in their history, so the plain one carries none.
template <bool viscous>
struct OgdenOf {
  static constexpr std::string_view keyword = "MAT_OGDEN_RUBBER";
  static constexpr unsigned families = in_solids;
  static constexpr bool total = true, can_fail = false;
  static constexpr int rotated = 0;

  Real density = 0, bulk = 0, shear = 0;
  int terms = 0, branches = 0;
  Real mu[ogden_terms] = {}, alpha[ogden_terms] = {};  // [stress], [-]
  Real branch_shear[ogden_branches] = {},
       decay[ogden_branches] = {};  // G_i [stress], beta_i [1/time]

  template <class L>
  struct Branches {
    Sym3<L> green;                 // dev(E) at the end of the last step
    Sym3<L> part[ogden_branches];  // h_i
  };
  template <class L>
  struct Elasticity {};
  template <class L>
  using State = std::conditional_t<viscous, Branches<L>, Elasticity<L>>;

  // whether this variant serves the card
  static bool matches(const Parameters& p) { return viscous == (p.rows() > 0); }
  static OgdenOf from(const Parameters& p);
  Elastic elastic() const {
    double stiff = shear;
    for (int i = 0; i < branches; ++i) stiff += branch_shear[i];
    return {density, bulk, stiff};
  }

  template <class L>
  FABRICA_FN Sym3<L> stress(const Mat3<L>& F, Point<L>& point, State<L>& state) const {
    Mat3<L> H = F;
    for (int i = 0; i < 3; ++i) H.a[i][i] = H.a[i][i] - L(1.0);
    const Eigen3<L> e = eigen_symmetric(L(2.0) * sym(H) + left_cauchy_green(H));
    const L J = point.volume_ratio, per_volume = L(1.0) / J;
    const Vec3<L> l = isochoric_logarithm(e.value);

    // equation (1), and for the time step d tau_i / d ln(lam_i)
    Vec3<L> tau{L(0.0), L(0.0), L(0.0)}, rise = tau;
    for (int j = 0; j < terms; ++j)
      for (int i = 0; i < 3; ++i) {
        const L p = expm1(L(alpha[j]) * l[i]);
        tau[i] = fma(L(mu[j]), p, tau[i]);
        rise[i] = fma(L(mu[j] * alpha[j]), L(1.0) + p, rise[i]);
      }
    const L mean = (tau.x + tau.y + tau.z) * L(1.0 / 3.0);
    const L sphere = L(bulk) * (J - L(1.0)) - mean;
    tangent(rise, tau, e.value, point);
    const Vec3<L> principal{per_volume * (tau.x + sphere), per_volume * (tau.y + sphere),
                            per_volume * (tau.z + sphere)};
    Sym3<L> s = from_principal(principal, e.vector);
    if constexpr (viscous) s += per_volume * push_forward(F, relax(H, point.dt, state));
    return s;
  }

  // strain energy per initial volume of the elastic part
  template <class L>
  FABRICA_FN L energy(const Mat3<L>& F, const L& J) const {
    Mat3<L> H = F;
    for (int i = 0; i < 3; ++i) H.a[i][i] = H.a[i][i] - L(1.0);
    const Vec3<L> l =
        isochoric_logarithm(eigen_symmetric(L(2.0) * sym(H) + left_cauchy_green(H)).value);
    L W = L(bulk) * (J - L(1.0) - log1p(J - L(1.0)));
    for (int j = 0; j < terms; ++j)
      for (int i = 0; i < 3; ++i) W = fma(L(mu[j] / alpha[j]), expm1(L(alpha[j]) * l[i]), W);
    return W;
  }

 private:
  // ln(lam*_i) from the eigenvalues of b - I
  template <class L>
  FABRICA_FN static Vec3<L> isochoric_logarithm(const Vec3<L>& c) {
    Vec3<L> l{L(0.5) * log1p(c.x), L(0.5) * log1p(c.y), L(0.5) * log1p(c.z)};
    const L mean = (l.x + l.y + l.z) * L(1.0 / 3.0);
    l.x -= mean, l.y -= mean, l.z -= mean;
    return l;
  }
  template <class L>
  FABRICA_FN void tangent(const Vec3<L>& rise, const Vec3<L>& tau, const Vec3<L>& c,
                          Point<L>& point) const {
    const L J = point.volume_ratio;
    const L lowest = min(min(tau.x, tau.y), tau.z);
    L steepest = L(0.0), widest = L(1.0), most = L(0.0);
    for (int i = 0; i < 3; ++i) {
      steepest = max(steepest, abs(rise[i]));
      most = max(most, tau[i] - lowest);
      widest = max(widest, L(1.0) + c[i]);
    }
    L branch = L(0.0);
    if constexpr (viscous)
      for (int i = 0; i < branches; ++i) branch += L(2 * branch_shear[i]) * widest * widest;
    // 4/3 of the deviatoric slope, the stress itself and J U'' = K / J
    const L shear_now = fma(L(0.5), steepest, most) + branch;
    point.modulus = max(point.modulus, (fma(L(4.0 / 3.0), shear_now, L(bulk))) / J);
    point.shear = max(point.shear, shear_now / J);
  }
  // advances the branches of equation (2) and returns S
  template <class L>
  FABRICA_FN Sym3<L> relax(const Mat3<L>& H, const L& dt, State<L>& state) const {
    const Sym3<L> green = deviator(sym(H) + L(0.5) * left_cauchy_green(transpose(H)));
    const Sym3<L> change = green - state.green;
    state.green = green;
    Sym3<L> S = L(0.0) * green;
    for (int i = 0; i < branches; ++i) {
      L fade;
      const L phi = relaxation(L(decay[i]) * dt, fade);
      state.part[i] = fade * state.part[i] + (L(2 * branch_shear[i]) * phi) * change;
      S += state.part[i];
    }
    return S;
  }
  template <class L>
  FABRICA_FN static Sym3<L> push_forward(const Mat3<L>& F, const Sym3<L>& S) {
    return rotate(F, S);  // F S F^T
  }
};

template <bool viscous>
OgdenOf<viscous> OgdenOf<viscous>::from(const Parameters& p) {
  if (p.real("n") > 0)
    throw std::invalid_argument(
        "MAT_OGDEN_RUBBER: fitting a test curve (N > 0) is not supported; give MU and ALPHA");
  if (p.real("g") > 0)
    throw std::invalid_argument("MAT_OGDEN_RUBBER: frictional damping (G, SIGF) is not supported");
  if (p.rows() > ogden_branches)
    throw std::invalid_argument(
        "MAT_OGDEN_RUBBER: more than 6 viscoelastic terms are not supported");
  OgdenOf m;
  m.density = Real(p.real("ro"));
  double G = 0;
  for (int j = 1; j <= ogden_terms; ++j) {
    const double mu = p.real("mu" + std::to_string(j)), alpha = p.real("alpha" + std::to_string(j));
    if (mu == 0 || alpha == 0) continue;
    m.mu[m.terms] = Real(mu), m.alpha[m.terms] = Real(alpha);
    ++m.terms;
    G += mu * alpha / 2;
  }
  if (!(G > 0))
    throw std::invalid_argument("MAT_OGDEN_RUBBER: the initial shear modulus is not positive");
  const double nu = p.real("pr");
  m.shear = Real(G), m.bulk = Real(2 * G * (1 + nu) / (3 * (1 - 2 * nu)));
  m.branches = p.rows();
  for (int i = 0; i < m.branches; ++i) {
    m.branch_shear[i] = Real(p.row(i, "gi"));
    m.decay[i] = Real(p.row(i, "betai"));
  }
  return m;
}

using Ogden = OgdenOf<false>;
using ViscousOgden = OgdenOf<true>;

}  // namespace fabrica
