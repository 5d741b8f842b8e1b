#pragma once
// Text and boxes over the renderers of a window, in pixels of the finished picture from its top
// left.
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <string>

#include "result/drawing.h"

namespace fabrica {

class Canvas {
 public:
  // `scale`: pixels of the window per pixel of the picture
  Canvas(vtkRenderWindow* window, int width, int height, double scale);
  void label(const Label& label);
  void box(double x, double y, double width, double height, const Rgb& color);
  void stroke(const Stroke& stroke);

 private:
  vtkNew<vtkRenderer> renderer_;
  double height_, scale_;
};

// Colour of 0..1, from dark blue over green to yellow: even steps look even.
Rgb scale_color(double value);

// At most `length` characters; three dots stand for the rest.
std::string shortened(const std::string& text, std::size_t length);

}  // namespace fabrica
