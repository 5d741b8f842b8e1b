#include "model/card.h"

#include <algorithm>
#include <stdexcept>

namespace fabrica {
namespace {

// column of a field in the table of repeating cards, or -1
int table_column(const KeywordSchema& schema, std::string_view field) {
  int column = 0;
  for (const CardSchema& c : schema.cards)
    if (c.repeats)
      for (const FieldSchema& f : c.fields) {
        if (f.name == field) return column;
        ++column;
      }
  return -1;
}

std::vector<const FieldSchema*> table_fields(const KeywordSchema& schema) {
  std::vector<const FieldSchema*> fields;
  for (const CardSchema& c : schema.cards)
    if (c.repeats)
      for (const FieldSchema& f : c.fields) fields.push_back(&f);
  return fields;
}

}  // namespace

Card::Card(std::string_view keyword) {
  std::vector<std::string> found;
  schema = Vocabulary::get().find(keyword, found);
  if (!schema) throw std::invalid_argument("unknown keyword " + std::string(keyword));
  options = std::move(found);
  prepare();
}

void Card::prepare() {
  for (const CardSchema& c : schema->cards) {
    if (c.repeats) {
      columns_ += int(c.fields.size());
      continue;
    }
    card_lines.push_back(0);
    for (const FieldSchema& f : c.fields) values.push_back(f.default_value);
  }
  values_given.assign(values.size(), 0);
  texts.resize(values.size());
}

int Card::index_of(std::string_view field) const {
  int i = 0;
  if (schema)
    for (const CardSchema& c : schema->cards)
      if (!c.repeats)
        for (const FieldSchema& f : c.fields) {
          if (f.name == field) return i;
          ++i;
        }
  throw std::out_of_range((schema ? schema->name : std::string("empty card")) + " has no field " +
                          std::string(field));
}

double Card::real(std::string_view field) const { return values[index_of(field)]; }
std::string_view Card::text(std::string_view field) const { return texts[index_of(field)]; }
bool Card::given(std::string_view field) const { return values_given[index_of(field)] != 0; }

bool Card::has_field(std::string_view field) const {
  if (!schema) return false;
  for (const CardSchema& c : schema->cards)
    if (!c.repeats)
      for (const FieldSchema& f : c.fields)
        if (f.name == field) return true;
  return false;
}

bool Card::has_option(std::string_view option) const {
  return std::find(options.begin(), options.end(), option) != options.end();
}

Location Card::where_of(std::string_view field) const {
  std::size_t line = 0;
  for (const CardSchema& c : schema->cards) {
    if (c.repeats) continue;
    for (const FieldSchema& f : c.fields)
      if (f.name == field)
        return {where.file,
                line < card_lines.size() && card_lines[line] > 0 ? card_lines[line] : where.line};
    ++line;
  }
  return where;
}

Card& Card::set(std::string_view field, double value) {
  const int i = index_of(field);
  values[i] = value;
  values_given[i] = 1;
  return *this;
}

Card& Card::set(std::string_view field, std::string_view text) {
  const int i = index_of(field);
  texts[i] = text;
  values_given[i] = !text.empty();
  return *this;
}

double Card::row(int i, std::string_view field) const {
  const int column = table_column(*schema, field);
  if (column < 0) throw std::out_of_range(schema->name + " has no column " + std::string(field));
  return row(i, column);
}

std::string_view Card::row_text(int i, int column) const {
  const std::size_t cell = std::size_t(i) * columns_ + column;
  return cell < table_texts_.size() ? std::string_view(table_texts_[cell]) : std::string_view{};
}

Location Card::where_of_row(int i) const {
  return {where.file, i < int(row_lines.size()) ? row_lines[i] : where.line};
}

Card& Card::add_row(const std::vector<double>& row_values) {
  const auto fields = table_fields(*schema);
  if (row_values.size() > fields.size()) throw std::out_of_range(schema->name + ": row too long");
  for (std::size_t i = 0; i < fields.size(); ++i) {
    table_.push_back(i < row_values.size() ? row_values[i] : fields[i]->default_value);
    table_given_.push_back(i < row_values.size());
  }
  if (!table_texts_.empty()) table_texts_.resize(table_.size());
  row_lines.push_back(where.line);
  return *this;
}

Card& Card::add_row(std::string_view text, const std::vector<double>& row_values) {
  const auto fields = table_fields(*schema);
  std::size_t column = 0;
  while (column < fields.size() && fields[column]->type != FieldType::text) ++column;
  if (column == fields.size()) throw std::out_of_range(schema->name + ": no text column");
  std::vector<double> all = row_values;
  all.insert(all.begin() + std::ptrdiff_t(std::min(column, all.size())), 0.0);
  add_row(all);
  table_texts_.resize(table_.size());
  table_texts_[table_.size() - std::size_t(columns_) + column] = text;
  return *this;
}

std::vector<std::int64_t> Card::row_ids() const {
  std::vector<std::int64_t> ids;
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (table_given_[i] && table_[i] != 0) ids.push_back(to_id(table_[i]));
  return ids;
}

}  // namespace fabrica
