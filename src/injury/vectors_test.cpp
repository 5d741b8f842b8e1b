// Known values of injury measures: closed forms and numerics of high accuracy, as tabulated with
// the public rating vectors; here each is computed again from a sampled signal.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "injury/body.h"
#include "injury/catalogue.h"
#include "injury/head.h"
#include "injury/tissue.h"

using namespace fabrica;
using std::numbers::pi;

namespace {

constexpr double per_mille = 1e-3;
bool close(double a, double b) { return std::abs(a - b) <= per_mille * std::abs(b); }

Signal sampled(const char* unit, double end, double interval, auto&& value) {
  Signal s{"a", unit, "s", {}, {}};
  for (int i = 0; i <= int(std::lround(end / interval)); ++i)
    s.x.push_back(i * interval), s.y.push_back(value(i * interval));
  return s;
}
Signal half_sine(const char* unit, double peak, double duration, double end,
                 double interval = 1e-5) {
  return sampled(unit, end, interval,
                 [=](double t) { return t < duration ? peak * std::sin(pi * t / duration) : 0.0; });
}
Signal constant(const char* unit, double value) {
  return sampled(unit, 0.01, 1e-3, [=](double) { return value; });
}

}  // namespace

// T a^2.5: 0.010 * 100^2.5 = 1000, 0.015 * 60^2.5, 0.036 * 60^2.5
TEST_CASE("HIC of rectangular pulses is T a^2.5, limited by the window") {
  auto rectangle = [](double g, double length) {
    return sampled("g", 0.08, 1e-5,
                   [=](double t) { return t >= 0.02 && t <= 0.02 + length + 1e-9 ? g : 0.0; });
  };
  CHECK(close(hic(rectangle(100, 0.010), 0.015).value, 1000));
  CHECK(close(hic(rectangle(60, 0.040), 0.015).value, 418.282201));
  CHECK(close(hic(rectangle(60, 0.040), 0.036).value, 1003.87728));
}

// maximisation of the closed-form integral; best window of the first 6.7023 ms
TEST_CASE("HIC of half-sines and a triangle is that of the best window") {
  const Hic h = hic(half_sine("g", 100, 0.010, 0.03), 0.015);
  CHECK(close(h.value, 414.64565));
  CHECK(std::abs(h.to - h.from - 6.7023e-3) < 1e-4);
  CHECK(close(hic(half_sine("g", 100, 0.010, 0.06), 0.036).value, 414.64565));
  CHECK(close(hic(half_sine("g", 50, 0.060, 0.06), 0.015).value, 248.579724));
  CHECK(close(hic(half_sine("g", 50, 0.060, 0.06), 0.036).value, 434.454003));
  const Signal triangle =
      sampled("g", 0.012, 1e-5, [](double t) { return 120 * (1 - std::abs(t - 0.006) / 0.006); });
  CHECK(close(hic(triangle, 0.015).value, 466.418989));
}

TEST_CASE("HIC does not depend on units and scales with a^2.5") {
  Signal a = half_sine("g", 100, 0.010, 0.03), b = a;
  for (double& y : b.y) y *= 2 * 9.80665;
  for (double& t : b.x) t *= 1000;
  b.unit = "m/s2", b.x_unit = "ms";
  CHECK(close(hic(b, 0.015).value, std::pow(2, 2.5) * hic(a, 0.015).value));
}

// A cos(pi 1.5 / 20)
TEST_CASE("3 ms clip of a half-sine, also where 3 ms is no whole number of steps") {
  CHECK(close(clip(half_sine("g", 60, 0.020, 0.04), 0.003), 58.3421952));
  CHECK(close(clip(half_sine("g", 60, 0.020, 0.04, 0.7e-4), 0.003), 58.3421952));
}

