#include "deck/writer.h"

#include <charconv>
#include <cmath>
#include <string>

#include "model/condition.h"

namespace fabrica {
namespace {

// shortest decimal form that reads back to the same double
std::string shortest(double v) {
  char buffer[40];
  if (v == std::floor(v) && std::abs(v) < 1e15) {
    const auto [p, e] = std::to_chars(buffer, buffer + sizeof buffer, std::int64_t(v));
    return v == 0 && std::signbit(v) ? "-0." : std::string(buffer, p);
  }
  const auto [p, e] = std::to_chars(buffer, buffer + sizeof buffer, v);
  return std::string(buffer, p);
}

// A number in scientific form, such as -3.25e-02, without the letter e and the leading zeros of the
// exponent; without the point too, where that is what makes it fit: -3.25-2, -325-4.
std::string compact(const std::string& scientific, int width) {
  const std::size_t e = scientific.find('e');
  std::string mantissa = scientific.substr(0, e), exponent = scientific.substr(e + 1);
  const char sign = exponent[0];
  exponent.erase(0, std::min(exponent.find_first_not_of("+-0"), exponent.size() - 1));
  const std::string text = mantissa + sign + exponent;
  const std::size_t point = mantissa.find('.');
  if (int(text.size()) <= width || point == std::string::npos) return text;
  const int power = std::stoi(sign + exponent) - int(mantissa.size() - point - 1);
  return mantissa.erase(point, 1) + (power < 0 ? "" : "+") + std::to_string(power);
}

// The shortest text that reads back as v. A number that needs 17 digits, a sign and two digits of
// exponent has 21 characters: where 20 columns are all there is, it loses its last digit, 1e-16 of
// it.
std::string real_text(double v, int width) {
  std::string text = shortest(v);
  if (text.find_first_of(".e") == std::string::npos && int(text.size()) < width) text += '.';
  if (int(text.size()) <= width) return text;
  char buffer[40];
  const auto [p, err] =
      std::to_chars(buffer, buffer + sizeof buffer, v, std::chars_format::scientific);
  text = compact(std::string(buffer, p), width);
  for (int digits = 15; width >= 20 && int(text.size()) > width; --digits) {
    const auto [q, error] =
        std::to_chars(buffer, buffer + sizeof buffer, v, std::chars_format::scientific, digits);
    text = compact(std::string(buffer, q), width);
  }
  return text;
}

class DeckWriter {
 public:
  DeckWriter(const Model& model, std::ostream* out, bool long_fields)
      : model_(model), out_(out), long_(long_fields) {}
  bool fits = true;  // every value so far fits its field

  void write() {
    text(long_ ? "*KEYWORD LONG=Y\n" : "*KEYWORD\n");
    if (!model_.title.empty()) text("*TITLE\n" + model_.title + "\n");
    nodes();
    solids();
    shells();
    beams();
    discretes();
    lumped();
    for (const auto& card : model_.cards) write_card(*card);
    text("*END\n");
  }

 private:
  void text(const std::string& s) {
    if (out_) out_->write(s.data(), std::streamsize(s.size()));
  }
  void put(const std::string& s, int width) {
    if (long_ && width < 20) width = 20;
    if (int(s.size()) > width) fits = false;
    line_.append(std::size_t(std::max(0, width - int(s.size()))), ' ');
    line_ += s;
  }
  void put_integer(std::int64_t v, int width) { put(std::to_string(v), width); }
  void put_real(double v, int width) { put(real_text(v, long_ && width < 20 ? 20 : width), width); }
  void end_line() {
    while (!line_.empty() && line_.back() == ' ') line_.pop_back();
    line_ += '\n';
    text(line_);
    line_.clear();
  }
  std::int64_t node_id(int i) const { return i < 0 ? 0 : model_.nodes.id[std::size_t(i)]; }
  std::int64_t part_id(int i) const { return i < 0 ? 0 : model_.parts[std::size_t(i)].id; }

