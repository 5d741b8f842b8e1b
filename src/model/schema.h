#pragma once
// The vocabulary of the keyword format, read from the .kw files that are compiled into the program.
// Reader, writer, checks and manual pages all come from these tables.
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace fabrica {

enum class FieldType { integer, real, text };

// what this program does with a keyword or a field that is given
enum class Support {
  full,         // acts on it
  ignored,      // cannot change the physics; reported, then passed over
  unsupported,  // would change the physics; an error for `run`, listed by `check`
};

struct FieldSchema {
  std::string name;  // lower case, as in the manual: "sigy"
  FieldType type = FieldType::real;
  int column = 0;  // first character in fixed format, from 0
  int width = 10;
  double default_value = 0;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool exclusive_minimum = false;  // value must be greater than minimum
  bool required = false;
  std::string reference;  // kind of entity that a non-zero value must name: node, part, section,
                          // material, curve, table, hourglass, node_set, part_set, segment_set,
                          // box, coordinate_system, ...
  Support support = Support::full;  // of a value that is neither blank nor the default
  std::string
      supported_values;  // "0 1": integer values that are supported although support is not full
  std::string unit;      // "stress", "mass/length^3", ...
  std::string help;
};

struct CardSchema {
  std::vector<FieldSchema> fields;
  std::string
      condition;  // expression over earlier fields and options, e.g. "n == 0"; empty: always there
  bool optional = false;  // may be missing at the end of the block
  bool repeats = false;   // repeats to the end of the block: its rows form the card's table
  bool title = false;     // one 80-column text line
};

struct KeywordSchema {
  std::string name;                  // canonical: "MAT_PLASTIC_KINEMATIC"
  std::vector<std::string> aliases;  // "MAT_003"
  std::vector<std::string> options;  // suffixes that may follow: "TITLE", "ID", "MPP"
  std::string summary;
  std::string category;  // for the manual: "material", "contact", ...
  Support support = Support::full;
  std::string reason;  // why ignored or unsupported
  bool repeats_whole =
      false;  // the whole card group may occur again in one block (PART, SECTION_*)
  std::vector<CardSchema> cards;
};

// The schema of all keywords, from the embedded .kw texts. Only their names are indexed at the
// start; a keyword is read when it is first asked for. Safe to ask from several threads.
class Vocabulary {
 public:
  static const Vocabulary& get();
  // Finds the schema for a keyword as it stands in a deck
  // ("MAT_PIECEWISE_LINEAR_PLASTICITY_TITLE"), resolving aliases; options receives the suffixes
  // found. Null if unknown.
  const KeywordSchema* find(std::string_view keyword, std::vector<std::string>& options) const;
  const KeywordSchema* find(std::string_view canonical) const;
  // known names near a misspelt one, best first
  std::vector<std::string> suggest(std::string_view keyword, int count = 3) const;
  const std::vector<KeywordSchema>& all() const;
  // A vocabulary of its own from .kw text, which must outlive it; for tests.
  explicit Vocabulary(std::string_view text);
  ~Vocabulary();
  // what is wrong with the .kw texts, "line N: ..."; empty in a sound build
  const std::vector<std::string>& problems() const;

 private:
  struct Content;
  Vocabulary();
  void index();
  int canonical(std::string_view name) const;
  const KeywordSchema& schema(int i) const;
  std::unique_ptr<Content> content_;
};

}  // namespace fabrica
