// Draws a chart as PNG, at twice the size and reduced.
#include <vtkImageResize.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkWindowToImageFilter.h>

#include <stdexcept>

#include "result/picture/canvas.h"
#include "result/picture/module.h"

namespace fabrica {
namespace {

constexpr int oversampling = 2;

void draw(const Drawing& drawing, const std::string& path) {
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(drawing.width * oversampling, drawing.height * oversampling);
  Canvas canvas(window, drawing.width, drawing.height, oversampling);
  for (const Stroke& s : drawing.strokes) canvas.stroke(s);
  for (const Label& l : drawing.labels) canvas.label(l);
  window->Render();

  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window);
  grab->ReadFrontBufferOff();
  grab->ShouldRerenderOff();
  vtkNew<vtkImageResize> reduce;
  reduce->SetInputConnection(grab->GetOutputPort());
  reduce->SetOutputDimensions(drawing.width, drawing.height, 1);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(reduce->GetOutputPort());
  writer->SetFileName(path.c_str());
  writer->Write();
  if (writer->GetErrorCode() != 0) throw std::runtime_error("cannot write " + path);
}

}  // namespace
}  // namespace fabrica

extern "C" __attribute__((visibility("default"))) std::string fabrica_draw_chart(
    const fabrica::Drawing& drawing, const std::string& path) {
  try {
    fabrica::draw(drawing, path);
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}
