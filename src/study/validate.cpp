#include "study/validate.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "signal/cora.h"
#include "study/assets.h"
#include "study/case_page.h"
#include "study/compare.h"
#include "study/error.h"
#include "study/fit.h"
#include "study/process.h"
#include "study/rate_curve.h"
#include "study/run_setup.h"

namespace fabrica::study {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// A case on its way.
struct Work {
  Case c;
  std::string folder;              // OUT/NAME
  std::string deck;                // what is run
  std::vector<std::string> files;  // that the deck consists of
  std::string resolution;          // of a generated body
  Outcome outcome;
  bool must_run = false;
};

// Finds or writes the deck and its fingerprint, and sees whether the result is up to date.
void prepare(Work& w, const ValidateOptions& o) {
  fs::create_directories(w.folder);
  w.outcome.name = w.c.name;
  w.outcome.title = w.c.title;
  w.outcome.version = program_version();
  if (!w.c.runs()) {
    w.outcome.fingerprint = fingerprint(0, {read_file(w.c.file)});
    return;
  }
  if (!w.c.body.empty()) w.resolution = o.resolution.empty() ? "standard" : o.resolution;
  w.outcome.resolution = w.resolution;
  const RunSetup setup = set_up_run(w.c, w.folder, w.resolution, o.paths);
  w.deck = setup.deck;
  w.files = setup.content.files;
  w.outcome.fingerprint = setup.fingerprint;
  w.must_run = !up_to_date(w.folder, setup.fingerprint);
}

// runs what is not up to date, side by side
void run_cases(std::vector<Work>& all, const ValidateOptions& o) {
  std::vector<Work*> due;
  std::vector<Command> commands;
  for (Work& w : all) {
    if (!w.must_run) continue;
    clear_run(w.folder);
    due.push_back(&w);
    commands.push_back(run_command(w.c, w.deck, w.folder, o.threads));
    fmt::print("{}: runs ({})\n", w.c.name, w.deck);
  }
  std::fflush(stdout);
  run_all(commands, o.jobs, [&](std::size_t i, const Ended& e) {
    write_record(due[i]->folder, {due[i]->outcome.fingerprint, time_of_day(), e.status, e.seconds});
    fmt::print("{}: ended with status {} after {:.1f} s\n", due[i]->c.name, e.status, e.seconds);
    std::fflush(stdout);
  });
}

// Why a run ended: as it says itself, else the last that it printed.
std::string why_ended(const ordered_json& summary, const std::string& log) {
  if (summary.contains("ending")) return summary["ending"].get<std::string>();
  return last_line(log);
}

// what the run left behind: times, summary, energies
void read_run(Work& w, Channels& channels, PageExtras& extras) {
  const RunRecord run = read_record(w.folder);
  if (run.status < 0)
    throw StudyError(w.c.file, 0, "", "has no result", "Run it without --compare-only");
  w.outcome.run_seconds = run.seconds;
  w.outcome.finished = run.finished;
  if (run.fingerprint != w.outcome.fingerprint)
    throw StudyError(w.c.file, 0, "", "the result is not up to date",
                     "Run it without --compare-only");
  const std::string summary = read_file(w.folder + "/result/summary.json");
  if (!summary.empty()) w.outcome.summary = ordered_json::parse(summary);
  if (run.status != 0)
    throw StudyError(w.deck, 0, "",
                     fmt::format("the run ended with status {}: {}", run.status,
                                 why_ended(w.outcome.summary, w.folder + "/run.log")),
                     "Read " + w.folder + "/run.log");
  extras.files = w.files;
  for (const char* name : {"kinetic_energy", "internal_energy", "hourglass_energy",
                           "sliding_interface_energy", "eroded_internal_energy", "total_energy"})
    try {
      const std::string text = std::string("glstat:") + name;
      extras.energies.push_back({name, {channels.abscissa(text), channels.column(text)}});
    } catch (const StudyError&) {  // a deck need not ask for glstat
    }
}

// draws states of the run; the page does without where that cannot be done
void draw_picture(const Work& w, PageExtras& extras) {
  const std::string file = w.folder + "/picture.png", made_of = w.folder + "/picture.txt";
  std::string times;
  for (const double t : w.c.picture.times)
    times += fmt::format("{}{:g}", times.empty() ? "" : ",", t);
  const std::string key = w.outcome.fingerprint + times + w.c.picture.view + w.c.picture.color;
  if (!fs::exists(file) || read_file(made_of) != key) {
    Command command{{this_program(), "picture", w.folder + "/result", "--out", file, "--view",
                     w.c.picture.view, "--color", w.c.picture.color},
                    w.folder + "/picture.log"};
    if (!times.empty()) command.arguments.insert(command.arguments.end(), {"--times", times});
    run_all({command}, 1, [&](std::size_t, const Ended& e) {
      if (e.status == 0)
        write_file(made_of, key);
      else
        extras.picture_remark = "No picture: " + last_line(command.log);
    });
  }
  if (extras.picture_remark.empty()) extras.picture = "picture.png";
}

// "rating:<signal>:<method>[:part]" or "fit:<name>:<coefficient>"
double named_number(const std::string& text, const Outcome& o,
                    const std::map<std::string, double>& fits) {
  if (text.starts_with("fit:")) {
    if (const auto at = fits.find(text.substr(4)); at != fits.end()) return at->second;
    std::string list;
    for (const auto& [name, value] : fits) list += (list.empty() ? "" : ", ") + name;
    throw StudyError("'" + text + "': there is no such number; there are: " + list + ". Name one");
  }
  if (text == "rating:all:cora" && o.cora_of_all) return *o.cora_of_all;
  for (const SignalResult& s : o.signals)
    for (const auto& [method, parts] : s.ratings)
      for (const auto& [part, value] : parts)
        if (text == "rating:" + s.name + ":" + method + ":" + part ||
            (part == "total" && text == "rating:" + s.name + ":" + method))
          return value;
  throw StudyError(
      "'" + text +
      "': there is no such rating. Write rating:<signal>:<method>[:part] of a signal " +
      "that is rated");
}

std::optional<double> cora_of_all(const std::vector<SignalResult>& signals) {
  std::vector<double> totals, weights;
  for (const SignalResult& s : signals)
    if (const auto at = s.ratings.find("cora"); at != s.ratings.end())
      totals.push_back(at->second.back().second), weights.push_back(s.weight);
  const bool any = std::any_of(weights.begin(), weights.end(), [](double v) { return v > 0; });
  if (totals.size() < 2 || !any) return {};
  return cora_combined(totals, weights);
}

void compare(Work& w) {
  PageExtras extras;
  Channels channels(w.folder + "/result/csv", w.c.folder, w.c.time_unit);
  Outcome& o = w.outcome;
  o.state = State::passed;
  extras.readme = read_file(w.c.folder + "/readme.md");
  try {
    if (w.c.runs()) {
      read_run(w, channels, extras);
      draw_picture(w, extras);
    } else {
      o.finished = time_of_day();
    }
    for (const SignalSpec& s : w.c.signals) o.signals.push_back(compare_signal(s, channels, w.c));
    o.cora_of_all = cora_of_all(o.signals);
    std::map<std::string, double> fits;
    for (const FitSpec& f : w.c.fits)
      for (const auto& [name, value] : fit_outcomes(f, w.c)) fits[f.name + ":" + name] = value;
    for (const CheckSpec& c : w.c.checks)
      o.checks.push_back(
          evaluate(c, channels, [&](const std::string& t) { return named_number(t, o, fits); }));
    for (const CheckResult& c : o.checks)
      if (!c.passed) o.state = State::failed;
  } catch (const std::exception& e) {
    o.state = State::failed;
    o.reason = e.what();
  }
  write_file(w.folder + "/outcome.json", to_json(o).dump(2) + "\n");
  write_file(w.folder + "/index.html", case_page(w.c, o, extras));
}

void print(const Outcome& o) {
  fmt::print("{}: {}{}\n", o.name, state_name(o.state), o.reason.empty() ? "" : ": " + o.reason);
  for (const SignalResult& s : o.signals) {
    for (const auto& [method, parts] : s.ratings)
      fmt::print("  {:<5} {}: {} {:.3f} ({})\n", "", s.name, method, parts.back().second,
                 rating_word(method, parts.back().second));
    if (!s.remark.empty()) fmt::print("  {:<5} {}: {}\n", "", s.name, s.remark);
  }
  if (o.cora_of_all)
    fmt::print("  {:<5} {}: cora {:.3f} ({})\n", "", all_signals, *o.cora_of_all,
               rating_word("cora", *o.cora_of_all));
  for (const CheckResult& c : o.checks)
    fmt::print("  {:<5} {}: {}\n", c.passed ? "ok" : "FAIL", c.name,
               c.computed ? fmt::format("{:.5g}, demanded {}", c.value, c.bound) : c.problem);
}

std::vector<std::string> chosen(const ValidateOptions& o) {
  const std::vector<std::string> all = find_cases(o.cases);
  std::string list;
  for (const std::string& f : all)
    list += (list.empty() ? "" : ", ") + fs::path(f).filename().string();
  for (const std::string& name : o.names)
    if (std::none_of(all.begin(), all.end(),
                     [&](const std::string& f) { return fs::path(f).filename() == name; }))
      throw StudyError(o.cases, 0, name, "is no case", "Take one of: " + list);
  std::vector<std::string> out;
  for (const std::string& f : all)
    if (o.names.empty() ||
        std::find(o.names.begin(), o.names.end(), fs::path(f).filename().string()) != o.names.end())
      out.push_back(f);
  return out;
}

// why a case is not taken up now; empty: it is
std::string skip_reason(const Case& c, const ValidateOptions& o) {
  if (c.slow && !o.slow && o.names.empty()) return "slow: name it, or give --slow";
  std::string texts = c.deck + c.loads;
  for (const SignalSpec& s : c.signals) texts += s.reference + s.low + s.high;
  if (const std::string name = missing_path(texts, c.paths, o.paths); !name.empty())
    return "needs --set " + name + "=FOLDER (" + c.paths.at(name) + ")";
  return {};
}

std::vector<Outcome> stored(const std::string& out) {
  std::vector<Outcome> list;
  std::error_code e;
  for (const auto& entry : fs::directory_iterator(out, e))
    if (const std::string text = read_file((entry.path() / "outcome.json").string()); !text.empty())
      list.push_back(outcome_from(ordered_json::parse(text)));
  std::sort(list.begin(), list.end(),
            [](const Outcome& a, const Outcome& b) { return a.name < b.name; });
  return list;
}

}  // namespace

