#include "app/study.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <thread>

namespace fabrica {
namespace {

// "name=folder" of --set
std::map<std::string, std::string> paths_of(const std::vector<std::string>& texts) {
  std::map<std::string, std::string> out;
  for (const std::string& text : texts) {
    const std::size_t at = text.find('=');
    if (at == std::string::npos || at == 0 || at + 1 == text.size())
      throw CLI::ValidationError("--set " + text, "write --set NAME=FOLDER");
    const std::string folder = text.substr(at + 1);
    if (!std::filesystem::is_directory(folder))
      throw CLI::ValidationError("--set " + text, "there is no folder " + folder + "; correct it");
    out[text.substr(0, at)] = std::filesystem::absolute(folder).lexically_normal().string();
  }
  return out;
}

int cores() { return std::max(1, int(std::thread::hardware_concurrency())); }

void add_validate(CLI::App& app, StudyCommands& c) {
  auto* command = app.add_subcommand(
      "validate", "Run cases that are not up to date, compare them, write their pages");
  command->add_option("name", c.validate.names,
                      "names of cases; all that are not slow if none is given");
  command->add_option("--cases", c.validate.cases, "folder below which the cases lie")
      ->capture_default_str();
  command->add_option("--out", c.validate.out, "folder for results and pages")
      ->capture_default_str();
  command->add_option("--resolution", c.validate.resolution, "of generated bodies")
      ->check(CLI::IsMember({"coarse", "standard", "fine"}));
  command->add_option("--jobs", c.validate.jobs, "runs side by side")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--threads", c.validate.threads,
                   "threads of each run; 0 shares the cores among the jobs")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--set", c.validate_paths,
                      "NAME=FOLDER for {NAME} in the file names of cases");
  command->add_flag("--slow", c.validate.slow, "also cases that are marked as slow");
  command->add_flag("--compare-only", c.validate.compare_only,
                    "run nothing, compare what is there");
  command->add_flag("--table", c.table, "only print all ratings, the published ones beside them");
  command->callback([&c] {
    if (c.table) throw CLI::RuntimeError(study::print_ratings(c.validate));
    c.validate.paths = paths_of(c.validate_paths);
    if (c.validate.threads == 0) c.validate.threads = std::max(1, cores() / c.validate.jobs);
    throw CLI::RuntimeError(study::validate(c.validate));
  });
}

void add_plan(CLI::App& app, StudyCommands& c) {
  auto* command =
      app.add_subcommand("study", "Run the rows of a parameter study that have no result yet");
  command->add_option("plan", c.study.plan, "plan.toml")->required()->check(CLI::ExistingFile);
  command->add_option("--out", c.study.out,
                      "folder for runs, table and plots; out/studies/NAME if not given");
  command->add_option("--resolution", c.study.resolution, "of generated bodies")
      ->check(CLI::IsMember({"coarse", "standard", "fine"}));
  command->add_option("--jobs", c.study.jobs, "runs side by side")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--threads", c.study.threads, "threads of each run")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--set", c.study_paths,
                      "NAME=FOLDER for {NAME} in the file names of the plan");
  command->add_option("--row", c.study.row, "only this row, from 1, without table")
      ->check(CLI::PositiveNumber);
  command->add_flag("--slurm", c.study.slurm, "write a job array for a cluster instead of running");
  command->callback([&c] {
    c.study.paths = paths_of(c.study_paths);
    for (const auto& [name, folder] : c.study.paths)
      c.study.set_arguments += " --set \"" + name + "=" + folder + "\"";
    throw CLI::RuntimeError(study::run_study(c.study));
  });
}

}  // namespace

void add_study(CLI::App& app, StudyCommands& commands) {
  add_validate(app, commands);
  add_plan(app, commands);
}

}  // namespace fabrica
