#include "model/function.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace fabrica;

namespace {

FunctionLibrary library() {
  return FunctionLibrary([](std::int64_t id, double time) -> double {
    if (id == 7) return 2 * time;
    throw FunctionError("there is no curve", true);
  });
}

double value(FunctionLibrary& lib, const char* text, double time = 0) {
  std::vector<double> none;
  long steps = 100'000;
  Frame frame{&none, time, 0, &steps, 0};
  return lib.expression(text).value(frame);
}
double value(const char* text, double time = 0) {
  FunctionLibrary lib = library();
  return value(lib, text, time);
}

// "unknown: ..." or "wrong: ..."
std::string error(const char* text, const char* source = nullptr) {
  FunctionLibrary lib = library();
  try {
    if (source) lib.add(source);
    value(lib, text);
  } catch (const FunctionError& e) {
    return (e.unknown() ? "unknown: " : "wrong: ") + std::string(e.what());
  }
  return "";
}

}  // namespace

TEST_CASE("expressions have the values of their arithmetic") {
  CHECK(value("1+2*3-4/8") == 6.5);
  CHECK(value("-2**2") == -4);
  CHECK(value("2**-1 * 2**3**2") == 256);  // from the right: 3**2 first
  CHECK(value("(1 - 4) - 5 - -6") == -2);
  CHECK(value("1.5e2 + .5D1 + 2.E-1") == 155.2);
  CHECK(value("MAX(3, min(5, 4)) + ABS(-1)") == 5);
  CHECK(value("IF(-1, 10, 20, 30) + IF(0, 1, 2, 3) + if(9, 0, 0, 100)") == 112);
  CHECK(value("sin(30*DTOR) + PI") == doctest::Approx(0.5 + std::numbers::pi).epsilon(1e-15));
  CHECK(value("mod(7, 4) + sign(3, -1) + anint(2.6) + aint(-2.6)") == 1);
  CHECK(value("TIME * LC7\n + 1", 3) == 19);
  CHECK(value("1 < 2 && !(3 >= 4) || 0 ? 5 : 6") == 5);
}

TEST_CASE("functions in C: variables, branches and loops") {
  FunctionLibrary lib = library();
  lib.add(
      "float factorial(float n) { float r = 1, i; for (i = 2; i <= n; i++) r *= i; return r; }");
  lib.add(
      "double Collatz(double n)\n{ int count; /* steps to 1 */ count = 0;\n while (n != 1) { "
      "if (fmod(n, 2) == 0) n = n/2; else { n = 3*n + 1; } count += 1; } // done\n return count; "
      "}");
  lib.add("float twice(float x){ return factorial(x) + factorial(x); };");
  CHECK(value(lib, "factorial(6)") == 720);
  CHECK(value(lib, "COLLATZ(27)") == 111);
  CHECK(value(lib, "twice(factorial(3)) - 1.0") == 1439);
  lib.add("area(a, b) = a*b/2 \n");
  CHECK(value(lib, "area(3, 5)") == 7.5);
  Curve points;
  points.x = {0, 1, 3}, points.y = {0, 10, 14};
  lib.add("Stim", points);
  CHECK(value(lib, "stim(TIME) + STIM(-5) + stim(9)", 2) == 26);
}

TEST_CASE("a variable keeps its value from call to call until it is reset") {
  FunctionLibrary lib = library();
  lib.add("float count(float by) { float n, m = 5; n = n + by; m = m + 1; return 100*n + m; }");
  CHECK(value(lib, "count(1)") == 106);
  CHECK(value(lib, "count(1) + 0*count(2)") == 206);
  CHECK(value(lib, "count(1)") == 506);
  lib.reset();
  CHECK(value(lib, "count(1)") == 106);
}

// Two filters of time constant T in series under a unit step, as of muscle activation:
//   a(t) = 1 - (1 + t/T) exp(-t/T); Euler's method with the step of the table has an error below
//   its bound
TEST_CASE("a filter with memory follows the solution of its differential equation") {
  FunctionLibrary lib = library();
  lib.add(
      "float ode(float u,float tne,float tna1,float tna2, float tt)\n{\nfloat na,ne,t,tts,dt;\n"
      "dt=tt-tts;\ntts=tt;\nne=ne+dt*(u-ne)/tne;\nt=tna1;\nif(ne<na) t=tna2;\n"
      "na=na+dt*(ne-na)/t;\nreturn na;\n}\n");
  const Curve c = lib.tabulated(lib.expression("ode(1,0.04,0.04,0.08,TIME)").value, 2);
  CHECK(c.x.front() == 0);
  CHECK(c.x.back() == 2);
  CHECK(c.x.size() < 2000);
  for (double t = 0; t <= 2; t += 0.013)
    CHECK(std::abs(c.at(t) - (1 - (1 + t / 0.04) * std::exp(-t / 0.04))) < 2e-3);
}

// what is left out lies within 1e-6 of the range of the lines; between samples sin deviates by
// h^2/8
TEST_CASE("a table has as many points as its shape needs") {
  FunctionLibrary lib = library();
  const Curve line = lib.tabulated(lib.expression("3*TIME - 1").value, 5);
  CHECK(line.x.size() == 2);
  const Curve wave = lib.tabulated(lib.expression("SIN(TIME)").value, 2 * std::numbers::pi);
  CHECK(wave.x.size() < 4000);
  for (double t = 0; t < 6.28; t += 0.01) CHECK(std::abs(wave.at(t) - std::sin(t)) < 3e-6);
}

TEST_CASE("what is not evaluated is told from what is wrong") {
  CHECK(error("MAX(SENSORD(7)-3, 0)") == "unknown: sensord is not evaluated");
  CHECK(error("DX1 + 2") == "unknown: dx1 is not evaluated");
  CHECK(error("LC8*2") == "unknown: there is no curve");
  CHECK(error("1 +") == "wrong: a number or a name is missing before ''");
  CHECK(error("(1 + 2") == "wrong: ')' is missing before ''");
  CHECK(error("1 2") == "wrong: '2' is not understood");
  CHECK(error("1.2.3") == "wrong: '1.2.3' is not a number");
  CHECK(error("SIN(1, 2)") == "wrong: sin takes 1 arguments, not 2");
  CHECK(error("f(1)", "float f(float x) { return y; }") == "unknown: y is not evaluated");
  CHECK(error("f(1)", "float f(float x) { y = 1; return x; }") == "unknown: y is not declared");
  CHECK(error("f(1)", "float f(float x) { float x; return x; }") == "wrong: x is declared twice");
  CHECK(error("f(1)", "float f(float x) { x = 2; }") == "wrong: f returns no value");
  CHECK(error("f(1)", "float f(float x) { while (1) x = 2; return x; }") ==
        "wrong: it does not come to an end");
  CHECK(error("f(1)", "float f(float x) { return f(x); }") == "wrong: f calls itself without end");
  CHECK(error("f(1, 2)", "float f(float x) { return x; }") == "wrong: f takes 1 arguments, not 2");
  CHECK(error("f(1)", "float f(float x) { return x;") == "wrong: '}' is missing");
  CHECK(error(std::string(5000, '(').c_str()) == "wrong: it is nested too deeply");
  CHECK(error(std::string(5000, '-').c_str()) == "wrong: it is nested too deeply");
  std::string sum = "1";
  for (int i = 0; i < 5000; ++i) sum += "+1";
  CHECK(error(sum.c_str()) == "wrong: it is too long");
  FunctionLibrary lib = library();
  CHECK_THROWS_WITH_AS(lib.tabulated(lib.expression("1/(TIME - 1)").value, 2),
                       doctest::Contains("is not a number"), FunctionError);
}
