// Regular keywords: cards by schema.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "deck/context.h"
#include "deck/number.h"
#include "model/condition.h"

namespace fabrica {
namespace {

std::string number_text(double v) {
  char buffer[32];
  const auto [p, e] = std::to_chars(buffer, buffer + sizeof buffer, v);
  return std::string(buffer, p);
}

// columns of a card in the block's format, and the column before which a comma makes it free
struct Places {
  std::vector<FieldPlace> fields;
  int comma_limit = 1 << 30;
};

Places places_of(const CardSchema& card, Format format) {
  Places places;
  int at = 0, end = 0;
  for (std::size_t i = 0; i < card.fields.size(); ++i) {
    const FieldSchema& f = card.fields[i];
    // in long format gaps double with the fields
    at += format.long_fields ? 2 * (f.column - end) : f.column - end;
    end = f.column + f.width;
    int width = format.long_fields && f.width < 20 ? 20 : f.width;
    if (f.type == FieldType::text) {
      places.comma_limit = std::min(places.comma_limit, f.width >= 40 ? at : at + width);
      // a last text reaches to the end of the line
      if (i + 1 == card.fields.size() && f.width >= 40) width = 4096;
    }
    places.fields.push_back({at, width});
    at += width;
  }
  return places;
}

class CardReader {
 public:
  CardReader(Context& context, Block& block, const KeywordSchema& schema,
             const std::vector<std::string>& options)
      : context_(context), block_(block), schema_(schema), options_(options) {
    quiet_ = schema.support != Support::full;
    for (const CardSchema& c : schema.cards) {
      places_.push_back(places_of(c, block.format));
      if (c.condition.find("option(TITLE)") != std::string::npos) own_title_ = true;
    }
  }

  void read() {
    do {
      Card card(schema_);
      card.options = options_;
      card.where = block_.where;
      const bool complete = read_group(card);
      const Placement& p = block_.placement;
      if (!p.none()) put(p, card);
      if (complete) keep(std::move(card));
      if (!complete) return block_.skip();
    } while (schema_.repeats_whole && !schema_.cards.empty() && !block_.only_blank_left());
    surplus_lines();
  }

 private:
  void keep(Card card) {
    if (schema_.name == "DEFINE_TRANSFORMATION") {
      std::string problem;
      const auto map = affine_of(card, problem);
      if (map)
        context_.transformations[card.id("tranid")] = *map;
      else
        context_.report(Severity::unsupported, "bad-transformation", card.where, block_.keyword,
                        "option", problem, "Use TRANSL, ROTATE, SCALE, MIRROR and POINT");
    }
    context_.curve_units.add(context_.builder.add_card(std::move(card)), block_.placement);
  }

  void put(const Placement& p, Card& card) {
    if (!place_functions(p, card))
      context_.error(
          "unit-not-converted", card.where, block_.keyword, "function",
          "a unit factor of *INCLUDE_TRANSFORM reaches a function, whose units are not known",
          "Convert the included file to the units of the deck");
    place(p, card, [&](const FieldSchema& f, const std::string& what) {
      if (!quiet_)
        context_.error("unit-not-converted", card.where_of_row(0), block_.keyword, f.name,
                       "a unit factor of *INCLUDE_TRANSFORM reaches this field, but " + what,
                       "Convert the included file to the units of the deck");
    });
    if (!move_geometry(p, card) && !quiet_)
      context_.error("transform-unsupported", card.where, block_.keyword, "",
                     "the points of this keyword are not moved by a transformation",
                     "Move the keyword out of the transformed file");
  }

  // one group of cards; false if it ended too early
  bool read_group(Card& card) {
    const auto has = [&](const char* o) {
      return std::find(options_.begin(), options_.end(), o) != options_.end();
    };
    if (has("TITLE") && !own_title_) {
      if (!block_.next()) return truncated("the title line");
      card.title = trimmed(block_.line());
    }
    std::size_t index = 0, line = 0;
    bool table_read = false;
    for (std::size_t i = 0; i < schema_.cards.size(); ++i) {
      const CardSchema& c = schema_.cards[i];
      if (c.repeats) {
        if (!table_read && applies(c, card)) read_table(card);
        table_read = table_read || applies(c, card);
        continue;
      }
      const std::size_t first = index, at = line++;
      index += c.fields.size();
      if (!applies(c, card)) continue;
      if (!block_.next()) {
        if (c.optional) continue;
        return truncated(c.fields.empty() ? "a line of text"
                                          : "the line that starts with " + c.fields[0].name);
      }
      if (!c.fields.empty() && c.fields[0].name == "ampersand" && !block_.line().starts_with('&')) {
        block_.again();
        continue;
      }
      card.card_lines[at] = block_.lines.number;
      if (c.title)
        card.title = trimmed(block_.line());
      else
        read_fields(card, i, first);
    }
    return true;
  }