// A triangle of base 10 ms and height 100 is 3 ms wide at 70; with a second one of base 5 ms and
// height 80 it is 3 ms wide in all where 10 (1 - L/100) + 5 (1 - L/80) = 3, L = 12/0.1625. The
// duration is met to 1e-9 of it, which is 3e-8 of these levels.
TEST_CASE(
    "3 ms clip: the level between samples is exact, and two peaks count together where asked") {
  auto triangle = [](double t, double middle, double base, double height) {
    return std::max(0.0, height * (1 - std::abs(t - middle) / (base / 2)));
  };
  const Signal one =
      sampled("g", 0.04, 1e-3, [&](double t) { return triangle(t, 0.010, 0.010, 100); });
  CHECK(std::abs(clip(one, 0.003) - 70) < 1e-7);
  CHECK(std::abs(clip(one, 0.003, Clip::cumulative) - 70) < 1e-7);
  const Signal two = sampled("g", 0.04, 0.5e-3, [&](double t) {
    return triangle(t, 0.010, 0.010, 100) + triangle(t, 0.030, 0.005, 80);
  });
  CHECK(std::abs(clip(two, 0.003) - 70) < 1e-7);
  CHECK(std::abs(clip(two, 0.003, Clip::cumulative) - 12 / 0.1625) < 1e-7);
  // a plateau that lasts for exactly 3 ms
  const Signal flat =
      sampled("g", 0.04, 1e-3, [](double t) { return t > 0.0095 && t < 0.0135 ? 50.0 : 0.0; });
  CHECK(std::abs(clip(flat, 0.003) - 50) < 1e-7);
  CHECK_THROWS_AS(clip(flat, 0.05), SignalError);
}

TEST_CASE("BrIC of angular velocities with known peaks") {
  auto of = [](double x, double y, double z) {
    return bric({constant("rad/s", x), constant("rad/s", y), constant("rad/s", z)});
  };
  CHECK(close(of(20, 30, 10), 0.654201722));
  CHECK(close(of(66.25, 0, 0), 1));
  CHECK(close(of(-15, 40, -25), 0.945219371));
  CHECK(close(weibull(0.6, 0.602, 2.84), 0.62864381));
  CHECK(close(weibull(0.6, 0.12, 2.84), 1));
}

// reference: integration to a relative tolerance of 1e-10
TEST_CASE("DAMAGE of half-sine angular accelerations") {
  auto of = [](double x, double y, double z, double duration) {
    const double end = 0.3;
    return damage({half_sine("rad/s2", x, duration, end, 1e-4),
                   half_sine("rad/s2", y, duration, end, 1e-4),
                   half_sine("rad/s2", z, duration, end, 1e-4)});
  };
  CHECK(close(of(5000, 0, 0, 0.010), 0.251564631));
  CHECK(close(of(0, 5000, 0, 0.010), 0.335651486));
  CHECK(close(of(0, 0, 5000, 0.010), 0.402999529));
  CHECK(close(of(3000, 4000, 2000, 0.015), 0.493210765));
}

TEST_CASE("Nij of constant forces and moments in each of the four cases") {
  const NeckIntercepts set = neck_intercepts("H3-50M");
  auto of = [&](double f, double m) { return nij(constant("N", f), constant("Nm", m), set); };
  CHECK(close(of(3000, 60).tension_flexion, 0.634335928));
  CHECK(close(of(3000, -60).tension_extension, 0.885231985));
  CHECK(close(of(-2500, 100).compression_flexion, 0.728424801));
  CHECK(close(of(-2500, -40).compression_extension, 0.702140452));
  CHECK(close(of(0, 155).largest(), 0.5));
  // M_oc = M_y - e F_x
  CHECK(close(occipital_moment(constant("Nm", 50), constant("kN", 1), 0.01778).y[0], 32.22));
  CHECK_THROWS_AS(neck_intercepts("nobody"), SignalError);
}

// D_0 sin(pi t / T): max of V C = D_0^2 pi / (2 T D_ref)
TEST_CASE("VC of a half-sine deflection") {
  const Signal d = half_sine("mm", 40, 0.040, 0.040, 1e-4);
  CHECK(close(viscous_criterion(d, 0.229, 1.3), 0.356687376));
  CHECK(close(viscous_criterion(d, 0.229, 1.0), 0.274374904));
}

