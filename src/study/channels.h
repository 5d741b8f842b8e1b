#pragma once
// Columns of the csv histories of a run and of csv files beside a case, each file read once.
#include <map>
#include <string>
#include <vector>

#include "result/csv_history.h"

namespace fabrica::study {

// A csv file with the comment lines at its head: "# provenance: digitised" gives
// head["provenance"].
struct SourcedTable {
  CsvTable table;
  std::map<std::string, std::string> head;
};
SourcedTable read_sourced_csv(const std::string& path);

struct Curve {
  std::vector<double> x, y;
};

class Channels {
 public:
  // `histories` holds one csv file per database, over time in `time_unit` (ms, s); `folder` the
  // files that a case names
  Channels(std::string histories, std::string folder, std::string time_unit)
      : histories_(std::move(histories)),
        folder_(std::move(folder)),
        time_unit_(std::move(time_unit)) {}

  const std::string& time_unit() const { return time_unit_; }

  // Values of "database:column" or "file.csv:column", or of such joined by " + ", " - " and " / "
  // (which binds more). Throws StudyError naming what is missing and what there is instead.
  std::vector<double> column(const std::string& text);
  // The first column of the table that `text` names: time in histories.
  std::vector<double> abscissa(const std::string& text);
  // The unit in the brackets of a header, "force [kN]" or "force_kN", empty if there is none.
  std::string unit(const std::string& text);
  // The unit of the first column of the table that `text` names.
  std::string abscissa_unit(const std::string& text);
  // The comment lines of the file that `text` names.
  const std::map<std::string, std::string>& head(const std::string& text);
  // the column that is meant: equal, or the only one that is `name` followed by a unit
  static std::size_t find_column(const CsvTable& table, const std::string& name,
                                 const std::string& where);

 private:
  const SourcedTable& table_of(const std::string& text);
  std::string path_of(const std::string& text) const;

  std::string histories_, folder_, time_unit_;
  std::map<std::string, SourcedTable> tables_;
};

// the part of "database:column" or "file.csv:column" behind the first colon after the file
std::string column_of(const std::string& text);
std::string table_name_of(const std::string& text);

}  // namespace fabrica::study
