#include "app/injury.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "app/injury_strains.h"
#include "injury/measures.h"
#include "signal/channel_file.h"

namespace fabrica {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::pair<std::string, std::string> assignment(const std::string& text) {
  const std::size_t equal = text.find('=');
  if (equal == std::string::npos || equal == 0)
    throw SignalError("bad-setting", "'" + text + "' is not of the form role=value",
                      "Write head.ax=run.csv:column");
  const std::string role = text.substr(0, equal);
  if (roles().count(role) == 0)
    throw SignalError("unknown-role", "there is no channel '" + role + "'",
                      "fabrica injury --list names them");
  return {role, text.substr(equal + 1)};
}

// The folder of histories of a run, or "".
fs::path histories(const std::string& input) {
  return fs::is_directory(fs::path(input) / "csv") ? fs::path(input) / "csv" : fs::path();
}

bool is_run(const std::string& input) {
  return !histories(input).empty() || fs::exists(fs::path(input) / "d3plot");
}

// Strains of organs and ribs from the animations of the runs among the inputs.
void add_strains(const InjuryCommand& c, Channels& channels) {
  const StrainRequest request = strain_request(c.parts, c.strain);
  bool any = false;
  for (const std::string& input : c.inputs) {
    any = any || fs::exists(fs::path(input) / "d3plot");
    RunStrains run = strains_of_run(input, request);
    for (const std::string& note : run.notes) fmt::print(stderr, "note: {}\n", note);
    channels.merge(run.channels);
  }
  if (!any && !c.parts.empty())
    throw SignalError("cannot-read", "--part names parts, but no input is a folder with a d3plot",
                      "Give the folder of the run; *DATABASE_BINARY_D3PLOT makes it");
}

// "nodout:x_acceleration:7" of a run whose folder is an input -> its csv file and column
std::string located(const InjuryCommand& c, const std::string& where) {
  const std::size_t colon = where.find(':');
  for (const std::string& input : c.inputs)
    if (const fs::path folder = histories(input); !folder.empty() && colon != std::string::npos)
      if (const fs::path file = folder / (where.substr(0, colon) + ".csv"); fs::exists(file))
        return file.string() + where.substr(colon);
  if (colon == std::string::npos || fs::exists(where.substr(0, colon))) return where;
  for (const std::string& input : c.inputs) {
    if (histories(input).empty()) continue;
    std::set<std::string> there;
    for (const auto& entry : fs::directory_iterator(histories(input)))
      there.insert(entry.path().stem().string());
    throw SignalError(
        "no-such-channel",
        "'" + where + "' is no file, and " + input + " has no database " + where.substr(0, colon),
        fmt::format("It has: {}. Ask for others in the deck (*DATABASE_...)",
                    there.empty() ? "none" : fmt::format("{}", fmt::join(there, ", "))));
  }
  return where;
}

// Histories of a run are written at the cycle next to each output time: read at their mean step.
void even_out(const std::string& role, Signal& s) {
  if (role.ends_with(".strain") || role.ends_with(".stress")) return;  // tables, not histories
  try {
    sample_interval(s);
  } catch (const SignalError& e) {
    if (e.name() != "not-uniform") return;  // reported by the measures
    s = resampled(s, (s.x.back() - s.x.front()) / double(s.size() - 1));
    fmt::print(stderr,
               "note: {} is not sampled at a constant step; it is read at its mean step {:.6g}\n",
               role, s.x[1] - s.x[0]);
  }
}

// Where the strain of a tissue could have come from.
std::string strain_remedy(const InjuryCommand& c, const std::string& role) {
  const std::string tissue = role.substr(0, role.find('.'));
  for (const std::string& input : c.inputs) {
    if (fs::exists(fs::path(input) / "d3plot"))
      return "; no part of " + input + "/d3plot is titled so: --part " + tissue + "=ID,...";
    if (!histories(input).empty())
      return "; " + input + " has no d3plot: run with *DATABASE_BINARY_D3PLOT";
  }
  return "";
}

Channels read_channels(const InjuryCommand& c) {
  Channels channels;
  for (const std::string& input : c.inputs) {
    if (is_run(input)) continue;  // its histories are named one by one
    for (Signal& s : read_all_signals(input)) {
      const std::string role = roles().count(s.name) ? s.name : role_of_code(s.name);
      if (!role.empty()) channels[role] = std::move(s);
    }
  }
  for (const std::string& text : c.channels) {
    const auto [role, where] = assignment(text);
    channels[role] = read_signal(located(c, where));
  }
  for (const std::string& text : c.units) {
    const auto [role, unit] = assignment(text);
    if (const auto found = channels.find(role);
        found != channels.end() && found->second.unit.empty())
      found->second.unit = unit;
  }
  for (auto& [role, s] : channels) even_out(role, s);
  add_strains(c, channels);
  if (!c.time_unit.empty())
    for (auto& [role, s] : channels)
      if (s.x_unit.empty()) s.x_unit = c.time_unit;
  return channels;
}

void print_list() {
  for (const Measure& m : measures()) {
    fmt::print("{} [{}], {}\n  formula  {}\n  filter   {}\n", m.name, m.unit, m.region, m.formula,
               m.filter);
    if (m.limit) fmt::print("  limit    {} ({})\n", *m.limit, m.limit_source);
    fmt::print("  source   {}\n", m.source);
    if (!m.doubt.empty()) fmt::print("  not confirmed: {}\n", m.doubt);
    fmt::print("  channels ");
    for (const std::string& role : m.roles) fmt::print(" {}", role);
    fmt::print("\n");
  }
  fmt::print("\nchannels\n");
  for (const auto& [role, meaning] : roles()) fmt::print("  {:<18}{}\n", role, meaning);
}

void print_table(const std::vector<Judged>& all) {
  fmt::print("{:<28}{:>12} {:<5}{:>10}\n", "measure", "value", "unit", "limit");
  for (const Judged& j : all) {
    const Measure& m = *j.measure;
    if (!j.finding) continue;
    fmt::print("{:<28}{:>12.4g} {:<5}{:>10}{}\n", m.name, j.finding->value,
               m.unit == "1" ? "" : m.unit, m.limit ? fmt::format("{:.4g}", *m.limit) : "-",
               m.limit && j.finding->value > *m.limit ? "  exceeded" : "");
    if (!j.finding->detail.empty()) fmt::print("    {}\n", j.finding->detail);
    if (!m.doubt.empty()) fmt::print("    not confirmed: {}\n", m.doubt);
    for (const Risk& r : j.finding->risks)
      fmt::print("    {:<26}{:>10.1f} %    {}{}\n", r.event, 100 * r.probability, r.source,
                 r.doubt.empty() ? "" : "; not confirmed: " + r.doubt);
  }
  fmt::print("\nnot computed\n");
  for (const Judged& j : all)
    if (!j.finding) fmt::print("{:<28}{}{}\n", j.measure->name, j.failed ? "error " : "", j.reason);
}

ordered_json with_doubt(ordered_json entry, const std::string& doubt) {
  entry["confirmed"] = doubt.empty();
  if (!doubt.empty()) entry["not_confirmed"] = doubt;
  return entry;
}

ordered_json report(const std::vector<Judged>& all) {
  ordered_json list = ordered_json::array();
  for (const Judged& j : all) {
    const Measure& m = *j.measure;
    ordered_json entry{{"name", m.name}, {"region", m.region}, {"unit", m.unit}};
    if (j.finding) {
      entry["value"] = j.finding->value;
      if (m.limit) entry["exceeded"] = j.finding->value > *m.limit;
      entry["detail"] = j.finding->detail;
      entry["risks"] = ordered_json::array();
      for (const Risk& r : j.finding->risks)
        entry["risks"].push_back(with_doubt(
            {{"event", r.event}, {"probability", r.probability}, {"source", r.source}}, r.doubt));
    } else {
      entry[j.failed ? "error" : "missing"] = j.reason;
    }
    entry["filter"] = m.filter, entry["formula"] = m.formula;
    if (m.limit) entry["limit"] = *m.limit, entry["limit_source"] = m.limit_source;
    entry["source"] = m.source, entry["channels"] = m.roles;
    list.push_back(with_doubt(std::move(entry), m.doubt));
  }
  return list;
}

}  // namespace

