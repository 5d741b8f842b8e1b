#pragma once
// Numbers as decks write them: C and Fortran forms (1.5d3, 1.0+3, .5, 5.), blanks around them.
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

namespace fabrica {

// text without blanks and tabs at both ends
inline std::string_view trimmed(std::string_view t) {
  while (!t.empty() && (t.front() == ' ' || t.front() == '\t')) t.remove_prefix(1);
  while (!t.empty() && (t.back() == ' ' || t.back() == '\t' || t.back() == '\r'))
    t.remove_suffix(1);
  return t;
}

// Fortran form, once the plain form has failed; nothing if it is no finite number
std::optional<double> parse_fortran_real(std::string_view text);

// the finite number that fills the whole text, or nothing; text must be trimmed and not empty
inline std::optional<double> parse_real(std::string_view text) {
  double value = 0;
  const char* first = text.data();
  const char* const last = first + text.size();
  if (first != last && *first == '+') ++first;
  const auto [p, e] = std::from_chars(first, last, value);
  if (e == std::errc() && p == last && std::isfinite(value)) return value;
  return parse_fortran_real(text);
}

// an integer, also when written as a real without fraction
inline std::optional<std::int64_t> parse_integer(std::string_view text) {
  std::int64_t value = 0;
  const auto [p, e] = std::from_chars(text.data(), text.data() + text.size(), value);
  // up to what a double counts exactly
  if (e == std::errc() && p == text.data() + text.size())
    return value > -9'000'000'000'000'000 && value < 9'000'000'000'000'000 ? std::optional(value)
                                                                           : std::nullopt;
  const auto real = parse_real(text);
  if (!real || std::abs(*real) > 9e15 || *real != std::floor(*real)) return std::nullopt;
  return std::int64_t(*real);
}

}  // namespace fabrica
