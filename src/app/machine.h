#pragma once
// What this machine can do: peak multiply-add rate of native packs on one core, and the memory
// triad on one and on several threads.
#include <map>
#include <string>
#include <vector>

namespace fabrica {

struct Machine {
  std::string name, instruction_set;
  std::map<int, double> triad;  // threads -> GB/s together, a = b + s c, three streams
  double peak = 0;              // Gflop/s in Real, one core
};
Machine measure_machine(const std::vector<int>& threads);

}  // namespace fabrica
