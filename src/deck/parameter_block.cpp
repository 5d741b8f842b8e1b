// *PARAMETER, *PARAMETER_EXPRESSION, their _LOCAL forms and *PARAMETER_DUPLICATION.
#include <cctype>
#include <cmath>

#include "deck/context.h"
#include "deck/number.h"

namespace fabrica {
namespace {

class ParameterReader {
 public:
  ParameterReader(Context& context, Block& block, bool local, bool is_mutable)
      : context_(context), block_(block), local_(local), mutable_(is_mutable) {
    width_ = block.format.long_fields ? 20 : 10;
  }

  // up to four pairs of name and value a line
  void values() {
    std::vector<FieldPlace> places;
    for (int i = 0; i < 8; ++i) places.push_back({i * width_, width_});
    FieldTexts texts;
    while (block_.next()) {
      cut_fields(block_.line(), places, 1 << 30, texts);
      for (std::size_t i = 0; i < 8; i += 2) {
        if (texts.text[i].empty()) continue;
        // a text value may be longer than its field
        const bool text = std::toupper(static_cast<unsigned char>(texts.text[i][0])) == 'C';
        std::string_view value = texts.text[i + 1];
        const auto start = (i + 1) * std::size_t(width_);
        if (text && !texts.free && start < block_.line().size())
          value = trimmed(block_.line().substr(start));
        define(texts.text[i], value, block_.here(), false);
        if (text && !texts.free) break;
      }
    }
  }

  // one expression a parameter; lines whose name field is blank go on with it
  void expressions() {
    std::string head, body;
    Location where;
    while (block_.next()) {
      const std::string_view line = block_.line();
      if (trimmed(line).empty()) continue;
      std::size_t cut = std::min(line.size(), std::size_t(width_)), skip = cut;
      if (const std::size_t comma = line.find(',');
          comma != line.npos && comma <= std::size_t(width_))
        cut = comma, skip = comma + 1;
      const std::string_view name = trimmed(line.substr(0, cut));
      const std::string_view text = trimmed(line.substr(skip));
      if (name.empty()) {
        body += " ";
        body += text;
        continue;
      }
      if (!head.empty()) define(head, body, where, true);
      head = name, body = text, where = block_.here();
    }
    if (!head.empty()) define(head, body, where, true);
  }

  // only the first *PARAMETER_DUPLICATION counts
  void duplication() {
    while (block_.next()) {
      const std::string_view text = trimmed(block_.line().substr(0, std::size_t(width_)));
      if (text.empty()) continue;
      const auto flag = parse_integer(text);
      if (!flag || *flag < 1 || *flag > 5) {
        context_.error("value-out-of-range", block_.here(), block_.keyword, "dflag",
                       "expected 1 to 5", "Use 1 to 5");
      } else if (context_.parameters.duplication) {
        context_.report(Severity::warning, "duplicate-keyword", block_.here(), block_.keyword,
                        "dflag", "the first *PARAMETER_DUPLICATION counts",
                        "Give the keyword once");
      } else {
        context_.parameters.duplication = Duplication(*flag);
      }
    }
  }

 private:
  void define(std::string_view head, std::string_view text, Location where, bool expression) {
    const char type = char(std::toupper(static_cast<unsigned char>(head[0])));
    const std::string name(trimmed(head.substr(1)));
    bool good = !name.empty() && (type == 'R' || type == 'I' || type == 'C');
    for (const char c : name)
      good = good && (std::isalnum(static_cast<unsigned char>(c)) || c == '_');
    if (!good) {
      context_.error("bad-parameter", where, block_.keyword, std::string(head),
                     "expected R, I or C and a name of letters, digits and _",
                     "Write for example \"R  width\"");
      return;
    }
    ParameterValue value = std::int64_t(0);
    if (!value_of(type, name, text, where, expression, value)) return;
    const bool twice =
        context_.parameters.define(name, std::move(value), local_, mutable_ && type != 'C');
    if (twice) report_twice(name, where);
  }

  bool value_of(char type, const std::string& name, std::string_view text, Location where,
                bool expression, ParameterValue& value) {
    if (type == 'C') {
      value = std::string(text);
      return true;
    }
    if (expression) {
      std::string problem;
      const auto result = evaluate_expression(text, context_.parameters, problem);
      if (!result) {
        context_.error(problem.ends_with("not defined") ? "undefined-parameter" : "bad-expression",
                       where, block_.keyword, name, problem,
                       "Correct the expression \"" + std::string(text.substr(0, 60)) + "\"");
        return false;
      }
      value = *result;
    } else {
      double number = 0;
      bool given = false;
      if (!context_.number(block_, where, name, text, false, number, given)) return false;
      value = number;
    }
    return as_type(type, name, where, value);
  }

  // integers are cut towards zero, as in a Fortran assignment
  bool as_type(char type, const std::string& name, Location where, ParameterValue& value) {
    const double number = as_real(value);
    if (type == 'R') {
      value = number;
      return true;
    }
    if (std::holds_alternative<std::int64_t>(value)) return true;
    if (std::abs(number) > 9e15) {
      context_.error("bad-number", where, block_.keyword, name, "too large for an integer",
                     "Declare it with R");
      return false;
    }
    value = std::int64_t(std::trunc(number));
    return true;
  }

  void report_twice(const std::string& name, Location where) {
    const Duplication d = context_.parameters.duplication.value_or(Duplication::warn_keep);
    const bool replaced = d == Duplication::warn_replace || d == Duplication::replace;
    const std::string what = "parameter " + name + " is defined already; the " +
                             (replaced ? "new" : "first") + " value counts";
    if (d == Duplication::error_keep)
      context_.error("duplicate-parameter", where, block_.keyword, name, what,
                     "Give each parameter once");
    else if (d == Duplication::warn_keep || d == Duplication::warn_replace)
      context_.report(Severity::warning, "duplicate-parameter", where, block_.keyword, name, what,
                      "Give each parameter once, or choose with *PARAMETER_DUPLICATION");
  }

  Context& context_;
  Block& block_;
  bool local_, mutable_;
  int width_;
};

}  // namespace

bool read_parameters(Context& context, Block& block) {
  const std::string& k = block.keyword;
  // *PARAMETER{_EXPRESSION}{_LOCAL}{_MUTABLE}
  std::string stem = k;
  const auto take = [&](std::string_view option) {
    if (!stem.ends_with(option)) return false;
    stem.resize(stem.size() - option.size());
    return true;
  };
  const bool is_mutable = take("_MUTABLE"), local = take("_LOCAL");
  ParameterReader reader(context, block, local, is_mutable || take("_MUTABLE"));
  if (stem == "PARAMETER")
    reader.values();
  else if (stem == "PARAMETER_EXPRESSION")
    reader.expressions();
  else if (k == "PARAMETER_DUPLICATION")
    reader.duplication();
  else
    return false;
  return true;
}

}  // namespace fabrica
