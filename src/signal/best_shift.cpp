// Correlation of two curves at every shift. With r = reference, s = signal, m the shift, and sums
// over the overlap:
//   raw      K(m) = S(r s) / sqrt(S(r r) S(s s))
//   centred  rho(m) = (S(r s) - S(r) S(s) / c) / sqrt((S(r r) - S(r)^2 / c) (S(s s) - S(s)^2 / c)),
//   c = number of terms
// S(r s) for all m comes from one Fourier transform of twice the length, the rest from running
// sums.
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/FFT>

#include "signal/rating_pair.h"

namespace fabrica {
namespace {

constexpr double equal_to_rounding = 1e-12;

// products[m + n - 1] = sum over i of a[i + m] b[i]
std::vector<double> sliding_products(const std::vector<double>& a, const std::vector<double>& b) {
  const std::size_t n = a.size();
  std::size_t length = 1;
  while (length < 2 * n) length *= 2;
  std::vector<double> padded_a(length, 0.0), padded_b(length, 0.0), product;
  std::copy(a.begin(), a.end(), padded_a.begin());
  std::copy(b.begin(), b.end(), padded_b.begin());
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> fa, fb;
  fft.fwd(fa, padded_a);
  fft.fwd(fb, padded_b);
  for (std::size_t k = 0; k < length; ++k) fa[k] *= std::conj(fb[k]);
  fft.inv(product, fa);
  std::vector<double> out(2 * n - 1);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = product[(i + length - (n - 1)) % length];
  return out;
}

// sums of y and y^2 over the first i samples
struct RunningSums {
  std::vector<double> y, yy;
  explicit RunningSums(const std::vector<double>& v) : y(v.size() + 1, 0.0), yy(v.size() + 1, 0.0) {
    for (std::size_t i = 0; i < v.size(); ++i) {
      y[i + 1] = y[i] + v[i];
      yy[i + 1] = yy[i] + v[i] * v[i];
    }
  }
};

}  // namespace

BestShift best_shift(const std::vector<double>& reference, const std::vector<double>& signal,
                     long most, bool centred) {
  const long n = long(reference.size());
  std::vector<double> r = reference, s = signal;
  if (centred) {  // a common mean changes nothing but the rounding
    double mean_r = 0, mean_s = 0;
    for (long i = 0; i < n; ++i) mean_r += r[i] / double(n), mean_s += s[i] / double(n);
    for (long i = 0; i < n; ++i) r[i] -= mean_r, s[i] -= mean_s;
  }
  const std::vector<double> products = sliding_products(r, s);
  const RunningSums of_r(r), of_s(s);
  // differences of sums below this part of the whole are rounding
  const double tiny_r = 1e-14 * of_r.yy[n], tiny_s = 1e-14 * of_s.yy[n];

  auto correlation = [&](long m) {
    const long r0 = std::max(0L, m), s0 = std::max(0L, -m), count = n - std::abs(m);
    double rr = of_r.yy[r0 + count] - of_r.yy[r0], ss = of_s.yy[s0 + count] - of_s.yy[s0];
    double rs = products[m + n - 1];
    if (centred) {
      const double sum_r = of_r.y[r0 + count] - of_r.y[r0], sum_s = of_s.y[s0 + count] - of_s.y[s0];
      rr -= sum_r * sum_r / double(count), ss -= sum_s * sum_s / double(count),
          rs -= sum_r * sum_s / double(count);
    }
    return rr <= tiny_r || ss <= tiny_s ? 0.0 : rs / std::sqrt(rr * ss);
  };

  BestShift best{0, correlation(0)};
  for (long m = 1; m <= most; ++m)
    for (const long shift : {-m, m})
      if (const double value = correlation(shift); value > best.value + equal_to_rounding)
        best = {shift, value};
  return best;
}

}  // namespace fabrica
