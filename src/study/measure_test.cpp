#include "study/measure.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "study/compare.h"
#include "study/error.h"
#include "study/fit.h"

using namespace fabrica::study;

namespace {

namespace fs = std::filesystem;

struct Result {
  fs::path path = fs::temp_directory_path() / ("fabrica_measure_" + std::to_string(::getpid()));
  Result() {
    fs::create_directories(path);
    std::ofstream(path / "a.csv") << "time,f:1,u\n0,0,0\n1,2,10\n2,-6,20\n3,4,15\n";
    std::ofstream(path / "ref.csv") << "# provenance: digitised by hand\n# source: somebody\ntime "
                                       "[ms],g [kN],h_mm\n0,1,2\n1,,3\n";
  }
  ~Result() { fs::remove_all(path); }
};

double value(Channels& channels, const std::string& statistic_name, const std::string& over = "",
             std::optional<std::pair<double, double>> range = {}) {
  CheckSpec c;
  c.model = "a:f:1", c.statistic = statistic_name, c.over = over, c.range = range;
  return statistic(c, channels);
}

}  // namespace

TEST_CASE("statistics of a column are those of its numbers") {
  const Result r;
  Channels channels(r.path.string(), r.path.string(), "ms");
  CHECK(value(channels, "last") == 4);
  CHECK(value(channels, "max") == 4);
  CHECK(value(channels, "min") == -6);
  CHECK(value(channels, "peak") == -6);
  CHECK(value(channels, "magnitude") == 6);
  // trapezoids 1, -2, -1 over a time of 3
  CHECK(value(channels, "mean") == doctest::Approx(-2.0 / 3));
  // work over way: 10*1 + 10*(-2) + (-5)*(-1) = -5 over 10 + 10 - 5 = 15
  CHECK(value(channels, "mean", "a:u") == doctest::Approx(-5.0 / 15));
}

// A spring of stiffness 2 that breaks under 6 stores u = f^2/4 until then. Its support rings by a
// third before, and swings to larger loads of either sign while the energy is given back.
TEST_CASE("the load at failure is that under which the stored energy was greatest") {
  const std::vector<double> stored{0, 0.04, 1, 4, 9, 8.9, 5, 2, 1, 1.5};
  CHECK(failure_load({0, -0.4, -2, -4, -6, -7, -8, 9, -3, 1}, stored) == 6);
  CHECK(failure_load({0, 0.4, 2.7, 1.3, 6, -11, 8, 9, 3, 1}, stored) == 6);
  CHECK(failure_load({0, 0.4, 7, 4, 6, 9, 8, 9, 3, 1}, stored) == 7);  // ringing before it counts
  CHECK(failure_load({0, 1, 2, 3}, {0, 1, 4, 9}) == 3);                // nothing gave way
  // a dip at less than a quarter of the energy is settling
  CHECK(failure_load({0, 2, 1, 9, 0}, {0, 1, 0.5, 20, 0}) == 9);
  // 2 % is what noise of the energy may have
  CHECK(failure_load({0, 2, 3, 4, 0}, {0, 5, 4.91, 6, 0}) == 4);
  CHECK(failure_load({0, 2, 3, 4, 0}, {0, 5, 4.89, 6, 0}) == 2);
  CHECK(failure_load({}, {}) == 0);
}

TEST_CASE("failure reads load and energy in the same part of the run") {
  const Result r;
  std::ofstream(r.path / "e.csv") << "time,u:7\n0,0\n1,4\n2,3\n3,9\n";
  Channels channels(r.path.string(), r.path.string(), "ms");
  CheckSpec c;
  c.model = "a:f:1", c.statistic = "failure", c.energy = "e:u:7";
  CHECK(statistic(c, channels) == 2);
  c.window = {1.5, 3};
  CHECK(statistic(c, channels) == 6);
  c.energy = "e:u:8";
  CHECK_THROWS_WITH_AS(statistic(c, channels), doctest::Contains("there are: time, u:7"),
                       StudyError);
}

TEST_CASE("a curve counts from where it first reaches a level, whatever its sign") {
  CHECK(first_reaching({0, 1, 2}, {0, -1, -3}, 2) == doctest::Approx(1.5));
  CHECK(first_reaching({5, 6}, {4, 0}, 2) == 5);
  CHECK_THROWS_WITH_AS(first_reaching({0, 1}, {0, 1}, 2), doctest::Contains("never reaches 2"),
                       StudyError);
}