TEST_CASE("tibia index and thoracic index of constant loads") {
  CHECK(close(tibia_index(constant("Nm", 100), constant("Nm", 120), constant("kN", -4),
                          tibia_limits("H3-50M")),
              0.805665028));
  CHECK(combined_thoracic_index(85, 102) == 2);
  CHECK(largest_compression(constant("kN", -7)) == 7);
  CHECK(largest_compression(constant("kN", 7)) == 0);
}

TEST_CASE("ribs: probability of at least k fractures is exact") {
  const std::vector<double> p{0.05, 0.1, 0.3, 0.6, 0.02, 0.15, 0, 0.4, 0.25, 0.08, 0.01, 0.5};
  CHECK(close(at_least(p, 1), 0.959132818));
  CHECK(close(at_least(p, 2), 0.779879127));
  CHECK(close(at_least(p, 3), 0.469377924));
  CHECK(close(at_least(p, 6), 0.00838025543));
  CHECK(std::abs(at_least(p, 0) - 1) < 1e-12);
}

// Larsson et al. 2021: ln e at fracture is normal, median -2.9866 - 0.0130 age, deviation 0.3026.
// At 25, 45, 65 years half of the ribs break at 3.65, 2.81, 2.17 %; Phi(-1) = 0.158655254,
// Phi(1.6448536) = 0.95.
TEST_CASE("ribs: the risk of one rib is log-normal in strain, with a median that falls with age") {
  CHECK(close(rib_fracture_probability(0.0364578, 25), 0.5));
  CHECK(close(rib_fracture_probability(0.0281108, 45), 0.5));
  CHECK(close(rib_fracture_probability(0.0216749, 65), 0.5));
  const double median = std::exp(-2.9866 - 0.0130 * 40);
  CHECK(std::abs(rib_fracture_probability(median, 40) - 0.5) < 1e-12);
  CHECK(close(rib_fracture_probability(median * std::exp(-0.3026), 40), 0.158655254));
  CHECK(close(rib_fracture_probability(median * std::exp(1.6448536 * 0.3026), 40), 0.95));
  CHECK(rib_fracture_probability(0.02, 70) > rib_fracture_probability(0.02, 30));
  CHECK(rib_fracture_probability(0, 30) == 0);
}

// Twelve subjects, whose strains at 25 years are 1.654 to 4.102 %: at 65 years bone bears
// 1 - 0.0051 x 40 = 0.796 of them
TEST_CASE("rib fractures after Forman: steps of one in twelve, moved by age") {
  CHECK(rib_fracture_probability_forman(0.0165, 25) == 0);
  CHECK(rib_fracture_probability_forman(0.0166, 25) == doctest::Approx(1.0 / 12));
  CHECK(rib_fracture_probability_forman(0.0240, 25) == doctest::Approx(5.0 / 12));
  CHECK(rib_fracture_probability_forman(0.0411, 25) == 1);
  CHECK(rib_fracture_probability_forman(0.796 * 0.0240, 65) == doctest::Approx(5.0 / 12));
  CHECK(rib_fracture_probability_forman(0.0240, 65) == doctest::Approx(6.0 / 12));  // 3.015 %
  CHECK(rib_fracture_probability_forman(0, 65) == 0);
}

TEST_CASE("tissue: quantiles and fractions weigh elements by their volume") {
  const std::vector<double> strain{0.1, 0.3, 0.2}, volume{90, 4, 6};
  CHECK(volume_quantile(strain, volume, 1) == 0.3);
  CHECK(volume_quantile(strain, volume, 0.95) == 0.2);
  CHECK(volume_quantile(strain, volume, 0.5) == 0.1);
  CHECK(std::abs(volume_fraction_above(strain, volume, 0.15) - 0.1) < 1e-12);
  CHECK_THROWS_AS(volume_quantile({}, {}, 1), SignalError);
}
