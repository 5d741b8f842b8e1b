#include "signal/units.h"

#include <fmt/format.h>

#include <array>
#include <numbers>

namespace fabrica {
namespace {

constexpr double g = 9.80665;  // standard acceleration of free fall [m/s2]
constexpr double degree = std::numbers::pi / 180;

// name, quantity, how many of the quantity's first unit it is
struct Unit {
  const char *name, *quantity;
  double factor;
};
constexpr std::array units{
    Unit{"1", "number", 1},
    Unit{"-", "number", 1},
    Unit{"%", "number", 0.01},
    Unit{"percent", "number", 0.01},
    Unit{"s", "time", 1},
    Unit{"ms", "time", 1e-3},
    Unit{"us", "time", 1e-6},
    Unit{"m", "length", 1},
    Unit{"cm", "length", 1e-2},
    Unit{"mm", "length", 1e-3},
    Unit{"m/s", "velocity", 1},
    Unit{"mm/ms", "velocity", 1},
    Unit{"mm/s", "velocity", 1e-3},
    Unit{"km/h", "velocity", 1 / 3.6},
    Unit{"m/s2", "acceleration", 1},
    Unit{"m/s^2", "acceleration", 1},
    Unit{"mm/ms2", "acceleration", 1000},
    Unit{"mm/s2", "acceleration", 1e-3},
    Unit{"g", "acceleration", g},
    Unit{"N", "force", 1},
    Unit{"kN", "force", 1e3},
    Unit{"N s", "impulse", 1},
    Unit{"Ns", "impulse", 1},
    Unit{"kNs", "impulse", 1e3},
    Unit{"N.m", "moment", 1},
    Unit{"Nm", "moment", 1},
    Unit{"Nmm", "moment", 1e-3},
    Unit{"kNmm", "moment", 1},
    Unit{"kNm", "moment", 1e3},
    Unit{"rad", "angle", 1},
    Unit{"deg", "angle", degree},
    Unit{"rad/s", "angular velocity", 1},
    Unit{"rad/ms", "angular velocity", 1e3},
    Unit{"deg/s", "angular velocity", degree},
    Unit{"rad/s2", "angular acceleration", 1},
    Unit{"rad/ms2", "angular acceleration", 1e6},
    Unit{"deg/s2", "angular acceleration", degree},
    Unit{"Pa", "stress", 1},
    Unit{"kPa", "stress", 1e3},
    Unit{"MPa", "stress", 1e6},
    Unit{"GPa", "stress", 1e9},
    Unit{"J", "energy", 1},
    Unit{"kJ", "energy", 1e3},
    Unit{"kg", "mass", 1},
};

const Unit* find(const std::string& name) {
  for (const Unit& u : units)
    if (name == u.name) return &u;
  return nullptr;
}

const Unit& required(const std::string& name) {
  if (name.empty())
    throw SignalError(
        "unit-missing", "a signal has no unit",
        "Name it in the header of the column, as force_kN or force [kN], or by an option");
  if (const Unit* u = find(name)) return *u;
  std::string all;
  for (const Unit& u : units) all += (all.empty() ? "" : ", ") + std::string(u.name);
  throw SignalError("unknown-unit", "'" + name + "' is not a known unit", "Known are: " + all);
}

}  // namespace

bool known_unit(const std::string& unit) { return find(unit) != nullptr; }

double unit_factor(const std::string& from, const std::string& to) {
  const Unit &a = required(from), &b = required(to);
  if (std::string(a.quantity) != b.quantity)
    throw SignalError("different-units",
                      fmt::format("{} ({}) cannot be {} ({})", from, a.quantity, to, b.quantity),
                      "Compare channels of one quantity");
  return a.factor / b.factor;
}

Signal in_unit(Signal signal, const std::string& unit) {
  const double factor = unit_factor(signal.unit, unit);
  for (double& y : signal.y) y *= factor;
  signal.unit = unit;
  return signal;
}

Signal in_x_unit(Signal signal, const std::string& unit) {
  const double factor = unit_factor(signal.x_unit, unit);
  for (double& x : signal.x) x *= factor;
  signal.x_unit = unit;
  return signal;
}

}  // namespace fabrica
