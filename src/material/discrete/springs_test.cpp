// Work per cycle of every spring law under a sinusoidal elongation, against the closed form (V48).
#include "material/discrete/springs.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "material/discrete/six_dof.h"

namespace fabrica {
namespace {
constexpr double pi = std::numbers::pi;

struct TestCard : Parameters {
  std::map<std::string, double, std::less<>> value;
  std::map<std::string, std::pair<std::vector<Real>, std::vector<Real>>, std::less<>> points;
  double real(std::string_view f) const override {
    const auto i = value.find(f);
    return i == value.end() ? 0.0 : i->second;
  }
  bool given(std::string_view f) const override { return value.contains(f); }
  CurveView curve(std::string_view f) const override {
    const auto i = points.find(f);
    if (i == points.end()) return {};
    return {i->second.first.data(), i->second.second.data(), int(i->second.first.size()), true};
  }
  TableView table(std::string_view) const override { return {}; }
  int rows() const override { return 0; }
  double row(int, std::string_view) const override { return 0; }
};

constexpr int steps = 40000;  // per cycle; the trapezoid's error falls with its square
constexpr double period = 2.0;

// Work of the last of n cycles of d = A sin(2 pi t / T).
double work_of_last_cycle(const SpringLaw& law, double A, int cycles) {
  SpringState state;
  const double w = 2 * pi / period, dt = period / steps;
  double work = 0, before_d = 0, before_f = 0;
  for (int i = 0; i <= cycles * steps; ++i) {
    const double t = i * dt, d = A * std::sin(w * t);
    const double rate = i == 0 ? 0.0 : (d - before_d) / dt;
    const double f = spring_force(law, {d, rate, i == 0 ? 0.0 : dt, t}, state).force;
    if (i > (cycles - 1) * steps) work += 0.5 * (f + before_f) * (d - before_d);
    before_d = d, before_f = f;
  }
  return work;
}

double work_of(std::string_view keyword, const TestCard& card, double A, int cycles) {
  const auto law = spring_law(keyword, card);
  REQUIRE(law);
  return work_of_last_cycle(*law, A, cycles);
}
}  // namespace

// elastic laws return all work
TEST_CASE("springs: elastic laws do no work in a cycle") {
  TestCard c;
  c.value["k"] = 3;
  CHECK(std::fabs(work_of("MAT_SPRING_ELASTIC", c, 0.5, 2)) < 1e-12);
  c.points["lcd"] = {{-1, -0.25, 0, 0.5, 1}, {-4, -0.5, 0, 1, 1.5}};
  CHECK(std::fabs(work_of("MAT_SPRING_NONLINEAR_ELASTIC", c, 1.0, 2)) < 1e-9);
}

// W = pi c w A^2
TEST_CASE("springs: a viscous damper takes pi c w A^2 in a cycle") {
  TestCard c;
  c.value["dc"] = 0.75;
  const double expected = pi * 0.75 * (2 * pi / period) * 0.5 * 0.5;
  CHECK(work_of("MAT_DAMPER_VISCOUS", c, 0.5, 2) == doctest::Approx(expected).epsilon(1e-6));
  // the same through the curve of S05
  c.points["lcdr"] = {{-4, 4}, {-3, 3}};
  CHECK(work_of("MAT_DAMPER_NONLINEAR_VISCOUS", c, 0.5, 2) ==
        doctest::Approx(expected).epsilon(1e-6));
}

// A factor on the rate: F = K d (1 + c d'), so W = int K c d d'^2 dt = 0 over a cycle, while over
// the first quarter it is K A^2/2 + K c A^3 w / 3.
TEST_CASE("springs: the rate factor of S04 multiplies the force") {
  TestCard c;
  c.points["lcd"] = {{-2, 2}, {-6, 6}};
  c.points["lcr"] = {{-4, 4}, {-1, 3}};  // 1 + d'/2
  const auto law = spring_law("MAT_SPRING_NONLINEAR_ELASTIC", c);
  REQUIRE(law);
  SpringState state;
  const double A = 0.8, w = 2 * pi / period, dt = period / steps;
  double work = 0;
  for (int i = 0; i < steps / 4; ++i) {
    const double t = (i + 0.5) * dt,
                 step = A * (std::sin(w * (t + dt / 2)) - std::sin(w * (t - dt / 2)));
    work += spring_force(*law, {A * std::sin(w * t), A * w * std::cos(w * t), dt, t}, state).force *
            step;
  }
  const double expected = 3 * A * A / 2 + 3 * 0.5 * A * A * A * w / 3;
  CHECK(work == doctest::Approx(expected).epsilon(1e-6));
}

// Perfectly plastic (KT = 0): parallelogram of height 2 FY and width 2 (A - FY / K).
TEST_CASE("springs: the elastoplastic loop is a parallelogram") {
  TestCard c;
  c.value = {{"k", 4}, {"kt", 0}, {"fy", 1}};
  CHECK(work_of("MAT_SPRING_ELASTOPLASTIC", c, 0.5, 2) ==
        doctest::Approx(4 * 1 * (0.5 - 0.25)).epsilon(1e-6));
}

// Monotone loading with hardening follows the slope KT behind the yield point.
TEST_CASE("springs: hardening has the tangent KT") {
  TestCard c;
  c.value = {{"k", 4}, {"kt", 0.5}, {"fy", 1}};
  const auto law = spring_law("MAT_SPRING_ELASTOPLASTIC", c);
  SpringState state;
  for (const double d : {0.1, 0.3, 0.7, 1.25})
    CHECK(spring_force(*law, {d}, state).force ==
          doctest::Approx(d < 0.25 ? 4 * d : 1 + 0.5 * (d - 0.25)).epsilon(1e-12));
  // reversal: elastic over the doubled, hardened range
  const double top = 1.5;
  CHECK(spring_force(*law, {1.25 - 2 * top / 4 + 1e-9}, state).force ==
        doctest::Approx(-top).epsilon(1e-6));
}

// Kinematic hardening, bilinear: in the steady cycle the window keeps its width 2 FY, so that the
// loop is a parallelogram with slopes K, KT:  W = 2 FY * 2 (A - FY / K) (1 - KT / K) ... from (d,
// F) corners (A, F1), (A - 2 FY/K, F1 - 2 FY): area = 2 FY * (2 A - 2 FY / K) - 2 FY / K * KT (2 A
// - 2 FY / K).
TEST_CASE("springs: the kinematic loop of S06 is the bilinear one") {
  TestCard c;
  const double K = 4, KT = 0.5, FY = 1, A = 1.0;
  c.value = {{"beta", 2}, {"tyi", FY}, {"cyi", -FY}};
  c.points["lcdl"] = {{-2.25, -0.25, 0.25, 2.25}, {-2, -1, 1, 2}};
  c.points["lcdu"] = {{-1, 1}, {-4, 4}};
  const double width = 2 * A - 2 * FY / K;
  CHECK(work_of("MAT_SPRING_GENERAL_NONLINEAR", c, A, 3) ==
        doctest::Approx(2 * FY * width * (1 - KT / K)).epsilon(1e-6));
}

// Softening (BETA = 0): the tension side falls for good and takes up where it left.
TEST_CASE("springs: S06 keeps its softened strength") {
  TestCard c;
  c.value = {{"beta", 0}, {"tyi", 1}, {"cyi", -1}};
  c.points["lcdl"] = {{-2.25, -0.25, 0.25, 1.25}, {-2, -1, 1, 0.5}};
  c.points["lcdu"] = {{-1, 1}, {-4, 4}};
  const auto law = spring_law("MAT_SPRING_GENERAL_NONLINEAR", c);
  SpringState s;
  const auto at = [&](double d) { return spring_force(*law, {d}, s).force; };
  CHECK(at(0.25) == doctest::Approx(1));
  CHECK(at(0.75) == doctest::Approx(0.75));            // on the falling branch
  CHECK(at(0.65) == doctest::Approx(0.35));            // elastic with slope 4
  CHECK(at(0.85) == doctest::Approx(0.70));            // back on the branch
  CHECK(at(0.85 - 0.425) == doctest::Approx(-1.0));    // the other side yields at CYI
  CHECK(at(-0.075) == doctest::Approx(-1.25));         // and hardens with slope 0.5
  CHECK(at(-0.075 + 0.4875) == doctest::Approx(0.7));  // the tension side waits at 0.7
  CHECK(at(-0.075 + 0.5875) == doctest::Approx(0.65));
}

// Isotropic: the window grows until the path stays inside it; then the loop is elastic.
TEST_CASE("springs: the isotropic loop of S06 shakes down") {
  TestCard c;
  c.value = {{"beta", 1}, {"tyi", 1}, {"cyi", -1}};
  c.points["lcdl"] = {{-2.25, -0.25, 0.25, 2.25}, {-5, -1, 1, 5}};
  c.points["lcdu"] = {{-1, 1}, {-4, 4}};
  const double first = work_of("MAT_SPRING_GENERAL_NONLINEAR", c, 0.5, 1);
  CHECK(first > 0.3);
  CHECK(std::fabs(work_of("MAT_SPRING_GENERAL_NONLINEAR", c, 0.5, 20)) < 1e-5 * first);
}

// Steady Maxwell response: loss stiffness (K0 - KI) w tau / (1 + w^2 tau^2), tau = 1 / BETA; W = pi
// K'' A^2.
TEST_CASE("springs: the Maxwell spring loses pi K'' A^2 in a cycle") {
  TestCard c;
  c.value = {{"k0", 5}, {"ki", 2}, {"beta", 4}};
  const double w = 2 * pi / period, z = w / 4, loss = 3 * z / (1 + z * z);
  CHECK(work_of("MAT_SPRING_MAXWELL", c, 0.5, 8) ==
        doctest::Approx(pi * loss * 0.25).epsilon(1e-6));
}

// After the cut-off time the force is FC.
TEST_CASE("springs: the Maxwell spring holds FC after TC") {
  TestCard c;
  c.value = {{"k0", 5}, {"ki", 2}, {"beta", 4}, {"tc", 1}, {"fc", 0.25}};
  const auto law = spring_law("MAT_SPRING_MAXWELL", c);
  SpringState state;
  CHECK(spring_force(*law, {0.1, 0, 0.1, 0.5}, state).force != doctest::Approx(0.25));
  CHECK(spring_force(*law, {0.7, 0, 0.1, 1.0}, state).force == 0.25);
}

// First cycle of S08 in compression to A: loading along y = x / 2 loses A F/2 - F^2 / (2
// KU); later cycles run up and down the unloading line and lose nothing.
TEST_CASE("springs: the inelastic spring loses its first loading only") {
  TestCard c;
  c.value = {{"ku", 4}, {"ctf", 1}};
  c.points["lcfd"] = {{0, 2}, {0, 1}};
  const double A = 0.5, F = 0.25;
  CHECK(work_of("MAT_SPRING_INELASTIC", c, A, 1) ==
        doctest::Approx(A * F / 2 - F * F / (2 * 4)).epsilon(1e-6));
  CHECK(std::fabs(work_of("MAT_SPRING_INELASTIC", c, A, 2)) < 1e-9);
  // tension is free
  const auto law = spring_law("MAT_SPRING_INELASTIC", c);
  SpringState state;
  CHECK(spring_force(*law, {0.3}, state).force == 0);
  CHECK(spring_force(*law, {-0.3}, state).force == doctest::Approx(-0.15));
}

TEST_CASE("springs: an unknown law is none") { CHECK(!spring_law("MAT_ELASTIC", TestCard{})); }

namespace {
// work of one direction of a discrete beam in cycle `cycles`
double beam_work(const TestCard& c, std::string_view keyword, int dof, double A, int cycles) {
  const auto law = beam_law(keyword, c);
  REQUIRE(law);
  BeamLawState state;
  BeamMotion m;
  m.mass = 4, m.inertia = 1;
  const double w = 2 * pi / period, dt = period / steps;
  double work = 0, before_u = 0, before_f = 0;
  for (int i = 0; i <= cycles * steps; ++i) {
    const double u = A * std::sin(w * i * dt);
    m.rate[dof] = i == 0 ? 0.0 : (u - before_u) / dt;
    m.u[dof] = u;
    const double f = beam_force(*law, m, state).force[dof];
    if (i > (cycles - 1) * steps) work += 0.5 * (f + before_f) * (u - before_u);
    before_u = u, before_f = f;
  }
  return work;
}
constexpr auto general = GeneralBeam::keyword;
}  // namespace

TEST_CASE("discrete beam 066: each direction loses pi c w A^2") {
  TestCard c;
  c.value = {{"tkr", 2}, {"tds", 0.5}, {"rdt", 0.25}, {"fos", 3}};
  const double w = 2 * pi / period;
  CHECK(std::fabs(beam_work(c, LinearBeam::keyword, 0, 0.5, 2)) < 1e-12);
  CHECK(beam_work(c, LinearBeam::keyword, 1, 0.5, 2) ==
        doctest::Approx(pi * 0.5 * w * 0.25).epsilon(1e-6));
  CHECK(beam_work(c, LinearBeam::keyword, 5, 0.5, 2) ==
        doctest::Approx(pi * 0.25 * w * 0.25).epsilon(1e-6));
}

// L = 2 x, mirrored. Every unloading path from (A, 2A) has a closed-form area; a side is loaded
// anew only in the first cycle, so that its work there is 2 * (A^2 - area under the unloading
// path).
TEST_CASE("discrete beam 119: first loops of the four unloading options") {
  const double A = 0.5, F = 1.0;
  TestCard c;
  c.points["lcidtr"] = {{0, 1}, {0, 2}};
  c.points["lcidtur"] = {{0, 1}, {0, 8}};
  CHECK(std::fabs(beam_work(c, general, 0, A, 1)) < 1e-12);
  c.value["iunld"] = 1;  // steeper line through the peak, then zero
  CHECK(beam_work(c, general, 0, A, 1) ==
        doctest::Approx(2 * (A * F / 2 - F * F / (2 * 8))).epsilon(1e-6));
  CHECK(std::fabs(beam_work(c, general, 0, A, 2)) < 1e-9);
  c.value["iunld"] = 3;  // parabola: area = F (A - o) / 3
  c.value["offset"] = 0.4;
  CHECK(beam_work(c, general, 0, A, 1) ==
        doctest::Approx(2 * (A * F / 2 - F * 0.6 * A / 3)).epsilon(1e-6));
  // stiffness K = 8 down to the unloading line 0.5 x, which is met at x1: F - 8 (A - x1) = x1 / 2
  c.value["iunld"] = 2;
  c.value["kt"] = 8;
  c.points["lcidtur"] = {{0, 1}, {0, 0.5}};
  const double x1 = (8 * A - F) / 7.5, under = (A - x1) * (F + x1 / 2) / 2 + x1 * x1 / 4;
  CHECK(beam_work(c, general, 0, A, 1) == doctest::Approx(2 * (A * F / 2 - under)).epsilon(1e-6));
}

TEST_CASE("discrete beam 119: damping factor, damping curve and its scale") {
  TestCard c;
  const double A = 0.5, w = 2 * pi / period;
  c.points["lcidrs"] = {{-1, 1}, {-2, 2}};
  c.value = {{"kr", 9}, {"dampf", 0.5}};  // c = 0.5 sqrt(9 * 1)
  CHECK(beam_work(c, general, 4, A, 2) == doctest::Approx(pi * 1.5 * w * A * A).epsilon(1e-6));
  c.value = {};
  c.points["lcidrds"] = {{-4, 4}, {-2, 2}};
  c.points["lcidres"] = {{-1, 1}, {3, 3}};
  CHECK(beam_work(c, general, 4, A, 2) == doctest::Approx(pi * 1.5 * w * A * A).epsilon(1e-6));
}

// F = FMAX (a TL(l / L0) TV(v / (VMAX SV)) + h): factors at points of their curves, h in closed
// form
TEST_CASE("springs: a muscle pulls by activation, length, velocity and passive stretch") {
  TestCard c;
  c.value = {{"l0", 32}, {"vmax", 0.32}, {"sv", 1},  {"a", -1},     {"fmax", 900},
             {"tl", -2}, {"tv", -3},     {"fpe", 0}, {"lmax", 0.6}, {"ksh", 4}};
  c.points["a"] = {{0, 10}, {0, 0.5}};
  c.points["tl"] = {{0.5, 1, 1.5}, {0, 1, 0.4}};
  c.points["tv"] = {{-1, -0.5, 0, 1}, {0, 0.25, 1, 1.4}};
  const auto force = [&](double length, double rate, double time) {
    const auto law = spring_law("MAT_SPRING_MUSCLE", c);
    REQUIRE(law);
    SpringState s;
    return spring_force(*law, {0, rate, 0.1, time, length}, s);
  };
  const double h = std::expm1(4 * 0.5 / 0.6) / std::expm1(4.0);
  CHECK(force(32, 0, 10).force == doctest::Approx(450));
  CHECK(force(32, 0, 99).force == doctest::Approx(450));  // the last activation is held
  CHECK(force(32, 0, 5).force == doctest::Approx(225));
  CHECK(force(48, 0, 10).force == doctest::Approx(900 * (0.5 * 0.4 + h)));
  CHECK(force(32, -0.16, 10).force == doctest::Approx(450 * 0.25));
  CHECK(force(32, 0.32, 10).force == doctest::Approx(450 * 1.4));
  CHECK(force(32, -0.5, 10).force == 0);  // no push
  CHECK(force(12, 0, 10).force == 0);
  CHECK(force(32, 0, 10).damping == doctest::Approx(450 * 1.5 / 0.32));  // steepest slope
  // the tangent of the passive curve, by a difference
  c.value["a"] = 0;
  const double slope = (force(45.001, 0, 0).force - force(44.999, 0, 0).force) / 0.002;
  CHECK(force(45, 0, 0).stiffness == doctest::Approx(slope).epsilon(1e-6));
  c.value["sv"] = 0.5;  // half as fast
  c.value["a"] = 1;
  CHECK(force(32, -0.08, 0).force == doctest::Approx(900 * 0.25));
  c.value["tl"] = -8, c.points.erase("tl");
  CHECK_THROWS_WITH(spring_law("MAT_SPRING_MUSCLE", c), doctest::Contains("tl names curve 8"));
}

TEST_CASE("discrete beam 119: failure by separate sums and by one sum") {
  TestCard c;
  c.value = {{"utfailr", 1}, {"ucfails", 2}};
  BeamMotion m;
  BeamLawState s;
  m.u[0] = 0.8, m.u[1] = -1.6;  // 0.64 on each side
  CHECK(!beam_force(*beam_law(general, c), m, s).failed);
  c.value["fcrit"] = 1;
  CHECK(beam_force(*beam_law(general, c), m, s).failed);
  m.u[1] = 1.6;  // no positive limit along s
  CHECK(!beam_force(*beam_law(general, c), m, s).failed);
}

}  // namespace fabrica
