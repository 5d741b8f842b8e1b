#include "material/materials.h"

#include "material/law_test.h"

namespace fabrica {
namespace {

// One call of a law, whatever its form: rate laws take sym(H) as the strain increment, total laws I
// + H as F.
template <class M, class L>
Sym3<L> advance(const M& m, const Sym3<L>& old, const Mat3<L>& H, Point<L>& point,
                typename M::template State<L>& s) {
  if constexpr (M::total) {
    const Mat3<L> F = identity3<L>() + H;
    return m.stress(F, point, s);
  } else {
    return m.stress(old, sym(H), point, s);
  }
}

TEST_CASE("all laws: same bits for every lane width") {
  using P = Pack<Real, 16>;
  Samples().each([](const auto& m) {
    using M = std::decay_t<decltype(m)>;
    std::mt19937 random(2);
    auto wide_state = fresh_state<M, P>();
    typename M::template State<Real> state[16];
    for (auto& s : state) s = fresh_state<M, Real>();
    Sym3<P> wide{P(0.0), P(0.0), P(0.0), P(0.0), P(0.0), P(0.0)};
    Sym3<Real> single[16] = {};
    bool same = true;
    for (int step = 0; step < 20; ++step) {
      Mat3<P> H;
      P J = P(1.0);
      Mat3<Real> one[16];
      for (int lane = 0; lane < 16; ++lane) {
        const Mat3<double> F = random_gradient(random, M::total ? 0.2 : 0.003);
        for (int i = 0; i < 9; ++i) {
          one[lane].a[i / 3][i % 3] = Real(F.a[i / 3][i % 3] - (i % 4 == 0));
          set(H.a[i / 3][i % 3], lane, one[lane].a[i / 3][i % 3]);
        }
        set(J, lane, Real(det(F)));
      }
      auto wide_point = fresh_point<P>(m, 0.5);
      wide_point.volume_ratio = J;
      wide = advance(m, wide, H, wide_point, wide_state);
      for (int lane = 0; lane < 16; ++lane) {
        auto point = fresh_point<Real>(m, 0.5);
        point.volume_ratio = get(J, lane);
        single[lane] = advance(m, single[lane], one[lane], point, state[lane]);
        for (int i = 0; i < 6; ++i) same = same && single[lane][i] == get(wide[i], lane);
        same = same && point.modulus == get(wide_point.modulus, lane);
      }
    }
    CHECK_MESSAGE(same, M::keyword);
  });
}

// s(Q F) = Q s(F) Q^T for total laws, s(Q old Q^T, Q e Q^T) = Q s(old, e) Q^T for rate laws
TEST_CASE("all laws: objectivity and isotropy") {
  Samples().each([](const auto& m) {
    using M = std::decay_t<decltype(m)>;
    std::mt19937 random(6);
    for (int k = 0; k < 100; ++k) {
      const Mat3<double> Q = rotation_about(random_direction(random), 0.3 + k);
      auto plain = fresh_state<M>(), turned = plain;
      Sym3<double> a = no_stress(), b = a;
      double scale = 0;
      for (int step = 0; step < 5; ++step) {
        const Mat3<double> F = random_gradient(random, M::total ? 0.3 : 0.004);
        auto p = fresh_point(m, 0.5, det(F)), q = p;
        if constexpr (M::total) {
          a = m.stress(F, p, plain);
          b = m.stress(Q * F, q, turned);
        } else {
          const Sym3<double> e = sym(F + diagonal(-1, -1, -1));
          a = m.stress(a, e, p, plain);
          b = m.stress(b, rotate(Q, e), q, turned);
        }
        scale = std::max(scale, largest(a));
        CHECK_MESSAGE(largest(rotate(Q, a) - b) < 1e-8 * scale, M::keyword);
        CHECK(near(p.modulus, q.modulus, 1e-7));
      }
    }
  });
}

// Closed strain paths cost work: sum of stress x strain over a cycle from and to the virgin state
// is not negative.
TEST_CASE("rate laws: random cycles dissipate") {
  Samples().each([](const auto& m) {
    using M = std::decay_t<decltype(m)>;
    if constexpr (!M::total && !std::is_same_v<M, ViscousFoam>) {
      std::mt19937 random(12);
      std::uniform_real_distribution<double> uniform(-1, 1);
      double least = 0;
      for (int path = 0; path < 500; ++path) {
        auto state = fresh_state<M>();
        Sym3<double> s = no_stress(), sum = no_stress();
        double work = 0, size = 0, J = 1;
        const int steps = 40;
        for (int i = 0; i <= steps; ++i) {
          // the last step closes the path
          Sym3<double> e;
          for (int j = 0; j < 6; ++j) e[j] = i < steps ? 2e-3 * uniform(random) : -sum[j];
          const int parts = i < steps ? 5 : 50;
          for (int k = 0; k < parts; ++k) {
            const Sym3<double> part = (1.0 / parts) * e;
            J *= std::exp(trace(part));
            auto point = fresh_point(m, 0.5, J);
            const Sym3<double> old = s;
            s = m.stress(old, part, point, state);
            const double w = 0.5 * ddot(old + s, part);
            work += w, size += std::abs(w);
          }
          sum += e;
        }
        least = std::min(least, work / size);
      }
      CHECK_MESSAGE(least > -1e-6, M::keyword);
    }
  });
}

// m . A(n) . m of the acoustic tensor by central differences from a state that the law has just
// reached.
template <class M>
double acoustic(const M& m, const Mat3<double>& F, const Sym3<double>& s,
                const typename M::template State<double>& state, double dt, const Vec3<double>& n,
                const Vec3<double>& d) {
  const double h = 1e-6, J = det(F);
  double traction[2];
  for (int side = 0; side < 2; ++side) {
    Mat3<double> step;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) step.a[i][j] = (side ? h : -h) * d[i] * n[j];
    auto copy = state;
    if constexpr (M::total) {
      // nominal traction on the plane n: J' s' (I + step)^-T n
      const Mat3<double> A = identity3<double>() + step, G = A * F;
      auto point = fresh_point(m, dt, det(G));
      const Sym3<double> now = m.stress(G, point, copy);
      traction[side] = det(A) * dot(d, now * (transpose(inverse(A)) * n));
    } else {
      auto point = fresh_point(m, dt, J * (1 + step.a[0][0] + step.a[1][1] + step.a[2][2]));
      traction[side] = dot(d, m.stress(s, sym(step), point, copy) * n);
    }
  }
  return (traction[1] - traction[0]) / (2 * h);
}

TEST_CASE("all laws: the modulus for the time step covers the acoustic tensor") {
  Samples().each([](const auto& m) {
    using M = std::decay_t<decltype(m)>;
    std::mt19937 random(3);
    double worst = 0;
    for (int k = 0; k < 300; ++k) {
      auto state = fresh_state<M>();
      Sym3<double> s = no_stress();
      // long steps, so that damping proportional to the rate does not count as stiffness
      const double dt = 1e6;
      Mat3<double> F = identity3<double>();
      double modulus = 0;
      for (int i = 0; i < 3; ++i) {
        F = random_gradient(random, M::total ? 0.25 : 0.01);
        auto point = fresh_point(m, dt, det(F));
        s = advance(m, s, F + diagonal(-1, -1, -1), point, state);
        modulus = point.modulus;
      }
      for (int i = 0; i < 20; ++i) {
        const Vec3<double> n = random_direction(random), d = i % 2 ? n : random_direction(random);
        worst = std::max(worst, acoustic(m, F, s, state, dt, n, d) / modulus);
      }
    }
    CHECK_MESSAGE(worst < 1.001, M::keyword << " " << worst);
  });
}

TEST_CASE("laws are found by keyword, family and card") {
  const Samples samples;
  std::string found;
  auto name = [&](const auto& m) { found = std::decay_t<decltype(m)>::keyword; };
  CHECK(with_material("MAT_PLASTIC_KINEMATIC", samples.plastic, nullptr, name));
  CHECK(found == "MAT_PLASTIC_KINEMATIC");
  CHECK_FALSE(with_material<in_shells>("MAT_CRUSHABLE_FOAM", samples.crushable, nullptr, name));
  CHECK_FALSE(with_material("MAT_UNKNOWN", samples.plastic, nullptr, name));
  CHECK(material_index("MAT_OGDEN_RUBBER", samples.ogden) !=
        material_index("MAT_OGDEN_RUBBER", samples.ogden_viscous));
  CHECK(material_index("MAT_UNKNOWN", samples.ogden) == -1);
  int solids = 0, shells = 0;
  for_each_material<in_solids>(Materials{}, [&](auto) { ++solids; });
  for_each_material<in_shells>(Materials{}, [&](auto) { ++shells; });
  CHECK(solids == Materials::size - 1);  // muscles are for trusses
  CHECK(shells < solids);
}

}  // namespace
}  // namespace fabrica
