#include "deck/context.h"

#include <algorithm>

#include "deck/number.h"

namespace fabrica {
namespace {

constexpr int most_reports = 200;

std::string shown(std::string_view text) { return "\"" + std::string(text.substr(0, 40)) + "\""; }

}  // namespace

void cut_fields(std::string_view line, const std::vector<FieldPlace>& places, int comma_limit,
                FieldTexts& out) {
  out.text.assign(places.size(), {});
  out.surplus = {};
  const std::size_t comma = line.find(',');
  out.free = comma != line.npos && int(comma) < comma_limit;
  if (out.free) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::size_t end = line.find(',');
      out.text[i] = trimmed(line.substr(0, end));
      line.remove_prefix(end == line.npos ? line.size() : end + 1);
      if (line.empty()) return;
    }
    out.surplus = trimmed(line);
    return;
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto column = std::size_t(places[i].column);
    if (column >= line.size()) return;
    out.text[i] = trimmed(line.substr(column, std::size_t(places[i].width)));
  }
  const std::size_t end =
      places.empty() ? 0 : std::size_t(places.back().column + places.back().width);
  if (end < line.size()) out.surplus = trimmed(line.substr(end));
}

bool Block::next() {
  if (repeated) {
    repeated = false;
    return true;
  }
  if (!lines.next_data()) return false;
  long_line = lines.line.find('\t') != lines.line.npos;
  if (long_line) expanded = without_tabs(lines.line);
  return true;
}

bool Block::only_blank_left() const {
  if (repeated && !trimmed(lines.line).empty()) return false;
  Lines ahead(lines.rest());
  while (ahead.next_data())
    if (!trimmed(ahead.line).empty()) return false;
  return true;
}

void Block::skip() {
  repeated = false;
  while (lines.next_data()) {
  }
}

void Context::report(Severity severity, const std::string& name, Location where,
                     const std::string& keyword, const std::string& field, std::string message,
                     std::string remedy) {
  Tally& tally = tallies_[{name, keyword, field}];
  tally.severity = severity;
  tally.last = where;
  if (++tally.count <= most_reports)
    diagnostics.add({severity, name, where, keyword, field, std::move(message), std::move(remedy)});
}

void Context::summarise_rest() {
  for (const auto& [key, tally] : tallies_)
    if (tally.count > most_reports)
      diagnostics.add(
          {tally.severity, key[0], tally.last, key[1], key[2],
           std::to_string(tally.count - most_reports) + " more of the same kind, the last here", "",
           tally.count - most_reports});
}

bool Context::parameter(const Block& block, Location where, const std::string& field,
                        std::string_view text, bool integer, double& value) {
  const bool minus = text[0] == '-';
  std::string_view name = trimmed(text.substr(minus ? 2 : 1));
  const ParameterValue* found = parameters.find(name);
  if (!found) {
    error(
        "undefined-parameter", where, block.keyword, field,
        "parameter " + std::string(name) + " is not defined here",
        "Define it with *PARAMETER before its first use, in this file or in one that includes it");
    return false;
  }
  if (const auto* words = std::get_if<std::string>(found)) {
    const auto real = parse_real(*words);
    if (!real) {
      error("bad-number", where, block.keyword, field,
            "parameter " + std::string(name) + " is a text, not a number",
            "Declare it with R or I");
      return false;
    }
    value = *real;
  } else {
    value = as_real(*found);
  }
  if (minus) value = -value;
  // integers from real parameters are rounded towards zero, as the reference program does
  if (integer) value = std::trunc(value);
  return true;
}

bool Context::number(const Block& block, Location where, const std::string& field,
                     std::string_view text, bool integer, double& value, bool& given) {
  given = false;
  if (text.empty()) return true;
  given = true;
  if (text[0] == '&' || text.starts_with("-&"))
    return parameter(block, where, field, text, integer, value);
  if (integer) {
    if (const auto i = parse_integer(text)) {
      value = double(*i);
      return true;
    }
  } else if (const auto r = parse_real(text)) {
    value = *r;
    return true;
  }
  error("bad-number", where, block.keyword, field,
        shown(text) + (integer ? " is not an integer" : " is not a finite number"),
        "Check that the value stands within the columns of its field");
  return false;
}

}  // namespace fabrica