  void nodes() {
    const Nodes& n = model_.nodes;
    if (n.size() > 0) text("*NODE\n");
    for (std::size_t i = 0; i < n.id.size(); ++i) {
      put_integer(n.id[i], 8);
      for (int k = 0; k < 3; ++k) put_real(n.x[i][k], 16);
      if (n.translation_code[i] || n.rotation_code[i]) {
        put_integer(n.translation_code[i], 8);
        put_integer(n.rotation_code[i], 8);
      }
      end_line();
    }
  }
  void head(std::int64_t id, int part) {
    put_integer(id, 8);
    put_integer(part_id(part), 8);
  }
  void solids() {
    const Solids& s = model_.solids;
    if (s.size() > 0) text("*ELEMENT_SOLID\n");
    for (std::size_t i = 0; i < s.id.size(); ++i) {
      head(s.id[i], s.part[i]);
      if (s.node[i][8] >= 0) end_line();
      for (int k = 0; k < (s.node[i][8] >= 0 ? 10 : 8); ++k)
        put_integer(node_id(s.node[i][std::size_t(k)]), 8);
      end_line();
    }
  }
  void shells() {
    const Shells& s = model_.shells;
    const bool extra = !s.thickness.empty() || !s.beta.empty();
    if (s.size() > 0) text(extra ? "*ELEMENT_SHELL_THICKNESS\n" : "*ELEMENT_SHELL\n");
    for (std::size_t i = 0; i < s.id.size(); ++i) {
      head(s.id[i], s.part[i]);
      for (const int n : s.node[i]) put_integer(node_id(n), 8);
      end_line();
      if (!extra) continue;
      for (std::size_t k = 0; k < 4; ++k)
        put_real(i < s.thickness.size() ? double(s.thickness[i][k]) : 0.0, 16);
      put_real(i < s.beta.size() ? double(s.beta[i]) : 0.0, 16);
      end_line();
    }
  }
  void beams() {
    const Beams& b = model_.beams;
    const bool vectors = !b.orientation.empty();
    if (b.size() > 0) text(vectors ? "*ELEMENT_BEAM_ORIENTATION\n" : "*ELEMENT_BEAM\n");
    for (std::size_t i = 0; i < b.id.size(); ++i) {
      head(b.id[i], b.part[i]);
      for (const int n : b.node[i]) put_integer(node_id(n), 8);
      end_line();
      if (!vectors) continue;
      for (int k = 0; k < 3; ++k)
        put_real(i < b.orientation.size() ? b.orientation[i][k] : 0.0, 10);
      end_line();
    }
  }
  void discretes() {
    const Discretes& d = model_.discretes;
    if (d.size() > 0) text("*ELEMENT_DISCRETE\n");
    for (std::size_t i = 0; i < d.id.size(); ++i) {
      head(d.id[i], d.part[i]);
      for (const int n : d.node[i]) put_integer(node_id(n), 8);
      put_integer(
          d.orientation[i] < 0 ? 0 : model_.sd_orientations[std::size_t(d.orientation[i])].id, 8);
      put_real(d.scale[i], 16);
      put_integer(0, 8);
      put_real(d.offset[i], 16);
      end_line();
    }
  }
  void lumped() {
    if (!model_.masses.empty()) text("*ELEMENT_MASS\n");
    for (const NodalMass& m : model_.masses) {
      put_integer(m.id, 8);
      put_integer(node_id(m.node), 8);
      put_real(m.mass, 16);
      put_integer(part_id(m.part), 8);
      end_line();
    }
    if (!model_.inertias.empty()) text("*ELEMENT_INERTIA\n");
    for (const NodalInertia& m : model_.inertias) {
      put_integer(m.id, 8);
      put_integer(node_id(m.node), 8);
      end_line();
      for (const double v : m.inertia) put_real(v, 10);
      put_real(m.mass, 10);
      end_line();
    }
  }

