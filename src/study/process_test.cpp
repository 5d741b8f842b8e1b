#include "study/process.h"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

using namespace fabrica::study;

TEST_CASE("every command runs once and its status comes back") {
  std::vector<Command> commands;
  for (int i = 0; i < 7; ++i) commands.push_back({{"sh", "-c", "exit " + std::to_string(i)}, ""});
  commands.push_back({{"there-is-no-such-program"}, ""});
  std::vector<int> status(commands.size(), -1);
  run_all(commands, 3, [&](std::size_t i, const Ended& e) {
    CHECK(status[i] == -1);
    status[i] = e.status;
  });
  for (int i = 0; i < 7; ++i) CHECK(status[std::size_t(i)] == i);
  CHECK(status[7] == 127);
}

// each command ends well only if it sees all three at work within 20 s
TEST_CASE("as many commands run side by side as there are jobs") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("fabrica_jobs_" + std::to_string(getpid()));
  for (const int jobs : {3, 1}) {
    std::filesystem::create_directories(folder);
    std::vector<Command> commands;
    const std::string patience = jobs == 3 ? "200" : "3";
    for (int i = 0; i < 3; ++i)
      commands.push_back(
          {{"sh", "-c",
            "cd " + folder.string() + "; : > begun" + std::to_string(i) + "; for n in $(seq " +
                patience + "); do [ $(ls | wc -l) -eq 3 ] && exit 0; sleep 0.1; done; exit 9"},
           ""});
    int together = 0;
    run_all(commands, jobs, [&](std::size_t, const Ended& e) { together += e.status == 0; });
    // one at a time the last finds the marks of the others, and only it
    CHECK(together == (jobs == 3 ? 3 : 1));
    std::filesystem::remove_all(folder);
  }
}

TEST_CASE("what a command prints is in its log") {
  const std::string log =
      (std::filesystem::temp_directory_path() / ("fabrica_log_" + std::to_string(getpid())))
          .string();
  run_all({{{"sh", "-c", "echo out; echo err >&2"}, log}}, 1, [](std::size_t, const Ended&) {});
  CHECK(last_line(log) == "err");
  std::filesystem::remove(log);
}

TEST_CASE("a killed program takes the commands it started with it") {
  const std::string mark =
      (std::filesystem::temp_directory_path() / ("fabrica_mark_" + std::to_string(getpid())))
          .string();
  const pid_t parent = fork();
  if (parent == 0) {
    run_all({{{"sh", "-c", "echo $$ > " + mark + "; exec sleep 60"}, ""}}, 1,
            [](std::size_t, const Ended&) {});
    _exit(0);
  }
  pid_t child = 0;
  for (int i = 0; i < 500 && child == 0; ++i) {
    std::ifstream(mark) >> child;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  REQUIRE(child > 0);
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  // the child is gone, or a corpse that nobody has collected yet
  bool gone = false;
  for (int i = 0; i < 500 && !gone; ++i) {
    std::ifstream stat("/proc/" + std::to_string(child) + "/stat");
    std::string pid, name, state;
    gone = !(stat >> pid >> name >> state) || state == "Z";
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  CHECK(gone);
  std::filesystem::remove(mark);
}