// f is 0, 2, -6, 4 at the times 0 to 3
TEST_CASE("a range bounds every statistic") {
  const Result r;
  Channels channels(r.path.string(), r.path.string(), "ms");
  const std::pair early{0.0, 1.5}, middle{1.0, 2.0};
  CHECK(value(channels, "min", "", early) == 0);
  CHECK(value(channels, "last", "", early) == 2);
  CHECK(value(channels, "peak", "", early) == 2);
  CHECK(value(channels, "max", "", middle) == 2);
  CHECK(value(channels, "magnitude", "", middle) == 6);
  CHECK(value(channels, "mean", "", middle) == -2);
  CHECK(value(channels, "max", "a:u", {{14, 16}}) == 4);
  CHECK_THROWS_WITH_AS(value(channels, "max", "", {{7, 8}}), doctest::Contains("no sample"),
                       StudyError);
}

// f is 0, 2, -6, 4 and u 0, 10, 20, 15 at the times 0 to 3
TEST_CASE("a window takes a part of the run's time, a range a part of what is in it") {
  const Result r;
  Channels channels(r.path.string(), r.path.string(), "ms");
  CheckSpec c;
  c.model = "a:f:1", c.statistic = "max", c.window = {1.5, 3};
  CHECK(statistic(c, channels) == 4);
  c.statistic = "mean";
  CHECK(statistic(c, channels) == -1);
  c.over = "a:u", c.range = {14, 16}, c.statistic = "last", c.window = {0, 2.5};
  CHECK_THROWS_WITH_AS(statistic(c, channels), doctest::Contains("no sample from 14 to 16"),
                       StudyError);
  c.window = {0, 3};
  CHECK(statistic(c, channels) == 4);

  Case owner;
  SignalSpec s;
  s.name = "f", s.model = "a:f:1", s.x = "a:u", s.scale = 2, s.window = {0.5, 2};
  const SignalResult shown = compare_signal(s, channels, owner);
  CHECK(shown.model.x == std::vector<double>{10, 20});
  CHECK(shown.model.y == std::vector<double>{4, -12});

  // over time the reference is cut with it
  std::ofstream(r.path / "long.csv") << "time [ms],g [kN]\n0,9\n0.5,1\n1,3\n2,2\n2.5,7\n";
  s.x.clear(), s.reference = "long.csv:g";
  const SignalResult cut = compare_signal(s, channels, owner);
  CHECK(cut.reference.x == std::vector<double>{0.5, 1, 2});
  CHECK(cut.reference_peak == 3);
}

TEST_CASE("a quotient, a sum, a unit, and the head of a file are found") {
  const Result r;
  Channels channels(r.path.string(), r.path.string(), "ms");
  CHECK(channels.column("a:f:1 / a:u") == std::vector<double>{0, 0.2, -0.3, 4.0 / 15});
  CHECK(channels.column("a:f:1 + a:u") == std::vector<double>{0, 12, 14, 19});
  // from left to right, quotients first
  CHECK(channels.column("a:u - a:f:1 / a:f:1 - a:u") == std::vector<double>{0, -1, -1, -1});
  CHECK(channels.abscissa("a:f:1 + a:u / a:u") == channels.abscissa("a:f:1"));
  CHECK(channels.unit("ref.csv:g") == "kN");
  CHECK(channels.unit("ref.csv:h_mm") == "mm");
  CHECK(channels.head("ref.csv:g").at("provenance") == "digitised by hand");
  CHECK(std::isnan(channels.column("ref.csv:g")[1]));
}

TEST_CASE("an abscissa is called by its column or as the case names it") {
  const Result r;
  Channels channels(r.path.string(), r.path.string(), "ms");
  SignalSpec s;
  s.name = "force", s.model = "a:f:1", s.x = "a:u";
  Case c;
  CHECK(compare_signal(s, channels, c).x_name == "u");
  s.x_name = "travel of the ram";
  CHECK(compare_signal(s, channels, c).x_name == "travel of the ram");
}

TEST_CASE("a check reads its column behind a filter of SAE J211, and then its window") {
  const Result r;
  {
    std::ofstream out(r.path / "h.csv");
    out << "time,f\n";  // a half sine of 100 over 50 ms with a ripple of 3 kHz on it
    for (int i = 0; i <= 1000; ++i) {
      const double t = 0.05 * i, pi = std::acos(-1.0);
      out << t << ',' << 100 * std::sin(pi * t / 50) + 40 * std::sin(2 * pi * 3 * t) << '\n';
    }
  }
  Channels channels(r.path.string(), r.path.string(), "ms");
  CheckSpec c;
  c.model = "h:f", c.statistic = "max";
  CHECK(statistic(c, channels) == doctest::Approx(140).epsilon(0.01));
  c.filter = "CFC180";
  CHECK(statistic(c, channels) == doctest::Approx(100).epsilon(0.01));
  // cut before it is filtered, the curve would bend at the edges of the window
  c.window = {5, 10};
  CHECK(statistic(c, channels) ==
        doctest::Approx(100 * std::sin(std::acos(-1.0) / 5)).epsilon(0.01));
  // the same rows in seconds are sampled a thousand times more slowly
  Channels seconds(r.path.string(), r.path.string(), "s");
  CHECK_THROWS_WITH(statistic(c, seconds),
                    doctest::Contains("needs 1800 samples a second, the signal has 20"));
}

