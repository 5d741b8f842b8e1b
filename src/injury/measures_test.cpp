#include "injury/measures.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "injury/logistic.h"
#include "signal/channel_file.h"

using namespace fabrica;
namespace fs = std::filesystem;

namespace {

Signal pulse(const char* unit, double peak) {
  Signal s{"a", unit, "ms", {}, {}};
  for (int i = 0; i <= 2000; ++i) {
    const double t = 0.05 * i;
    s.x.push_back(t);
    s.y.push_back(peak * std::exp(-std::pow((t - 50) / 12, 2)));
  }
  return s;
}
const Judged& of(const std::vector<Judged>& all, const std::string& name) {
  return *std::find_if(all.begin(), all.end(),
                       [&](const Judged& j) { return j.measure->name == name; });
}

}  // namespace

TEST_CASE("measures: each has a name of its own, known roles, a formula and a source") {
  std::set<std::string> names;
  for (const Measure& m : measures()) {
    CAPTURE(m.name);
    CHECK(names.insert(m.name).second);
    CHECK(!m.formula.empty());
    CHECK(!m.source.empty());
    CHECK(!m.filter.empty());
    CHECK(!m.roles.empty());
    for (const std::string& r : m.roles) CHECK(roles().count(r) == 1);
    if (m.limit) CHECK(!m.limit_source.empty());
  }
}

TEST_CASE("measures: what lacks a channel says which") {
  const std::vector<Judged> all =
      judge({}, {{"chest.deflection", pulse("mm", 50)}, {"head.ax", pulse("g", 50)}});
  CHECK(!of(all, "HIC15").finding);
  CHECK(of(all, "HIC15").reason == "no channel head.ay, head.az");
  CHECK(!of(all, "HIC15").failed);
  REQUIRE(of(all, "chest deflection").finding);
  CHECK(std::abs(of(all, "chest deflection").finding->value - 50) < 0.1);
  CHECK(std::abs(of(all, "Cmax").finding->value - 100 * 50 / 229.0) < 0.1);
}

TEST_CASE("measures: a channel that is no use is reported, the others are judged") {
  Signal bad = pulse("kN", 5);
  const std::vector<Judged> all =
      judge({}, {{"chest.deflection", bad}, {"femur_left.fz", pulse("kN", -6)}});
  CHECK(of(all, "chest deflection").failed);
  CHECK(of(all, "chest deflection").reason.find("[different-units]") == 0);
  CHECK(std::abs(of(all, "femur force left").finding->value - 6) < 0.01);
}

TEST_CASE("measures: every one can be computed") {
  Channels c;
  for (const auto& [role, meaning] : roles()) {
    const std::string kind = role.substr(role.find('.') + 1);
    if (kind == "strain" || kind == "stress")
      c[role] = {role, kind == "strain" ? "1" : "MPa", "1", {1, 2, 3}, {0.01, 0.02, 5}};
    else
      c[role] = pulse(kind == "deflection" ? "mm"
                      : kind[0] == 'a'     ? "g"
                      : kind[0] == 'w'     ? "rad/s"
                      : kind[0] == 'f'     ? "kN"
                                           : "Nm",
                      3);
  }
  for (const Judged& j : judge({}, c)) {
    CAPTURE(j.measure->name);
    CAPTURE(j.reason);
    REQUIRE(j.finding);
    CHECK(std::isfinite(j.finding->value));
    for (const Risk& r : j.finding->risks) CHECK((r.probability >= 0 && r.probability <= 1));
  }
}

// HIC15 = 0.015 a^2.5 of a constant acceleration; 1/(1 + exp(1.54 + 200/HIC - 0.00650 HIC))
// and 3.39, 0.00372
TEST_CASE("measures: the risks of HIC15 at 300, 700 and 1000 are the tabulated ones") {
  const double expected[3][3]{{300, 0.436183291, 0.0501794893},
                              {700, 0.93844457, 0.255077211},
                              {1000, 0.991507137, 0.532454306}};
  for (const auto& [value, minor, serious] : expected) {
    Signal x = pulse("g", 1), none = x;
    for (double& y : x.y) y = std::pow(value / 0.015, 0.4);
    for (double& y : none.y) y = 0;
    const Judged j = of(judge({}, {{"head.ax", x}, {"head.ay", none}, {"head.az", none}}), "HIC15");
    REQUIRE(j.finding);
    CHECK(std::abs(j.finding->value - value) < 1e-3 * value);
    CHECK(std::abs(j.finding->risks[0].probability - minor) < 1e-3 * minor);
    CHECK(std::abs(j.finding->risks[2].probability - serious) < 1e-3 * serious);
  }
}

