#pragma once
// An error of a case or a plan: "file:line: key: what was found. What to do".
#include <stdexcept>
#include <string>

namespace fabrica::study {

class StudyError : public std::runtime_error {
 public:
  explicit StudyError(const std::string& text) : std::runtime_error(text) {}
  StudyError(const std::string& file, int line, const std::string& key, const std::string& message,
             const std::string& remedy)
      : std::runtime_error(file + (line > 0 ? ":" + std::to_string(line) : "") + ": " +
                           (key.empty() ? "" : key + ": ") + message + ". " + remedy) {}
};

}  // namespace fabrica::study
