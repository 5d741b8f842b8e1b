#pragma once
// `fabrica run` and `fabrica check`.
#include <string>
#include <vector>

namespace fabrica {

struct RunCommand {
  std::string deck;
  std::string out = "out";
  int threads = 0;              // 0: all cores
  double until = 0;             // 0: the deck's end time
  std::string restart;          // file to continue from
  double restart_interval = 0;  // time between restart files; 0: one at the end
  bool vtu = false;             // also write a .vtu series
  bool allow_unsupported = false;
  std::string walls = "impulse";  // how rigid walls stop nodes: impulse, constraint
  bool quiet = false;
};
// Returns the exit status: 0 done, 1 bad input, 2 unsupported input, 3 the physics broke, 130
// stopped by a signal.
int run_command(const RunCommand& command);

struct CheckCommand {
  std::string deck;
  std::string write;  // file to write the model back to
  bool quiet = false;
};
// 0 when there are neither errors nor unsupported keywords, 1 for errors, 2 for unsupported
// keywords only.
int check_command(const CheckCommand& command);

}  // namespace fabrica
