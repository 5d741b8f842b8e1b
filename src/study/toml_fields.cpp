#include "study/toml_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace fabrica::study {

toml::table read_toml(const std::string& path) {
  if (!std::filesystem::is_regular_file(path))
    throw StudyError(path, 0, "", "there is no such file", "Check the path");
  try {
    return toml::parse_file(path);
  } catch (const toml::parse_error& e) {
    throw StudyError(path, int(e.source().begin.line), "", std::string(e.description()),
                     "Mend the TOML there (toml.io explains the form)");
  }
}

const toml::node* Fields::find(const std::string& key) {
  known_.insert(key);
  return table_->get(key);
}

const toml::node& Fields::need(const std::string& key, const std::string& what) {
  const toml::node* node = find(key);
  if (!node) fail(key, "is missing", "Give " + what);
  return *node;
}

std::string Fields::text(const std::string& key) {
  const auto value = need(key, "a text in quotes").value_exact<std::string>();
  if (!value) fail(key, "is not a text", "Put it in quotes");
  return *value;
}

double Fields::number(const std::string& key) {
  const auto value = need(key, "a number").value<double>();
  if (!value) fail(key, "is not a number", "Give a number without quotes");
  if (!std::isfinite(*value)) fail(key, "is not finite", "Give a finite number");
  return *value;
}

std::string Fields::text(const std::string& key, const std::string& otherwise) {
  known_.insert(key);
  return has(key) ? text(key) : otherwise;
}

double Fields::number(const std::string& key, double otherwise) {
  known_.insert(key);
  return has(key) ? number(key) : otherwise;
}

int Fields::integer(const std::string& key, int otherwise) {
  const toml::node* node = find(key);
  if (!node) return otherwise;
  const auto value = node->value_exact<std::int64_t>();
  if (!value) fail(key, "is not a whole number", "Give a whole number without quotes");
  return int(*value);
}

bool Fields::flag(const std::string& key, bool otherwise) {
  const toml::node* node = find(key);
  if (!node) return otherwise;
  const auto value = node->value_exact<bool>();
  if (!value) fail(key, "is neither true nor false", "Write true or false without quotes");
  return *value;
}

std::optional<double> Fields::maybe_number(const std::string& key) {
  known_.insert(key);
  return has(key) ? std::optional(number(key)) : std::nullopt;
}

std::optional<std::pair<double, double>> Fields::interval(const std::string& key) {
  if (!find(key)) return std::nullopt;
  const std::vector<double> v = numbers(key);
  if (v.size() != 2 || !(v[0] < v[1]))
    fail(key, "is not an interval", "Give [from, to] with from below to");
  return std::pair(v[0], v[1]);
}

std::vector<std::string> Fields::texts(const std::string& key) {
  const toml::node* node = find(key);
  if (!node) return {};
  if (!node->is_array()) return {text(key)};
  std::vector<std::string> out;
  for (const toml::node& item : *node->as_array()) {
    const auto value = item.value_exact<std::string>();
    if (!value) fail(key, "holds something that is not a text", "Put every item in quotes");
    out.push_back(*value);
  }
  return out;
}

std::vector<double> Fields::numbers(const std::string& key) {
  const toml::node* node = find(key);
  if (!node) return {};
  if (!node->is_array()) return {number(key)};
  std::vector<double> out;
  for (const toml::node& item : *node->as_array()) {
    const auto value = item.value<double>();
    if (!value || !std::isfinite(*value))
      fail(key, "holds something that is not a finite number", "Give numbers without quotes");
    out.push_back(*value);
  }
  return out;
}

std::optional<Fields> Fields::table(const std::string& key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  if (!node->is_table()) fail(key, "is not a table", "Write it as { ... } or under [" + key + "]");
  return Fields(*node->as_table(), file_, prefix_ + key + ".");
}

std::vector<Fields> Fields::tables(const std::string& key) {
  const toml::node* node = find(key);
  std::vector<Fields> out;
  if (!node) return out;
  if (!node->is_array_of_tables())
    fail(key, "is not a list of tables", "Head each of them with [[" + key + "]]");
  int number = 1;
  for (const toml::node& item : *node->as_array())
    out.emplace_back(*item.as_table(), file_, fmt::format("{}{}[{}].", prefix_, key, number++));
  return out;
}

std::vector<std::string> Fields::keys() {
  std::vector<std::pair<std::pair<toml::source_index, toml::source_index>, std::string>> found;
  for (const auto& [key, node] : *table_) {
    found.push_back(
        {{node.source().begin.line, node.source().begin.column}, std::string(key.str())});
    known_.insert(std::string(key.str()));
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> out;
  for (auto& f : found) out.push_back(std::move(f.second));
  return out;
}

std::string Fields::literal(const std::string& key) {
  const toml::node& node = need(key, "a number or a text");
  if (const auto i = node.value_exact<std::int64_t>()) return std::to_string(*i);
  if (const auto x = node.value_exact<double>()) return fmt::format("{}", *x);
  if (const auto s = node.value_exact<std::string>()) return *s;
  fail(key, "is neither a number nor a text", "Give one of them");
}

bool Fields::is_integer(const std::string& key) const {
  const toml::node* node = table_->get(key);
  return node && node->is_integer();
}

bool Fields::is_table(const std::string& key) const {
  const toml::node* node = table_->get(key);
  return node && node->is_table();
}

void Fields::finish() const {
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (known_.count(name)) continue;
    std::string list;
    for (const std::string& k : known_) list += (list.empty() ? "" : ", ") + k;
    fail(name, "is not a key of this table", "Remove it or correct it; there are: " + list);
  }
}

int Fields::line(const std::string& key) const {
  const toml::node* node = key.empty() ? nullptr : table_->get(key);
  return int((node ? node->source() : table_->source()).begin.line);
}

void Fields::fail(const std::string& key, const std::string& message,
                  const std::string& remedy) const {
  throw StudyError(file_, line(key), prefix_ + key, message, remedy);
}

void Fields::one_of(const std::string& key, const std::string& value,
                    const std::vector<std::string>& allowed) const {
  if (std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return;
  std::string list;
  for (const std::string& a : allowed) list += (list.empty() ? "" : ", ") + a;
  fail(key, "'" + value + "' is not known", "Take one of: " + list);
}

}  // namespace fabrica::study
