#include "result/picture/canvas.h"

#include <vtkActor2D.h>
#include <vtkAutoInit.h>
#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingFreeType)

namespace fabrica {

Canvas::Canvas(vtkRenderWindow* window, int, int height, double scale)
    : height_(height), scale_(scale) {
  window->SetNumberOfLayers(2);
  renderer_->SetLayer(1);
  renderer_->InteractiveOff();
  renderer_->SetBackground(1, 1, 1);
  window->AddRenderer(renderer_);
  // the white ground under everything
  vtkNew<vtkRenderer> ground;
  ground->SetBackground(1, 1, 1);
  window->AddRenderer(ground);
}

void Canvas::label(const Label& l) {
  vtkNew<vtkTextActor> text;
  text->SetInput(l.text.c_str());
  text->SetPosition(l.x * scale_, (height_ - l.y) * scale_);
  vtkTextProperty* p = text->GetTextProperty();
  p->SetFontFamilyToArial();
  p->SetFontSize(int(std::lround(l.size * scale_ * 0.8)));
  p->SetColor(l.color[0] / 255.0, l.color[1] / 255.0, l.color[2] / 255.0);
  p->SetVerticalJustificationToCentered();
  if (l.anchor == Anchor::middle) p->SetJustificationToCentered();
  if (l.anchor == Anchor::end) p->SetJustificationToRight();
  if (l.vertical) p->SetOrientation(90);
  renderer_->AddActor2D(text);
}

void Canvas::box(double x, double y, double width, double height, const Rgb& color) {
  vtkNew<vtkPoints> points;
  const double left = x * scale_, right = (x + width) * scale_, up = (height_ - y) * scale_,
               low = (height_ - y - height) * scale_;
  points->InsertNextPoint(left, low, 0);
  points->InsertNextPoint(right, low, 0);
  points->InsertNextPoint(right, up, 0);
  points->InsertNextPoint(left, up, 0);
  vtkNew<vtkCellArray> cells;
  const vtkIdType corners[4] = {0, 1, 2, 3};
  cells->InsertNextCell(4, corners);
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(color[0] / 255.0, color[1] / 255.0, color[2] / 255.0);
  renderer_->AddActor2D(actor);
}

void Canvas::stroke(const Stroke& s) {
  // a band of quadrilaterals per piece: the width of lines is not left to the driver
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  auto piece = [&](double x0, double y0, double x1, double y1) {
    const double dx = x1 - x0, dy = y1 - y0, length = std::hypot(dx, dy);
    if (!(length > 0)) return;
    // half the width aside, and a little beyond the ends so that bends close
    const double h = 0.5 * s.width / length, nx = -dy * h, ny = dx * h, ex = dx * h * 0.7,
                 ey = dy * h * 0.7;
    const double corners[4][2] = {{x0 + nx - ex, y0 + ny - ey},
                                  {x0 - nx - ex, y0 - ny - ey},
                                  {x1 - nx + ex, y1 - ny + ey},
                                  {x1 + nx + ex, y1 + ny + ey}};
    vtkIdType ids[4];
    for (int i = 0; i < 4; ++i)
      ids[i] =
          points->InsertNextPoint(corners[i][0] * scale_, (height_ - corners[i][1]) * scale_, 0);
    cells->InsertNextCell(4, ids);
  };
  double walked = 0;  // along the line, for dashes of 7 and gaps of 5
  for (std::size_t i = 1; i < s.x.size(); ++i) {
    const double dx = s.x[i] - s.x[i - 1], dy = s.y[i] - s.y[i - 1], length = std::hypot(dx, dy);
    if (!s.dashed) piece(s.x[i - 1], s.y[i - 1], s.x[i], s.y[i]);
    for (double at = 0; s.dashed && at < length;) {
      const double phase = std::fmod(walked + at, 12.0);
      const double end = std::min(length, at + (phase < 7 ? 7 - phase : 12 - phase) + 1e-9);
      if (phase < 7)
        piece(s.x[i - 1] + dx * at / length, s.y[i - 1] + dy * at / length,
              s.x[i - 1] + dx * end / length, s.y[i - 1] + dy * end / length);
      at = end;
    }
    walked += length;
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(s.color[0] / 255.0, s.color[1] / 255.0, s.color[2] / 255.0);
  renderer_->AddActor2D(actor);
}

Rgb scale_color(double value) {
  // nine points of the viridis scale, which is in the public domain (CC0); the darkest part is left
  // out
  static constexpr double points[9][3] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                          {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                          {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
  if (!(value == value)) return {200, 200, 200};  // not a number: grey
  const double at = 1.2 + std::clamp(value, 0.0, 1.0) * 6.8;
  const int i = std::min(int(at), 7);
  Rgb out;
  for (int k = 0; k < 3; ++k)
    out[k] = static_cast<unsigned char>(
        std::lround(points[i][k] + (at - i) * (points[i + 1][k] - points[i][k])));
  return out;
}

std::string shortened(const std::string& text, std::size_t length) {
  return text.size() <= length ? text : text.substr(0, length - 3) + "...";
}

}  // namespace fabrica