// 49 CFR 571.208 S6.2 to S6.6 and UN R94, 5.2.1; sources in docs/theory/injury.md
TEST_CASE("measures: limits are those of the regulations") {
  const std::pair<const char*, double> limits[]{
      {"HIC15", 700},           {"HIC36", 1000},
      {"a3ms head", 80},        {"Nij", 1},
      {"chest deflection", 63}, {"VC", 1},
      {"a3ms chest", 60},       {"femur force left", 10},
      {"tibia force right", 8}, {"tibia index left", 1.3}};
  for (const auto& [name, limit] : limits) {
    CAPTURE(name);
    const Judged j = of(judge({}, {}), name);
    REQUIRE(j.measure->limit);
    CHECK(*j.measure->limit == limit);
    CHECK(j.measure->limit_source.find("confirmed") == std::string::npos);
  }
}

// 40 % of compression is AIS 4 and 30 % AIS 2 (to 0.1); CTI: 1/(1 + exp(8.224 - 7.125 CTI))
TEST_CASE("measures: severity after Kroell and the risk of CTI at known loads") {
  const std::vector<Judged> all =
      judge({.chest_depth = 230}, {{"chest.deflection", pulse("mm", 92)},
                                   {"chest.ax", pulse("g", 0)},
                                   {"chest.ay", pulse("g", 0)},
                                   {"chest.az", pulse("g", 0)}});
  REQUIRE(of(all, "Cmax").finding);
  CHECK(of(all, "Cmax").finding->detail.find("Kroell 4.0") != std::string::npos);
  REQUIRE(of(all, "CTI").finding);
  CHECK(std::abs(of(all, "CTI").finding->value - 92 / 102.0) < 1e-3);
  const Risk& serious = of(all, "CTI").finding->risks[1];
  CHECK(serious.event == "AIS3+");
  CHECK(std::abs(serious.probability - 0.142152) < 2e-3);
}

// docs/theory/injury.md: what stands in one program only, or not alike in two
TEST_CASE("measures: what is not confirmed says so, and nothing else does") {
  Channels c;
  for (const char* role : {"head.ax", "head.ay", "head.az", "chest.ax", "chest.ay", "chest.az"})
    c[role] = pulse("g", 50);
  for (const char* role : {"head.wx", "head.wy", "head.wz"}) c[role] = pulse("rad/s", 30);
  c["chest.deflection"] = pulse("mm", 40);
  c["femur_left.fz"] = pulse("kN", -4);
  c["ribs.strain"] = {"ribs", "1", "1", {5, 6}, {0.01, 0.02}};
  std::vector<std::string> open;
  for (const Judged& j : judge({}, c)) {
    if (!j.measure->doubt.empty()) open.push_back(j.measure->name);
    if (j.finding)
      for (const Risk& r : j.finding->risks)
        if (!r.doubt.empty()) open.push_back(j.measure->name + " " + r.event);
  }
  CHECK(open == std::vector<std::string>{
                    "HIC15 skull fracture AIS2+", "BrIC AIS4+", "BrIC AIS5+", "CTI AIS2+", "MPS95",
                    "CSDM", "fractured ribs, risk NFR1+", "fractured ribs, risk NFR2+",
                    "fractured ribs, risk NFR3+", "fractured ribs, Forman NFR1+",
                    "fractured ribs, Forman NFR2+", "fractured ribs, Forman NFR3+"});
}

