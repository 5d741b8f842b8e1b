#include "model/condition.h"

#include <cctype>
#include <charconv>
#include <stdexcept>

namespace fabrica {
namespace {

// recursive descent, one function per level of binding
class Condition {
 public:
  Condition(std::string_view text, const Card& card) : text_(text), card_(card) {}

  double whole() {
    const double value = either();
    skip();
    if (at_ != text_.size()) fail();
    return value;
  }

 private:
  [[noreturn]] void fail() const {
    throw std::invalid_argument("condition not understood: " + std::string(text_));
  }
  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool take(std::string_view token) {
    skip();
    if (!text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }
  double either() {
    double a = both();
    while (take("||")) {
      const double b = both();
      a = a != 0 || b != 0;
    }
    return a;
  }
  double both() {
    double a = comparison();
    while (take("&&")) {
      const double b = comparison();
      a = a != 0 && b != 0;
    }
    return a;
  }
  double comparison() {
    const double a = sum();
    if (take("==")) return a == sum();
    if (take("!=")) return a != sum();
    if (take("<=")) return a <= sum();
    if (take(">=")) return a >= sum();
    if (take("<")) return a < sum();
    if (take(">")) return a > sum();
    return a;
  }
  double sum() {
    double a = product();
    for (;;) {
      if (take("+"))
        a += product();
      else if (take("-"))
        a -= product();
      else
        return a;
    }
  }
  double product() {
    double a = factor();
    while (take("*")) a *= factor();
    return a;
  }
  double factor() {
    if (take("!")) return factor() == 0;
    if (take("-")) return -factor();
    if (take("(")) {
      const double a = either();
      if (!take(")")) fail();
      return a;
    }
    skip();
    double number = 0;
    const char* const end = text_.data() + text_.size();
    if (at_ < text_.size() &&
        (std::isdigit(static_cast<unsigned char>(text_[at_])) || text_[at_] == '.')) {
      const auto [p, e] = std::from_chars(text_.data() + at_, end, number);
      // a name may start with a digit ("2dbinr"): then letters follow
      if (e == std::errc() && (p == end || !std::isalpha(static_cast<unsigned char>(*p)))) {
        at_ = std::size_t(p - text_.data());
        return number;
      }
    }
    return named();
  }
  std::string_view name() {
    skip();
    const std::size_t start = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_'))
      ++at_;
    if (start == at_) fail();
    return text_.substr(start, at_ - start);
  }
  double named() {
    const std::string_view word = name();
    if (word != "option" && word != "given")
      return card_.has_field(word) ? card_.real(word) : (fail(), 0.0);
    if (!take("(")) fail();
    const std::string_view argument = name();
    if (!take(")")) fail();
    if (word == "option") return card_.has_option(argument);
    return card_.has_field(argument) ? card_.given(argument) : (fail(), false);
  }

  std::string_view text_;
  const Card& card_;
  std::size_t at_ = 0;
};

}  // namespace

double evaluate_condition(std::string_view expression, const Card& card) {
  return Condition(expression, card).whole();
}

}  // namespace fabrica
