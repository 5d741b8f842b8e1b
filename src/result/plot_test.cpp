#include "result/plot.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "result/binout.h"
#include "result/chart.h"
#include "result/csv_history.h"
#include "result/sample_test.h"

using namespace fabrica;

namespace {

HistoryDatabase energies() {
  HistoryDatabase d;
  d.path = "glstat";
  d.variables = {{"kinetic_energy", 1}, {"internal_energy", 1}, {"eroded_kinetic_energy", 1}};
  return d;
}
HistoryDatabase nodes() {
  HistoryDatabase d;
  d.path = "nodout";
  d.ids = {605, 7};
  d.variables = {{"x_displacement", 2}, {"z_displacement", 2}};
  return d;
}

template <class Writer>
void write(Writer& out) {
  const int g = out.add(energies()), n = out.add(nodes());
  for (int i = 0; i < 5; ++i) {
    const double t = 0.5 * i;
    out.write(g, {t, i, {{t * t}, {1 - t}, {0}}});
    out.write(n, {t, i, {{t, 2 * t}, {-t, 3 * t}}});
  }
  out.flush();
}

std::string contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("plot: curves are found by short names, in a binout and in csv files alike") {
  const sample::Scratch binout, csv;
  {
    BinoutWriter out(binout.file("binout0000"), "");
    write(out);
    CsvHistoryWriter tables(csv.path.string());
    write(tables);
  }
  for (const sample::Scratch* folder : {&binout, &csv}) {
    PlotOptions o;
    o.input = folder->path.string();
    o.curves = {"glstat:kinetic", "nodout:x:7"};
    auto curves = find_curves(o);
    REQUIRE(curves.size() == 2);
    CHECK(curves[0].name == "glstat:kinetic_energy");
    CHECK(curves[0].x == std::vector<double>{0, 0.5, 1, 1.5, 2});
    CHECK(curves[0].y == std::vector<double>{0, 0.25, 1, 2.25, 4});
    CHECK(curves[1].name == "nodout:x_displacement:7");
    CHECK(curves[1].y == std::vector<double>{0, 1, 2, 3, 4});
    o.curves = {"nodout:z"};
    CHECK(find_curves(o).size() == 2);

    // against another quantity
    o.curves = {"nodout:z:605"};
    o.x = "nodout:x:7";
    curves = find_curves(o);
    CHECK(curves[0].x == std::vector<double>{0, 1, 2, 3, 4});
    CHECK(curves[0].y == std::vector<double>{0, -0.5, -1, -1.5, -2});
    o.x.clear();

    const std::pair<const char*, const char*> wrong[] = {
        {"glstat:energy",
         "variable of glstat 'energy' may be any of: eroded_kinetic_energy, internal_energy, "
         "kinetic_energy"},
        {"glstat:mass", "there is no variable of glstat 'mass'; there are: "},
        {"rcforc:x", "there is no database 'rcforc'; there are: glstat, nodout"},
        {"nodout:x:8", "there is no id 8; there are: 605, 7"},
        {"glstat", "is not of the form database:variable[:id]"}};
    for (const auto& [curve, message] : wrong) {
      o.curves = {curve};
      CHECK_THROWS_WITH(find_curves(o), doctest::Contains(message));
    }
  }
}

TEST_CASE("plot: an overlay names its columns") {
  const sample::Scratch scratch;
  {
    BinoutWriter out(scratch.file("binout"), "");
    write(out);
  }
  std::ofstream(scratch.file("test.csv")) << "# measured\ntime;force;stroke\n0;1;10\n1;2;20\n";
  PlotOptions o;
  o.input = scratch.path.string();
  o.curves = {"glstat:internal"};
  o.overlay = {scratch.file("test.csv"), scratch.file("test.csv") + ":stroke:force"};
  const auto curves = find_curves(o);
  REQUIRE(curves.size() == 3);
  CHECK(curves[1].y == std::vector<double>{1, 2});
  CHECK(curves[2].x == std::vector<double>{10, 20});
  CHECK(curves[2].dashed);
}

TEST_CASE("chart: ticks are round and span the range") {
  CHECK(round_ticks(0, 10, 5) == std::vector<double>{0, 2, 4, 6, 8, 10});
  for (const double high : {0.0013, 1.0, 7.7, 123456.0}) {
    const auto t = round_ticks(-0.3 * high, high, 6);
    CHECK(t.front() <= -0.3 * high);
    CHECK(t.back() >= high);
    CHECK(t.size() >= 4);
    CHECK(t.size() <= 9);
  }
}

TEST_CASE("chart: a curve is clipped to the frame and broken where it is not a number") {
  PlotOptions o;
  o.x_range = {0, 4};
  o.y_range = {0, 1};
  const PlotCurve c{"a:b", {0, 1, 2, 3, 4}, {0.5, 0.5, NAN, 0.5, 10.5}};
  const Drawing d = make_chart(o, {c});
  std::vector<Stroke> curve;
  for (const Stroke& s : d.strokes)
    if (s.color == distinct_color(0)) curve.push_back(s);
  REQUIRE(curve.size() == 2);
  double left = 1e9, right = -1e9, top = 1e9;
  for (const Stroke& s : d.strokes) {
    left = std::min(left, *std::min_element(s.x.begin(), s.x.end()));
    right = std::max(right, *std::max_element(s.x.begin(), s.x.end()));
    top = std::min(top, *std::min_element(s.y.begin(), s.y.end()));
  }
  // the second piece leaves through the top, 0.05 after x = 3
  CHECK(curve[1].y.back() == doctest::Approx(top));
  CHECK(curve[1].x.back() == doctest::Approx(left + (right - left) * 3.05 / 4));
}

TEST_CASE("plot: svg") {
  const sample::Scratch scratch;
  {
    BinoutWriter out(scratch.file("binout"), "");
    write(out);
  }
  PlotOptions o;
  o.input = scratch.path.string();
  o.output = scratch.file("chart.svg");
  o.title = "a < b & c";
  o.curves = {"glstat:kinetic", "glstat:internal"};
  render_plot(o);
  const std::string svg = contents(o.output);
  CHECK(svg.find("a &lt; b &amp; c") != std::string::npos);
  CHECK(svg.find(">kinetic energy<") != std::string::npos);
  o.output = scratch.file("chart.pdf");
  CHECK_THROWS_WITH(render_plot(o), doctest::Contains("written as .png or .svg"));
}
