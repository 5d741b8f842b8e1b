#pragma once
// What went wrong, where, and what to do about it. Readers collect diagnostics instead of stopping
// at the first; nothing is lost, and whoever drives the reader decides when to stop.
#include <string>
#include <vector>

namespace fabrica {

// a place in a deck: index into Diagnostics::files (-1: not from a file), line from 1
struct Location {
  int file = -1;
  int line = 0;
};

enum class Severity { note, warning, ignored, unsupported, error };

struct Diagnostic {
  Severity severity = Severity::error;
  std::string name;  // stable kebab-case name, e.g. "missing-node", "unknown-keyword"
  Location where;
  std::string keyword;  // without the star; may be empty
  std::string field;    // may be empty
  std::string message;  // what was found and what was expected
  std::string remedy;   // what the user can do
  int cases = 1;        // how many it stands for: more than one where the rest is only counted
};

class Diagnostics {
 public:
  std::vector<std::string> files;

  void add(Diagnostic d) { list_.push_back(std::move(d)); }
  void error(std::string name, Location where, std::string keyword, std::string field,
             std::string message, std::string remedy) {
    add({Severity::error, std::move(name), where, std::move(keyword), std::move(field),
         std::move(message), std::move(remedy)});
  }
  void warning(std::string name, Location where, std::string keyword, std::string field,
               std::string message, std::string remedy = {}) {
    add({Severity::warning, std::move(name), where, std::move(keyword), std::move(field),
         std::move(message), std::move(remedy)});
  }
  const std::vector<Diagnostic>& list() const { return list_; }
  // cases of a severity, those that are only counted among them
  int count(Severity s) const;
  bool has_errors() const { return count(Severity::error) > 0; }
  // "file:line: error [name] *KEYWORD, field X: message. Remedy"
  std::string format(const Diagnostic& d) const;

 private:
  std::vector<Diagnostic> list_;
};

}  // namespace fabrica
