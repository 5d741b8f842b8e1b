#include "study/channels.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "signal/curve.h"
#include "study/error.h"

namespace fabrica::study {
namespace {

namespace fs = std::filesystem;

// where the table's name ends: the colon behind ".csv", else the first one
std::size_t colon_of(const std::string& text) {
  const std::size_t csv = text.find(".csv:");
  const std::size_t at = csv != std::string::npos ? csv + 4 : text.find(':');
  if (at == std::string::npos || at == 0 || at + 1 == text.size())
    throw StudyError("'" + text + "' is not of the form database:column or file.csv:column. " +
                     "Name both");
  return at;
}

// a list of the databases of a result
std::string files_of(const std::string& folder) {
  std::string list;
  std::error_code e;
  for (const auto& entry : fs::directory_iterator(folder, e))
    if (entry.path().extension() == ".csv")
      list += (list.empty() ? "" : ", ") + entry.path().stem().string();
  return list.empty() ? "none" : list;
}

// where the last operator stands that binds least: " + " and " - " before " / "; npos: none
std::size_t operator_at(const std::string& text) {
  const std::size_t plus = text.rfind(" + "), minus = text.rfind(" - ");
  if (plus == std::string::npos && minus == std::string::npos) return text.rfind(" / ");
  if (plus == std::string::npos || minus == std::string::npos) return std::min(plus, minus);
  return std::max(plus, minus);
}

double combine(char operation, double a, double b) {
  if (operation == '+') return a + b;
  if (operation == '-') return a - b;
  return b != 0 ? a / b : 0;
}

}  // namespace

std::string table_name_of(const std::string& text) { return text.substr(0, colon_of(text)); }
std::string column_of(const std::string& text) { return text.substr(colon_of(text) + 1); }

SourcedTable read_sourced_csv(const std::string& path) {
  SourcedTable out{read_csv(path), {}};
  std::ifstream in(path);
  for (std::string line; std::getline(in, line) && !line.empty() && line[0] == '#';) {
    const std::size_t colon = line.find(':');
    const std::size_t first = line.find_first_not_of("# ");
    if (colon == std::string::npos || first == std::string::npos || first >= colon) continue;
    const std::size_t value = line.find_first_not_of(' ', colon + 1);
    if (value != std::string::npos)
      out.head.emplace(line.substr(first, colon - first), line.substr(value));
  }
  return out;
}

std::string Channels::path_of(const std::string& text) const {
  const std::string name = table_name_of(text);
  if (name.ends_with(".csv"))
    return fs::path(name).is_absolute() ? name : (fs::path(folder_) / name).string();
  return (fs::path(histories_) / csv_name(name)).string();
}

const SourcedTable& Channels::table_of(const std::string& text) {
  const std::string path = path_of(text);
  const auto at = tables_.find(path);
  if (at != tables_.end()) return at->second;
  if (!fs::is_regular_file(path)) {
    const std::string name = table_name_of(text);
    if (name.ends_with(".csv"))
      throw StudyError("'" + text + "': there is no file " + path + ". Correct the name or add it");
    throw StudyError("'" + text + "': the result has no database " + name + "; it has: " +
                     files_of(histories_) + ". Ask for it in the deck (*DATABASE_...)");
  }
  return tables_.emplace(path, read_sourced_csv(path)).first->second;
}

std::size_t Channels::find_column(const CsvTable& table, const std::string& name,
                                  const std::string& where) {
  std::size_t found = table.names.size(), hits = 0;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const std::string& n = table.names[i];
    if (n == name) return i;
    if (n.starts_with(name) &&
        (n.substr(name.size()).starts_with(" [") || n.substr(name.size()).starts_with("_")))
      found = i, ++hits;
  }
  if (hits == 1) return found;
  throw StudyError("'" + where + "': there is no column " + name +
                   "; there are: " + listed(table.names, name) + ". Name one of them");
}

std::vector<double> Channels::column(const std::string& text) {
  if (const std::size_t at = operator_at(text); at != std::string::npos) {
    std::vector<double> left = column(text.substr(0, at));
    const std::vector<double> right = column(text.substr(at + 3));
    if (left.size() != right.size())
      throw StudyError("'" + text + "': the two are not sampled at the same times. " +
                       "Give both databases one interval");
    for (std::size_t i = 0; i < left.size(); ++i)
      left[i] = combine(text[at + 1], left[i], right[i]);
    return left;
  }
  const CsvTable& table = table_of(text).table;
  const auto& values = table.columns[find_column(table, column_of(text), text)];
  if (values.empty()) throw StudyError("'" + text + "': the column is empty. Let the run go on");
  return values;
}

std::vector<double> Channels::abscissa(const std::string& text) {
  const std::size_t at = operator_at(text);
  return at == std::string::npos ? table_of(text).table.columns[0] : abscissa(text.substr(0, at));
}

namespace {

std::string unit_in(const std::string& header) {
  const std::size_t open = header.find('['), close = header.find(']');
  if (open != std::string::npos && close != std::string::npos && open < close)
    return header.substr(open + 1, close - open - 1);
  const std::size_t bar = header.rfind('_');
  return bar == std::string::npos ? "" : header.substr(bar + 1);
}

}  // namespace

std::string Channels::unit(const std::string& text) {
  const CsvTable& table = table_of(text).table;
  return unit_in(table.names[find_column(table, column_of(text), text)]);
}

std::string Channels::abscissa_unit(const std::string& text) {
  return unit_in(table_of(text).table.names[0]);
}

const std::map<std::string, std::string>& Channels::head(const std::string& text) {
  return table_of(text).head;
}

}  // namespace fabrica::study
