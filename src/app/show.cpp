#include "app/show.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>

namespace fabrica {
namespace {

// "low,high"
std::optional<std::pair<double, double>> range_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos)
    throw CLI::ValidationError("a range is two numbers with a comma: low,high");
  return std::pair(std::stod(text.substr(0, comma)), std::stod(text.substr(comma + 1)));
}

void add_picture(CLI::App& app, ShowCommands& c) {
  auto* picture =
      app.add_subcommand("picture", "Draw states of a result as a PNG, without a display");
  picture->add_option("result", c.picture.input, "result folder, d3plot, .pvd or .vtu")->required();
  picture->add_option("--out", c.picture.output, "picture (.png)")->required();
  picture->add_option("--states", c.picture.states, "state numbers from 0, negative from the end")
      ->delimiter(',');
  picture->add_option("--times", c.picture.times, "states nearest to these times, side by side")
      ->delimiter(',');
  picture
      ->add_option("--color", c.picture.color,
                   "part, plastic_strain, von_mises, displacement, velocity, velocity_z, ...")
      ->capture_default_str();
  picture->add_option("--range", c.range, "low,high of the colours");
  picture
      ->add_option("--view", c.picture.view, "iso, front, back, left, right, top, bottom or x,y,z")
      ->capture_default_str();
  picture->add_option("--zoom", c.picture.zoom, "magnification")->capture_default_str();
  picture->add_option("--width", c.picture.width, "pixels")->capture_default_str();
  picture->add_option("--height", c.picture.height, "pixels")->capture_default_str();
  picture->add_option("--only", c.picture.only, "part ids to show")->delimiter(',');
  picture->add_option("--hide", c.picture.hide, "part ids to leave out")->delimiter(',');
  picture->add_option("--title", c.title, "title");
  picture->add_flag("--edges", c.edges, "draw element edges");
  picture->add_flag("--no-edges", c.no_edges, "do not draw element edges");
  picture->add_flag("--no-caption", c.no_caption, "no title and times");
  picture->callback([&c] {
    c.picture.range = range_of(c.range);
    if (c.edges) c.picture.edges = true;
    if (c.no_edges) c.picture.edges = false;
    if (!c.title.empty()) c.picture.title = c.title;
    c.picture.caption = !c.no_caption;
    render_picture(c.picture);
    fmt::print("{}\n", c.picture.output);
  });
}

void add_plot(CLI::App& app, ShowCommands& c) {
  auto* plot = app.add_subcommand("plot", "Draw time histories of a result as PNG or SVG");
  plot->add_option("result", c.plot.input, "result folder, binout or history .csv")->required();
  plot->add_option("curves", c.plot.curves,
                   "db:variable[:id], e.g. glstat:kinetic nodout:x_displacement:605")
      ->required();
  plot->add_option("--out", c.plot.output, "picture (.png or .svg)")->required();
  plot->add_option("--x", c.plot.x, "curve to take as x axis instead of time");
  plot->add_option("--csv", c.plot.overlay, "reference curve file[:x_column:y_column]");
  plot->add_option("--title", c.plot.title, "title");
  plot->add_option("--x-label", c.plot.x_label, "label of the x axis");
  plot->add_option("--y-label", c.plot.y_label, "label of the y axis");
  plot->add_option("--x-range", c.x_range, "low,high");
  plot->add_option("--y-range", c.y_range, "low,high");
  plot->add_option("--width", c.plot.width, "pixels")->capture_default_str();
  plot->add_option("--height", c.plot.height, "pixels")->capture_default_str();
  plot->callback([&c] {
    c.plot.x_range = range_of(c.x_range), c.plot.y_range = range_of(c.y_range);
    render_plot(c.plot);
    fmt::print("{}\n", c.plot.output);
  });
}

}  // namespace

void add_show(CLI::App& app, ShowCommands& commands) {
  add_picture(app, commands);
  add_plot(app, commands);
}

}  // namespace fabrica