  bool applies(const CardSchema& c, const Card& card) {
    if (c.condition.empty()) return true;
    try {
      return evaluate_condition(c.condition, card) != 0;
    } catch (const std::exception& e) {
      context_.error("bad-schema", block_.where, block_.keyword, "", e.what(),
                     "Report this keyword to the developers");
      return false;
    }
  }

  bool truncated(const std::string& what) {
    if (!quiet_)
      context_.error("truncated-card", block_.here(), block_.keyword, "",
                     "the block ends before " + what, "Give all lines of the keyword");
    return false;
  }

  void read_fields(Card& card, std::size_t which, std::size_t first) {
    const CardSchema& c = schema_.cards[which];
    cut_fields(block_.line(), places_[which].fields, places_[which].comma_limit, texts_);
    for (std::size_t i = 0; i < c.fields.size(); ++i) {
      double value = c.fields[i].default_value;
      std::string text;
      bool given = false;
      convert(c.fields[i], texts_.text[i], value, text, given);
      card.values[first + i] = value;
      card.values_given[first + i] = given;
      card.texts[first + i] = std::move(text);
    }
    surplus_text();
  }

  // all rows of the repeating cards that apply; columns of the others stay blank
  void read_table(Card& card) {
    std::vector<std::size_t> active;
    bool any_text = false;
    for (std::size_t i = 0; i < schema_.cards.size(); ++i) {
      const CardSchema& c = schema_.cards[i];
      if (!c.repeats) continue;
      if (applies(c, card)) active.push_back(i);
      for (const FieldSchema& f : c.fields) any_text = any_text || f.type == FieldType::text;
    }
    while (block_.next()) {
      if (trimmed(block_.line()).empty() && !is_text_row(active)) continue;
      add_row(card, active, any_text);
    }
  }

  bool is_text_row(const std::vector<std::size_t>& active) const {
    const auto& fields = schema_.cards[active[0]].fields;
    return fields.size() == 1 && fields[0].type == FieldType::text;
  }

  void add_row(Card& card, const std::vector<std::size_t>& active, bool any_text) {
    const std::size_t start = card.table_.size();
    for (const CardSchema& c : schema_.cards)
      if (c.repeats)
        for (const FieldSchema& f : c.fields) card.table_.push_back(f.default_value);
    card.table_given_.resize(card.table_.size(), 0);
    if (any_text) card.table_texts_.resize(card.table_.size());
    card.row_lines.push_back(block_.lines.number);
    std::size_t cell = start;
    for (std::size_t i = 0; i < schema_.cards.size(); ++i) {
      const CardSchema& c = schema_.cards[i];
      if (!c.repeats) continue;
      const auto found = std::find(active.begin(), active.end(), i);
      if (found != active.end() && (found == active.begin() || block_.next())) {
        cut_fields(block_.line(), places_[i].fields, places_[i].comma_limit, texts_);
        for (std::size_t k = 0; k < c.fields.size(); ++k) {
          std::string text;
          bool given = false;
          convert(c.fields[k], texts_.text[k], card.table_[cell + k], text, given);
          card.table_given_[cell + k] = given;
          if (any_text) card.table_texts_[cell + k] = std::move(text);
        }
        surplus_text();
      }
      cell += c.fields.size();
    }
  }

  // the value of a field, checked against its schema; value keeps the default if the field is blank
  void convert(const FieldSchema& f, std::string_view source, double& value, std::string& text,
               bool& given) {
    if (f.type == FieldType::text) {
      text = f.name == "function" ? with_parameters(source) : std::string(source);
      if (source.size() > 1 && source[0] == '&' && f.width <= 20)
        if (const auto* p = context_.parameters.find(source.substr(1)))
          if (const auto* words = std::get_if<std::string>(p)) text = *words;
      given = !text.empty();
    } else {
      double number = 0;
      if (quiet_) {
        const auto r = source.empty() ? std::nullopt : parse_real(source);
        given = r.has_value();
        number = r.value_or(0);
      } else if (!context_.number(block_, block_.here(), f.name, source,
                                  f.type == FieldType::integer, number, given)) {
        given = false;
        return;
      }
      // fixed columns cannot tell zero from blank
      if (given && number == 0 && f.default_value != 0) given = false;
      if (given) value = number;
    }
    if (!quiet_) check(f, value, text, given);
  }

