#include "result/drawing.h"

#include <fmt/format.h>

namespace fabrica {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string hex(const Rgb& c) { return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]); }

}  // namespace

Rgb distinct_color(int index) {
  // muted and of different lightness, so that neighbours differ in a grey print too
  static constexpr Rgb colors[] = {{68, 119, 170}, {221, 170, 51},  {34, 136, 96},
                                   {187, 85, 102}, {136, 204, 238}, {136, 34, 85},
                                   {153, 153, 51}, {102, 102, 120}, {238, 119, 80},
                                   {102, 78, 160}, {150, 200, 140}, {160, 120, 90}};
  return colors[index % 12];
}

std::string svg(const Drawing& d) {
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<g fill=\"none\" "
      "stroke-linejoin=\"round\">\n",
      d.width, d.height);
  for (const Stroke& s : d.strokes) {
    out += fmt::format("<polyline stroke=\"{}\" stroke-width=\"{}\"{} points=\"", hex(s.color),
                       s.width, s.dashed ? " stroke-dasharray=\"7 5\"" : "");
    for (std::size_t i = 0; i < s.x.size(); ++i)
      out += fmt::format("{:.2f},{:.2f} ", s.x[i], s.y[i]);
    out += "\"/>\n";
  }
  out += "</g>\n<g font-family=\"Helvetica, Arial, sans-serif\">\n";
  for (const Label& l : d.labels) {
    const char* anchor = l.anchor == Anchor::start    ? "start"
                         : l.anchor == Anchor::middle ? "middle"
                                                      : "end";
    const std::string turn =
        l.vertical ? fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", l.x, l.y) : "";
    out += fmt::format(
        "<text x=\"{:.2f}\" y=\"{:.2f}\" dy=\"0.35em\" font-size=\"{}\" fill=\"{}\" "
        "text-anchor=\"{}\"{}>{}</text>\n",
        l.x, l.y, l.size, hex(l.color), anchor, turn, escaped(l.text));
  }
  return out + "</g>\n</svg>\n";
}

}  // namespace fabrica
