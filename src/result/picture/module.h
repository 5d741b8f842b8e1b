#pragma once
// The border between the library and its drawing module: plain functions found by name.
#include <string>

#include "result/drawing.h"
#include "result/picture.h"

namespace fabrica::module {

// Each returns an empty string, or what went wrong.
using DrawPicture = std::string (*)(const PictureOptions&);
using DrawChart = std::string (*)(const Drawing&, const std::string& path);

constexpr const char* file_name = "libfabrica_picture.so";
constexpr const char* draw_picture = "fabrica_draw_picture";
constexpr const char* draw_chart = "fabrica_draw_chart";

// The function of that name, with a display to draw on. Throws std::runtime_error if the module is
// not found.
void* load(const char* function);

// A private X server without a screen, for as long as the object lives. Where Xvfb is not installed
// the user's own display serves; throws std::runtime_error naming the package if there is neither.
class Display {
 public:
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

 private:
  int process_ = -1;
  std::string earlier_;
  bool had_earlier_ = false;
};

}  // namespace fabrica::module
