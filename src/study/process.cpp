#include "study/process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>

#include "study/error.h"

namespace fabrica::study {
namespace {

using Clock = std::chrono::steady_clock;

// In the child: becomes the command. Only calls that are allowed between fork and exec.
[[noreturn]] void become(char* const* arguments, const char* log, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // the parent died before the line above
  const int out = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (out >= 0) dup2(out, 1), dup2(out, 2);
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing >= 0) dup2(nothing, 0);
  execvp(arguments[0], arguments);
  _exit(127);
}

pid_t start(const Command& c) {
  std::vector<char*> arguments;
  for (const std::string& a : c.arguments) arguments.push_back(const_cast<char*>(a.c_str()));
  arguments.push_back(nullptr);
  const std::string log = c.log.empty() ? "/dev/null" : c.log;
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) throw StudyError("no further process can be started. Give fewer --jobs");
  if (child == 0) become(arguments.data(), log.c_str(), parent);
  return child;
}

}  // namespace

void run_all(const std::vector<Command>& commands, int jobs,
             const std::function<void(std::size_t, const Ended&)>& ended) {
  struct Running {
    std::size_t index;
    Clock::time_point since;
  };
  std::map<pid_t, Running> running;
  std::size_t next = 0;
  while (next < commands.size() || !running.empty()) {
    while (next < commands.size() && int(running.size()) < std::max(1, jobs)) {
      running[start(commands[next])] = {next, Clock::now()};
      ++next;
    }
    int state = 0;
    const pid_t pid = waitpid(-1, &state, 0);
    const auto at = running.find(pid);
    if (at == running.end()) continue;
    const Running r = at->second;
    running.erase(at);
    const int status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
    ended(r.index, {status, std::chrono::duration<double>(Clock::now() - r.since).count()});
  }
}

std::string this_program() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

std::string last_line(const std::string& path) {
  std::ifstream in(path);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace fabrica::study
