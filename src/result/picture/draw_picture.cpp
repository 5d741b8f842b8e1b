// Draws snapshots: one panel per state, all with the same camera and colours; legend or scale at
// the right, time under each panel, title on top. Everything is drawn at twice the size and
// reduced, which smooths edges.
#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellData.h>
#include <vtkFeatureEdges.h>
#include <vtkFloatArray.h>
#include <vtkImageResize.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "base/tensor.h"
#include "result/picture/canvas.h"
#include "result/picture/module.h"
#include "result/picture/snapshot.h"
#include "result/picture/surface.h"

namespace fabrica {
namespace {

constexpr int oversampling = 2;
constexpr int most_legend_entries = 16;

struct Axes {
  Vec3d towards, right, up;  // from the model to the viewer, and across the picture
};

struct Panel {
  double time;
  vtkSmartPointer<vtkPolyData> surface;
  std::vector<double> value;  // of the field, per cell or per point of the surface
  bool value_of_points = false;
};

Vec3d view_direction(const std::string& view) {
  static const std::map<std::string, Vec3d> names = {
      {"iso", {1, -1, 0.85}}, {"front", {1, 0, 0}}, {"back", {-1, 0, 0}}, {"side", {0, -1, 0}},
      {"left", {0, -1, 0}},   {"right", {0, 1, 0}}, {"top", {0, 0, 1}},   {"bottom", {0, 0, -1}}};
  if (const auto it = names.find(view); it != names.end()) return it->second;
  Vec3d v{};
  char rest = 0;
  if (std::sscanf(view.c_str(), "%lf,%lf,%lf%c", &v.x, &v.y, &v.z, &rest) != 3 || !(dot(v, v) > 0))
    throw std::runtime_error(
        "view '" + view +
        "' is none of iso, front, back, side, left, right, top, bottom and no vector x,y,z");
  return v;
}

Axes make_axes(const std::string& view) {
  const Vec3d d = view_direction(view);
  Axes a;
  a.towards = (1.0 / std::sqrt(dot(d, d))) * d;
  // z is up, but for views along it
  const Vec3d up = std::abs(a.towards.z) > 0.98 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
  a.right = cross(up, a.towards);
  a.right = (1.0 / std::sqrt(dot(a.right, a.right))) * a.right;
  a.up = cross(a.towards, a.right);
  return a;
}

// The array of a field and what is taken of it: component 0.., or -1 for the magnitude.
struct Field {
  vtkDataArray* array = nullptr;
  bool of_points = false;
  int component = -1;
};
Field find_field(vtkPolyData* surface, const std::string& name) {
  auto find = [&](const std::string& n) -> Field {
    if (vtkDataArray* a = surface->GetCellData()->GetArray(n.c_str())) return {a, false, -1};
    if (vtkDataArray* a = surface->GetPointData()->GetArray(n.c_str())) return {a, true, -1};
    return {};
  };
  if (Field f = find(name); f.array) return f;
  if (name.size() > 2 && name[name.size() - 2] == '_') {
    Field f = find(name.substr(0, name.size() - 2));
    f.component = name.back() - 'x';
    if (f.array && f.component >= 0 && f.component < f.array->GetNumberOfComponents()) return f;
  }
  std::string known;
  for (vtkDataSetAttributes* data : {static_cast<vtkDataSetAttributes*>(surface->GetCellData()),
                                     static_cast<vtkDataSetAttributes*>(surface->GetPointData())})
    for (int i = 0; i < data->GetNumberOfArrays(); ++i)
      if (const std::string n = data->GetArrayName(i) ? data->GetArrayName(i) : "";
          !n.empty() && n != "alive" && n.rfind("vtk", 0) != 0 && n != "Normals")
        known += (known.empty() ? "" : ", ") + n;
  throw std::runtime_error("there is no field '" + name + "'; there are: part, " + known);
}

void take_values(Panel& panel, const std::string& name) {
  const Field f = find_field(panel.surface, name);
  panel.value_of_points = f.of_points;
  const int components = f.array->GetNumberOfComponents();
  for (vtkIdType i = 0; i < f.array->GetNumberOfTuples(); ++i) {
    const double* t = f.array->GetTuple(i);
    double v = t[std::max(f.component, 0)];
    if (f.component < 0 && components > 1) {
      v = 0;
      for (int k = 0; k < components; ++k) v += t[k] * t[k];
      v = std::sqrt(v);
    }
    panel.value.push_back(v);
  }
}

std::pair<double, double> value_range(const std::vector<Panel>& panels) {
  double low = 1e300, high = -1e300;
  for (const Panel& p : panels)
    for (const double v : p.value) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  if (!(high > low)) high = low + (low == 0 ? 1.0 : std::abs(low));
  return {low, high};
}

void color_surface(Panel& panel, const Snapshots& snapshots, const PictureOptions& o,
                   std::pair<double, double> range) {
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("color");
  colors->SetNumberOfComponents(3);
  auto insert = [&](const Rgb& c) { colors->InsertNextTuple3(c[0], c[1], c[2]); };
  if (panel.value.empty()) {
    vtkDataArray* part = panel.surface->GetCellData()->GetArray("part_id");
    for (vtkIdType c = 0; c < part->GetNumberOfTuples(); ++c) {
      const auto& ids = snapshots.part_id;
      const auto index = std::size_t(
          std::lower_bound(ids.begin(), ids.end(), std::int64_t(part->GetTuple1(c))) - ids.begin());
      if (o.palette.empty())
        insert(distinct_color(int(index)));
      else
        insert({o.palette[index % o.palette.size()][0], o.palette[index % o.palette.size()][1],
                o.palette[index % o.palette.size()][2]});
    }
  }
  for (const double v : panel.value)
    insert(scale_color((v - range.first) / (range.second - range.first)));
  vtkDataSetAttributes* data =
      panel.value_of_points ? static_cast<vtkDataSetAttributes*>(panel.surface->GetPointData())
                            : panel.surface->GetCellData();
  data->SetScalars(colors);
}

// Extent of all panels across the picture: low and high along right and up, and towards the viewer.
std::array<double, 6> extent(const std::vector<Panel>& panels, const Axes& axes) {
  std::array<double, 6> e{1e300, -1e300, 1e300, -1e300, 1e300, -1e300};
  for (const Panel& p : panels)
    for (vtkIdType n = 0; n < p.surface->GetNumberOfPoints(); ++n) {
      double x[3];
      p.surface->GetPoint(n, x);
      const Vec3d v{x[0], x[1], x[2]};
      const double along[3] = {dot(v, axes.right), dot(v, axes.up), dot(v, axes.towards)};
      for (int k = 0; k < 3; ++k) {
        e[2 * k] = std::min(e[2 * k], along[k]);
        e[2 * k + 1] = std::max(e[2 * k + 1], along[k]);
      }
    }
  return e;
}

// Beams again, over their lit selves: light does not suit lines.
void add_lines(vtkRenderer* renderer, const Panel& panel, vtkPolyDataMapper* like) {
  vtkNew<vtkPolyData> lines;
  lines->ShallowCopy(panel.surface);
  lines->SetPolys(nullptr);
  lines->SetStrips(nullptr);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(lines);
  mapper->SetColorModeToDirectScalars();
  mapper->SetScalarMode(like->GetScalarMode());
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetLighting(false);
  actor->GetProperty()->SetLineWidth(4);
  actor->GetProperty()->SetPointSize(7);
  renderer->AddActor(actor);
}

// One light from above the viewer's left shoulder, a weaker one from the right; both go with the
// camera.
void add_lights(vtkRenderer* renderer) {
  renderer->AutomaticLightCreationOff();
  const double from[3][4] = {{-0.5, 1.1, 1, 0.55}, {0.9, 0.2, 0.8, 0.35}, {0, 0, 1, 0.3}};
  for (const auto& f : from) {
    vtkNew<vtkLight> light;
    light->SetLightTypeToCameraLight();
    light->SetPosition(f[0], f[1], f[2]);
    light->SetFocalPoint(0, 0, 0);
    light->SetIntensity(f[3]);
    renderer->AddLight(light);
  }
}

void add_actors(vtkRenderer* renderer, const Panel& panel, bool edges, double feature_angle) {
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(panel.surface);
  normals->SetFeatureAngle(feature_angle);
  normals->ConsistencyOff();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(normals->GetOutputPort());
  mapper->SetColorModeToDirectScalars();
  panel.value_of_points ? mapper->SetScalarModeToUsePointData()
                        : mapper->SetScalarModeToUseCellData();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  vtkProperty* p = actor->GetProperty();
  p->SetAmbient(0.42);
  p->SetDiffuse(0.75);
  p->SetSpecular(0.06);
  p->SetLineWidth(float(edges ? 1.2 : 2.5));
  p->SetPointSize(6);
  p->SetEdgeVisibility(edges);
  p->SetEdgeColor(0.3, 0.3, 0.33);
  renderer->AddActor(actor);
  if (panel.surface->GetNumberOfLines() + panel.surface->GetNumberOfVerts() > 0)
    add_lines(renderer, panel, mapper);
  if (edges) return;

  // without element edges, the outlines of the bodies
  vtkNew<vtkFeatureEdges> outline;
  outline->SetInputData(panel.surface);
  outline->SetFeatureAngle(feature_angle + 5);
  outline->ColoringOff();
  outline->NonManifoldEdgesOff();
  vtkNew<vtkPolyDataMapper> lines;
  lines->SetInputConnection(outline->GetOutputPort());
  lines->ScalarVisibilityOff();
  lines->SetResolveCoincidentTopologyToPolygonOffset();
  vtkNew<vtkActor> drawn;
  drawn->SetMapper(lines);
  drawn->GetProperty()->SetColor(0.15, 0.15, 0.18);
  drawn->GetProperty()->SetLineWidth(1.5);
  drawn->GetProperty()->SetLighting(false);
  renderer->AddActor(drawn);
}

void set_camera(vtkRenderer* renderer, const Axes& axes, const std::array<double, 6>& e,
                double aspect, double zoom) {
  const Vec3d center = 0.5 * (e[0] + e[1]) * axes.right + 0.5 * (e[2] + e[3]) * axes.up +
                       0.5 * (e[4] + e[5]) * axes.towards;
  const double wide = e[1] - e[0], high = e[3] - e[2], deep = e[5] - e[4];
  const double half = 0.5 * std::max({high, wide / aspect, 1e-6 * (deep + 1e-30)}) * 1.06 / zoom;
  const double distance = 2 * (wide + high + deep);
  const Vec3d eye = center + distance * axes.towards;
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetFocalPoint(center.x, center.y, center.z);
  camera->SetPosition(eye.x, eye.y, eye.z);
  camera->SetViewUp(axes.up.x, axes.up.y, axes.up.z);
  camera->SetParallelScale(half);
  camera->SetClippingRange(0.5 * distance, 1.5 * distance);
}

// Where things stand, in pixels of the finished picture, from the top left.
struct Layout {
  double top = 0, legend = 0,
         caption = 0;  // height of the title, width of the legend, height of a caption
  int columns = 1, rows = 1;
  // of one panel, without its caption
  double width(const PictureOptions& o) const { return (o.width - legend) / columns; }
  double height(const PictureOptions& o) const { return (o.height - top) / rows - caption; }
};
Layout arrange(const PictureOptions& o, int panels, double aspect, double legend) {
  Layout best;
  double largest = 0;
  for (int columns = 1; columns <= panels; ++columns) {
    Layout l;
    l.top = o.caption ? 44 : 10;
    l.caption = o.caption ? 34 : 0;
    l.legend = legend;
    l.columns = columns;
    l.rows = (panels + columns - 1) / columns;
    const double size = std::min(l.width(o), l.height(o) * aspect);
    if (size > largest * 1.001) {
      largest = size;
      best = l;
    }
  }
  return best;
}

// Takes from the picture what its panels, wide over high, would leave empty.
void trim(PictureOptions& o, int panels, double aspect, double legend) {
  const Layout l = arrange(o, panels, aspect, legend);
  const double w = l.width(o), h = l.height(o);
  const double least = 0.2 * std::min(w, h);
  if (w > h * aspect)
    o.width = int(std::lround(l.legend + l.columns * std::max(h * aspect, least)));
  else
    o.height = int(std::lround(l.top + l.rows * (l.caption + std::max(w / aspect, least))));
}

// Entries "title (id)" of the parts that are seen.
std::vector<std::pair<std::string, Rgb>> legend_entries(const Snapshots& s,
                                                        const std::vector<Panel>& panels) {
  std::vector<bool> seen(s.part_id.size());
  for (const Panel& p : panels) {
    vtkDataArray* part = p.surface->GetCellData()->GetArray("part_id");
    for (vtkIdType c = 0; c < part->GetNumberOfTuples(); ++c)
      seen[std::lower_bound(s.part_id.begin(), s.part_id.end(), std::int64_t(part->GetTuple1(c))) -
           s.part_id.begin()] = true;
  }
  std::vector<std::pair<std::string, Rgb>> out;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i]) continue;
    const std::string name =
        s.part_title[i].empty() ? fmt::format("part {}", s.part_id[i]) : s.part_title[i];
    out.emplace_back(shortened(name, 34), distinct_color(int(i)));
  }
  return out;
}

