#include "result/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <stdexcept>

#include "result/chart.h"
#include "result/csv_history.h"
#include "result/drawing.h"
#include "result/lsda.h"
#include "result/picture/module.h"

namespace fabrica {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t most_curves_of_a_request = 12;

// "db:variable[:id]"
struct Request {
  std::string database, variable, id;
};
Request parse(const std::string& text) {
  const std::size_t a = text.find(':'), b = a == std::string::npos ? a : text.find(':', a + 1);
  if (a == std::string::npos || a == 0 || a + 1 == text.size())
    throw std::runtime_error("'" + text + "' is not of the form database:variable[:id]");
  return {text.substr(0, a), text.substr(a + 1, b == std::string::npos ? b : b - a - 1),
          b == std::string::npos ? "" : text.substr(b + 1)};
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& n : names) out += (out.empty() ? "" : ", ") + n;
  return out;
}

// The one name that is meant: equal, else the only one that begins so, else the only one that
// contains it.
std::string resolve(const std::string& wanted, const std::vector<std::string>& names,
                    const std::string& what) {
  if (std::find(names.begin(), names.end(), wanted) != names.end()) return wanted;
  for (const bool anywhere : {false, true}) {
    std::vector<std::string> found;
    for (const std::string& n : names)
      if (const std::size_t at = n.find(wanted); anywhere ? at != std::string::npos : at == 0)
        found.push_back(n);
    if (found.size() == 1) return found[0];
    if (found.size() > 1) {
      // all that may be meant
      found.clear();
      std::copy_if(names.begin(), names.end(), std::back_inserter(found),
                   [&](const std::string& n) { return n.find(wanted) != std::string::npos; });
      throw std::runtime_error(
          fmt::format("{} '{}' may be any of: {}", what, wanted, joined(found)));
    }
  }
  throw std::runtime_error(
      fmt::format("there is no {} '{}'; there are: {}", what, wanted, joined(names)));
}

// Where histories come from: a binout family or a folder of csv files.
class Source {
 public:
  virtual ~Source() = default;
  // All curves of a request, by the id they belong to ("" if to none); x is time.
  virtual std::vector<PlotCurve> find(const Request& request) const = 0;
};

class BinoutSource : public Source {
 public:
  explicit BinoutSource(const std::vector<std::string>& paths) {
    for (const std::string& p : paths) files_.emplace_back(p);
    // a database is a folder that holds states: "glstat", "elout/shell"
    std::set<std::string> names;
    for (const LsdaReader& file : files_)
      for (const auto& [path, symbol] : file.symbols())
        if (const std::size_t at = path.find("/d0"); at != std::string::npos && at > 0)
          names.insert(path.substr(1, at - 1));
    databases_.assign(names.begin(), names.end());
  }

  std::vector<PlotCurve> find(const Request& r) const override {
    const std::string database = resolve(r.database, databases_, "database");
    std::set<std::string> known;
    for (const LsdaReader& file : files_)
      for (const std::string& state : states(file, database))
        for (const std::string& v : file.list("/" + database + "/" + state)) known.insert(v);
    known.erase("time");
    const std::string variable =
        resolve(r.variable, {known.begin(), known.end()}, "variable of " + database);

    std::vector<PlotCurve> out;
    std::vector<std::int64_t> ids;
    for (const LsdaReader& file : files_) {
      const std::string root = "/" + database + "/";
      if (file.has(root + "metadata/ids")) ids = file.integers(root + "metadata/ids");
      for (const std::string& state : states(file, database)) {
        if (!file.has(root + state + "/" + variable) || !file.has(root + state + "/time")) continue;
        const double time = file.reals(root + state + "/time").at(0);
        const std::vector<double> values = file.reals(root + state + "/" + variable);
        if (out.size() < values.size()) out.resize(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
          out[i].x.push_back(time);
          out[i].y.push_back(values[i]);
        }
      }
    }
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i].name = database + ":" + variable + suffix(i, out.size(), ids);
    return out;
  }

 private:
  static std::vector<std::string> states(const LsdaReader& file, const std::string& database) {
    std::vector<std::string> out;
    for (const std::string& s : file.list("/" + database))
      if (s.size() >= 7 && s[0] == 'd' && std::isdigit(static_cast<unsigned char>(s[1])))
        out.push_back(s);
    return out;
  }
  static std::string suffix(std::size_t i, std::size_t count,
                            const std::vector<std::int64_t>& ids) {
    if (!ids.empty() && count % ids.size() == 0) {
      const std::size_t each = count / ids.size();
      return each == 1 ? fmt::format(":{}", ids[i])
                       : fmt::format(":{}.{}", ids[i / each], i % each + 1);
    }
    return count == 1 ? "" : fmt::format(":{}", i + 1);
  }

  std::vector<LsdaReader> files_;
  std::vector<std::string> databases_;
};

class CsvSource : public Source {
 public:
  explicit CsvSource(const std::vector<std::string>& paths) {
    for (const std::string& p : paths) databases_.emplace_back(fs::path(p).stem().string(), p);
  }

