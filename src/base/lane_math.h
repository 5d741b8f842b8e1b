#pragma once
// exp, log, expm1, log1p, pow, cbrt, sin, cos over any lane: one code of adds, multiplies and
// explicit fma for every width, so that the bits do not depend on the width or the C library.
//   exp x = 2^n e^r,          n = round(x / ln 2), |r| <= ln 2 / 2, Taylor series in r (1) log x =
//   k ln 2 + log(1+f), 1+f in [sqrt(1/2), sqrt(2)], s = f / (2+f),
//           log(1+f) = f - (f^2/2 - s (f^2/2 + R)),  R = 2 s^2/3 + 2 s^4/5 + ... (2)
//   sin, cos: x = q pi/2 + r with pi/2 in three parts (|x| < 1e4), Taylor series in r (3)
// Source: W. J. Cody and W. Waite, Software Manual for the Elementary Functions, 1980.
// Errors: about 1 unit in the last place; pow(x, y) grows with |y log x| / 8.
#include <cstring>
#include <limits>
#include <type_traits>

#include "base/lane.h"
#if !defined(__CUDACC__)
#include "base/pack.h"
#endif

namespace fabrica {

namespace lane_math {

template <class L>
concept Lane = requires {
  LaneTraits<L>::width;
};

template <class L>
using Bits = typename LaneTraits<L>::Int;

template <class L>
inline constexpr bool is_double = sizeof(ScalarOf<L>) == 8;

template <class L>
FABRICA_FN Bits<L> to_bits(const L& x) {
  Bits<L> b;
  std::memcpy(&b, &x, sizeof b);
  return b;
}
template <class L>
FABRICA_FN L from_bits(const Bits<L>& b) {
  L x;
  std::memcpy(&x, &b, sizeof x);
  return x;
}

template <class L>
inline constexpr int mantissa_bits = is_double<L> ? 52 : 23;
template <class L>
inline constexpr int exponent_bias = is_double<L> ? 1023 : 127;
// adding and subtracting this rounds to the nearest integer, which then stands in the low bits
template <class L>
inline constexpr double round_magic = is_double<L> ? 6755399441055744.0 : 12582912.0;

// nearest integer as a number and in n as an integer
template <class L>
FABRICA_FN L round_to_integer(const L& x, Bits<L>& n) {
  const L shifted = x + L(round_magic<L>);
  n = to_bits(shifted) - to_bits(L(round_magic<L>));
  return shifted - L(round_magic<L>);
}
// 2^n for a normal result
template <class L>
FABRICA_FN L power_of_two(const Bits<L>& n) {
  return from_bits<L>((n + exponent_bias<L>) << mantissa_bits<L>);
}

constexpr double inverse_factorial(int n) {
  double f = 1;
  for (int i = 2; i <= n; ++i) f *= i;
  return 1 / f;
}

// (ln 2)_high has trailing zeros so that k (ln 2)_high is exact
template <class L>
inline constexpr double ln2_high = is_double<L> ? 0x1.62e42feep-1 : 0x1.62ep-1;
template <class L>
inline constexpr double ln2_low = is_double<L> ? 0x1.a39ef35793c76p-33 : 0x1.0bfbe8e7bcd5ep-15;

// e^(x + tail), tail << 1
template <class L>
FABRICA_FN L exp_sum(const L& argument, const L& tail) {
  constexpr int degree = is_double<L> ? 13 : 7;
  constexpr double low = is_double<L> ? -746.0 : -104.5, high = is_double<L> ? 709.9 : 88.8;
  const L x = clamp(argument, L(low), L(high));
  Bits<L> n;
  const L k = round_to_integer(x * L(1.4426950408889634), n);
  const L r = fma(k, L(-ln2_low<L>), fma(k, L(-ln2_high<L>), x)) + tail;
  L p = L(inverse_factorial(degree));
  for (int i = degree - 1; i >= 2; --i) p = fma(p, r, L(inverse_factorial(i)));
  const L e = L(1.0) + fma(r * r, p, r);
  // in two factors, so that results that are subnormal or close to overflow stand
  const Bits<L> half = n >> 1;
  const L y = e * power_of_two<L>(half) * power_of_two<L>(n - half);
  const L infinity = L(std::numeric_limits<ScalarOf<L>>::infinity());
  const L bounded = select(argument > L(high), infinity, select(argument < L(low), L(0.0), y));
  return select(argument == argument, bounded, argument);
}

// log x = high + low with low << high; x positive
template <class L>
FABRICA_FN L log_parts(const L& argument, L& low) {
  // subnormal numbers are brought into range first
  constexpr double lift = is_double<L> ? 0x1p54 : 0x1p25;
  constexpr double shift = is_double<L> ? 54 : 25;
  const auto tiny = argument < L(std::numeric_limits<ScalarOf<L>>::min());
  const L x = select(tiny, argument * L(lift), argument);
  const Bits<L> one = to_bits(L(1.0)), root_half = to_bits(L(0.70710678118654752));
  const Bits<L> raised = to_bits(x) + (one - root_half);
  const Bits<L> exponent = (raised >> mantissa_bits<L>)-exponent_bias<L>;
  const auto mask = (typename std::conditional<is_double<L>, std::int64_t, std::int32_t>::type(1)
                     << mantissa_bits<L>)-1;
  const L m = from_bits<L>((raised & mask) + root_half);
  const L k = from_bits<L>(exponent + to_bits(L(round_magic<L>))) - L(round_magic<L>) -
              select(tiny, L(shift), L(0.0));

  const L f = m - L(1.0);
  const L s = f / (L(2.0) + f), z = s * s;
  constexpr int terms = is_double<L> ? 11 : 5;
  L R = L(2.0 / (2 * terms + 1));
  for (int i = terms - 1; i >= 1; --i) R = fma(R, z, L(2.0 / (2 * i + 1)));
  const L half_square = L(0.5) * f * f;
  const L rest = fma(k, L(ln2_low<L>), -(half_square - s * fma(R, z, half_square)));
  // k ln2_high + f is summed without error, then the rest is added
  const L a = k * L(ln2_high<L>);
  const L sum = a + f;
  const L back = sum - a;
  const L error = (a - (sum - back)) + (f - back);
  const L small = error + rest;
  const L high = sum + small;
  low = small - (high - sum);
  return high;
}

template <class L>
struct SineCosine {
  L sine, cosine;
};

template <class L>
FABRICA_FN SineCosine<L> sine_cosine(const L& x) {
  constexpr double first = is_double<L> ? 0x1.921fb544p+0 : 0x1.92p+0;
  constexpr double second = is_double<L> ? 0x1.0b4611a6p-34 : 0x1.fb4p-12;
  constexpr double third = is_double<L> ? 0x1.3198a2e037073p-69 : 0x1.4442d184p-24;
  Bits<L> n;
  const L k = round_to_integer(x * L(0.63661977236758134), n);
  const L r = fma(k, L(-third), fma(k, L(-second), fma(k, L(-first), x)));
  const L z = r * r;
  constexpr int last = is_double<L> ? 17 : 9;
  L s = L(((last / 2) % 2 ? -1 : 1) * inverse_factorial(last));
  for (int i = last - 2; i >= 3; i -= 2)
    s = fma(s, z, L(((i / 2) % 2 ? -1 : 1) * inverse_factorial(i)));
  const L sine = fma(r * z, s, r);
  L c = L((((last + 1) / 2) % 2 ? -1 : 1) * inverse_factorial(last + 1));
  for (int i = last - 1; i >= 4; i -= 2)
    c = fma(c, z, L(((i / 2) % 2 ? -1 : 1) * inverse_factorial(i)));
  const L cosine = L(1.0) + fma(z * z, c, L(-0.5) * z);
  // quadrant: k mod 4, computed in numbers
  Bits<L> unused;
  const L quarter = k - L(4.0) * round_to_integer(k * L(0.25), unused);  // -2, -1, 0, 1, 2
  const auto odd = abs(quarter) == L(1.0);
  const auto half_turn = abs(quarter) == L(2.0);
  const L a = select(odd, cosine, sine), b = select(odd, sine, cosine);
  return {select(half_turn | (quarter == L(-1.0)), -a, a),
          select(half_turn | (quarter == L(1.0)), -b, b)};
}

}  // namespace lane_math

// e^x; infinity above and 0 below the range of the type
template <lane_math::Lane L>
FABRICA_FN L exp(const L& x) {
  return lane_math::exp_sum(x, L(0.0));
}

// natural logarithm; -infinity at 0, not a number below
template <lane_math::Lane L>
FABRICA_FN L log(const L& x) {
  using Limits = std::numeric_limits<ScalarOf<L>>;
  L low;
  const L y = lane_math::log_parts(x, low);
  const L infinity = L(Limits::infinity());
  const L positive = select(x < infinity, y, x);
  return select(x > L(0.0), positive, select(x == L(0.0), -infinity, L(Limits::quiet_NaN())));
}

// log(1 + x), accurate for small x
template <lane_math::Lane L>
FABRICA_FN L log1p(const L& x) {
  // the rounding of u = 1 + x is undone by the factor x / (u - 1)
  const L u = L(1.0) + x, d = u - L(1.0);
  const auto same = d == L(0.0);
  return select(same, x, log(u) * (x / select(same, L(1.0), d)));
}

// e^x - 1, accurate for small x
template <lane_math::Lane L>
FABRICA_FN L expm1(const L& x) {
  constexpr int degree = lane_math::is_double<L> ? 15 : 8;
  const L r = clamp(x, L(-0.5), L(0.5));
  L p = L(lane_math::inverse_factorial(degree));
  for (int i = degree - 1; i >= 2; --i) p = fma(p, r, L(lane_math::inverse_factorial(i)));
  return select(abs(x) < L(0.5), fma(r * r, p, r), exp(x) - L(1.0));
}

// x^y for x >= 0; 0^y = 0 for y > 0, 1 for y = 0
template <lane_math::Lane L>
FABRICA_FN L pow(const L& x, const L& y) {
  L low;
  const L safe = select(x > L(0.0), x, L(1.0));
  const L high = lane_math::log_parts(safe, low);
  const L product = y * high;
  const L tail = fma(y, low, fma(y, high, -product));
  const L zero = select(y == L(0.0), L(1.0), L(0.0));
  return select(x > L(0.0), lane_math::exp_sum(product, tail), zero);
}

// real cube root, odd in x
template <lane_math::Lane L>
FABRICA_FN L cbrt(const L& x) {
  const L a = abs(x);
  const L safe = select(a > L(0.0), a, L(1.0));
  L y = exp(log(safe) * L(1.0 / 3.0));
  // one Newton pass removes the error of the exponential
  y = fma(L(-1.0 / 3.0), y - safe / (y * y), y);
  y = select(a > L(0.0), y, L(0.0));
  return select(x < L(0.0), -y, y);
}

template <lane_math::Lane L>
FABRICA_FN L sin(const L& x) {
  return lane_math::sine_cosine(x).sine;
}
template <lane_math::Lane L>
FABRICA_FN L cos(const L& x) {
  return lane_math::sine_cosine(x).cosine;
}

}  // namespace fabrica
