#pragma once
// Still pictures of animation states as PNG, drawn off screen: no display is needed.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fabrica {

struct PictureOptions {
  std::string input;   // result directory (d3plot, else *.pvd), or a d3plot, .pvd or .vtu file
  std::string output;  // .png
  // Which states, side by side: indices from 0, negative from the end; or the states nearest to
  // times. Neither: the last state.
  std::vector<int> states;
  std::vector<double> times;
  // "part", or a field: plastic_strain, von_mises, displacement, velocity, acceleration, the latter
  // three also as components ("velocity_z"); of a .vtu any array.
  std::string color = "part";
  std::optional<std::pair<double, double>>
      range;  // of the field; default: that of the states shown
  // Where the viewer stands: iso, front (+x), back, left (-y) or side, right, top, bottom, or a
  // vector "1,-2,0.5".
  std::string view = "iso";
  double zoom = 1;
  int width = 1200, height = 800;
  bool trim = false;  // width and height are what it may measure at most, and nothing stays empty
  std::optional<bool> edges;  // element edges; default: for up to 20000 faces
  // where faces meet at less than this they are shaded as one smooth surface [deg], and no outline
  // is drawn
  double feature_angle = 35;
  // colours of the parts in the order of their ids, again from the first after the last; empty:
  // distinct ones
  std::vector<std::array<unsigned char, 3>> palette;
  std::vector<std::int64_t> only, hide;  // user ids of parts; `only` empty: all
  std::optional<std::string> title;      // default: title of the result
  bool caption = true;                   // title and time of each state
};

// Draws a picture. Throws std::runtime_error that says what is missing: file, state, field (with
// those there are) or package.
void render_picture(const PictureOptions& options);

}  // namespace fabrica
