#include "study/campaign.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <limits>

#include "study/channels.h"
#include "study/error.h"
#include "study/outcome.h"
#include "study/run_setup.h"
#include "study/study_report.h"

namespace fabrica::study {
namespace {

namespace fs = std::filesystem;

// A row's folder belongs to one process at a time; the lock goes when the process ends, however.
// What a killed study had started may hold it for a moment longer: tries, one every 10 ms, are how
// often all rows together wait for that.
class RowLock {
 public:
  RowLock(const std::string& folder, int& tries) {
    fs::create_directories(folder);
    file_ = open((folder + "/lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    const auto take = [&] { return file_ >= 0 && flock(file_, LOCK_EX | LOCK_NB) == 0; };
    while (!(held_ = take()) && tries > 0) --tries, usleep(10000);
  }
  RowLock(RowLock&& other) noexcept : file_(other.file_), held_(other.held_) { other.file_ = -1; }
  RowLock(const RowLock&) = delete;
  ~RowLock() {
    if (file_ >= 0) close(file_);
  }
  bool held() const { return held_; }

 private:
  int file_ = -1;
  bool held_ = false;
};

std::string folder_of(const std::string& out, std::size_t row) {
  return fmt::format("{}/runs/{:05}", out, row + 1);
}

// the case of a row: its values in place of those of the base
Case case_of(const Plan& plan, std::size_t row) {
  Case c = plan.base;
  for (std::size_t i = 0; i < plan.names.size(); ++i) {
    const std::string &name = plan.names[i], &value = plan.rows[row][i];
    if (name == "option.end_time")
      c.end_time = std::stod(value);
    else if (name.starts_with("option."))
      c.body[name.substr(7)] = value;
    else
      c.parameters[name] = value;
  }
  return c;
}

// prepares the rows that have no result yet and runs them
void run_rows(const Plan& plan, const StudyOptions& o, const std::string& out) {
  std::vector<RowLock> locks;
  std::vector<Command> commands;
  std::vector<std::pair<std::size_t, std::string>> due;  // row, fingerprint
  std::size_t finished = 0;
  int tries = 200;
  for (std::size_t row = 0; row < plan.rows.size(); ++row) {
    if (o.row > 0 && row + 1 != std::size_t(o.row)) continue;
    const std::string folder = folder_of(out, row);
    RowLock lock(folder, tries);
    if (!lock.held()) {
      fmt::print("row {}: another process runs it\n", row + 1);
      continue;
    }
    const Case c = case_of(plan, row);
    const RunSetup setup = set_up_run(c, folder, o.resolution, o.paths);
    if (up_to_date(folder, setup.fingerprint)) {
      ++finished;
      continue;
    }
    clear_run(folder);
    commands.push_back(run_command(c, setup.deck, folder, o.threads));
    due.push_back({row, setup.fingerprint});
    locks.push_back(std::move(lock));
  }
  fmt::print("{}: {} rows, {} finished before, {} to run\n", plan.title, plan.rows.size(), finished,
             due.size());
  std::fflush(stdout);
  run_all(commands, o.jobs, [&](std::size_t i, const Ended& e) {
    const auto& [row, print] = due[i];
    write_record(folder_of(out, row), {print, time_of_day(), e.status, e.seconds});
    fmt::print("row {}: {} after {:.1f} s\n", row + 1,
               e.status == 0 ? "done" : fmt::format("ended with status {}", e.status), e.seconds);
    std::fflush(stdout);
  });
}

// the numbers that are kept of a row; what cannot be had is not a number
void measure_row(const Plan& plan, const std::string& folder, StudyRow& row) {
  Channels channels(folder + "/result/csv", plan.base.folder, plan.base.time_unit);
  for (const OutputSpec& output : plan.outputs) {
    row.outputs.push_back(std::numeric_limits<double>::quiet_NaN());
    if (row.status != 0) continue;
    try {
      row.outputs.back() = statistic(output.measure, channels);
    } catch (const std::exception& e) {
      row.problem = e.what();
    }
  }
}

std::vector<double> read_reference(const OutputSpec& output, std::size_t rows,
                                   const std::string& file) {
  if (output.reference.empty()) return {};
  std::vector<double> values;
  std::string text = read_file(output.reference);
  for (const char* at = text.c_str(); *at;) {
    char* end = nullptr;
    const double v = std::strtod(at, &end);
    if (end == at) break;
    values.push_back(v);
    at = end;
    while (*at == ',' || *at == '\n' || *at == '\r' || *at == ' ') ++at;
  }
  if (values.size() < rows)
    throw StudyError(
        file, 0, "output.reference",
        fmt::format("{} has {} numbers for {} rows", output.reference, values.size(), rows),
        "Give a file with one number a row");
  values.resize(rows);
  return values;
}

// a job array of which every task runs one row
void write_job_array(const Plan& plan, const StudyOptions& o, const std::string& out) {
  const std::string file = out + "/job.sh";
  const std::string common =
      fmt::format("\"{}\" study \"{}\" --out \"{}\"{}", this_program(),
                  fs::absolute(o.plan).string(), fs::absolute(out).string(), o.set_arguments);
  write_file(
      file,
      fmt::format("#!/bin/bash\n"
                  "# {} rows; afterwards, without --row, the same command writes the table\n"
                  "#SBATCH --job-name={}\n#SBATCH --array=1-{}%{}\n#SBATCH --cpus-per-task={}\n"
                  "#SBATCH --output={}/slurm-%a.log\nset -eu\n"
                  "exec {} --threads {} --row \"$SLURM_ARRAY_TASK_ID\"\n",
                  plan.rows.size(), plan.base.name, plan.rows.size(), o.jobs, o.threads,
                  fs::absolute(out).string(), common, o.threads));
  fmt::print("{}\nsubmit it: sbatch {}\nthen the table: {}\n", file, file, common);
}

}  // namespace

int run_study(const StudyOptions& o) {
  const Plan plan = read_plan(o.plan, o.paths);
  const std::string out = o.out.empty() ? "out/studies/" + plan.base.name : o.out;
  if (o.row < 0 || std::size_t(o.row) > plan.rows.size())
    throw StudyError(o.plan, 0, "--row", fmt::format("the plan has {} rows", plan.rows.size()),
                     "Give one of them");
  fs::create_directories(out);
  if (o.slurm) {
    write_job_array(plan, o, out);
    return 0;
  }
  run_rows(plan, o, out);
  StudyReport report{plan, {}, {}};
  bool good = true;
  for (std::size_t i = 0; i < plan.rows.size(); ++i) {
    if (o.row > 0 && i + 1 != std::size_t(o.row)) continue;
    const RunRecord record = read_record(folder_of(out, i));
    report.rows.push_back({i + 1, record.status, record.seconds, {}, {}});
    StudyRow& row = report.rows.back();
    measure_row(plan, folder_of(out, i), row);
    if (!row.problem.empty()) fmt::print(stderr, "row {}: {}\n", i + 1, row.problem);
    good = good && row.status == 0 && row.problem.empty();
  }
  if (o.row > 0) return good ? 0 : 1;
  for (const OutputSpec& output : plan.outputs)
    report.references.push_back(read_reference(output, plan.rows.size(), o.plan));
  write_report(report, out);
  return good ? 0 : 1;
}

}  // namespace fabrica::study