void draw_legend(Canvas& canvas, const std::vector<std::pair<std::string, Rgb>>& entries, double x,
                 double top) {
  double y = top + 12;
  for (const auto& [name, color] : entries) {
    canvas.box(x, y - 7, 14, 14, color);
    canvas.label({x + 22, y, name, 14, {40, 40, 44}});
    y += 24;
  }
}

void draw_scale(Canvas& canvas, const std::string& field, std::pair<double, double> range, double x,
                double top, double height) {
  std::string name = field;
  std::replace(name.begin(), name.end(), '_', ' ');
  canvas.label({x, top + 8, name, 15, {40, 40, 44}});
  const double first = top + 32, steps = 128, h = std::min(height - 48, 420.0);
  for (int i = 0; i < int(steps); ++i)
    canvas.box(x, first + h * i / steps, 18, h / steps + 0.5, scale_color(1 - (i + 0.5) / steps));
  for (int i = 0; i <= 5; ++i) {
    const double y = first + h * i / 5, v = range.second + (range.first - range.second) * i / 5;
    canvas.box(x + 18, y - 0.5, 5, 1, {90, 90, 96});
    canvas.label(
        {x + 28,
         y,
         fmt::format("{:.4g}", std::abs(v) < 1e-12 * (range.second - range.first) ? 0.0 : v),
         14,
         {40, 40, 44}});
  }
}

