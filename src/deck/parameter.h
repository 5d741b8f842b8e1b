#pragma once
// *PARAMETER: named values that fields refer to as &name or -&name, in nested scopes.
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fabrica {

// an integer, a real or a text, as declared by I, R and C
using ParameterValue = std::variant<std::int64_t, double, std::string>;

// what a second definition of a name does (DFLAG of *PARAMETER_DUPLICATION)
enum class Duplication { warn_keep = 1, warn_replace = 2, error_keep = 3, replace = 4, keep = 5 };

// Names are not case sensitive. Scope 0 is global; each include opens a scope for its _LOCAL names.
class ParameterTable {
 public:
  ParameterTable() : scopes_(1) {}
  std::optional<Duplication> duplication;  // as chosen; warn_keep where nothing is

  void open_scope() { scopes_.emplace_back(); }
  void close_scope() { scopes_.pop_back(); }
  // the innermost value of a name (without &), or null
  const ParameterValue* find(std::string_view name) const;
  // True if the name was already defined in its scope; what then happens follows `duplication`,
  // unless the first definition was mutable: then the new value replaces it without a word, and
  // false is returned.
  bool define(std::string_view name, ParameterValue value, bool local, bool is_mutable = false);

 private:
  struct Entry {
    ParameterValue value;
    bool is_mutable;
  };
  std::vector<std::map<std::string, Entry, std::less<>>> scopes_;
};

double as_real(const ParameterValue& value);

// Evaluates an expression with + - * / ** ( ), functions and parameter names with or without &.
// Integers stay integers and divide as in Fortran. Nothing, and what went wrong in `problem`, if it
// has no value.
std::optional<ParameterValue> evaluate_expression(std::string_view text,
                                                  const ParameterTable& table,
                                                  std::string& problem);

}  // namespace fabrica
