#include "study/case_file.h"

#include <algorithm>
#include <filesystem>

#include "model/wall_method.h"
#include "study/measure.h"
#include "study/toml_fields.h"

namespace fabrica::study {
namespace {

namespace fs = std::filesystem;

SignalSpec read_signal(Fields f) {
  SignalSpec s;
  s.line = f.line();
  s.name = f.text("name");
  s.model = f.text("model");
  s.x = f.text("x", "");
  s.unit = f.text("unit", "");
  s.x_name = f.text("x_name", "");
  s.x_unit = f.text("x_unit", "");
  s.scale = f.number("scale", 1);
  s.x_scale = f.number("x_scale", 1);
  s.window = f.interval("window");
  s.start_at = f.maybe_number("start_at");
  if (s.start_at && *s.start_at <= 0)
    f.fail("start_at", "is not above 0", "Give the magnitude from which contact counts as made");
  s.filter = read_filter(f);
  s.reference = f.text("reference", "");
  s.reference_x = f.text("reference_x", "");
  if (const auto corridor = f.texts("corridor"); !corridor.empty()) {
    if (corridor.size() != 2)
      f.fail("corridor", "has not two columns", "Give [\"file.csv:low\", \"file.csv:high\"]");
    s.low = corridor[0], s.high = corridor[1];
  }
  s.rating = f.texts("rating");
  for (const std::string& r : s.rating) f.one_of("rating", r, {"cora", "iso18571"});
  if (!s.rating.empty() && !s.x.empty())
    f.fail("rating", "rates curves over time, and x is given",
           "Rate the curve over time, or compare the loop by its corridor");
  s.interval = f.interval("interval");
  s.weight = f.number("weight", 1);
  if (!(s.weight >= 0)) f.fail("weight", "is negative", "Give a number from 0 upwards");
  s.paper = f.text("paper", "");
  f.finish();
  return s;
}

CheckSpec read_check(Fields f, bool limit) {
  CheckSpec c;
  c.line = f.line();
  c.name = f.text("name");
  c.model = f.text("model");
  const bool single = c.model.starts_with("rating:") || c.model.starts_with("fit:");
  for (const char* key : {"filter", "window", "statistic"})
    if (single && f.has(key)) f.fail(key, "is given for a single number", "Remove it");
  read_statistic(f, c);
  if (limit) {
    c.least = f.maybe_number("least"), c.most = f.maybe_number("most");
    if (!c.least && !c.most) f.fail("", "a limit without a bound", "Give least, most or both");
  } else {
    c.expected = f.number("expected");
    c.tolerance = f.number("tolerance");
    if (c.tolerance < 0) f.fail("tolerance", "is negative", "Give a number from 0 upwards");
  }
  f.finish();
  return c;
}

FitSpec read_fit(Fields f) {
  FitSpec s;
  s.line = f.line();
  s.name = f.text("name");
  s.data = f.text("data");
  s.outcome = f.text("outcome");
  s.at_least = f.number("at_least");
  s.predictors = f.texts("predictors");
  if (s.predictors.empty()) f.fail("predictors", "is missing", "Name one column or more");
  s.require = f.texts("require");
  f.finish();
  return s;
}

std::map<std::string, std::string> literals(std::optional<Fields> f) {
  std::map<std::string, std::string> out;
  if (!f) return out;
  for (const std::string& key : f->keys()) out[key] = f->literal(key);
  return out;
}

void read_what_runs(Fields& f, Case& c) {
  c.deck = f.text("deck", "");
  c.body = literals(f.table("body"));
  c.loads = f.text("loads", "");
  if (!c.deck.empty() && !c.body.empty())
    f.fail("body", "stands beside a deck", "Give one of them");
  if (!c.loads.empty() && c.body.empty())
    f.fail("loads", "belongs to a generated body", "Give body, or include the loads in the deck");
  c.end_time = f.number("end_time", 0);
  if (c.end_time < 0) f.fail("end_time", "is negative", "Give the time at which the run ends");
  c.time_unit = read_time_unit(f);
  c.allow_unsupported = f.flag("allow_unsupported", false);
  c.walls = read_walls(f);
  c.slow = f.flag("slow", false);
  c.parameters = literals(f.table("parameters"));
  c.paths = literals(f.table("paths"));
  if (auto p = f.table("picture")) {
    c.picture.times = p->numbers("times");
    c.picture.view = p->text("view", "iso");
    c.picture.color = p->text("color", "part");
    p->finish();
  }
}

void need_files(const Fields& f, const Case& c) {
  const auto need = [&](const std::string& key, const std::string& path) {
    if (path.empty() || path.find('{') != std::string::npos) return;
    if (!fs::is_regular_file(fs::path(c.folder) / path))
      f.fail(key, "there is no " + path + " in " + c.folder, "Correct the name or add the file");
  };
  need("deck", c.deck);
  need("loads", c.loads);
}

}  // namespace

std::string read_walls(Fields& f) {
  const std::string walls = f.text("walls", wall_method_names().front());
  f.one_of("walls", walls, wall_method_names());
  return walls;
}

Case read_case(const std::string& folder) {
  const std::string file = (fs::path(folder) / "case.toml").string();
  const toml::table table = read_toml(file);
  Fields f(table, file);
  Case c;
  c.folder = folder;
  c.file = file;
  c.name = fs::path(folder).filename().string();
  c.title = f.text("title");
  c.requirement = f.text("requirement");
  c.source = f.text("source");
  c.setup = f.text("setup", "");
  read_what_runs(f, c);
  for (Fields& s : f.tables("signal")) c.signals.push_back(read_signal(std::move(s)));
  for (Fields& s : f.tables("check")) c.checks.push_back(read_check(std::move(s), false));
  for (Fields& s : f.tables("limit")) c.checks.push_back(read_check(std::move(s), true));
  for (Fields& s : f.tables("fit")) c.fits.push_back(read_fit(std::move(s)));
  f.finish();
  if (c.signals.empty() && c.checks.empty())
    f.fail("", "compares nothing", "Add [[signal]], [[check]] or [[limit]]");
  for (std::size_t i = 0; i < c.signals.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (c.signals[i].name == c.signals[j].name)
        throw StudyError(file, c.signals[i].line, "signal.name",
                         "'" + c.signals[i].name + "' occurs twice", "Give each signal its own");
  need_files(f, c);
  return c;
}

std::vector<std::string> find_cases(const std::string& root) {
  if (!fs::is_directory(root))
    throw StudyError(root, 0, "", "is no folder", "Name the folder of the cases with --cases");
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().filename() != "case.toml") continue;
    const fs::path folder = entry.path().parent_path();
    const auto [at, fresh] = found.emplace(folder.filename().string(), folder.string());
    if (!fresh)
      throw StudyError(folder.string(), 0, "", "has the name of " + at->second,
                       "Rename one of the folders");
  }
  std::vector<std::string> out;
  for (auto& [name, folder] : found) out.push_back(folder);
  return out;
}

std::string expand(const std::string& text, const std::map<std::string, std::string>& values,
                   const std::string& file, int line) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t end = text[i] == '{' ? text.find('}', i) : std::string::npos;
    if (end == std::string::npos) {
      out += text[i];
      continue;
    }
    const std::string name = text.substr(i + 1, end - i - 1);
    const auto at = values.find(name);
    if (at == values.end())
      throw StudyError(file, line, "{" + name + "}", "has no value",
                       "Give --set " + name + "=FOLDER");
    out += at->second;
    i = end;
  }
  return out;
}

std::string missing_path(const std::string& text, const std::map<std::string, std::string>& paths,
                         const std::map<std::string, std::string>& values) {
  for (const auto& [name, what] : paths)
    if (text.find("{" + name + "}") != std::string::npos && !values.count(name)) return name;
  return {};
}

}  // namespace fabrica::study
