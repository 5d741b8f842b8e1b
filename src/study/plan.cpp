#include "study/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "study/measure.h"
#include "study/outcome.h"
#include "study/sampling.h"
#include "study/toml_fields.h"

namespace fabrica::study {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t most_runs = 100000;

// What varies: listed values, or a range.
struct Axis {
  std::string name;
  std::vector<std::string> values;
  std::optional<std::pair<double, double>> range;
};

Axis read_axis(Fields& parent, const std::string& key, const std::string& prefix) {
  Axis axis;
  axis.name = prefix + key;
  Fields f = *parent.table(key);
  axis.range = f.interval("range");
  for (const double v : f.numbers("values")) axis.values.push_back(fmt::format("{}", v));
  if (axis.range.has_value() == !axis.values.empty())
    f.fail("", "has not one way to vary", "Give either range = [low, high] or values = [...]");
  f.finish();
  return axis;
}

// [parameters] and [options]: tables vary, plain values are fixed
std::vector<Axis> read_axes(Fields& f, Plan& plan) {
  std::vector<Axis> axes;
  if (auto p = f.table("parameters"))
    for (const std::string& key : p->keys()) {
      if (p->is_table(key))
        axes.push_back(read_axis(*p, key, ""));
      else
        plan.base.parameters[key] = p->literal(key);
    }
  if (auto o = f.table("options"))
    for (const std::string& key : o->keys()) {
      if (key != "end_time" && !plan.base.body.count(key))
        o->fail(key, "is no option that can vary", "Vary end_time or a key of body");
      axes.push_back(read_axis(*o, key, "option."));
    }
  return axes;
}

// rows of numbers, separated by commas or blanks; lines that begin with # or a letter are passed
// over
std::vector<std::vector<std::string>> read_rows(const std::string& path, const Fields& f) {
  std::ifstream in(path);
  if (!in) f.fail("file", "there is no " + path, "Correct the path");
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#' || std::isalpha(static_cast<unsigned char>(line[0])))
      continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    rows.emplace_back();
    for (double v; cells >> v;) rows.back().push_back(fmt::format("{}", v));
  }
  return rows;
}

void sample_table(Fields& f, const std::string& folder,
                  const std::map<std::string, std::string>& paths, Plan& plan) {
  const std::string name = expand(f.text("file"), paths, plan.file, f.line("file"));
  plan.names = f.texts("columns");
  plan.rows = read_rows((fs::path(folder) / name).string(), f);
  const int most = f.integer("rows", int(plan.rows.size()));
  if (most < 1 || std::size_t(most) > plan.rows.size())
    f.fail("rows", fmt::format("the file has {} rows", plan.rows.size()),
           "Ask for that many or fewer");
  plan.rows.resize(std::size_t(most));
  for (std::size_t i = 0; i < plan.rows.size(); ++i)
    if (plan.rows[i].size() != plan.names.size())
      f.fail("columns",
             fmt::format("names {} columns, row {} has {}", plan.names.size(), i + 1,
                         plan.rows[i].size()),
             "Name every column of the file");
}

void sample_grid(const Fields& f, const std::vector<Axis>& axes, Plan& plan) {
  std::vector<std::size_t> counts;
  double runs = 1;
  for (const Axis& a : axes) {
    if (a.range)
      f.fail("method", "a grid needs values, " + a.name + " has a range", "List its values");
    counts.push_back(a.values.size());
    runs *= double(a.values.size());
  }
  if (runs > double(most_runs))
    f.fail("method", fmt::format("the grid has {:g} runs", runs), "Take fewer values");
  for (const auto& point : grid(counts)) {
    plan.rows.emplace_back();
    for (std::size_t i = 0; i < axes.size(); ++i)
      plan.rows.back().push_back(axes[i].values[point[i]]);
  }
}

