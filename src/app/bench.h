#pragma once
// `fabrica bench`: measures this machine (peak arithmetic, memory triad) and this program on it
// (kernels alone, whole time loops), and prints what share of the machine each reaches.
#include <string>

namespace CLI {
class App;
}

namespace fabrica {

struct BenchCommand {
  int threads = 1;
  int elements = 100000;
  double seconds = 3;  // per case
  std::string only;    // run cases whose name contains this
  std::string json;    // also write the table here
};
void add_bench(CLI::App& app, BenchCommand& command);
int bench_command(const BenchCommand& command);

}  // namespace fabrica
