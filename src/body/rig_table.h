#pragma once
// Keys of a rig file, asked for by name and type; every error names file, line and key.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "body/error.h"
#include "body/placement.h"

namespace fabrica::body {

// A table whose keys are asked for by name and type; `finish` refuses those that nobody asked for.
class RigTable {
 public:
  RigTable(const std::string& path, const toml::table& table, std::string prefix)
      : path_(path), table_(table), prefix_(std::move(prefix)) {}

  [[noreturn]] void fail(const std::string& key, const std::string& message) const {
    const toml::node* node = table_.get(key);
    const auto line = (node ? *node : static_cast<const toml::node&>(table_)).source().begin.line;
    throw BodyError(fmt::format("{}:{}: {}{} {}", path_, line, prefix_, key, message));
  }
  const toml::node* find(const std::string& key) {
    asked_.push_back(key);
    return table_.get(key);
  }
  const toml::node& need(const std::string& key, const std::string& what) {
    const toml::node* node = find(key);
    if (!node) fail(key, "is missing; give " + what);
    return *node;
  }
  double number(const std::string& key, double otherwise) {
    const toml::node* node = find(key);
    if (!node) return otherwise;
    const auto value = node->value<double>();
    if (!value) fail(key, "must be a number");
    return *value;
  }
  double positive(const std::string& key, const std::string& what) {
    need(key, what);
    const double value = number(key, 0);
    if (!(value > 0)) fail(key, fmt::format("is {:g}, which is not above 0; give {}", value, what));
    return value;
  }
  std::string text(const std::string& key, const std::string& what) {
    const auto value = need(key, what).value<std::string>();
    if (!value) fail(key, "must be a text; give " + what);
    return *value;
  }
  std::vector<std::string> texts(const std::string& key, const std::string& what) {
    std::vector<std::string> out;
    const toml::node& node = need(key, what);
    if (!node.is_array()) fail(key, "must be a list; give " + what);
    for (const toml::node& item : *node.as_array()) {
      const auto value = item.value<std::string>();
      if (!value) fail(key, "must be a list of texts; give " + what);
      out.push_back(*value);
    }
    return out;
  }
  std::optional<Point> point(const std::string& key) {
    const toml::node* node = find(key);
    if (!node) return {};
    const auto values = numbers(key, *node);
    if (values.size() != 3) fail(key, "must be three numbers such as [0, 0, 1]");
    return Point{values[0], values[1], values[2]};
  }
  std::vector<double> numbers(const std::string& key, const toml::node& node) const {
    std::vector<double> out;
    if (!node.is_array()) fail(key, "must be a list of numbers");
    for (const toml::node& item : *node.as_array()) {
      const auto value = item.value<double>();
      if (!value) fail(key, "must be a list of numbers");
      out.push_back(*value);
    }
    return out;
  }
  std::vector<RigTable> tables(const std::string& key) {
    std::vector<RigTable> out;
    const toml::node* node = find(key);
    if (!node) return out;
    if (!node->is_array_of_tables()) fail(key, fmt::format("is written as [[{}]]", key));
    for (const toml::node& item : *node->as_array())
      out.emplace_back(path_, *item.as_table(), fmt::format("{}[{}].", key, out.size() + 1));
    return out;
  }
  std::optional<RigTable> table(const std::string& key) {
    const toml::node* node = find(key);
    if (!node) return {};
    if (!node->is_table()) fail(key, "must be a table such as { along = \"x\", ... }");
    return RigTable(path_, *node->as_table(), prefix_ + key + ".");
  }
  // a table or a list of them
  std::vector<RigTable> one_or_more(const std::string& key) {
    const toml::node* node = find(key);
    if (node && node->is_array()) return tables(key);
    std::vector<RigTable> out;
    if (auto one = table(key)) out.push_back(*one);
    return out;
  }
  void finish() const {
    for (const auto& [key, node] : table_) {
      if (std::find(asked_.begin(), asked_.end(), std::string(key.str())) != asked_.end()) continue;
      fail(std::string(key.str()),
           fmt::format("is no key here; there are {}", fmt::join(asked_, ", ")));
    }
  }

 private:
  const std::string& path_;
  const toml::table& table_;
  std::string prefix_;
  std::vector<std::string> asked_;
};

}  // namespace fabrica::body