  void field(const FieldSchema& f, double value, bool given, const std::string& words) {
    if (f.type == FieldType::text) {
      // texts stand on the left
      const int width = long_ && f.width < 20 ? 20 : f.width;
      if (int(words.size()) > width && f.width < 40) fits = false;
      line_ += words;
      line_.append(std::size_t(std::max(0, width - int(words.size()))), ' ');
    } else if (!given) {
      put("", f.width);
    } else if (f.type == FieldType::integer && std::abs(value) < 9e15) {
      put_integer(std::int64_t(value), f.width);
    } else {
      put_real(value, f.width);
    }
  }
  void gap(const FieldSchema& f, int end) {
    line_.append(std::size_t(std::max(0, f.column - end)) * (long_ ? 2 : 1), ' ');
  }

  void write_card(const Card& card) {
    std::string name = "*" + card.schema->name;
    for (const std::string& option : card.options) name += "_" + option;
    text(name + "\n");
    bool own_title = false;
    for (const CardSchema& c : card.schema->cards)
      own_title = own_title || c.condition.find("option(TITLE)") != std::string::npos;
    if (card.has_option("TITLE") && !own_title) text(card.title + "\n");
    std::size_t first = 0, last_line = 0, line = 0;
    // optional cards up to the last that was there; all of them where rows follow
    for (std::size_t i = 0; i < card.card_lines.size(); ++i)
      if (present(card, i)) last_line = i;
    if (card.row_count() > 0) last_line = card.schema->cards.size();
    for (const CardSchema& c : card.schema->cards) {
      if (c.repeats) continue;
      const std::size_t at = line++, begin = first;
      first += c.fields.size();
      if (!c.condition.empty() && evaluate_condition(c.condition, card) == 0) continue;
      if (c.optional && at > last_line) continue;
      if (c.title) {
        text(card.title + "\n");
        continue;
      }
      if (!c.fields.empty() && c.fields[0].name == "ampersand" && !card.values_given[begin])
        continue;
      int end = 0;
      for (std::size_t i = 0; i < c.fields.size(); ++i) {
        gap(c.fields[i], end);
        end = c.fields[i].column + c.fields[i].width;
        field(c.fields[i], card.values[begin + i], card.values_given[begin + i] != 0,
              card.texts[begin + i]);
      }
      end_line();
    }
    rows(card);
  }
  // was the card in the deck, or has it a value?
  static bool present(const Card& card, std::size_t which) {
    if (card.card_lines[which] > 0) return true;
    std::size_t first = 0, line = 0;
    for (const CardSchema& c : card.schema->cards) {
      if (c.repeats) continue;
      if (line++ == which)
        for (std::size_t i = 0; i < c.fields.size(); ++i)
          if (card.values_given[first + i]) return true;
      first += c.fields.size();
    }
    return false;
  }
  void rows(const Card& card) {
    for (int r = 0; r < card.row_count(); ++r) {
      int column = 0;
      for (const CardSchema& c : card.schema->cards) {
        if (!c.repeats) continue;
        const int begin = column;
        column += int(c.fields.size());
        if (!c.condition.empty() && evaluate_condition(c.condition, card) == 0) continue;
        int end = 0;
        for (std::size_t i = 0; i < c.fields.size(); ++i) {
          gap(c.fields[i], end);
          end = c.fields[i].column + c.fields[i].width;
          const int k = begin + int(i);
          field(c.fields[i], card.row(r, k), card.row_given(r, k),
                std::string(card.row_text(r, k)));
        }
        end_line();
      }
    }
  }

  const Model& model_;
  std::ostream* out_;
  bool long_;
  std::string line_;
};

}  // namespace

void write_deck(const Model& model, std::ostream& out) {
  // try the usual widths first, without writing
  DeckWriter trial(model, nullptr, false);
  trial.write();
  DeckWriter(model, &out, !trial.fits).write();
}

}  // namespace fabrica
