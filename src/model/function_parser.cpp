// From the text of a function to what computes it, by recursive descent:
//   expression  or ? expression : expression        or    and || and        and  compare && compare
//   compare     sum < sum, ==, ...                  sum   product + product
//   product     power * power                       power unary ** power    unary  - unary, ! unary
//   atom        number, name, name(arguments), (expression)
//   statement   { ... }  float x = 1, y;  x = e;  if (e) s else s  while (e) s  for (s; e; s) s
//               return e;
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "base/math_functions.h"
#include "model/function.h"

namespace fabrica {
namespace {

using Two = double (*)(double, double);
const std::map<std::string, Two, std::less<>> functions_of_two{
    {"pow", [](double a, double b) { return std::pow(a, b); }},
    {"fmod", [](double a, double b) { return std::fmod(a, b); }},
    {"mod", [](double a, double b) { return std::fmod(a, b); }},
    {"atan2", [](double a, double b) { return std::atan2(a, b); }},
    {"sign", [](double a, double b) { return b < 0 ? -std::abs(a) : std::abs(a); }},
    {"max", [](double a, double b) { return std::max(a, b); }},
    {"fmax", [](double a, double b) { return std::max(a, b); }},
    {"min", [](double a, double b) { return std::min(a, b); }},
    {"fmin", [](double a, double b) { return std::min(a, b); }}};

struct Operator {
  std::string_view sign;
  Two apply;
};
// from the weakest binding to the strongest
const std::array<std::vector<Operator>, 6> operators{{
    {{"||", [](double a, double b) { return double(a != 0 || b != 0); }}},
    {{"&&", [](double a, double b) { return double(a != 0 && b != 0); }}},
    {{"==", [](double a, double b) { return double(a == b); }},
     {"!=", [](double a, double b) { return double(a != b); }}},
    {{"<=", [](double a, double b) { return double(a <= b); }},
     {">=", [](double a, double b) { return double(a >= b); }},
     {"<", [](double a, double b) { return double(a < b); }},
     {">", [](double a, double b) { return double(a > b); }}},
    {{"+", [](double a, double b) { return a + b; }},
     {"-", [](double a, double b) { return a - b; }}},
    {{"*", [](double a, double b) { return a * b; }},
     {"/", [](double a, double b) { return a / b; }}},
}};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

constexpr int deepest = 60;  // of brackets, and of calls
constexpr int most_terms = 2000;

void take_step(Frame& f) {
  if (--*f.steps_left < 0) throw FunctionError("it does not come to an end", false);
}

}  // namespace

class FunctionParser {
 public:
  using Step = std::function<bool(Frame&)>;

  FunctionParser(FunctionLibrary& library, std::string_view text, bool in_c)
      : library_(library), text_(text), in_c_(in_c) {}

  Expression whole_expression() {
    Value v = expression();
    skip();
    if (at_ < text_.size()) fail("'" + std::string(text_.substr(at_, 20)) + "' is not understood");
    return {std::move(v), std::move(curves_)};
  }

  // float name(float a, float b) { ... }, or name(a, b) = expression
  void definition() {
    take_type();
    FunctionLibrary::Function& f = library_.declare(word("the name of the function"));
    if (f.defined) fail("the function is defined twice");
    need("(");
    while (!take(")")) {
      take_type();
      variable_named(word("a parameter"), true);
      if (!next_is(")")) need(",");
    }
    f.parameters = names_.size();
    f.body = take("=") ? returned() : block();
    f.variable.assign(names_.size(), 0.0);
    f.defined = true;
    take(";");
    skip();
    if (at_ < text_.size()) fail("text follows the function");
  }

 private:
  [[noreturn]] void fail(const std::string& what, bool unknown = false) const {
    throw FunctionError(what, unknown);
  }

