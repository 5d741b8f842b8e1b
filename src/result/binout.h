#pragma once
// Time histories in a binout file, laid out as LS-DYNA does:
//   /<db>/metadata/{title, version, revision, date, ids, legend, legend_ids, ...}
//   /<db>/d000001/{time, cycle, <variables>}, d000002, ...
#include <string>
#include <vector>

#include "model/output.h"
#include "result/lsda.h"

namespace fabrica {

class BinoutWriter {
 public:
  // Starts a new file. Throws std::runtime_error if it cannot be written.
  BinoutWriter(const std::string& path, std::string title);
  // Goes on with the file of a run that is restarted at `restart_time`: states at or before it
  // stay, later ones are dropped. Starts a new file if there is none.
  BinoutWriter(const std::string& path, std::string title, double restart_time);

  // Announces a database; returns its number for write(). One that an earlier run began is
  // continued.
  int add(HistoryDatabase database);
  // Appends one state; throws std::runtime_error if the sample does not have the announced shape.
  void write(int database, const HistorySample& sample);
  // Makes all states so far readable, also if the run is killed later; happens by itself every 100
  // states.
  void flush();

 private:
  struct Stream {
    HistoryDatabase database;
    int states = 0;
  };
  void write_metadata(const HistoryDatabase& database);

  std::string title_;
  std::unique_ptr<LsdaWriter> file_;
  std::vector<Stream> streams_;
  std::map<std::string, int> earlier_;  // states of an earlier run by database
  int unflushed_ = 0;
};

// "d000001" for 1; LS-DYNA's six digits grow when they must.
std::string state_name(int number);

// Checks that a sample has the lengths its database announced; throws std::runtime_error naming the
// variable.
void check_shape(const HistoryDatabase& database, const HistorySample& sample);

}  // namespace fabrica
