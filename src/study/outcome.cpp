#include "study/outcome.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "study/error.h"

namespace fabrica::study {
namespace {

using nlohmann::ordered_json;

ordered_json json_of(const SignalResult& s) {
  ordered_json j{{"name", s.name}, {"unit", s.unit}, {"peak", s.peak}, {"peak_at", s.peak_at}};
  j["remark"] = s.remark;
  j["provenance"] = s.provenance;
  j["reference_source"] = s.reference_source;
  if (s.reference_peak) j["reference_peak"] = *s.reference_peak;
  if (s.reference_peak_at) j["reference_peak_at"] = *s.reference_peak_at;
  j["ratings"] = ordered_json::object();
  for (const auto& [method, parts] : s.ratings)
    for (const auto& [part, value] : parts) j["ratings"][method][part] = value;
  j["paper"] = s.paper;
  if (s.paper_total) j["paper_total"] = *s.paper_total;
  return j;
}

SignalResult signal_from(const ordered_json& j) {
  SignalResult s;
  s.name = j.at("name"), s.unit = j.at("unit"), s.peak = j.at("peak"), s.peak_at = j.at("peak_at");
  s.remark = j.at("remark"), s.provenance = j.at("provenance");
  s.reference_source = j.at("reference_source");
  if (j.contains("reference_peak")) s.reference_peak = j["reference_peak"].get<double>();
  if (j.contains("reference_peak_at")) s.reference_peak_at = j["reference_peak_at"].get<double>();
  for (const auto& [method, parts] : j.at("ratings").items())
    for (const auto& [part, value] : parts.items())
      s.ratings[method].emplace_back(part, value.get<double>());
  s.paper = j.at("paper");
  if (j.contains("paper_total")) s.paper_total = j["paper_total"].get<double>();
  return s;
}

ordered_json json_of(const CheckResult& c) {
  return {{"name", c.name},   {"computed", c.computed}, {"value", c.value},
          {"bound", c.bound}, {"passed", c.passed},     {"problem", c.problem}};
}

CheckResult check_from(const ordered_json& j) {
  CheckResult c;
  c.name = j.at("name"), c.computed = j.at("computed"), c.bound = j.at("bound");
  c.value = j.at("value").is_number() ? j["value"].get<double>() : 0;
  c.passed = j.at("passed"), c.problem = j.at("problem");
  return c;
}

}  // namespace

std::string state_name(State s) {
  return s == State::passed ? "passed" : s == State::failed ? "failed" : "skipped";
}

ordered_json to_json(const Outcome& o) {
  ordered_json j{{"name", o.name},
                 {"title", o.title},
                 {"state", state_name(o.state)},
                 {"reason", o.reason},
                 {"fingerprint", o.fingerprint},
                 {"version", o.version},
                 {"resolution", o.resolution},
                 {"finished", o.finished},
                 {"run_seconds", o.run_seconds},
                 {"summary", o.summary}};
  j["signals"] = ordered_json::array();
  for (const SignalResult& s : o.signals) j["signals"].push_back(json_of(s));
  if (o.cora_of_all) j["cora_of_all"] = *o.cora_of_all;
  j["checks"] = ordered_json::array();
  for (const CheckResult& c : o.checks) j["checks"].push_back(json_of(c));
  return j;
}

Outcome outcome_from(const ordered_json& j) {
  Outcome o;
  o.name = j.at("name"), o.title = j.at("title"), o.reason = j.at("reason");
  const std::string state = j.at("state");
  o.state = state == "passed" ? State::passed : state == "failed" ? State::failed : State::skipped;
  o.fingerprint = j.at("fingerprint"), o.version = j.at("version");
  o.resolution = j.at("resolution"), o.finished = j.at("finished");
  o.run_seconds = j.at("run_seconds"), o.summary = j.at("summary");
  for (const auto& s : j.at("signals")) o.signals.push_back(signal_from(s));
  if (j.contains("cora_of_all")) o.cora_of_all = j["cora_of_all"].get<double>();
  for (const auto& c : j.at("checks")) o.checks.push_back(check_from(c));
  return o;
}

void write_file(const std::string& path, const std::string& text) {
  const std::string part = path + ".part";
  {
    std::ofstream out(part, std::ios::binary);
    out << text;
    out.flush();
    if (!out) throw StudyError(path, 0, "", "cannot be written", "Check the folder and the disk");
  }
  // what the new name stands for must be on the disk first
  if (const int file = open(part.c_str(), O_RDONLY); file >= 0) fsync(file), close(file);
  std::filesystem::rename(part, path);
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace fabrica::study
