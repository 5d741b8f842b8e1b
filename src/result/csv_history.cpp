#include "result/csv_history.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "result/binout.h"

namespace fabrica {
namespace {

constexpr double from_the_start = -std::numeric_limits<double>::infinity();

// The header and the lines with time <= end of an earlier run; empty if there is no file.
std::string kept_lines(const std::string& path, double end) {
  std::ifstream in(path);
  std::string line, kept;
  for (bool header = true; std::getline(in, line); header = false)
    if (header || std::strtod(line.c_str(), nullptr) <= end) kept += line + "\n";
  return kept;
}

std::string trimmed(std::string s) {
  const char* blanks = " \t\r\"";
  s.erase(0, std::min(s.find_first_not_of(blanks), s.size()));
  s.erase(s.find_last_not_of(blanks) + 1);
  return s;
}

std::vector<std::string> cells(const std::string& line) {
  const char separator = line.find(';') != std::string::npos ? ';' : ',';
  std::vector<std::string> out;
  for (std::size_t i = 0; i <= line.size();) {
    const std::size_t end = std::min(line.find(separator, i), line.size());
    out.push_back(trimmed(line.substr(i, end - i)));
    i = end + 1;
  }
  return out;
}

}  // namespace

std::vector<std::string> column_names(const HistoryDatabase& d) {
  std::vector<std::string> out;
  const int ids = int(d.ids.size());
  for (const HistoryVariable& v : d.variables) {
    const int each = ids > 0 && v.length % ids == 0 ? v.length / ids : 0;  // values per entity
    for (int i = 0; i < v.length; ++i) {
      if (each == 1)
        out.push_back(fmt::format("{}:{}", v.name, d.ids[i]));
      else if (each > 1)
        out.push_back(fmt::format("{}:{}.{}", v.name, d.ids[i / each], i % each + 1));
      else
        out.push_back(v.length == 1 ? v.name : fmt::format("{}:{}", v.name, i + 1));
    }
  }
  return out;
}

std::string csv_name(const std::string& database) {
  std::string name = database;
  for (char& c : name)
    if (c == '/') c = '_';
  return name + ".csv";
}

CsvHistoryWriter::CsvHistoryWriter(const std::string& directory)
    : CsvHistoryWriter(directory, from_the_start) {}

CsvHistoryWriter::CsvHistoryWriter(const std::string& directory, double restart_time)
    : directory_(directory), restart_time_(restart_time) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw std::runtime_error("cannot make " + directory + ": " + error.message());
}

int CsvHistoryWriter::add(HistoryDatabase database) {
  const std::string path = directory_ + "/" + csv_name(database.path);
  const bool restarted = restart_time_ != from_the_start;
  const std::string kept = restarted ? kept_lines(path, restart_time_) : "";
  Stream s{std::move(database), {std::fopen(path.c_str(), "w"), std::fclose}};
  if (!s.file) throw std::runtime_error("cannot write " + path);
  if (!kept.empty()) {
    std::fputs(kept.c_str(), s.file.get());
  } else {
    std::string header = "time,cycle";
    for (const std::string& name : column_names(s.database)) header += "," + name;
    std::fputs((header + "\n").c_str(), s.file.get());
  }
  streams_.push_back(std::move(s));
  return int(streams_.size()) - 1;
}

void CsvHistoryWriter::write(int database, const HistorySample& sample) {
  Stream& s = streams_.at(database);
  check_shape(s.database, sample);
  // nine digits of a value carry any single-precision number; time is given in full
  std::string line = fmt::format("{},{}", sample.time, sample.cycle);
  for (const auto& values : sample.values)
    for (const double v : values) line += fmt::format(",{:.9g}", v);
  line += '\n';
  if (std::fputs(line.c_str(), s.file.get()) < 0)
    throw std::runtime_error("cannot write " + csv_name(s.database.path) + ": disk full?");
}

void CsvHistoryWriter::flush() {
  for (Stream& s : streams_) std::fflush(s.file.get());
}

CsvTable read_csv(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot open " + path);
  CsvTable table;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (trimmed(line).empty() || line[0] == '#') continue;
    const std::vector<std::string> row = cells(line);
    if (table.names.empty()) {
      table.names = row;
      table.columns.resize(row.size());
      continue;
    }
    if (row.size() != table.names.size())
      throw std::runtime_error(fmt::format("{}:{}: {} cells, the header has {}", path, number,
                                           row.size(), table.names.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      char* end = nullptr;
      const double v = std::strtod(row[i].c_str(), &end);
      if (*end != '\0')
        throw std::runtime_error(fmt::format("{}:{}: '{}' is not a number", path, number, row[i]));
      table.columns[i].push_back(row[i].empty() ? std::numeric_limits<double>::quiet_NaN() : v);
    }
  }
  return table;
}

}  // namespace fabrica
