#include "base/lane_math.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

// inside the namespace, where the names hide those of the C library
namespace fabrica {
namespace {

// distance in units of the last place of the reference
template <class T>
double ulps(T value, double reference) {
  const T r = T(reference);
  const double unit =
      double(std::nextafter(std::abs(r), std::numeric_limits<T>::infinity())) - double(std::abs(r));
  return std::abs(double(value) - reference) / unit;
}

template <class T, class F, class G>
double worst(F f, G reference, double low, double high, bool logarithmic = false) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  double w = 0;
  for (int i = 0; i < 100000; ++i) {
    const double u = uniform(random);
    const T x = T(logarithmic ? low * std::pow(high / low, u) : low + (high - low) * u);
    w = std::max(w, ulps<T>(f(x), double(reference((long double)(x)))));
  }
  return w;
}

template <class T>
void check_accuracy() {
  const double big = sizeof(T) == 8 ? 700 : 87;
  auto e = [](T x) { return exp(x); };
  auto l = [](T x) { return log(x); };
  CHECK(worst<T>(
            e, [](long double x) { return std::exp(x); }, -big, big) < 2);
  CHECK(worst<T>(
            e, [](long double x) { return std::exp(x); }, -1, 1) < 2);
  CHECK(worst<T>(
            l, [](long double x) { return std::log(x); }, 0.5, 2) < 2);
  CHECK(worst<T>(
            l, [](long double x) { return std::log(x); }, 1e-37, 1e37, true) < 2);
  CHECK(worst<T>([](T x) { return cbrt(x); }, [](long double x) { return std::cbrt(x); }, 1e-30,
                 1e30, true) < 2);
  CHECK(worst<T>([](T x) { return cbrt(x); }, [](long double x) { return std::cbrt(x); }, -8,
                 -0.1) < 2);
  CHECK(worst<T>([](T x) { return pow(x, T(0.2)); },
                 [](long double x) { return std::pow(x, (long double)(T(0.2))); }, 1e-6, 1e6,
                 true) < 2);
  CHECK(worst<T>([](T x) { return pow(x, T(5)); }, [](long double x) { return std::pow(x, 5.0L); },
                 0.3, 3) < 4);
  auto e1 = [](T x) { return expm1(x); };
  auto l1 = [](T x) { return log1p(x); };
  CHECK(worst<T>(
            e1, [](long double x) { return std::expm1(x); }, -2, 2) < 3);
  CHECK(worst<T>(
            l1, [](long double x) { return std::log1p(x); }, -0.5, 1) < 3);
  CHECK(worst<T>(
            e1, [](long double x) { return std::expm1(x); }, 1e-9, 1e-2, true) < 3);
  CHECK(worst<T>(
            l1, [](long double x) { return std::log1p(x); }, 1e-9, 1e-2, true) < 3);
  // near the zeros of sine and cosine the absolute error counts
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(-100, 100);
  const double unit = std::numeric_limits<T>::epsilon();
  double w = 0;
  for (int i = 0; i < 100000; ++i) {
    const T x = T(angle(random));
    w = std::max(w, std::abs(double(sin(x)) - std::sin(double(x))) / unit);
    w = std::max(w, std::abs(double(cos(x)) - std::cos(double(x))) / unit);
  }
  CHECK(w < 1);
}

TEST_CASE("lane math agrees with the C library") {
  check_accuracy<float>();
  check_accuracy<double>();
}

TEST_CASE("lane math at the ends of the range") {
  const float infinity = std::numeric_limits<float>::infinity();
  CHECK(exp(0.0f) == 1.0f);
  CHECK(exp(1000.0f) == infinity);
  CHECK(exp(-1000.0f) == 0.0f);
  CHECK(log(1.0) == 0.0);
  CHECK(log(0.0f) == -infinity);
  CHECK(std::isnan(log(-1.0f)));
  CHECK(pow(0.0, 0.5) == 0.0);
  CHECK(pow(3.0, 0.0) == 1.0);
  CHECK(cbrt(0.0f) == 0.0f);
  CHECK(ulps(log(1e-320), std::log(1e-320)) < 2);
  CHECK(ulps(exp(-740.0), std::exp(-740.0)) < 2);
  CHECK(sin(0.0) == 0.0);
  CHECK(cos(0.0) == 1.0);
}

template <class T, int W>
void check_width() {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-20, 20);
  using P = Pack<T, W>;
  for (int k = 0; k < 2000; ++k) {
    P x;
    for (int i = 0; i < W; ++i) set(x, i, T(uniform(random)));
    const P e = exp(x), l = log(abs(x)), p = pow(abs(x), P(0.2)), c = cbrt(x), s = sin(x),
            o = cos(x);
    bool same = true;
    for (int i = 0; i < W; ++i) {
      const T a = get(x, i), b = std::abs(a);
      same = same && get(e, i) == exp(a) && get(l, i) == log(b) && get(p, i) == pow(b, T(0.2)) &&
             get(c, i) == cbrt(a) && get(s, i) == sin(a) && get(o, i) == cos(a);
    }
    REQUIRE(same);
  }
}

TEST_CASE("lane math gives the same bits for every width") {
  check_width<float, 8>();
  check_width<float, 16>();
  check_width<double, 4>();
  check_width<double, 8>();
}

}  // namespace
}  // namespace fabrica