void sample_hypercube(Fields& f, const std::vector<Axis>& axes, Plan& plan) {
  const int samples = f.integer("samples", 0);
  if (samples < 1 || std::size_t(samples) > most_runs)
    f.fail("samples", "is missing or out of range", fmt::format("Give 1 to {}", most_runs));
  for (const auto& point :
       latin_hypercube(samples, int(axes.size()), std::uint64_t(f.integer("seed", 1)))) {
    plan.rows.emplace_back();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const Axis& a = axes[i];
      plan.rows.back().push_back(
          a.range ? fmt::format("{:.9g}",
                                a.range->first + point[i] * (a.range->second - a.range->first))
                  : a.values[std::size_t(point[i] * double(a.values.size()))]);
    }
  }
}

OutputSpec read_output(Fields f) {
  OutputSpec o;
  o.measure.name = f.text("name");
  o.measure.model = f.text("model");
  read_statistic(f, o.measure);
  o.reference = f.text("reference", "");
  f.finish();
  return o;
}

void read_base(Fields& f, Plan& plan, const std::string& folder,
               const std::map<std::string, std::string>& paths) {
  Case& c = plan.base;
  c.file = plan.file, c.folder = folder, c.name = fs::path(plan.file).stem().string();
  if (auto p = f.table("paths"))
    for (const std::string& key : p->keys()) c.paths[key] = p->literal(key);
  const std::string deck = f.text("deck", "");
  if (const std::string name = missing_path(deck, c.paths, paths); !name.empty())
    f.fail("deck", "{" + name + "} has no value",
           "Give --set " + name + "=FOLDER (" + c.paths[name] + ")");
  if (!deck.empty()) {
    c.deck = fs::absolute(fs::path(folder) / expand(deck, paths, plan.file, f.line("deck")))
                 .lexically_normal()
                 .string();
    if (!fs::is_regular_file(c.deck)) f.fail("deck", "there is no " + c.deck, "Correct the path");
  }
  if (auto b = f.table("body"))
    for (const std::string& key : b->keys()) c.body[key] = b->literal(key);
  c.loads = f.text("loads", "");
  if (c.deck.empty() == c.body.empty())
    f.fail("deck", "one of deck and body is needed", "Give one of them");
  c.end_time = f.number("end_time", 0);
  c.time_unit = read_time_unit(f);
  c.allow_unsupported = f.flag("allow_unsupported", false);
  c.walls = read_walls(f);
}

}  // namespace

Plan read_plan(const std::string& file, const std::map<std::string, std::string>& paths) {
  const toml::table table = read_toml(file);
  Fields f(table, file);
  Plan plan;
  plan.file = file;
  const std::string folder = fs::absolute(file).parent_path().string();
  plan.title = f.text("title");
  read_base(f, plan, folder, paths);
  const std::vector<Axis> axes = read_axes(f, plan);
  auto sampling = f.table("sampling");
  if (!sampling)
    f.fail("sampling", "is missing", "Give method = \"grid\", \"latin_hypercube\" or \"table\"");
  const std::string method = sampling->text("method");
  if (method != "table") {
    if (axes.empty()) f.fail("parameters", "nothing varies", "Give a parameter a range or values");
    for (const Axis& a : axes) plan.names.push_back(a.name);
  }
  if (method == "grid")
    sample_grid(*sampling, axes, plan);
  else if (method == "latin_hypercube")
    sample_hypercube(*sampling, axes, plan);
  else if (method == "table")
    sample_table(*sampling, folder, paths, plan);
  else
    sampling->fail("method", "'" + method + "' is not known",
                   "Take grid, latin_hypercube or table");
  sampling->finish();
  for (Fields& o : f.tables("output")) {
    plan.outputs.push_back(read_output(std::move(o)));
    std::string& reference = plan.outputs.back().reference;
    if (!reference.empty())
      reference = (fs::path(folder) / expand(reference, paths, file, f.line("output"))).string();
  }
  if (plan.outputs.empty())
    f.fail("output", "is missing", "Say with [[output]] what is kept of every run");
  f.finish();
  return plan;
}

}  // namespace fabrica::study
