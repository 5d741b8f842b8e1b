#pragma once
// A flat drawing in pixels, origin at the top left: what a chart is before it becomes SVG or PNG.
#include <array>
#include <string>
#include <vector>

namespace fabrica {

using Rgb = std::array<unsigned char, 3>;

struct Stroke {
  std::vector<double> x, y;
  Rgb color{};
  double width = 1;
  bool dashed = false;
};
enum class Anchor { start, middle, end };
struct Label {
  double x = 0, y = 0;  // y is that of the vertical centre of the text
  std::string text;
  double size = 14;
  Rgb color{};
  Anchor anchor = Anchor::start;
  bool vertical = false;  // reads upwards
};
struct Drawing {
  int width = 0, height = 0;
  std::vector<Stroke> strokes;
  std::vector<Label> labels;
};

std::string svg(const Drawing& drawing);

// Colours that are told apart well, also by those who see few; 12, then they repeat.
Rgb distinct_color(int index);

}  // namespace fabrica