  // text
  void skip() {
    while (at_ < text_.size()) {
      if (text_.substr(at_).starts_with("/*")) {
        const std::size_t end = text_.find("*/", at_ + 2);
        at_ = end == text_.npos ? text_.size() : end + 2;
      } else if (text_.substr(at_).starts_with("//")) {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (std::isspace(static_cast<unsigned char>(text_[at_]))) {
        ++at_;
      } else {
        return;
      }
    }
  }
  bool next_is(std::string_view sign) {
    skip();
    return text_.substr(at_).starts_with(sign);
  }
  bool take(std::string_view sign) {
    if (!next_is(sign)) return false;
    at_ += sign.size();
    return true;
  }
  void need(std::string_view sign) {
    if (!take(sign))
      fail("'" + std::string(sign) + "' is missing before '" + std::string(text_.substr(at_, 20)) +
           "'");
  }
  // the next name in small letters, or ""
  std::string name() {
    skip();
    std::string out;
    if (at_ >= text_.size() || !is_letter(text_[at_])) return out;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_])))
      out += char(std::tolower(static_cast<unsigned char>(text_[at_++])));
    return out;
  }
  std::string word(const char* what) {
    const std::string out = name();
    if (out.empty())
      fail(std::string(what) + " is missing before '" + std::string(text_.substr(at_, 20)) + "'");
    return out;
  }
  bool take_word(std::string_view wanted) {
    const std::size_t before = at_;
    if (name() == wanted) return true;
    at_ = before;
    return false;
  }
  bool take_type() { return take_word("float") || take_word("double") || take_word("int"); }

  // variables
  std::size_t variable_named(const std::string& wanted, bool fresh) {
    const auto it = std::find(names_.begin(), names_.end(), wanted);
    if (fresh) {
      if (it != names_.end()) fail(wanted + " is declared twice");
      names_.push_back(wanted);
      return names_.size() - 1;
    }
    if (it == names_.end()) fail(wanted + " is not declared", true);
    return std::size_t(it - names_.begin());
  }

  // expressions
  Value expression() {
    if (++depth_ > deepest) fail("it is nested too deeply");
    Value v = binary(0);
    if (take("?")) {
      Value yes = expression();
      need(":");
      Value no = expression();
      v = [v = std::move(v), yes = std::move(yes), no = std::move(no)](Frame& f) {
        return v(f) != 0 ? yes(f) : no(f);
      };
    }
    --depth_;
    return v;
  }
  Value binary(std::size_t level) {
    if (level == operators.size()) return power();
    Value a = binary(level + 1);
    for (;;) {
      const auto found = std::find_if(
          operators[level].begin(), operators[level].end(),
          [&](const Operator& o) { return next_is(o.sign) && !(o.sign == "*" && next_is("**")); });
      if (found == operators[level].end()) return a;
      at_ += found->sign.size();
      if (++terms_ > most_terms) fail("it is too long");
      Value b = binary(level + 1);
      a = [a = std::move(a), b = std::move(b), apply = found->apply](Frame& f) {
        const double left = a(f);
        return apply(left, b(f));
      };
    }
  }
  // a sign binds weaker than **: -a**2 is -(a**2)
  Value power() {
    if (++depth_ > deepest) fail("it is nested too deeply");
    Value v;
    if (take("-")) {
      v = [a = power()](Frame& f) { return -a(f); };
    } else if (take("+")) {
      v = power();
    } else if (!next_is("!=") && take("!")) {
      v = [a = power()](Frame& f) { return double(a(f) == 0); };
    } else {
      v = atom();
      if (take("**"))
        v = [v = std::move(v), b = power()](Frame& f) {
          const double a = v(f);
          return std::pow(a, b(f));
        };
    }
    --depth_;
    return v;
  }
  Value atom() {
    if (take("(")) {
      Value v = expression();
      need(")");
      return v;
    }
    skip();
    if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) return number();
    const std::string n = word("a number or a name");
    if (take("(")) return call(n);
    if (const auto it = std::find(names_.begin(), names_.end(), n); it != names_.end())
      return [slot = std::size_t(it - names_.begin())](Frame& f) { return (*f.variable)[slot]; };
    return constant(n);
  }
  Value number() {
    std::size_t end = at_;
    while (end < text_.size() && (is_digit(text_[end]) || text_[end] == '.')) ++end;
    std::string digits(text_.substr(at_, end - at_));
    if (end < text_.size() && std::string_view("eEdD").find(text_[end]) != std::string_view::npos) {
      std::size_t e = end + 1;
      if (e < text_.size() && (text_[e] == '+' || text_[e] == '-')) ++e;
      if (e < text_.size() && is_digit(text_[e])) {
        while (e < text_.size() && is_digit(text_[e])) ++e;
        digits += 'e' + std::string(text_.substr(end + 1, e - end - 1));
        end = e;
      }
    }
    if (in_c_ && end < text_.size() && (text_[end] == 'f' || text_[end] == 'F')) ++end;
    char* stop = nullptr;
    const double v = std::strtod(digits.c_str(), &stop);
    if (*stop != '\0') fail("'" + digits + "' is not a number");
    at_ = end;
    return [v](Frame&) { return v; };
  }
  Value constant(const std::string& n) {
    if (n == "pi") return [](Frame&) { return std::numbers::pi; };
    if (!in_c_ && n == "time") return [](Frame& f) { return f.time; };
    if (!in_c_ && n == "dtor") return [](Frame&) { return std::numbers::pi / 180; };
    if (!in_c_ && n == "rtod") return [](Frame&) { return 180 / std::numbers::pi; };
    if (std::int64_t id = 0; !in_c_ && n.starts_with("lc")) {
      const auto [p, e] = std::from_chars(n.data() + 2, n.data() + n.size(), id);
      if (e == std::errc() && p == n.data() + n.size() && n.size() > 2)
        return curves_.push_back(id),
               [&curve = library_.curve_, id](Frame& f) { return curve(id, f.time); };
    }
    fail(n + " is not evaluated", true);
  }
  Value call(const std::string& n) {
    std::vector<Value> a;
    while (!take(")")) {
      a.push_back(expression());
      if (!next_is(")")) need(",");
    }
    const auto count = [&](std::size_t wanted) {
      if (a.size() != wanted)
        fail(n + " takes " + std::to_string(wanted) + " arguments, not " +
             std::to_string(a.size()));
    };
    if (const auto f = functions_of_one().find(n); f != functions_of_one().end()) {
      count(1);
      return [x = a[0], apply = f->second](Frame& frame) { return apply(x(frame)); };
    }
    if (const auto f = functions_of_two.find(n); f != functions_of_two.end()) {
      count(2);
      return [x = a[0], y = a[1], apply = f->second](Frame& frame) {
        const double left = x(frame);
        return apply(left, y(frame));
      };
    }
    if (n == "if") {  // IF(e, negative, zero, positive)
      count(4);
      return [a](Frame& f) {
        const double e = a[0](f);
        return a[e < 0 ? 1 : e == 0 ? 2 : 3](f);
      };
    }
    return call_defined(n, std::move(a));
  }
  Value call_defined(const std::string& n, std::vector<Value> a) {
    return [&function = library_.declare(n), a = std::move(a), n](Frame& f) {
      take_step(f);
      if (!function.defined) throw FunctionError(n + " is not evaluated", true);
      if (!function.body) {
        if (a.size() != 1) throw FunctionError(n + " takes one argument", false);
        return function.points.at(a[0](f));
      }
      if (a.size() != function.parameters)
        throw FunctionError(n + " takes " + std::to_string(function.parameters) +
                                " arguments, not " + std::to_string(a.size()),
                            false);
      if (f.depth > deepest) throw FunctionError(n + " calls itself without end", false);
      std::vector<double> given(a.size());
      for (std::size_t i = 0; i < a.size(); ++i) given[i] = a[i](f);
      std::copy(given.begin(), given.end(), function.variable.begin());
      Frame inner{&function.variable, f.time, 0, f.steps_left, f.depth + 1};
      if (!function.body(inner)) throw FunctionError(n + " returns no value", false);
      return inner.result;
    };
  }

  // statements
  Step block() {
    need("{");
    std::vector<Step> steps;
    while (!take("}")) {
      if (at_ >= text_.size()) fail("'}' is missing");
      steps.push_back(statement());
    }
    return [steps = std::move(steps)](Frame& f) {
      for (const Step& s : steps)
        if (s(f)) return true;
      return false;
    };
  }
  Step statement() {
    if (++depth_ > deepest) fail("it is nested too deeply");
    Step s = any_statement();
    --depth_;
    return [s = std::move(s)](Frame& f) {
      take_step(f);
      return s(f);
    };
  }
  Step returned() {
    Value v = expression();
    return [v = std::move(v)](Frame& f) { return f.result = v(f), true; };
  }
  Step any_statement() {
    if (next_is("{")) return block();
    if (take(";")) return [](Frame&) { return false; };
    if (take_type()) return declaration();
    if (take_word("return")) {
      Step s = returned();
      need(";");
      return s;
    }
    if (take_word("if")) return condition();
    if (take_word("while")) {
      need("(");
      Value until = expression();
      need(")");
      return loop(until, statement(), {});
    }
    if (take_word("for")) return counted_loop();
    Step s = assignment();
    need(";");
    return s;
  }
  Step declaration() {
    std::vector<Step> steps;
    do {
      const std::size_t slot = variable_named(word("a variable"), true);
      if (take("=")) {
        Value v = expression();
        steps.push_back([slot, v](Frame& f) { return (*f.variable)[slot] = v(f), false; });
      }
    } while (take(","));
    need(";");
    return [steps](Frame& f) {
      for (const Step& s : steps) s(f);
      return false;
    };
  }
  Step condition() {
    need("(");
    Value e = expression();
    need(")");
    Step yes = statement(), no;
    if (take_word("else")) no = statement();
    return [e, yes, no](Frame& f) { return e(f) != 0 ? yes(f) : no ? no(f) : false; };
  }
  static Step loop(Value until, Step body, Step after) {
    return [until, body, after](Frame& f) {
      while (until(f) != 0) {
        take_step(f);
        if (body(f)) return true;
        if (after) after(f);
      }
      return false;
    };
  }
  Step counted_loop() {
    need("(");
    Step first = assignment();
    need(";");
    Value until = expression();
    need(";");
    Step after = assignment();
    need(")");
    Step turns = loop(until, statement(), after);
    return [first, turns](Frame& f) { return first(f), turns(f); };
  }
  Step assignment() {
    const std::size_t slot = variable_named(word("a variable"), false);
    for (const char* twice : {"++", "--"})
      if (take(twice))
        return [slot, by = twice[0] == '+' ? 1.0 : -1.0](Frame& f) {
          return (*f.variable)[slot] += by, false;
        };
    for (const auto& level : operators)
      for (const Operator& o : level)
        if (std::string_view("+-*/").find(o.sign[0]) != std::string_view::npos &&
            take(std::string(o.sign) + "=")) {
          Value v = expression();
          return [slot, v, apply = o.apply](Frame& f) {
            double& x = (*f.variable)[slot];
            const double right = v(f);
            return x = apply(x, right), false;
          };
        }
    need("=");
    Value v = expression();
    return [slot, v](Frame& f) { return (*f.variable)[slot] = v(f), false; };
  }

  FunctionLibrary& library_;
  std::string_view text_;
  bool in_c_;
  std::size_t at_ = 0;
  int depth_ = 0, terms_ = 0;
  std::vector<std::string> names_;  // of variables, by their place
  std::vector<std::int64_t> curves_;
};

void FunctionLibrary::add(std::string_view source) {
  FunctionParser(*this, source, true).definition();
}

void FunctionLibrary::add(std::string_view name, Curve points) {
  std::string small(name);
  for (char& c : small) c = char(std::tolower(static_cast<unsigned char>(c)));
  Function& f = declare(small);
  if (f.defined) throw FunctionError("function " + small + " is defined twice", false);
  f.points = std::move(points);
  f.defined = true;
}

Expression FunctionLibrary::expression(std::string_view source) {
  return FunctionParser(*this, source, false).whole_expression();
}

}  // namespace fabrica
