#pragma once
// The tables of data/ as part of the program, and a table read from the text of a csv file. Lines
// that start with # are comments, the first other line names the columns, cells may stand in double
// quotes.
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "body/error.h"

namespace fabrica::body {

struct DataFile {
  std::string_view path;  // relative to data/, e.g. "anatomy/bones/index.csv"
  std::string_view text;
};

// all files of data/, sorted by path (made by cmake/embed_data.cmake)
const std::vector<DataFile>& embedded_data_files();

bool has_data_file(std::string_view path);
// the text of a file; throws BodyError when there is none
std::string_view data_file(std::string_view path);

class Table {
 public:
  // of an embedded file; throws BodyError naming file and line when a row has not as many cells as
  // the header
  explicit Table(std::string_view path);
  // of a text, `path` names it in messages
  Table(std::string_view path, std::string_view text);

  int rows() const { return int(lines_.size()); }
  const std::vector<std::string>& columns() const { return columns_; }
  bool has_column(std::string_view column) const;
  // a cell; throws BodyError naming file, line and column when there is no such column
  const std::string& text(int row, std::string_view column) const;
  // a cell as a number; throws BodyError when it is none
  double number(int row, std::string_view column) const;
  // where a row stands in its file, from 1
  int line(int row) const { return lines_[std::size_t(row)]; }
  // "path:line: message" as an error
  [[noreturn]] void fail(int row, const std::string& message) const;

 private:
  int column_index(int row, std::string_view column) const;

  std::string path_;
  std::vector<std::string> columns_;
  std::map<std::string, int, std::less<>> index_;
  std::vector<std::vector<std::string>> cells_;
  std::vector<int> lines_;
};

}  // namespace fabrica::body
