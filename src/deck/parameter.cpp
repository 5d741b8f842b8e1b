#include "deck/parameter.h"

#include <cctype>
#include <cmath>

#include "base/math_functions.h"
#include "deck/number.h"

namespace fabrica {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = char(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

class Expression {
 public:
  Expression(std::string_view text, const ParameterTable& table) : text_(text), table_(table) {}
  std::string problem;

  std::optional<ParameterValue> whole() {
    ParameterValue value = sum();
    skip();
    if (at_ < text_.size())
      fail("text after the expression: " + std::string(text_.substr(at_, 20)));
    if (!problem.empty()) return std::nullopt;
    if (!std::isfinite(as_real(value))) return fail("the value is not finite"), std::nullopt;
    return value;
  }

 private:
  ParameterValue fail(const std::string& what) {
    if (problem.empty()) problem = what;
    at_ = text_.size();
    return std::int64_t(0);
  }
  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  char peek() {
    skip();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  static bool integers(const ParameterValue& a, const ParameterValue& b) {
    return std::holds_alternative<std::int64_t>(a) && std::holds_alternative<std::int64_t>(b);
  }
  // a op b; integers stay integers unless they overflow
  ParameterValue apply(char op, const ParameterValue& a, const ParameterValue& b) {
    if (integers(a, b)) {
      const std::int64_t i = std::get<std::int64_t>(a), j = std::get<std::int64_t>(b);
      std::int64_t r = 0;
      if (op == '+' && !__builtin_add_overflow(i, j, &r)) return r;
      if (op == '-' && !__builtin_sub_overflow(i, j, &r)) return r;
      if (op == '*' && !__builtin_mul_overflow(i, j, &r)) return r;
      if (op == '/' && j == 0) return fail("division by zero");
      if (op == '/' && !(j == -1 && i == INT64_MIN)) return i / j;
    }
    const double x = as_real(a), y = as_real(b);
    if (op == '/' && y == 0) return fail("division by zero");
    return op == '+' ? x + y : op == '-' ? x - y : op == '*' ? x * y : x / y;
  }
  ParameterValue sum() {
    if (++depth_ > 100) return fail("nested too deeply");
    ParameterValue a = signed_product();
    for (;;) {
      const char c = peek();
      if (c != '+' && c != '-') break;
      ++at_;
      a = apply(c, a, product());
    }
    --depth_;
    return a;
  }
  // a sign binds weaker than ** and *: -a**2 is -(a**2)
  ParameterValue signed_product() {
    if (take('-')) return apply('-', std::int64_t(0), signed_checked());
    if (take('+')) return signed_checked();
    return product();
  }
  ParameterValue signed_checked() {
    if (++depth_ > 100) return fail("nested too deeply");
    ParameterValue a = signed_product();
    --depth_;
    return a;
  }
  ParameterValue product() {
    ParameterValue a = power();
    for (;;) {
      const char c = peek();
      if ((c != '*' && c != '/') || text_.substr(at_).starts_with("**")) break;
      ++at_;
      a = apply(c, a, power());
    }
    return a;
  }
  ParameterValue power() {
    if (++depth_ > 100) return fail("nested too deeply");
    const ParameterValue a = atom();
    peek();
    if (!text_.substr(std::min(at_, text_.size())).starts_with("**")) return --depth_, a;
    at_ += 2;
    const ParameterValue b = peek() == '-' ? signed_product() : power();
    --depth_;
    const double r = std::pow(as_real(a), as_real(b));
    if (integers(a, b) && std::abs(r) < 9e15) return std::int64_t(std::trunc(r));
    return r;
  }
  ParameterValue atom() {
    if (take('(')) {
      ParameterValue a = sum();
      return take(')') ? a : fail("a closing bracket is missing");
    }
    // signs may follow an operator: 2*-3
    if (peek() == '-' || peek() == '+') return signed_checked();
    const bool reference = take('&');
    const char c = peek();
    if (!reference && (std::isdigit(static_cast<unsigned char>(c)) || c == '.')) return number();
    const std::size_t start = at_;
    while (at_ < text_.size() && is_name(text_[at_])) ++at_;
    if (start == at_)
      return fail(c ? std::string("unexpected ") + c : "the expression ends too early");
    const std::string name = lower(text_.substr(start, at_ - start));
    if (!reference && peek() == '(') return call(name);
    if (const ParameterValue* v = table_.find(name)) {
      if (std::holds_alternative<std::string>(*v)) return fail("parameter " + name + " is a text");
      return *v;
    }
    if (name == "pi") return 3.14159265358979323846;
    return fail("parameter " + name + " is not defined");
  }
  ParameterValue number() {
    std::size_t end = at_;
    bool real = false;
    while (end < text_.size()) {
      const char c = text_[end];
      const bool exponent = c == 'e' || c == 'E' || c == 'd' || c == 'D';
      if (exponent && end + 1 < text_.size() && (text_[end + 1] == '+' || text_[end + 1] == '-'))
        ++end;
      if (exponent || c == '.') real = true;
      if (!exponent && c != '.' && !std::isdigit(static_cast<unsigned char>(c))) break;
      ++end;
    }
    const std::string_view digits = text_.substr(at_, end - at_);
    at_ = end;
    if (!real)
      if (const auto i = parse_integer(digits)) return *i;
    if (const auto r = parse_real(digits)) return *r;
    return fail("not a number: " + std::string(digits));
  }
  ParameterValue call(const std::string& name) {
    take('(');
    std::vector<ParameterValue> arguments{sum()};
    while (take(',')) arguments.push_back(sum());
    if (!take(')')) return fail("a closing bracket is missing");
    const auto known = functions_of_one().find(name);
    if (known != functions_of_one().end() && arguments.size() == 1) {
      if (name == "abs" && integers(arguments[0], arguments[0])) {
        const std::int64_t i = std::get<std::int64_t>(arguments[0]);
        return i < 0 && i != INT64_MIN ? -i : i;
      }
      return known->second(as_real(arguments[0]));
    }
    return several(name, arguments);
  }
  ParameterValue several(const std::string& name, const std::vector<ParameterValue>& a) {
    if (a.size() == 1 && (name == "int" || name == "nint")) {
      const double x = name == "int" ? std::trunc(as_real(a[0])) : std::round(as_real(a[0]));
      return std::abs(x) < 9e15 ? ParameterValue(std::int64_t(x)) : fail(name + ": too large");
    }
    if (a.size() == 1 && name == "float") return as_real(a[0]);
    if (name == "min" || name == "max") {
      ParameterValue best = a[0];
      for (const ParameterValue& v : a)
        if (name == "min" ? as_real(v) < as_real(best) : as_real(v) > as_real(best)) best = v;
      return best;
    }
    if (a.size() == 2 && name == "atan2") return std::atan2(as_real(a[0]), as_real(a[1]));
    if (a.size() == 2 && name == "sign")
      return std::copysign(std::abs(as_real(a[0])), as_real(a[1]));
    if (a.size() == 2 && name == "mod") {
      if (as_real(a[1]) == 0) return fail("division by zero");
      if (integers(a[0], a[1])) {
        const std::int64_t j = std::get<std::int64_t>(a[1]);
        return j == -1 ? std::int64_t(0) : std::get<std::int64_t>(a[0]) % j;
      }
      return std::fmod(as_real(a[0]), as_real(a[1]));
    }
    return fail("no function " + name + " with " + std::to_string(a.size()) + " arguments");
  }

  std::string_view text_;
  const ParameterTable& table_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

double as_real(const ParameterValue& value) {
  if (const auto* i = std::get_if<std::int64_t>(&value)) return double(*i);
  if (const auto* r = std::get_if<double>(&value)) return *r;
  return 0;
}

const ParameterValue* ParameterTable::find(std::string_view name) const {
  const std::string key = lower(name);
  for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope)
    if (const auto it = scope->find(key); it != scope->end()) return &it->second.value;
  return nullptr;
}

bool ParameterTable::define(std::string_view name, ParameterValue value, bool local,
                            bool is_mutable) {
  auto& scope = local ? scopes_.back() : scopes_.front();
  const auto [it, fresh] = scope.emplace(lower(name), Entry{value, is_mutable});
  if (fresh) return false;
  const bool free = it->second.is_mutable;
  if (free || duplication == Duplication::warn_replace || duplication == Duplication::replace)
    it->second.value = std::move(value);
  return !free;
}

std::optional<ParameterValue> evaluate_expression(std::string_view text,
                                                  const ParameterTable& table,
                                                  std::string& problem) {
  Expression expression(text, table);
  auto value = expression.whole();
  problem = expression.problem;
  return value;
}

}  // namespace fabrica
