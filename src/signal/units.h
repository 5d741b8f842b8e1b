#pragma once
// Units of signals by name: how many of one make one of another.
#include <string>

#include "signal/curve.h"

namespace fabrica {

// One `from` in units `to`, e.g. unit_factor("ms", "s") = 0.001. Throws SignalError "unit-missing"
// if either is "", "unknown-unit", "different-units" if they measure different things.
double unit_factor(const std::string& from, const std::string& to);

bool known_unit(const std::string& unit);

// The signal with y, or x, in another unit.
Signal in_unit(Signal signal, const std::string& unit);
Signal in_x_unit(Signal signal, const std::string& unit);

}  // namespace fabrica
