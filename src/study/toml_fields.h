#pragma once
// A table of a TOML file as case and plan read it: every key is asked for by name and type, a wrong
// type or a missing key is an error with file, line, key and remedy, and a key that nobody asked
// for is one too.
#include <toml++/toml.h>

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "study/error.h"

namespace fabrica::study {

// A TOML file; throws StudyError with file and line where it cannot be parsed.
toml::table read_toml(const std::string& path);

class Fields {
 public:
  // `prefix` stands before the keys in messages: "signal[2]."
  Fields(const toml::table& table, std::string file, std::string prefix = {})
      : table_(&table), file_(std::move(file)), prefix_(std::move(prefix)) {}

  bool has(const std::string& key) const { return table_->contains(key); }
  // Required values.
  std::string text(const std::string& key);
  double number(const std::string& key);
  // Values with a default.
  std::string text(const std::string& key, const std::string& otherwise);
  double number(const std::string& key, double otherwise);
  int integer(const std::string& key, int otherwise);
  bool flag(const std::string& key, bool otherwise);
  std::optional<double> maybe_number(const std::string& key);
  // [low, high] with low < high
  std::optional<std::pair<double, double>> interval(const std::string& key);
  // A list, or a single value that stands for a list of one; empty where the key is missing.
  std::vector<std::string> texts(const std::string& key);
  std::vector<double> numbers(const std::string& key);
  // Tables: [key] (nothing where missing) and [[key]].
  std::optional<Fields> table(const std::string& key);
  std::vector<Fields> tables(const std::string& key);

  // All keys in the order of the file; asking counts them as known.
  std::vector<std::string> keys();
  // The value of a key, as a number with all its digits or as text.
  std::string literal(const std::string& key);
  bool is_integer(const std::string& key) const;
  bool is_table(const std::string& key) const;

  // Throws StudyError for the first key that nobody asked for, naming those that exist.
  void finish() const;
  int line(const std::string& key = {}) const;
  const std::string& file() const { return file_; }
  [[noreturn]] void fail(const std::string& key, const std::string& message,
                         const std::string& remedy) const;
  // Fails where the value of a key is none of those allowed.
  void one_of(const std::string& key, const std::string& value,
              const std::vector<std::string>& allowed) const;

 private:
  const toml::node* find(const std::string& key);
  const toml::node& need(const std::string& key, const std::string& what);

  const toml::table* table_;
  std::string file_, prefix_;
  std::set<std::string> known_;
};

}  // namespace fabrica::study
