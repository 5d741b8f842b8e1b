#include "app/flops.h"

#include "base/lane.h"

namespace fabrica {

struct Counted {
  Real v;
  static inline long count = 0;
  Counted() = default;
  Counted(float x) : v(Real(x)) {}
  Counted(double x) : v(Real(x)) {}
  Counted(int x) : v(Real(x)) {}
  explicit operator Real() const { return v; }
  static Counted one(Real x) { return ++count, Counted(x); }
  Counted operator-() const { return Counted(-v); }
  Counted& operator+=(Counted b) { return *this = one(v + b.v); }
  Counted& operator-=(Counted b) { return *this = one(v - b.v); }
  Counted& operator*=(Counted b) { return *this = one(v * b.v); }
  Counted& operator/=(Counted b) { return *this = one(v / b.v); }
  friend Counted operator+(Counted a, Counted b) { return one(a.v + b.v); }
  friend Counted operator-(Counted a, Counted b) { return one(a.v - b.v); }
  friend Counted operator*(Counted a, Counted b) { return one(a.v * b.v); }
  friend Counted operator/(Counted a, Counted b) { return one(a.v / b.v); }
  friend bool operator<(Counted a, Counted b) { return a.v < b.v; }
  friend bool operator>(Counted a, Counted b) { return a.v > b.v; }
  friend bool operator<=(Counted a, Counted b) { return a.v <= b.v; }
  friend bool operator>=(Counted a, Counted b) { return a.v >= b.v; }
  friend bool operator==(Counted a, Counted b) { return a.v == b.v; }
  friend bool operator!=(Counted a, Counted b) { return a.v != b.v; }
};
template <>
struct LaneTraits<Counted> {
  using Scalar = Real;
  using Mask = bool;
  using Int = LaneTraits<Real>::Int;
  static constexpr int width = 1;
};
inline Counted select(bool m, Counted a, Counted b) { return m ? a : b; }
inline Counted min(Counted a, Counted b) { return a.v < b.v ? a : b; }
inline Counted max(Counted a, Counted b) { return a.v > b.v ? a : b; }
inline Counted abs(Counted a) { return Counted(a.v < 0 ? -a.v : a.v); }
inline Counted fma(Counted a, Counted b, Counted c) {
  return ++Counted::count, Counted::one(fma(a.v, b.v, c.v));
}
inline Counted sqrt(Counted a) { return Counted::one(sqrt(a.v)); }
inline Real get(Counted a, int) { return a.v; }
inline void set(Counted& a, int, Real v) { a.v = v; }

}  // namespace fabrica

#include "base/aligned.h"
#include "element/hex8.h"
#include "element/shell_bt.h"
#include "element/tet4.h"
#include "material/elastic.h"
#include "material/plastic_kinematic.h"

namespace fabrica {
namespace {

template <class E, class M>
double count(const M& law, ElementParameters p, const double (*x)[3]) {
  const Elastic e = law.elastic();
  p.density = Real(e.density), p.bulk = Real(e.bulk), p.shear = Real(e.shear);
  p.youngs = Real(e.youngs()), p.poisson = Real(e.poisson());
  Corners<Counted, E::corners> c{};
  for (int a = 0; a < E::corners; ++a)
    for (int d = 0; d < 3; ++d)
      c.x[a][d] = x[a][d], c.v[a][d] = 0.01 * x[a][(d + 1) % 3], c.w[a][d] = 0.001;
  AlignedVector<Real> state(std::size_t(E::template state_fields<M>(p)) * block_size, Real(0));
  const StateView<Counted> s{state.data()};
  Given<Counted> g{};
  for (Counted& h : g.thickness) h = 0.1;
  E::template initialise<Counted>(law, p, c, g, s);
  CornerForces<Counted, E::corners> out;
  Totals<Counted> totals;
  Counted::count = 0;
  E::template forces<Counted>(law, p, Real(1e-4), c, s, out, totals);
  return double(Counted::count);
}

constexpr double brick[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

// the card of a bilinear steel
class Steel : public Parameters {
 public:
  double real(std::string_view f) const override {
    return f == "ro"     ? 7.85e-6
           : f == "e"    ? 210
           : f == "pr"   ? 0.3
           : f == "sigy" ? 0.3
           : f == "etan" ? 2.1
                         : 0;
  }
  bool given(std::string_view f) const override { return real(f) != 0; }
  CurveView curve(std::string_view) const override { return {}; }
  TableView table(std::string_view) const override { return {}; }
  int rows() const override { return 0; }
  double row(int, std::string_view) const override { return 0; }
};

PlasticKinematic steel() { return PlasticKinematic::from(Steel()); }

}  // namespace

double flops_of_brick() {
  ElementParameters p;
  p.hourglass = 2, p.hourglass_coefficient = Real(0.1);
  return count<Hex8<false>>(steel(), p, brick);
}

double flops_of_tet() {
  constexpr double x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Elastic e = Elastic::from_youngs(1.1e-6, 0.5, 0.4);
  return count<Tet4>(ElasticLaw{Real(e.density), Real(e.bulk), Real(e.shear)}, ElementParameters{},
                     x);
}

double flops_of_shell() {
  ElementParameters p;
  p.hourglass = 4, p.hourglass_coefficient = Real(0.05), p.layers = 5;
  for (int q = 0; q < 5; ++q) p.layer_z[q] = Real(0.4 * (q - 2)), p.layer_weight[q] = Real(0.2);
  return count<ShellBT>(steel(), p, brick);
}

}  // namespace fabrica
