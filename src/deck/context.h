#pragma once
// What the parts of the reader share: the model under construction, parameters, transformations,
// and the block of lines below one keyword.
#include <array>
#include <map>
#include <string>
#include <vector>

#include "deck/curve_units.h"
#include "deck/parameter.h"
#include "deck/placement.h"
#include "deck/reader.h"
#include "deck/text.h"

namespace fabrica {

// width of fields: 10 (and what the keyword says), 20 in long format, 10 for ids of bulk keywords
// with I10
struct Format {
  bool long_fields = false;
  bool wide_ids = false;
};

struct FieldPlace {
  int column, width;
};

// the fields of one line, as text without blanks around it
struct FieldTexts {
  std::vector<std::string_view> text;
  bool free = false;         // separated by commas
  std::string_view surplus;  // what stands behind the last field
};

// Cuts a line at columns, or at commas if one stands before column `comma_limit`.
void cut_fields(std::string_view line, const std::vector<FieldPlace>& places, int comma_limit,
                FieldTexts& out);

// One keyword and the data lines below it.
struct Block {
  std::string keyword;  // upper case, without star and format sign
  Location where;
  Format format;
  const Placement& placement;
  Lines& lines;
  bool repeated = false;  // the current line is to be read again
  bool long_line = false;
  std::string expanded;

  // moves to the next data line; false at the end of the block
  bool next();
  void again() { repeated = true; }
  std::string_view line() const { return long_line ? std::string_view(expanded) : lines.line; }
  Location here() const { return {where.file, lines.number}; }
  // true if no line with text is left
  bool only_blank_left() const;
  void skip();
};

class Context {
 public:
  Context(Builder& b, Diagnostics& d, const ReadOptions& o)
      : builder(b), diagnostics(d), options(o) {}
  Builder& builder;
  Diagnostics& diagnostics;
  const ReadOptions& options;
  ParameterTable parameters;
  std::map<std::int64_t, Affine> transformations;
  CurveUnits curve_units;
  int keywords = 0;

  // Reports a problem; the 200th of the same name, keyword and field is the last that is
  // listed singly, the others are counted.
  void report(Severity severity, const std::string& name, Location where,
              const std::string& keyword, const std::string& field, std::string message,
              std::string remedy);
  void error(const std::string& name, Location where, const std::string& keyword,
             const std::string& field, std::string message, std::string remedy) {
    report(Severity::error, name, where, keyword, field, std::move(message), std::move(remedy));
  }
  void summarise_rest();

  // Converts the text of a field; parameters are replaced. Blank gives given = false. False, after
  // a report, if the text is no number.
  bool number(const Block& block, Location where, const std::string& field, std::string_view text,
              bool integer, double& value, bool& given);

 private:
  bool parameter(const Block& block, Location where, const std::string& field,
                 std::string_view text, bool integer, double& value);
  struct Tally {
    Severity severity;
    Location last;
    int count = 0;
  };
  std::map<std::array<std::string, 3>, Tally> tallies_;  // by name, keyword and field
};

// Reads *NODE and *ELEMENT_* straight into the model's arrays; false if the keyword is none of
// them.
bool read_bulk(Context& context, Block& block);

// Reads the block of a regular keyword by its schema and adds its cards to the model.
void read_cards(Context& context, Block& block, const KeywordSchema& schema,
                const std::vector<std::string>& options);

// Reads *PARAMETER and its relatives; false if the keyword is none of them.
bool read_parameters(Context& context, Block& block);

}  // namespace fabrica
