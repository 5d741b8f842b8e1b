#pragma once
// `fabrica picture` and `fabrica plot`.
#include <string>
#include <vector>

#include "result/picture.h"
#include "result/plot.h"

namespace CLI {
class App;
}

namespace fabrica {

struct ShowCommands {
  PictureOptions picture;
  PlotOptions plot;
  std::string range, x_range, y_range, title;
  bool edges = false, no_edges = false, no_caption = false;
};
void add_show(CLI::App& app, ShowCommands& commands);

}  // namespace fabrica
