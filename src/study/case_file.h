#pragma once
// A case: one folder with case.toml, which says what is computed, what it is compared with and how
// closely. docs/manual/validate.md describes every key.
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fabrica::study {

class Fields;

// A curve of the result that is drawn and, where a reference curve is at hand, rated.
struct SignalSpec {
  std::string name;
  std::string model;   // "database:column" of the result, or "file.csv:column" in the folder
  std::string x;       // what the curve is drawn over; empty: time
  std::string x_name;  // as the page calls it; empty: the column
  std::string unit;    // after scaling, as shown and as the reference must have it
  std::string x_unit;  // likewise of the abscissa
  double scale = 1;    // from the result's unit into `unit`
  double x_scale = 1;
  std::optional<std::pair<double, double>> window;  // of the run's time: what is looked at
  std::optional<double> start_at;   // in `unit`: the abscissa counts from where |y| reaches it
  std::string filter;               // one of cfc_names(), or none
  std::string reference;            // "file.csv:column", or none
  std::string reference_x;          // its abscissa: a column of the same file; empty: the first one
  std::string low, high;            // corridor: columns of files, or none
  std::vector<std::string> rating;  // "cora", "iso18571"
  double weight = 1;                // in the rating of all signals of the case
  std::optional<std::pair<double, double>> interval;  // of time, for the rating
  std::string paper;  // "test/signal" of the published table, or none
  int line = 0;
};

// A number of the result and what it must be.
struct CheckSpec {
  std::string name;
  std::string model;  // as of a signal,
                      // "rating:<signal>:<method>[:part]" or "fit:<name>:<coefficient>"
  std::string over;   // the mean is taken over this, not over time
  std::optional<std::pair<double, double>> window;  // of the run's time: what is looked at
  std::optional<std::pair<double, double>> range;   // of `over`
  std::string filter;                               // one of cfc_names(), or none
  std::string statistic;                            // one of statistic_names()
  std::string energy;  // of "failure": what is stored in the part that breaks
  std::optional<double> expected;
  double tolerance = 0;  // relative to expected, absolute where that is 0
  std::optional<double> least, most;
  int line = 0;
};

// A logistic regression on a table of outcomes: the coefficients can be checked.
struct FitSpec {
  std::string name, data, outcome;
  double at_least = 1;                  // the event: outcome >= at_least
  std::vector<std::string> predictors;  // columns
  std::vector<std::string> require;     // "column >= number": rows kept
  int line = 0;
};

struct PictureSpec {
  std::vector<double> times;  // empty: the last state
  std::string view = "iso", color = "part";
};

struct Case {
  std::string name;  // of the folder
  std::string folder, file;
  std::string title, requirement, source, setup;
  std::string deck;                         // empty: nothing is run
  std::map<std::string, std::string> body;  // a generated body: options of `fabrica body`
  std::string loads;                        // keyword file beside a generated body
  std::string time_unit = "ms";
  double end_time = 0;  // 0: the deck's
  bool allow_unsupported = false;
  std::string walls = "impulse";                  // `fabrica run --walls`
  bool slow = false;                              // runs only when named, or with --slow
  std::map<std::string, std::string> parameters;  // *PARAMETER values
  std::map<std::string, std::string> paths;       // {name} in file names; what the folder must hold
  PictureSpec picture;
  std::vector<SignalSpec> signals;
  std::vector<CheckSpec> checks;
  std::vector<FitSpec> fits;

  bool runs() const { return !deck.empty() || !body.empty(); }
};

// Reads "walls" of a case or a plan.
std::string read_walls(Fields& f);

// Reads FOLDER/case.toml. Throws StudyError with file, line, key and remedy.
Case read_case(const std::string& folder);

// Folders below `root` that hold a case.toml, sorted by name. Throws StudyError where two folders
// have one name.
std::vector<std::string> find_cases(const std::string& root);

// Replaces {name} by what `values` gives for it. Throws StudyError for a name without a value.
std::string expand(const std::string& text, const std::map<std::string, std::string>& values,
                   const std::string& file, int line);

// The first name of `paths` that `text` mentions and `values` lacks; empty if none.
std::string missing_path(const std::string& text, const std::map<std::string, std::string>& paths,
                         const std::map<std::string, std::string>& values);

}  // namespace fabrica::study
