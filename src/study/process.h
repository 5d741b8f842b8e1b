#pragma once
// Programs run side by side. They die with this process, so that a killed study leaves nothing
// behind.
#include <functional>
#include <string>
#include <vector>

namespace fabrica::study {

struct Command {
  std::vector<std::string> arguments;  // the program first
  std::string log;                     // file that takes what it prints; empty: thrown away
};

// How a command ended: its exit status, or 128 + signal; 127 if it could not be started.
struct Ended {
  int status = 0;
  double seconds = 0;
};

// Runs all commands, at most `jobs` at once, in their order; `ended` is called as each one ends,
// from the calling thread.
void run_all(const std::vector<Command>& commands, int jobs,
             const std::function<void(std::size_t, const Ended&)>& ended);

// The path of the running program.
std::string this_program();

// The last line of a text file that is not empty; empty if there is none.
std::string last_line(const std::string& path);

}  // namespace fabrica::study
