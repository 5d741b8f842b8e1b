#include "body/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace fabrica::body {
namespace {

const DataFile* find(std::string_view path) {
  const auto& files = embedded_data_files();
  const auto at =
      std::lower_bound(files.begin(), files.end(), path,
                       [](const DataFile& f, std::string_view p) { return f.path < p; });
  return at != files.end() && at->path == path ? &*at : nullptr;
}

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

}  // namespace

bool has_data_file(std::string_view path) { return find(path) != nullptr; }

std::string_view data_file(std::string_view path) {
  const DataFile* file = find(path);
  if (!file) throw BodyError(fmt::format("data/{} is not among the tables of the program", path));
  return file->text;
}

Table::Table(std::string_view path) : Table(path, data_file(path)) {}

Table::Table(std::string_view path, std::string_view text) : path_(path) {
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> cells = split(line);
    if (columns_.empty()) {
      columns_ = std::move(cells);
      for (std::size_t c = 0; c < columns_.size(); ++c) index_[columns_[c]] = int(c);
      continue;
    }
    if (cells.size() != columns_.size())
      throw BodyError(
          fmt::format("{}:{}: {} cells where the header names {} columns; add or remove commas",
                      path_, number, cells.size(), columns_.size()));
    cells_.push_back(std::move(cells));
    lines_.push_back(number);
  }
  if (columns_.empty()) throw BodyError(fmt::format("{}: no line names the columns", path_));
}

bool Table::has_column(std::string_view column) const {
  return index_.find(column) != index_.end();
}

void Table::fail(int row, const std::string& message) const {
  throw BodyError(fmt::format("{}:{}: {}", path_, line(row), message));
}

int Table::column_index(int row, std::string_view column) const {
  const auto at = index_.find(column);
  if (at == index_.end())
    fail(row, fmt::format("no column is named '{}'; name it in the header", column));
  return at->second;
}

const std::string& Table::text(int row, std::string_view column) const {
  return cells_[std::size_t(row)][std::size_t(column_index(row, column))];
}

double Table::number(int row, std::string_view column) const {
  const std::string& cell = text(row, column);
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || cell.empty())
    fail(row,
         fmt::format("'{}' in column '{}' is no number; write one such as 12.5", cell, column));
  return value;
}

}  // namespace fabrica::body
