#pragma once
// Functions of a deck: *DEFINE_FUNCTION (a function in C), *DEFINE_FUNCTION_TABULATED (points) and
// the expressions of *DEFINE_CURVE_FUNCTION, which become curves over time.
//   C:          float f(float u, float t) { float x; x = x + (u - x)/t; return x; }
//   expression: MIN(MAX(LC310, 0.0), f(stim(TIME), 0.04))
// Names are not case sensitive; all numbers are double. A variable of a C function keeps its value
// from one call to the next, as the published filters of muscle activation need it; one that is
// declared with a value is set at each call.
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "model/define.h"

namespace fabrica {

// What is wrong with a function. `unknown`: it is well written but asks for what is not there.
class FunctionError : public std::runtime_error {
 public:
  FunctionError(const std::string& message, bool unknown)
      : std::runtime_error(message), unknown_(unknown) {}
  bool unknown() const { return unknown_; }

 private:
  bool unknown_;
};

// What a call can see: its variables, the time, and how much work is left.
struct Frame {
  std::vector<double>* variable = nullptr;
  double time = 0, result = 0;
  long* steps_left = nullptr;
  int depth = 0;
};
using Value = std::function<double(Frame&)>;

struct Expression {
  Value value;
  std::vector<std::int64_t> curves;  // ids that it names by LC
};

class FunctionLibrary {
 public:
  // value of curve ID at a time; throws FunctionError for an unknown one
  using CurveValue = std::function<double(std::int64_t id, double time)>;
  explicit FunctionLibrary(CurveValue curve) : curve_(std::move(curve)) {}

  // Adds a function in C, or one of one argument by points. Throws FunctionError.
  void add(std::string_view source);
  void add(std::string_view name, Curve points);

  // An expression over TIME; throws FunctionError.
  Expression expression(std::string_view source);
  // Forgets what the variables of functions hold.
  void reset();

  // The value from time 0 to `end` as straight lines: sampled at steps that are halved until
  // no value moves by more than 1e-3 of the range, then thinned to 1e-6 of it. Throws FunctionError
  // where that is not reached with two million steps, or a value is not a number.
  Curve tabulated(const Value& value, double end);

  struct Function {
    std::size_t parameters = 0;
    std::vector<double> variable;      // parameters first
    std::function<bool(Frame&)> body;  // true: `return` was met
    bool defined = false;
    Curve points;  // without a body
  };

 private:
  friend class FunctionParser;
  Function& declare(const std::string& name);

  CurveValue curve_;
  std::map<std::string, std::unique_ptr<Function>> functions_;
};

}  // namespace fabrica
