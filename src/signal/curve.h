#pragma once
// Measured or computed signals: y sampled over x, which is time or, in force-deflection curves, a
// displacement. What a signal is checked for, and how it is read between its samples.
#include <stdexcept>
#include <string>
#include <vector>

namespace fabrica {

// What is wrong with a signal: a kebab-case name that never changes, what was found, what can be
// done.
class SignalError : public std::runtime_error {
 public:
  SignalError(std::string name, const std::string& message, const std::string& remedy)
      : std::runtime_error("[" + name + "] " + message + ". " + remedy), name_(std::move(name)) {}
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

// Names for a message, at most 24 of them: those with the id of what was wanted ("force:7") first.
std::string listed(std::vector<std::string> names, const std::string& wanted = {});

// n samples y at x. Units are names of signal/units.h; "" means that none was given, "1" that there
// is none.
struct Signal {
  std::string name;
  std::string unit;
  std::string x_unit;
  std::vector<double> x, y;

  std::size_t size() const { return x.size(); }
};

// Throws SignalError "empty-signal", "ragged-signal", "not-a-number" or "time-not-ascending" unless
// the signal has at least two samples, as many y as x, only finite numbers, and ascending x.
void check(const Signal& signal);

// The constant distance of the samples in units of x; "not-uniform" where steps differ by more than
// one thousandth.
double sample_interval(const Signal& signal);

// True if both have the same number of samples at the same x, to one thousandth of a step.
bool same_base(const Signal& a, const Signal& b);

// y at x, linear between samples; outside the first and the last value.
double value_at(const Signal& signal, double x);

// The signal read at low, low + step, ... up to high. Throws "interval-not-covered" if the signal
// does not reach that far, by more than half of one of its own steps.
Signal resampled(const Signal& signal, double low, double high, double step);

// The signal's whole range at a constant step.
Signal resampled(const Signal& signal, double step);

}  // namespace fabrica
