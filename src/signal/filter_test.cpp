#include "signal/filter.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "signal/operations.h"

using namespace fabrica;

namespace {

double decibel(double gain) { return 20 * std::log10(gain); }

Signal sampled(double interval, int n, auto&& value, const char* unit = "g") {
  Signal s{"a", unit, "s", {}, {}};
  for (int i = 0; i < n; ++i) s.x.push_back(interval * i), s.y.push_back(value(interval * i));
  return s;
}

}  // namespace

// Corridor of SAE J211-1 with F_H = CFC, F_N = CFC/0.6: within 0.5 dB up to F_H; +0.5, -4 dB at
// F_N; above it at most 0.5 dB - 9 dB an octave down to -30 dB and, to a quarter of the sampling
// rate, where a sampled filter can follow an analogue one, at least -4 dB - 24 dB an octave.
TEST_CASE(
    "CFC: the response lies in the corridor of SAE J211 for every class and rates of 1 to 100 "
    "kHz") {
  int tested = 0;
  for (const double cfc : {60.0, 180.0, 600.0, 1000.0})
    for (const double rate :
         {1e3, 1.8e3, 2e3, 5e3, 6e3, 8e3, 10e3, 12.5e3, 20e3, 25e3, 50e3, 80e3, 100e3}) {
      if (rate < 10 * cfc) {
        CHECK_THROWS_AS(cfc_coefficients(cfc, 1 / rate), SignalError);
        continue;
      }
      ++tested;
      const FilterCoefficients c = cfc_coefficients(cfc, 1 / rate);
      const double f_n = cfc / 0.6;
      bool inside = true;
      for (double f = 0.1; f < 0.499 * rate; f *= 1.01) {
        const double gain = decibel(cfc_gain(c, f, 1 / rate)), octaves = std::log2(f / f_n);
        const double high = f <= f_n ? 0.5 : std::max(0.5 - 9 * octaves, -30.0);
        const double low = f <= cfc        ? -0.5
                           : f <= f_n      ? -0.5 - 3.5 * std::log(f / cfc) / std::log(f_n / cfc)
                           : f <= rate / 4 ? -4 - 24 * octaves
                                           : -1e9;
        inside = inside && gain <= high && gain >= low;
      }
      CAPTURE(cfc);
      CAPTURE(rate);
      CHECK(inside);
    }
  CHECK(tested == 13 + 12 + 9 + 7);
}

// |H|^2 of two passes = 1/sqrt(2) at F_N for sampling much faster than the class
TEST_CASE("CFC: gain at the corner frequency is 1/sqrt(2)") {
  for (const double cfc : {60.0, 180.0, 600.0, 1000.0})
    CHECK(std::abs(cfc_gain(cfc_coefficients(cfc, 1e-6), cfc / 0.6, 1e-6) - std::sqrt(0.5)) < 1e-3);
}

TEST_CASE("CFC: a class that SAE J211 does not have is refused") {
  for (const double cfc : {0.0, -60.0, 100.0, 1650.0})
    CHECK_THROWS_WITH_AS(cfc_coefficients(cfc, 1e-6), doctest::Contains("Use 60, 180, 600 or 1000"),
                         SignalError);
}

TEST_CASE("CFC: a filtered sine keeps its phase and has the gain of the response") {
  const double interval = 1e-4, f = 80;
  const FilterCoefficients c = cfc_coefficients(60, interval);
  const Signal s =
      sampled(interval, 4001, [&](double t) { return std::sin(2 * std::numbers::pi * f * t); });
  const Signal out = cfc_filtered(s, 60);
  double largest = 0;
  for (int i = 1000; i <= 3000; ++i)
    largest = std::max(largest, std::abs(out.y[i] - cfc_gain(c, f, interval) * s.y[i]));
  CHECK(largest < 1e-6);
}

TEST_CASE("CFC: a straight line passes unchanged, to its ends") {
  const Signal s = sampled(1e-4, 500, [](double t) { return 3 + 20 * t; });
  const Signal out = cfc_filtered(s, 180);
  double largest = 0;
  for (std::size_t i = 0; i < s.size(); ++i)
    largest = std::max(largest, std::abs(out.y[i] - s.y[i]));
  CHECK(largest < 1e-3);
}

TEST_CASE("CFC: filtering does not depend on the unit of time") {
  Signal s = sampled(1e-4, 500, [](double t) { return std::exp(-1e4 * (t - 0.02) * (t - 0.02)); }),
         ms = s;
  for (double& t : ms.x) t *= 1000;
  ms.x_unit = "ms";
  const Signal a = cfc_filtered(s, 180), b = cfc_filtered(ms, 180);
  for (std::size_t i = 0; i < a.size(); i += 50) CHECK(std::abs(a.y[i] - b.y[i]) < 1e-9);
}

TEST_CASE("integral and derivative of a parabola, with units") {
  // a = 6 t [g]: v = 3 t^2 g
  const Signal a = sampled(1e-3, 101, [](double t) { return 6 * t; });
  const Signal v = integrated(a, 2);
  CHECK(v.unit == "m/s");
  CHECK(std::abs(v.y.back() - (2 + 3 * 0.01 * 9.80665)) < 1e-12);
  const Signal again = differentiated(v);
  CHECK(again.unit == "m/s2");
  CHECK(std::abs(again.y[0]) < 1e-6);
  CHECK(std::abs(again.y[50] - 6 * 0.05 * 9.80665) < 1e-9);
  CHECK(std::abs(again.y.back() - 6 * 0.1 * 9.80665) < 1e-6);
}

// F = 2 t [kN] over 10 ms: the impulse is F t / 2
TEST_CASE("the integral of a force over time is an impulse") {
  Signal force = sampled(
      1, 11, [](double t) { return 2 * t; }, "kN");
  force.x_unit = "ms";
  const Signal impulse = integrated(force);
  CHECK(impulse.unit == "N s");
  CHECK(impulse.y.back() == doctest::Approx(20e3 * 0.010 / 2).epsilon(1e-12));
}

TEST_CASE("a step longer than the record is refused with the unit it was taken in") {
  const Signal s = sampled(1e-4, 11, [](double t) { return t; });
  CHECK_THROWS_WITH_AS(resampled(s, 0.1), doctest::Contains("0.1 s is longer than"), SignalError);
}

TEST_CASE("of many names a message shows those with the wanted id, and how many there are") {
  CHECK(listed({"a", "b"}) == "a, b");
  std::vector<std::string> names{"time"};
  for (const char* what : {"force:", "moment:"})
    for (int id = 1; id <= 40; ++id) names.push_back(what + std::to_string(id));
  const std::string text = listed(names, "work:7");
  CHECK(text.starts_with("force:7, moment:7, time, force:1, "));
  CHECK(text.ends_with("force:22 and 57 more"));
}

TEST_CASE("resultant, crop and offset") {
  const Signal x = sampled(0.01, 11, [](double) { return 3; }),
               y = sampled(0.01, 11, [](double) { return 4; });
  CHECK(resultant({x, y}).y[5] == 5);
  CHECK(cropped(x, 0.02, 0.05).size() == 4);
  CHECK(offset(x, -3).y[3] == 0);
  CHECK_THROWS_AS(cropped(x, 7.0, 8.0), SignalError);
  const Signal metres = sampled(
      0.01, 11, [](double) { return 4; }, "mm");
  CHECK_THROWS_AS(resultant({x, metres}), SignalError);
}
