#pragma once
// Curves of time histories as PNG or SVG.
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fabrica {

struct PlotOptions {
  // Result directory (binout*, else *.csv), a binout or a history .csv.
  std::string input;
  std::string output;  // .png or .svg
  // "db:variable[:id]"; the variable may be shortened to a unique beginning or part:
  // "glstat:kinetic". Without an id all ids are drawn, at most 12 curves.
  std::vector<std::string> curves;
  std::string x;  // same form; default: time
  std::vector<std::string>
      overlay;  // csv files "file[:x_column:y_column]", columns default to the first two
  std::string title, x_label, y_label;
  std::optional<std::pair<double, double>> x_range, y_range;
  int width = 1000, height = 650;
};

// A curve that was found: its name in the legend and its points.
struct PlotCurve {
  std::string name;
  std::vector<double> x, y;
  bool dashed = false;
};

// The curves of a request, from the files. Throws std::runtime_error listing the candidates if a
// name is not unique or not there.
std::vector<PlotCurve> find_curves(const PlotOptions& options);

// Draws curves that are at hand. Errors for an output that is neither .png nor .svg, or cannot be
// written.
void draw_curves(const PlotOptions& options, const std::vector<PlotCurve>& curves);

// Finds the curves and draws them. Errors as above, and for an output that is neither .png nor
// .svg.
void render_plot(const PlotOptions& options);

}  // namespace fabrica
