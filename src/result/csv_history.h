#pragma once
// Time histories as text: one file <directory>/<db>.csv per database ("elout/shell" ->
// elout_shell.csv), one line per state. The header names variable and entity:
// "time,cycle,x_displacement:605,...". A variable with several values per entity is numbered within
// it: "sig_xx:605.2"; one that has nothing to do with the ids is numbered.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "model/output.h"

namespace fabrica {

class CsvHistoryWriter {
 public:
  // Files are created by add(). Throws std::runtime_error if the directory cannot be made.
  explicit CsvHistoryWriter(const std::string& directory);
  // Goes on after a restart: lines later than `restart_time` are dropped.
  CsvHistoryWriter(const std::string& directory, double restart_time);

  int add(HistoryDatabase database);
  void write(int database, const HistorySample& sample);
  void flush();

 private:
  struct Stream {
    HistoryDatabase database;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file;
  };
  std::string directory_;
  double restart_time_;
  std::vector<Stream> streams_;
};

// Column names of a database without "time" and "cycle", in the order of the values.
std::vector<std::string> column_names(const HistoryDatabase& database);

// "elout_shell.csv" for "elout/shell".
std::string csv_name(const std::string& database);

// A table of numbers with a header line; separators ',' or ';', lines that start with '#' are
// skipped, empty cells are NaN. Throws std::runtime_error naming file and line if a cell is not a
// number.
struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
};
CsvTable read_csv(const std::string& path);

}  // namespace fabrica
