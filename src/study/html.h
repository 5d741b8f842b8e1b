#pragma once
// What a page is put together from: escaped text, tables, charts.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fabrica::study {

// < > & and quotes as entities
std::string escaped(const std::string& text);

// Markdown with tables as HTML (md4c); HTML within it is shown as text. The title, a first line
// `# ...`, is left out, since a page has its own; of links only those into the web stay.
std::string html_of_markdown(const std::string& text);

// A table with a head line; an empty head leaves it out. Cells are HTML; below a head, a cell that
// begins with a digit or a minus sign stands to the right.
std::string table(const std::vector<std::string>& head,
                  const std::vector<std::vector<std::string>>& rows);

// A chart: drawn by web/page.js where its element stands.
struct Chart {
  struct Trace {
    std::string name;
    std::vector<double> x, y;
    std::string kind = "line";      // line, dashed, points
    std::vector<std::string> text;  // of points
  };
  struct Band {
    std::string name;
    std::vector<double> x, low, high;
    bool outer = false;
  };
  std::string id, x, y;
  bool loop = false;  // hover shows the nearest point, not all curves at one x
  std::vector<Trace> traces;
  std::vector<Band> bands;
};

// The place of a chart in the page.
std::string place_of(const Chart& chart, bool small = false);

// A whole page; `assets` is the way to the folder with script and style.
std::string page(const std::string& title, const std::string& assets, const std::string& body,
                 const std::vector<Chart>& charts);

// A curve of at most `most` points that looks the same: least and largest value of each of most/2
// equal stretches.
void thin(std::vector<double>& x, std::vector<double>& y, std::size_t most = 4000);

}  // namespace fabrica::study
