#pragma once
// One keyword with its values: what the reader fills, the writer writes back and the model is built
// from. Bulk keywords (*NODE, *ELEMENT_*) do not become cards; they go straight into the model's
// arrays.
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "model/schema.h"

namespace fabrica {

// The whole part of a value, held within what the type can count.
inline std::int64_t to_id(double value) { return std::int64_t(std::clamp(value, -9e15, 9e15)); }
inline int to_int(double value) { return int(std::clamp(value, -2147483647.0, 2147483647.0)); }

class Card {
 public:
  Card() = default;
  // An empty card of a keyword; every field blank. Throws std::invalid_argument for an unknown
  // name.
  explicit Card(std::string_view keyword);
  // An empty card of a schema, for the reader.
  explicit Card(const KeywordSchema& keyword) : schema(&keyword) { prepare(); }

  const KeywordSchema* schema = nullptr;
  std::vector<std::string> options;  // "TITLE", "ID", "MPP" as found
  std::string title;                 // of _TITLE or _ID, or the heading of *PART
  Location where;

  // Value of a field of the non-repeating cards: what was given, else the schema's default.
  // Throws std::out_of_range for a name the schema does not have.
  double real(std::string_view field) const;
  int integer(std::string_view field) const { return to_int(real(field)); }
  std::int64_t id(std::string_view field) const { return to_id(real(field)); }
  std::string_view text(std::string_view field) const;
  bool given(std::string_view field) const;
  bool has_field(std::string_view field) const;
  bool has_option(std::string_view option) const;
  // line of the physical card that holds the field
  Location where_of(std::string_view field) const;

  Card& set(std::string_view field, double value);
  Card& set(std::string_view field, std::string_view text);

  // the repeating card: rows x columns; blank cells hold the default
  int row_count() const { return columns_ == 0 ? 0 : int(table_.size()) / columns_; }
  int columns() const { return columns_; }
  double row(int i, int column) const { return table_[std::size_t(i) * columns_ + column]; }
  double row(int i, std::string_view field) const;
  bool row_given(int i, int column) const {
    return table_given_[std::size_t(i) * columns_ + column] != 0;
  }
  std::string_view row_text(int i, int column) const;
  Location where_of_row(int i) const;
  Card& add_row(const std::vector<double>& values);
  // adds a row in which cell `column` is a text (SET_*_GENERAL options)
  Card& add_row(std::string_view text, const std::vector<double>& values);
  // every value of the repeating rows that is not blank or zero, in order: the ids of a set
  std::vector<std::int64_t> row_ids() const;

  // storage, filled by the reader
  std::vector<double> values;  // one per field of the non-repeating cards, in schema order
  std::vector<std::uint8_t> values_given;  // same length
  std::vector<std::string> texts;          // same length; only text fields are non-empty
  std::vector<int> card_lines;  // line of each non-repeating card of the schema (0: not present)
  std::vector<double> table_;
  std::vector<std::uint8_t> table_given_;
  std::vector<std::string> table_texts_;  // empty, or one per cell
  std::vector<int> row_lines;
  int columns_ = 0;

 private:
  void prepare();
  int index_of(std::string_view field) const;
};

}  // namespace fabrica