int injury_command(const InjuryCommand& c) {
  if (c.list) return print_list(), 0;
  Subject subject;
  for (const std::string& text : c.settings) set_parameter(subject, text);
  const Channels channels = read_channels(c);
  if (channels.empty())
    throw SignalError("no-such-channel", "no input holds a channel that a measure needs",
                      "Name channels by --channel role=curve, or parts of a run by --part; fabrica "
                      "injury --list names the roles");
  std::vector<Judged> all = judge(subject, channels);
  for (Judged& j : all)
    if (!j.finding && !j.failed && j.measure->roles[0].ends_with(".strain"))
      j.reason += strain_remedy(c, j.measure->roles[0]);
  print_table(all);
  if (!c.json.empty()) {
    std::ofstream out(c.json);
    out << ordered_json{{"version", FABRICA_VERSION},
                        {"age", subject.age},
                        {"chest_depth_mm", subject.chest_depth},
                        {"neck", subject.neck},
                        {"leg", subject.leg},
                        {"measures", report(all)}}
               .dump(2)
        << '\n';
    if (!out) throw SignalError("cannot-write", "cannot write " + c.json, "Check the folder");
  }
  for (const Judged& j : all)
    if (j.failed) return 1;
  return 0;
}

void add_injury(CLI::App& app, InjuryCommand& c) {
  auto* injury = app.add_subcommand("injury", "Injury measures and risks from channels");
  injury->add_option("inputs", c.inputs,
                     "csv tables or ISO-MME tests that hold channels, or the folder of a run");
  injury->add_option("--channel", c.channels,
                     "role=curve, as head.ax=run.csv:acc_x or head.ax=nodout:x_acceleration:7");
  injury->add_option("--unit", c.units,
                     "role=unit of a channel that names none, as head.ax=mm/ms2");
  injury->add_option("--time-unit", c.time_unit, "unit of the time of channels that name none");
  injury->add_option("--part", c.parts,
                     "TISSUE=PARTS of the run's d3plot, as brain=12,13 or ribs=21,22+23");
  injury->add_option("--strain", c.strain, "of these parts: logarithmic or green")
      ->capture_default_str()
      ->check(CLI::IsMember({"logarithmic", "green"}));
  injury->add_option("--set", c.settings,
                     "NAME=VALUE: age, chest_depth_mm, vc_factor, neck_arm_mm, neck, leg, ...");
  injury->add_option("--json", c.json, "write all figures here");
  injury->add_flag("--list", c.list,
                   "list measures with formula, filter, limit and source, and the channels");
  injury->callback([&c] { throw CLI::RuntimeError(injury_command(c)); });
}

}  // namespace fabrica
