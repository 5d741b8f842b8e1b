#include "signal/channel_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "signal/iso_mme.h"
#include "signal/units.h"

namespace fabrica {
namespace {

namespace fs = std::filesystem;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; }

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && is_blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && is_blank(s.back())) s.remove_suffix(1);
  return s;
}

// A table whose rows are read one after the other: of a long file only what is asked for is kept.
class Table {
 public:
  explicit Table(const std::string& file);

  std::string path;
  std::vector<std::string> names;
  int line = 0;                         // of the row at hand
  std::vector<std::string_view> cells;  // of that row, names.size() of them, until the next one
  bool next_row();
  // no fewer than there are rows left, if they are as long as the header or longer
  std::size_t most_rows() const { return std::size_t(left_) / (2 * names.size()) + 1; }

 private:
  bool next_line();
  std::ifstream in_;
  std::string text_;
  std::streamoff left_ = 0;  // bytes after the header
};

// replaces `out` by the cells of a line
void split_cells(std::string_view line, std::vector<std::string_view>& out) {
  out.clear();
  const char separator = line.find(';') != std::string_view::npos ? ';' : ',';
  for (;;) {
    const std::size_t end = line.find(separator);
    out.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

// the next line that is neither blank nor a comment, in cells
bool Table::next_line() {
  while (std::getline(in_, text_)) {
    ++line;
    if (trimmed(text_).empty() || text_[0] == '#') continue;
    split_cells(text_, cells);
    return true;
  }
  return false;
}

bool Table::next_row() {
  if (!next_line()) return false;
  if (cells.size() != names.size())
    throw SignalError(
        "ragged-signal",
        fmt::format("{}:{}: {} cells, the header has {}", path, line, cells.size(), names.size()),
        "Give each row one cell for each column");
  return true;
}

Table::Table(const std::string& file) : path(file), in_(file, std::ios::binary) {
  if (!in_) throw SignalError("no-such-file", "cannot open " + path, "Check the path");
  if (next_line()) names.assign(cells.begin(), cells.end());
  if (names.size() < 2)
    throw SignalError("empty-signal", path + " has fewer than two columns",
                      "Give a header line and rows of numbers");
  std::error_code ignored;
  const auto size = fs::file_size(path, ignored);
  left_ = ignored ? 0 : std::streamoff(size) - in_.tellg();
}

// the column of that name, with or without unit; -1 if there is none
int find_column(const Table& t, const std::string& name) {
  for (std::size_t c = 0; c < t.names.size(); ++c)
    if (t.names[c] == name) return int(c);
  for (std::size_t c = 0; c < t.names.size(); ++c)
    if (name_and_unit(t.names[c]).name == name) return int(c);
  return -1;
}

[[noreturn]] void no_such_column(const Table& t, const std::string& name) {
  throw SignalError("no-such-channel", fmt::format("{} has no column '{}'", t.path, name),
                    "There are: " + listed(t.names, name));
}

int column(const Table& t, const std::string& name) {
  const int c = find_column(t, name);
  if (c < 0) no_such_column(t, name);
  return c;
}

double number(const Table& t, int column) {
  const std::string_view cell = t.cells[std::size_t(column)];
  const char *begin = cell.data(), *end = begin + cell.size();
  if (begin != end && *begin == '+') ++begin;
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value))
    throw SignalError(
        "not-a-number",
        fmt::format("{}:{}: '{}' in column '{}'", t.path, t.line, cell, t.names[column]),
        "Write a number, or leave the cell empty to drop the row");
  return value;
}

// rows in which a column holds a value
struct Condition {
  int column = -1;
  std::string value;
};

Signal empty_signal(const Table& t, int x, int y) {
  const NameAndUnit of_x = name_and_unit(t.names[x]), of_y = name_and_unit(t.names[y]);
  Signal s{of_y.name, of_y.unit, of_x.unit, {}, {}};
  s.x.reserve(t.most_rows()), s.y.reserve(t.most_rows());
  return s;
}

// appends the row at hand, unless it has no value
void add_row(Signal& s, const Table& t, int x, int y) {
  if (t.cells[x].empty() || t.cells[y].empty()) return;
  s.x.push_back(number(t, x));
  s.y.push_back(number(t, y));
}

Signal make_signal(Table& t, int x, int y, const Condition& only = {}) {
  Signal s = empty_signal(t, x, y);
  while (t.next_row())
    if (only.column < 0 || t.cells[only.column] == only.value) add_row(s, t, x, y);
  if (only.column >= 0) s.name += " " + only.value;
  if (only.column >= 0 && s.x.empty())
    throw SignalError(
        "no-such-row",
        fmt::format("{}: no row has {} = {}", t.path, t.names[only.column], only.value),
        "Check the value after @");
  return s;
}