  // A line of a function with the values of its &names.
  std::string with_parameters(std::string_view source) const {
    std::string out;
    while (!source.empty()) {
      const std::size_t mark = std::min(source.find('&'), source.size());
      const bool operation = source.substr(mark).starts_with("&&");
      std::size_t end = std::min(mark + (operation ? 2 : 1), source.size());
      while (!operation && end < source.size() &&
             (std::isalnum(static_cast<unsigned char>(source[end])) || source[end] == '_'))
        ++end;
      out += source.substr(0, mark);
      const auto* p = end > mark + 1
                          ? context_.parameters.find(source.substr(mark + 1, end - mark - 1))
                          : nullptr;
      if (p && !std::holds_alternative<std::string>(*p))
        out += '(' + number_text(as_real(*p)) + ')';
      else
        out += source.substr(mark, end - mark);
      source.remove_prefix(end);
    }
    return out;
  }

  void check(const FieldSchema& f, double value, const std::string& text, bool given) {
    if (!given) {
      if (f.required || (f.exclusive_minimum && f.default_value <= f.minimum))
        context_.error("missing-field", block_.here(), block_.keyword, f.name,
                       "a value is required",
                       "Give the field; it starts in column " + std::to_string(f.column + 1));
      return;
    }
    if (f.type != FieldType::text) {
      const bool low = f.exclusive_minimum ? value <= f.minimum : value < f.minimum;
      if (low || value > f.maximum) {
        std::string range = f.exclusive_minimum        ? "above " + number_text(f.minimum)
                            : std::isfinite(f.minimum) ? "from " + number_text(f.minimum)
                                                       : std::string();
        if (std::isfinite(f.maximum))
          range += (range.empty() ? "up to " : " up to ") + number_text(f.maximum);
        context_.error("value-out-of-range", block_.here(), block_.keyword, f.name,
                       number_text(value) + " is outside the range, expected a value " + range,
                       "Correct the value");
      }
    }
    if (f.support == Support::full) return;
    if (f.type != FieldType::text && (value == f.default_value || is_supported(f, value))) return;
    const bool ignored = f.support == Support::ignored;
    context_.report(
        ignored ? Severity::ignored : Severity::unsupported,
        ignored ? "ignored-field" : "unsupported-field", block_.here(), block_.keyword, f.name,
        (f.type == FieldType::text ? text : number_text(value)) +
            (ignored ? " has no effect here" : " asks for something that is not computed"),
        ignored ? "" : "Leave the field at its default");
  }

  static bool is_supported(const FieldSchema& f, double value) {
    std::string_view list = f.supported_values;
    while (!list.empty()) {
      const std::size_t end = std::min(list.find(' '), list.size());
      double v = 0;
      const auto [p, e] = std::from_chars(list.data(), list.data() + end, v);
      if (e == std::errc() && v == value) return true;
      list.remove_prefix(std::min(end + 1, list.size()));
    }
    return false;
  }

  // text behind the last known field, unless it is zero
  void surplus_text() {
    if (quiet_ || texts_.surplus.empty()) return;
    if (texts_.surplus.find_first_not_of("0., \t") == std::string_view::npos) return;
    context_.report(
        Severity::warning, "surplus-field", block_.here(), block_.keyword, "",
        "\"" + std::string(texts_.surplus.substr(0, 40)) + "\" stands behind the last known field",
        "Remove it, or check the columns");
  }

  void surplus_lines() {
    while (block_.next()) {
      const std::string_view text = trimmed(block_.line());
      if (quiet_ || text.find_first_not_of("0., \t") == std::string_view::npos) continue;
      context_.report(
          Severity::unsupported, "surplus-line", block_.here(), block_.keyword, "",
          "a line follows the last known card: \"" + std::string(text.substr(0, 40)) + "\"",
          "Remove it if it only holds defaults");
    }
  }

  Context& context_;
  Block& block_;
  const KeywordSchema& schema_;
  const std::vector<std::string>& options_;
  std::vector<Places> places_;
  FieldTexts texts_;
  bool quiet_ =
      false;  // the keyword is ignored or unsupported as a whole: its fields are not judged
  bool own_title_ = false;  // the schema says itself where the title stands
};

}  // namespace

void read_cards(Context& context, Block& block, const KeywordSchema& schema,
                const std::vector<std::string>& options) {
  if (schema.support != Support::full) {
    const bool ignored = schema.support == Support::ignored;
    context.report(ignored ? Severity::ignored : Severity::unsupported,
                   ignored ? "ignored-keyword" : "unsupported-keyword", block.where, block.keyword,
                   "",
                   schema.reason.empty() ? "the keyword is known but not computed" : schema.reason,
                   ignored ? "" : "Remove the keyword if the run can do without it");
    if (schema.cards.empty()) return block.skip();
  }
  CardReader(context, block, schema, options).read();
}

}  // namespace fabrica
