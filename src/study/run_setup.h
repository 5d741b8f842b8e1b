#pragma once
// From a case to a run: the body is made, the main deck written, all files read once.
#include <map>
#include <string>

#include "study/case_file.h"
#include "study/deck_source.h"
#include "study/process.h"

namespace fabrica::study {

struct RunSetup {
  std::string deck;  // what is run
  DeckContent content;
  std::string fingerprint;
};

// Prepares the run of a case in a folder, which is made if missing. A generated body is made again
// only when its options or the program have changed. Throws StudyError.
RunSetup set_up_run(const Case& c, const std::string& folder, const std::string& resolution,
                    const std::map<std::string, std::string>& paths);

// `fabrica run` of it into FOLDER/result, what it prints into FOLDER/run.log.
Command run_command(const Case& c, const std::string& deck, const std::string& folder, int threads);

// FOLDER/run.json: what was run, and how it ended.
struct RunRecord {
  std::string fingerprint, finished;
  int status = -1;  // -1: there is no record
  double seconds = 0;
};
RunRecord read_record(const std::string& folder);
void write_record(const std::string& folder, const RunRecord& record);
// True if the folder holds the finished result of that fingerprint.
bool up_to_date(const std::string& folder, const std::string& fingerprint);
// Takes away what an older or interrupted run left, which must not be taken for a new one's.
void clear_run(const std::string& folder);

// "2031-05-01 12:00 UTC"
std::string time_of_day();

}  // namespace fabrica::study