// "y", "x:y", "y@column=value"; a name may itself hold a colon
Signal select(Table&& t, std::string wanted) {
  Condition only;
  if (const std::size_t at = wanted.find('@'); at != std::string::npos) {
    const std::size_t equal = wanted.find('=', at);
    if (equal == std::string::npos)
      throw SignalError("no-such-row",
                        "'" + wanted.substr(at) + "' is not of the form @column=value",
                        "Write it so");
    only = {column(t, wanted.substr(at + 1, equal - at - 1)), wanted.substr(equal + 1)};
    wanted.resize(at);
  }
  if (wanted.empty()) return make_signal(t, 0, 1, only);
  if (const int y = find_column(t, wanted); y >= 0) return make_signal(t, 0, y, only);
  for (std::size_t colon = wanted.find(':'); colon != std::string::npos;
       colon = wanted.find(':', colon + 1)) {
    const int x = find_column(t, wanted.substr(0, colon)),
              y = find_column(t, wanted.substr(colon + 1));
    if (x >= 0 && y >= 0) return make_signal(t, x, y, only);
  }
  no_such_column(t, wanted);
}

bool is_csv(const std::string& path) { return fs::path(path).extension() == ".csv"; }

bool is_time(const std::string& unit) {
  return unit.empty() || unit == "s" || unit == "ms" || unit == "us";
}

// file and what follows its colon
std::pair<std::string, std::string> split(const std::string& where) {
  if (fs::exists(where)) return {where, ""};
  for (std::size_t colon = where.find(':'); colon != std::string::npos;
       colon = where.find(':', colon + 1))
    if (fs::exists(where.substr(0, colon)))
      return {where.substr(0, colon), where.substr(colon + 1)};
  if (const std::size_t at = where.find('@');
      at != std::string::npos && fs::exists(where.substr(0, at)))
    return {where.substr(0, at), where.substr(at)};
  throw SignalError("no-such-file", "cannot find " + where,
                    "Name an existing file, as table.csv:column");
}

}  // namespace

NameAndUnit name_and_unit(const std::string& header) {
  for (const auto& [open, close] : {std::pair('[', ']'), std::pair('(', ')')}) {
    const std::size_t a = header.find(open), b = header.find(close, a == std::string::npos ? 0 : a);
    if (a == std::string::npos || b == std::string::npos) continue;
    const std::string unit =
        plain_unit(std::string(trimmed(std::string_view(header).substr(a + 1, b - a - 1))));
    if (known_unit(unit))
      return {std::string(trimmed(std::string_view(header).substr(0, a))), unit};
  }
  // name_unit, where a slash is written as an underscore: velocity_m_s, omega_rad_s
  for (std::size_t at = header.find('_'); at != std::string::npos; at = header.find('_', at + 1)) {
    std::string unit = header.substr(at + 1);
    if (unit == "1" || at == 0) continue;  // a number in a name
    std::replace(unit.begin(), unit.end(), '_', '/');
    if (known_unit(unit)) return {header.substr(0, at), unit};
  }
  return {header, ""};
}

Signal read_signal(const std::string& where) {
  const auto [file, wanted] = split(where);
  Signal s = is_csv(file) ? select(Table(file), wanted) : read_mme_channel(file, wanted);
  if (s.size() < 2)
    throw SignalError("empty-signal", fmt::format("{} holds {} samples", where, s.size()),
                      "A curve needs at least two");
  return s;
}

std::vector<Signal> read_all_signals(const std::string& file) {
  if (!fs::exists(file)) throw SignalError("no-such-file", "cannot find " + file, "Check the path");
  if (!is_csv(file)) return read_mme_test(file);
  Table t(file);
  std::vector<Signal> out;
  for (std::size_t c = 1; c < t.names.size(); ++c) out.push_back(empty_signal(t, 0, int(c)));
  while (t.next_row())
    for (std::size_t c = 0; c < out.size(); ++c) add_row(out[c], t, 0, int(c) + 1);
  return out;
}

void write_csv(const std::string& path, const std::vector<Signal>& signals,
               const std::string& comment) {
  for (const Signal& s : signals)
    if (s.x != signals[0].x)
      throw SignalError("different-time-base",
                        fmt::format("'{}' and '{}' differ in x", signals[0].name, s.name),
                        "Resample them to one step, or write them to files of their own");
  std::ofstream out(path);
  if (!comment.empty()) out << "# " << comment << '\n';
  auto titled = [](const std::string& name, const std::string& unit) {
    return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
  };
  std::string text = titled(is_time(signals[0].x_unit) ? "time" : "x", signals[0].x_unit);
  for (const Signal& s : signals) text += "," + titled(s.name, s.unit);
  text += '\n';
  for (std::size_t i = 0; i < signals[0].size(); ++i) {
    text += fmt::format("{:.12g}", signals[0].x[i]);
    for (const Signal& s : signals) text += fmt::format(",{:.12g}", s.y[i]);
    text += '\n';
  }
  out << text;
  out.flush();
  if (!out)
    throw SignalError("cannot-write", "cannot write " + path,
                      "Check the folder and the space left");
}

}  // namespace fabrica
