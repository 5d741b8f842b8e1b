#pragma once
// What one core of this machine can do: peak multiply-add rate of native packs, and the memory
// triad.
#include <string>

namespace fabrica {

struct Machine {
  std::string name, instruction_set;
  double triad = 0;  // GB/s, a = b + s c, three streams
  double peak = 0;   // Gflop/s in Real
};
Machine measure_machine();

}  // namespace fabrica