TEST_CASE("a reference over another unit of time than the model's is not rated") {
  const Result r;
  std::ofstream(r.path / "curve.csv") << "time [ms],g [kN]\n0,0\n1,2\n2,-6\n3,4\n";
  Channels channels(r.path.string(), r.path.string(), "ms");
  SignalSpec s;
  s.name = "force", s.model = "a:f:1", s.unit = "kN", s.reference = "curve.csv:g";
  s.rating = {"cora"};
  Case c;
  c.file = "case.toml", c.time_unit = "s";
  CHECK_THROWS_WITH_AS(compare_signal(s, channels, c),
                       doctest::Contains("is given over ms, the model over s"), StudyError);
  c.time_unit = "ms";
  CHECK_NOTHROW(compare_signal(s, channels, c));
}

TEST_CASE("what is not in a result is named, and what there is instead") {
  const Result r;
  Channels channels(r.path.string(), r.path.string(), "ms");
  CHECK_THROWS_WITH_AS(channels.column("a:z"), doctest::Contains("there are: time, f:1, u"),
                       StudyError);
  CHECK_THROWS_WITH_AS(channels.column("b:f"), doctest::Contains("no database b; it has: "),
                       StudyError);
  CHECK_THROWS_WITH_AS(channels.column("no.csv:f"), doctest::Contains("no file"), StudyError);
  CHECK_THROWS_WITH_AS(channels.column("f"), doctest::Contains("database:column"), StudyError);
}

TEST_CASE("a check passes within its tolerance and fails beyond it") {
  const Result r;
  Channels channels(r.path.string(), r.path.string(), "ms");
  CheckSpec c;
  c.name = "f", c.model = "a:f:1", c.statistic = "last", c.expected = 5, c.tolerance = 0.2;
  CHECK(evaluate(c, channels, nullptr).passed);
  c.tolerance = 0.19;
  CHECK_FALSE(evaluate(c, channels, nullptr).passed);
  c.expected.reset(), c.most = 3.9;
  CHECK_FALSE(evaluate(c, channels, nullptr).passed);
  c.most = 4, c.least = 4;
  CHECK(evaluate(c, channels, nullptr).passed);
  c.model = "a:q";
  const CheckResult broken = evaluate(c, channels, nullptr);
  CHECK_FALSE(broken.passed);
  CHECK(broken.problem.find("there is no column q") != std::string::npos);
}

// One predictor with values 0 and 1: the odds of the two groups are the maximum of the likelihood,
// b0 = ln(odds of group 0), b1 = ln(odds ratio), and Var(b1) is the sum of the reciprocal counts.
TEST_CASE("a logistic fit of two groups gives their odds in closed form") {
  std::vector<std::vector<double>> x;
  std::vector<int> event;
  const auto add = [&](double group, int count, int happened) {
    for (int i = 0; i < count; ++i) x.push_back({group}), event.push_back(happened);
  };
  add(0, 30, 0), add(0, 10, 1), add(1, 8, 0), add(1, 24, 1);
  const LogisticFit f = fit_logistic(x, event);
  CHECK(f.coefficient[0] == doctest::Approx(std::log(10.0 / 30)).epsilon(1e-9));
  CHECK(f.coefficient[1] == doctest::Approx(std::log(24.0 / 8 / (10.0 / 30))).epsilon(1e-9));
  CHECK(f.standard_error[1] ==
        doctest::Approx(std::sqrt(1.0 / 30 + 1.0 / 10 + 1.0 / 8 + 1.0 / 24)).epsilon(1e-6));
}

TEST_CASE("a logistic fit without a maximum says so") {
  CHECK_THROWS_WITH_AS(fit_logistic({{0}, {1}, {2}, {3}}, {0, 0, 1, 1}),
                       doctest::Contains("separate"), StudyError);
  CHECK_THROWS_WITH_AS(fit_logistic({{0}, {1}}, {1, 1}), doctest::Contains("with and without"),
                       StudyError);
}
