#include "study/html.h"

#include <fmt/format.h>
#include <md4c-html.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <regex>

namespace fabrica::study {
namespace {

using nlohmann::json;

// six digits are more than a screen shows; what is no number is a gap
json numbers(const std::vector<double>& values) {
  json out = json::array();
  for (const double v : values)
    out.push_back(std::isfinite(v) ? json(std::stod(fmt::format("{:.7g}", v))) : json());
  return out;
}

json json_of(const Chart& c) {
  json out{{"id", c.id},
           {"x", c.x},
           {"y", c.y},
           {"loop", c.loop},
           {"traces", json::array()},
           {"bands", json::array()}};
  for (Chart::Trace t : c.traces) {
    if (t.kind != "points") thin(t.x, t.y);
    out["traces"].push_back({{"name", t.name},
                             {"x", numbers(t.x)},
                             {"y", numbers(t.y)},
                             {"kind", t.kind},
                             {"text", t.text}});
  }
  for (const Chart::Band& b : c.bands)
    out["bands"].push_back({{"name", b.name},
                            {"x", numbers(b.x)},
                            {"low", numbers(b.low)},
                            {"high", numbers(b.high)},
                            {"outer", b.outer}});
  return out;
}

bool is_number(const std::string& cell) {
  const std::size_t at = !cell.empty() && cell[0] == '-' ? 1 : 0;
  return at < cell.size() && std::isdigit(static_cast<unsigned char>(cell[at]));
}

}  // namespace

std::string html_of_markdown(const std::string& text) {
  const std::size_t title = text.starts_with("# ") ? text.find('\n') : 0;
  const std::string rest = title == std::string::npos ? "" : text.substr(title);
  std::string out;
  const auto append = [](const MD_CHAR* piece, MD_SIZE size, void* to) {
    static_cast<std::string*>(to)->append(piece, size);
  };
  if (md_html(rest.data(), MD_SIZE(rest.size()), append, &out, MD_FLAG_TABLES | MD_FLAG_NOHTML, 0))
    return "<pre>" + escaped(text) + "</pre>\n";
  // what a readme says of the files beside it leads nowhere from a page
  static const std::regex beside(R"(<a href="(?!https?:)[^"]*">([^<]*)</a>)");
  return std::regex_replace(out, beside, "$1");
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

std::string table(const std::vector<std::string>& head,
                  const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<table>\n";
  if (!head.empty()) {
    out += "<tr>";
    for (const std::string& h : head) out += "<th>" + h + "</th>";
    out += "</tr>\n";
  }
  for (const auto& row : rows) {
    out += "<tr>";
    for (const std::string& cell : row)
      out += (!head.empty() && is_number(cell) ? "<td class=\"number\">" : "<td>") + cell + "</td>";
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

std::string place_of(const Chart& chart, bool small) {
  return fmt::format("<div class=\"chart{}\" id=\"{}\"></div>\n", small ? " small" : "", chart.id);
}

std::string page(const std::string& title, const std::string& assets, const std::string& body,
                 const std::vector<Chart>& charts) {
  json list = json::array();
  for (const Chart& c : charts) list.push_back(json_of(c));
  std::string data = list.dump();
  // a text must not end the element that holds it
  for (std::size_t at = 0; (at = data.find("</", at)) != std::string::npos; at += 3)
    data.replace(at, 2, "<\\/");
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n<title>{}</title>\n"
      "<link rel=\"stylesheet\" href=\"{}/page.css\">\n"
      "<script src=\"{}/plotly-basic.min.js\"></script>\n<script src=\"{}/page.js\"></script>\n"
      "</head>\n<body>\n{}\n<script type=\"application/json\" id=\"charts\">{}</script>\n"
      "</body>\n</html>\n",
      escaped(title), assets, assets, assets, body, data);
}

void thin(std::vector<double>& x, std::vector<double>& y, std::size_t most) {
  if (x.size() <= most || x.size() != y.size()) return;
  const std::size_t stretches = most / 2;
  std::vector<double> kept_x, kept_y;
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t a = s * x.size() / stretches, b = (s + 1) * x.size() / stretches;
    const auto [low, high] = std::minmax_element(y.begin() + long(a), y.begin() + long(b));
    const auto [first, second] = std::minmax(low, high);
    for (const auto at : {first, second}) {
      kept_x.push_back(x[std::size_t(at - y.begin())]);
      kept_y.push_back(*at);
    }
  }
  x = std::move(kept_x), y = std::move(kept_y);
}

}  // namespace fabrica::study