std::vector<Panel> make_panels(const Snapshots& snapshots) {
  std::vector<Panel> out;
  for (const Snapshot& s : snapshots.list)
    out.push_back({s.time, visible_surface(s.grid), {}, false});
  return out;
}

void write_png(vtkRenderWindow* window, const PictureOptions& o) {
  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window);
  grab->ReadFrontBufferOff();
  grab->ShouldRerenderOff();
  vtkNew<vtkImageResize> reduce;
  reduce->SetInputConnection(grab->GetOutputPort());
  reduce->SetOutputDimensions(o.width, o.height, 1);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(reduce->GetOutputPort());
  writer->SetFileName(o.output.c_str());
  writer->Write();
  if (writer->GetErrorCode() != 0) throw std::runtime_error("cannot write " + o.output);
}

void draw(PictureOptions o) {
  if (o.width < 64 || o.height < 64 || o.width > 8000 || o.height > 8000 || !(o.zoom > 0))
    throw std::runtime_error("a picture is 64 to 8000 pixels wide and high, and zoom is positive");
  const Axes axes = make_axes(o.view);
  const Snapshots snapshots = load_snapshots(o);
  std::vector<Panel> panels = make_panels(snapshots);
  const bool by_part = o.color == "part";
  if (!by_part)
    for (Panel& p : panels) take_values(p, o.color);
  const auto range = by_part ? std::pair(0.0, 1.0) : o.range.value_or(value_range(panels));
  for (Panel& p : panels) color_surface(p, snapshots, o, range);

  // legend only when its entries can be told apart
  const auto entries =
      by_part ? legend_entries(snapshots, panels) : decltype(legend_entries(snapshots, panels)){};
  const bool legend =
      by_part && o.palette.empty() && entries.size() > 1 && entries.size() <= most_legend_entries;
  double strip = by_part ? 0 : 120;
  if (legend)
    for (const auto& [name, color] : entries)
      strip = std::max(strip, 56 + 7.2 * double(name.size()));

  const std::array<double, 6> e = extent(panels, axes);
  const double shape = std::max(e[1] - e[0], 1e-30) / std::max(e[3] - e[2], 1e-30);
  if (o.trim) trim(o, int(panels.size()), shape, strip);
  const Layout l = arrange(o, int(panels.size()), shape, strip);
  const double w = l.width(o), h = l.height(o);

  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(o.width * oversampling, o.height * oversampling);
  Canvas canvas(window, o.width, o.height, oversampling);
  if (o.caption)
    canvas.label({16,
                  24,
                  shortened(o.title.value_or(snapshots.title), std::size_t(o.width / 10)),
                  19,
                  {30, 30, 34}});
  if (legend) draw_legend(canvas, entries, o.width - strip + 12, l.top);
  if (!by_part)
    draw_scale(canvas, o.color, range, o.width - strip + 12, l.top, o.height - l.top - 10);

  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double left = w * double(int(i) % l.columns),
                 top = l.top + (h + l.caption) * double(int(i) / l.columns);
    vtkNew<vtkRenderer> renderer;
    renderer->SetBackground(1, 1, 1);
    renderer->SetViewport(left / o.width, 1 - (top + h) / o.height, (left + w) / o.width,
                          1 - top / o.height);
    add_lights(renderer);
    add_actors(renderer, panels[i],
               o.edges.value_or(panels[i].surface->GetNumberOfCells() <= 20000), o.feature_angle);
    set_camera(renderer, axes, e, w / h, o.zoom);
    window->AddRenderer(renderer);
    if (o.caption)
      canvas.label({left + w / 2,
                    top + h + l.caption / 2,
                    fmt::format("t = {:.4g}", panels[i].time),
                    16,
                    {60, 60, 66},
                    Anchor::middle});
  }
  window->Render();
  write_png(window, o);
}

}  // namespace
}  // namespace fabrica

extern "C" __attribute__((visibility("default"))) std::string fabrica_draw_picture(
    const fabrica::PictureOptions& options) {
  try {
    fabrica::draw(options);
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}