int validate(const ValidateOptions& o) {
  std::vector<Work> work;
  std::vector<Outcome> aside;  // skipped or broken
  for (const std::string& folder : chosen(o)) {
    Work w;
    w.outcome.name = fs::path(folder).filename().string();
    w.folder = o.out + "/" + w.outcome.name;
    try {
      w.c = read_case(folder);
      w.outcome.title = w.c.title;
      w.outcome.reason = skip_reason(w.c, o);
      if (w.outcome.reason.empty()) prepare(w, o);
    } catch (const std::exception& e) {
      w.outcome.state = State::failed;
      w.outcome.reason = e.what();
    }
    if (w.outcome.reason.empty())
      work.push_back(std::move(w));
    else
      aside.push_back(std::move(w.outcome));
  }
  fs::create_directories(o.out);
  if (!o.compare_only) run_cases(work, o);
  bool good = true;
  for (Work& w : work) {
    compare(w);
    print(w.outcome);
    good = good && w.outcome.state == State::passed;
  }
  std::vector<Outcome> shown = stored(o.out);
  for (Outcome& a : aside) {
    print(a);
    good = good && a.state != State::failed;
    // what an earlier call found about a skipped case stays; a broken one replaces it
    const auto at = std::find_if(shown.begin(), shown.end(),
                                 [&](const Outcome& s) { return s.name == a.name; });
    if (at == shown.end())
      shown.push_back(a);
    else if (a.state == State::failed)
      *at = a;
  }
  write_assets(o.out);
  write_file(o.out + "/index.html", index_page(shown));
  fmt::print("pages: {}/index.html\n", o.out);
  return good ? 0 : 1;
}

int print_ratings(const ValidateOptions& o) {
  fmt::print("{}", rating_table(stored(o.out), published_ratings()));
  return 0;
}

}  // namespace fabrica::study