TEST_CASE("measures: channel codes of ISO-MME name their roles") {
  CHECK(role_of_code("11HEAD0000H3ACXA") == "head.ax");
  CHECK(role_of_code("11HEAD0000H3AVZP") == "head.wz");
  CHECK(role_of_code("11NECKUP00H3FOZA") == "neck.fz");
  CHECK(role_of_code("11NECKLO00H3FOZA").empty());
  CHECK(role_of_code("11CHST0000H3DSXC") == "chest.deflection");
  CHECK(role_of_code("11FEMRRI00H3FOZB") == "femur_right.fz");
  CHECK(role_of_code("speed").empty());
}

TEST_CASE("settings are checked by name") {
  Subject s;
  set_parameter(s, "age=70");
  set_parameter(s, "neck=H3-05F");
  CHECK(s.age == 70);
  CHECK(s.neck == "H3-05F");
  CHECK_THROWS_AS(set_parameter(s, "hat=3"), SignalError);
  CHECK_THROWS_AS(set_parameter(s, "age=old"), SignalError);
}

// a two by two table: b_0 = ln(odds without), b_1 = ln(odds ratio), variances 1/a + 1/b (+ 1/c +
// 1/d)
TEST_CASE("logistic fit: a table of two groups has its closed form") {
  std::vector<std::vector<double>> x;
  std::vector<bool> y;
  auto add = [&](double group, int yes, int no) {
    for (int i = 0; i < yes + no; ++i) x.push_back({group}), y.push_back(i < yes);
  };
  add(0, 10, 30);
  add(1, 24, 8);
  const LogisticFit fit = fit_logistic(x, y);
  CHECK(std::abs(fit.coefficients[0] - std::log(10.0 / 30)) < 1e-9);
  CHECK(std::abs(fit.coefficients[1] - std::log(24.0 / 8 * 30 / 10)) < 1e-9);
  CHECK(std::abs(fit.standard_errors[1] - std::sqrt(1 / 10.0 + 1 / 30.0 + 1 / 24.0 + 1 / 8.0)) <
        1e-9);
  CHECK(std::abs(fit.probability({1}) - 0.75) < 1e-9);
  CHECK_THROWS_AS(fit_logistic({{0}, {1}, {2}, {3}}, {false, false, true, true}), SignalError);
  CHECK_THROWS_AS(fit_logistic({{0}, {1}}, {true, true}), SignalError);
}

// 93 tests of Kent and Patrie 2005; coefficients tabulated beside them. Rows with a compression
// below 1 % are left out.
TEST_CASE(
    "logistic fit: the rib fractures of 93 cadaver tests give the tabulated risk, which Cmax "
    "uses") {
  const fs::path folder = fs::path(FABRICA_SHARED) / "validation" / "13d_thorax_injury_outcomes";
  if (!fs::exists(folder)) {
    MESSAGE("skipped: the table of outcomes is not at hand");
    return;
  }
  const std::string table = (folder / "kent2005_93_cadaver_tests.csv").string();
  const std::string fits = (folder / "kent2005_logistic_fits_made_here.csv").string();
  // row numbers as x keep the columns in step
  const Signal c = read_signal(table + ":cmax_percent"), age = read_signal(table + ":age_years");
  const Signal fractures = read_signal(table + ":rib_fractures");
  REQUIRE(c.size() == 93);
  REQUIRE(age.size() == 93);
  REQUIRE(fractures.size() == 93);
  Subject subject{.age = 60, .chest_depth = 200};
  const Judged cmax = of(judge(subject, {{"chest.deflection", pulse("mm", 70)}}), "Cmax");
  REQUIRE(cmax.finding);
  int event = 0;
  for (const int least : {1, 6, 7}) {
    CAPTURE(least);
    std::vector<std::vector<double>> x;
    std::vector<bool> y;
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (c.y[i] < 1) continue;
      x.push_back({age.y[i], c.y[i]});
      y.push_back(fractures.y[i] >= least);
    }
    const LogisticFit fit = fit_logistic(x, y);
    int k = 0;
    for (const char* name : {"b0", "b_age", "b_cmax"}) {
      const double tabulated = read_signal(fits + ":n:" + name).y[event];
      CHECK(std::abs(fit.coefficients[k++] - tabulated) < 0.01 * std::abs(tabulated));
    }
    CHECK(std::abs(fit.probability({60, cmax.finding->value}) -
                   cmax.finding->risks[event].probability) < 1e-3);
    ++event;
  }
}