  std::vector<PlotCurve> find(const Request& r) const override {
    std::vector<std::string> names;
    for (const auto& d : databases_) names.push_back(d.first);
    std::string wanted = r.database;
    std::replace(wanted.begin(), wanted.end(), '/', '_');
    const std::string database = resolve(wanted, names, "database");
    const CsvTable table =
        read_csv(std::find_if(databases_.begin(), databases_.end(), [&](auto& d) {
                   return d.first == database;
                 })->second);
    auto variable_of = [](const std::string& column) { return column.substr(0, column.find(':')); };
    std::set<std::string> known;
    for (std::size_t c = 1; c < table.names.size(); ++c) known.insert(variable_of(table.names[c]));
    const std::string variable =
        resolve(r.variable, {known.begin(), known.end()}, "variable of " + database);
    std::vector<PlotCurve> out;
    for (std::size_t c = 1; c < table.names.size(); ++c)
      if (variable_of(table.names[c]) == variable)
        out.push_back({database + ":" + table.names[c], table.columns[0], table.columns[c]});
    return out;
  }

 private:
  std::vector<std::pair<std::string, std::string>> databases_;  // name, file
};

std::unique_ptr<Source> open_source(const std::string& input) {
  if (!fs::exists(input)) throw std::runtime_error("there is no " + input);
  if (!fs::is_directory(input)) {
    if (fs::path(input).extension() == ".csv")
      return std::make_unique<CsvSource>(std::vector{input});
    return std::make_unique<BinoutSource>(std::vector{input});
  }
  std::set<std::string> binouts, tables;
  for (const auto& entry : fs::directory_iterator(input)) {
    if (entry.path().filename().string().rfind("binout", 0) == 0)
      binouts.insert(entry.path().string());
    if (entry.path().extension() == ".csv") tables.insert(entry.path().string());
  }
  if (!binouts.empty())
    return std::make_unique<BinoutSource>(std::vector<std::string>(binouts.begin(), binouts.end()));
  if (tables.empty()) throw std::runtime_error(input + " holds neither a binout nor csv histories");
  return std::make_unique<CsvSource>(std::vector<std::string>(tables.begin(), tables.end()));
}

// The curves of one request, of one id where that is named.
std::vector<PlotCurve> select(const Source& source, const std::string& text) {
  const Request r = parse(text);
  std::vector<PlotCurve> all = source.find(r), out;
  std::vector<std::string> ids;
  for (PlotCurve& c : all) {
    const std::size_t a = c.name.find(':'), b = c.name.find(':', a + 1);
    const std::string id = b == std::string::npos ? "" : c.name.substr(b + 1);
    ids.push_back(id);
    if (r.id.empty() || r.id == id) out.push_back(std::move(c));
  }
  if (out.empty())
    throw std::runtime_error(
        fmt::format("'{}': there is no id {}; there are: {}", text, r.id, joined(ids)));
  if (out.size() > most_curves_of_a_request)
    throw std::runtime_error(
        fmt::format("'{}' means {} curves; name an id, one of: {}", text, out.size(), joined(ids)));
  return out;
}

// "file[:x:y]"; the columns by name or unique part of it
PlotCurve read_overlay(const std::string& text) {
  std::string file = text, x, y;
  if (!fs::exists(file)) {
    const std::size_t b = text.rfind(':'),
                      a = b == std::string::npos || b == 0 ? b : text.rfind(':', b - 1);
    if (a == std::string::npos || a == b) throw std::runtime_error("cannot open " + text);
    file = text.substr(0, a);
    x = text.substr(a + 1, b - a - 1);
    y = text.substr(b + 1);
  }
  const CsvTable table = read_csv(file);
  if (table.columns.size() < 2) throw std::runtime_error(file + " has fewer than two columns");
  auto column = [&](const std::string& name, std::size_t otherwise) -> std::size_t {
    if (name.empty()) return otherwise;
    const std::string found = resolve(name, table.names, "column of " + file);
    return std::size_t(std::find(table.names.begin(), table.names.end(), found) -
                       table.names.begin());
  };
  const std::size_t cx = column(x, 0), cy = column(y, 1);
  return {fs::path(file).stem().string() + ": " + table.names[cy], table.columns[cx],
          table.columns[cy], true};
}

}  // namespace

std::vector<PlotCurve> find_curves(const PlotOptions& o) {
  if (o.curves.empty())
    throw std::runtime_error("no curve is asked for: name database:variable[:id]");
  const std::unique_ptr<Source> source = open_source(o.input);
  std::vector<PlotCurve> out;
  for (const std::string& text : o.curves)
    for (PlotCurve& c : select(*source, text)) out.push_back(std::move(c));
  if (!o.x.empty()) {
    const std::vector<PlotCurve> x = select(*source, o.x);
    if (x.size() != 1)
      throw std::runtime_error("'" + o.x + "' for the x axis must be one curve; name an id");
    for (PlotCurve& c : out) {
      if (c.x != x[0].x)
        throw std::runtime_error(c.name + " and " + x[0].name +
                                 " are not sampled at the same times");
      c.x = x[0].y;
    }
  }
  for (const std::string& text : o.overlay) out.push_back(read_overlay(text));
  return out;
}

void draw_curves(const PlotOptions& o, const std::vector<PlotCurve>& curves) {
  const std::string extension = fs::path(o.output).extension().string();
  if (extension != ".png" && extension != ".svg")
    throw std::runtime_error("a chart is written as .png or .svg, not as " + o.output);
  const Drawing drawing = make_chart(o, curves);
  if (extension == ".svg") {
    std::ofstream out(o.output);
    out << svg(drawing);
    out.flush();
    if (!out) throw std::runtime_error("cannot write " + o.output);
    return;
  }
  const auto draw = reinterpret_cast<module::DrawChart>(module::load(module::draw_chart));
  const module::Display display;
  if (const std::string error = draw(drawing, o.output); !error.empty())
    throw std::runtime_error(error);
}

void render_plot(const PlotOptions& o) { draw_curves(o, find_curves(o)); }

}  // namespace fabrica
