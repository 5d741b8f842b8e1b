#include "deck/number.h"

#include <cctype>

namespace fabrica {

std::optional<double> parse_fortran_real(std::string_view text) {
  // mantissa as it stands, then e; d, D, E and a bare sign all open the exponent
  char buffer[64] = {};
  std::size_t n = 0;
  bool exponent = false, digits = false;
  if (text.size() + 2 > sizeof buffer) return std::nullopt;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (std::isdigit(static_cast<unsigned char>(c)) || (c == '.' && !exponent)) {
      digits = digits || c != '.';
      buffer[n++] = c;
    } else if (c == '+' || c == '-') {
      if (i == 0) {
        if (c == '-') buffer[n++] = c;
      } else if (exponent && buffer[n - 1] == 'e') {
        buffer[n++] = c;
      } else if (!exponent && digits) {
        exponent = true;
        buffer[n++] = 'e';
        buffer[n++] = c;
      } else {
        return std::nullopt;
      }
    } else if ((c == 'e' || c == 'E' || c == 'd' || c == 'D') && !exponent && digits) {
      exponent = true;
      buffer[n++] = 'e';
    } else {
      return std::nullopt;
    }
  }
  double value = 0;
  const auto [p, e] = std::from_chars(buffer, buffer + n, value);
  // too small for a double is zero, too large is an error
  const bool tiny = std::string_view(buffer, n).find("e-") != std::string_view::npos;
  if (e == std::errc::result_out_of_range && p == buffer + n && tiny) return 0.0;
  if (e != std::errc() || p != buffer + n || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace fabrica
