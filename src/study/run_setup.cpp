#include "study/run_setup.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "study/error.h"
#include "study/outcome.h"

namespace fabrica::study {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::string absolute(const std::string& folder, const std::string& path) {
  return fs::absolute(fs::path(path).is_absolute() ? fs::path(path) : fs::path(folder) / path)
      .lexically_normal()
      .string();
}

// Makes a body with `fabrica body`; returns its deck.
std::string generate_body(const Case& c, const std::string& folder, const std::string& resolution) {
  const std::string file = folder + "/body.k", made_of = folder + "/body.txt";
  Command command{{this_program(), "body", "--quiet"}, folder + "/body.log"};
  std::string read;  // what the body is made from besides the options
  for (const auto& [key, value] : c.body) {
    command.arguments.push_back("--" + key);
    // files lie in the folder of the case
    const bool file_of_case = value.ends_with(".toml");
    command.arguments.push_back(file_of_case ? absolute(c.folder, value) : value);
    if (file_of_case) read += read_file(command.arguments.back());
  }
  if (!resolution.empty())
    command.arguments.insert(command.arguments.end(), {"--resolution", resolution});
  command.arguments.insert(command.arguments.end(), {"--out", file});
  std::string key = engine_version + read;
  for (const std::string& a : command.arguments) key += "\n" + a;
  if (fs::exists(file) && read_file(made_of) == key) return file;
  run_all({command}, 1, [&](std::size_t, const Ended& e) {
    if (e.status != 0)
      throw StudyError(c.file, 0, "body", "the body cannot be made: " + last_line(command.log),
                       "Try `fabrica body` with the same options");
  });
  write_file(made_of, key);
  return file;
}

}  // namespace

RunSetup set_up_run(const Case& c, const std::string& folder, const std::string& resolution,
                    const std::map<std::string, std::string>& paths) {
  fs::create_directories(folder);
  RunSetup setup;
  std::vector<std::string> includes;
  if (!c.body.empty()) {
    includes.push_back(absolute(".", generate_body(c, folder, resolution)));
    if (!c.loads.empty()) includes.push_back(absolute(c.folder, c.loads));
  } else {
    setup.deck = absolute(c.folder, expand(c.deck, paths, c.file, 0));
  }
  if (!c.body.empty() || !c.parameters.empty()) {
    if (includes.empty()) includes.push_back(setup.deck);
    setup.deck = folder + "/main.k";
    write_main(setup.deck, c.parameters, includes);
  }
  setup.content = inspect_deck(setup.deck);
  for (const auto& [name, value] : c.parameters) need_parameter(setup.content, name, c.file, 0);
  setup.fingerprint = fingerprint(
      setup.content.hash,
      {fmt::format("{}", c.end_time), c.allow_unsupported ? "allow" : "", resolution, c.walls});
  return setup;
}

Command run_command(const Case& c, const std::string& deck, const std::string& folder,
                    int threads) {
  Command command{{this_program(), "run", deck, "--out", folder + "/result", "--threads",
                   std::to_string(threads)},
                  folder + "/run.log"};
  if (c.end_time > 0)
    command.arguments.insert(command.arguments.end(), {"--until", fmt::format("{}", c.end_time)});
  if (c.allow_unsupported) command.arguments.push_back("--allow-unsupported");
  command.arguments.insert(command.arguments.end(), {"--walls", c.walls});
  return command;
}

RunRecord read_record(const std::string& folder) {
  const std::string text = read_file(folder + "/run.json");
  const ordered_json j = ordered_json::parse(text.empty() ? "{}" : text, nullptr, false);
  if (!j.is_object() || !j.contains("status")) return {};
  return {j.value("fingerprint", ""), j.value("finished", ""), j.value("status", -1),
          j.value("seconds", 0.0)};
}

void write_record(const std::string& folder, const RunRecord& r) {
  const ordered_json j{{"fingerprint", r.fingerprint},
                       {"status", r.status},
                       {"seconds", r.seconds},
                       {"finished", r.finished}};
  write_file(folder + "/run.json", j.dump(2) + "\n");
}

bool up_to_date(const std::string& folder, const std::string& print) {
  const RunRecord r = read_record(folder);
  return r.status == 0 && r.fingerprint == print;
}

void clear_run(const std::string& folder) {
  fs::remove(folder + "/run.json");
  fs::remove_all(folder + "/result");
}

std::string time_of_day() {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
}

}  // namespace fabrica::study
