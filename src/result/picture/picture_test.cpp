// Pictures are judged by their pixels: a known body from a known side covers a known area in known
// colours.
#include "result/picture.h"

#include <doctest/doctest.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include "result/binout.h"
#include "result/d3plot.h"
#include "result/plot.h"
#include "result/sample_test.h"
#include "result/vtu.h"

using namespace fabrica;

namespace {

struct Image {
  vtkNew<vtkPNGReader> reader;
  int width, height;
  explicit Image(const std::string& path) {
    reader->SetFileName(path.c_str());
    reader->Update();
    width = reader->GetOutput()->GetDimensions()[0];
    height = reader->GetOutput()->GetDimensions()[1];
  }
  std::array<int, 3> at(int x, int y) {  // from the top left
    auto* p =
        static_cast<unsigned char*>(reader->GetOutput()->GetScalarPointer(x, height - 1 - y, 0));
    return {p[0], p[1], p[2]};
  }
  // pixels from `left` to `right` that are not white
  double covered(double left, double right) {
    int count = 0;
    const int a = int(left * width), b = int(right * width);
    for (int y = 0; y < height; ++y)
      for (int x = a; x < b; ++x) count += at(x, y) != std::array<int, 3>{255, 255, 255};
    return count / double(height * (b - a));
  }
};

// Two bricks of 1 x 1 x 1 side by side along x, of parts 1 and 2.
ResultMesh bricks() {
  ResultMesh m;
  m.title = "two bricks";
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i) {
        m.position.insert(m.position.end(), {float(i), float(j), float(k)});
        m.node_id.push_back(std::int64_t(m.node_id.size()) + 1);
      }
  m.solid = {{0, 1, 4, 3, 6, 7, 10, 9}, {1, 2, 5, 4, 7, 8, 11, 10}};
  m.solid_id = {1, 2};
  m.solid_part = {0, 1};
  m.part_id = {1, 2};
  m.part_title = {"left", "right"};
  m.part_family = {Family::solid, Family::solid};
  return m;
}

AnimationState state_of(const ResultMesh& m, double time) {
  AnimationState s;
  s.time = time;
  s.position = m.position;
  s.solid_plastic_strain = {0, 1};
  return s;
}

}  // namespace

TEST_CASE(
    "picture: two bricks from the side, by part and by field, from a d3plot and from a .pvd") {
  const sample::Scratch d3plot, series;
  const ResultMesh mesh = bricks();
  {
    D3plotWriter a(d3plot.file("d3plot"), mesh, {});
    VtuWriter b(series.file("run.pvd"), mesh);
    for (const double t : {0.0, 1.0}) {
      AnimationState s = state_of(mesh, t);
      if (t > 0) s.solid_alive = {1, 0};
      a.write(s);
      b.write(s);
    }
  }
  for (const sample::Scratch* folder : {&d3plot, &series}) {
    PictureOptions o;
    o.input = folder->path.string();
    o.output = folder->file("p.png");
    o.view = "side";
    o.width = 400;
    o.height = 200;
    o.caption = false;
    o.edges = false;
    o.color = "plastic_strain";
    o.states = {0};
    render_picture(o);
    Image first(o.output);
    CHECK(first.width == 400);
    CHECK(first.height == 200);
    // dark violet at the left, yellow at the right, white around
    const auto left = first.at(75, 100), right = first.at(200, 100), corner = first.at(2, 2);
    CHECK(left[2] > left[1]);
    CHECK(right[0] > 1.5 * right[2]);
    CHECK(corner == std::array<int, 3>{255, 255, 255});

    // two bricks of 2 x 1 beside the scale of 120 pixels and a margin: 280 x 140, and 10 above
    o.width = 400, o.height = 400, o.trim = true;
    render_picture(o);
    Image trimmed(o.output);
    CHECK(trimmed.width == 400);
    CHECK(trimmed.height == doctest::Approx(150).epsilon(0.02));
    o.height = 200, o.trim = false;

    // the second brick is deleted at t = 1: half the area of the panel goes
    o.color = "part";
    o.states.clear();
    o.times = {0.1, 0.9};
    render_picture(o);
    Image both(o.output);
    const double whole = both.covered(0, 0.38), half = both.covered(0.39, 0.77);
    CHECK(whole > 0.1);
    CHECK(half / whole == doctest::Approx(0.5).epsilon(0.1));

    o.hide = {1, 2};
    CHECK_THROWS_WITH(render_picture(o), "no element is left to be drawn");
    o.hide.clear();
    o.color = "temperature";
    CHECK_THROWS_WITH(render_picture(o),
                      doctest::Contains("there is no field 'temperature'; there are: part, "));
    o.color = "part";
    o.view = "inside";
    CHECK_THROWS_WITH(render_picture(o), doctest::Contains("view 'inside' is none of"));
    o.view = "iso";
    o.times.clear();
    o.states = {2};
    CHECK_THROWS_WITH(render_picture(o), doctest::Contains("has states 0 to 1"));
  }
}

TEST_CASE("picture: a shell on the face of a brick covers it") {
  // a flat brick, seen from above, whose upper face is a shell of another part: where the two are
  // drawn in one place, which of them a pixel shows is left to rounding
  const sample::Scratch folder;
  ResultMesh m = bricks();
  m.shell = {{7, 8, 11, 10}};
  m.shell_id = {3};
  m.shell_part = {2};
  m.part_id = {1, 2, 3};
  m.part_title = {"left", "right", "cover"};
  m.part_family = {Family::solid, Family::solid, Family::shell};
  {
    VtuWriter out(folder.file("run.pvd"), m);
    out.write(state_of(m, 0));
  }
  PictureOptions o;
  o.input = folder.path.string();
  o.output = folder.file("p.png");
  o.view = "top";
  o.width = 400, o.height = 200;
  o.caption = false, o.edges = false;
  o.palette = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
  render_picture(o);
  Image image(o.output);
  int of_cover = 0, of_brick = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto c = image.at(x, y);
      of_cover += c[2] > 2 * c[0] && c[2] > 2 * c[1];
      of_brick += c[1] > 2 * c[0] && c[1] > 2 * c[2];
    }
  CHECK(of_cover > 5000);
  CHECK(of_brick == 0);
}

TEST_CASE("picture: a chart as PNG shows its curve") {
  const sample::Scratch scratch;
  {
    BinoutWriter out(scratch.file("binout"), "");
    HistoryDatabase d;
    d.path = "glstat";
    d.variables = {{"kinetic_energy", 1}};
    const int n = out.add(d);
    for (int i = 0; i <= 10; ++i) out.write(n, {double(i), i, {{double(i)}}});
  }
  PlotOptions o;
  o.input = scratch.path.string();
  o.output = scratch.file("chart.png");
  o.curves = {"glstat:kinetic"};
  o.width = 500;
  o.height = 400;
  render_plot(o);
  Image image(o.output);
  // the straight line rises by as many pixels as the frame is high: every column crosses blue once
  int columns = 0;
  for (int x = 0; x < image.width; ++x) {
    bool blue = false;
    for (int y = 0; y < image.height; ++y) {
      const auto c = image.at(x, y);
      blue = blue || (c[2] > c[0] + 60 && c[2] > c[1] + 25);
    }
    columns += blue;
  }
  CHECK(columns > 350);
  CHECK(columns < 480);
}
