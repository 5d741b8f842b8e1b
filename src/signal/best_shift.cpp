// Correlation of two curves at every shift. With r = reference, s = signal, m the shift, and sums
// over the overlap:
//   raw      K(m) = S(r s) / sqrt(S(r r) S(s s))
//   centred  rho(m) = (S(r s) - S(r) S(s) / c) / sqrt((S(r r) - S(r)^2 / c) (S(s s) - S(s)^2 / c)),
//   c = number of terms
// S(r s) for all |m| <= M comes from one Fourier transform of length n + M or a little more, beyond
// which nothing wraps around; the other sums lose one term at each end as m grows.
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/FFT>

#include "signal/rating_pair.h"

namespace fabrica {
namespace {

constexpr double equal_to_rounding = 1e-12;

// the least multiple of 4 that is at least n and has no other prime factors than 2, 3, 5
std::size_t fast_length(std::size_t n) {
  for (std::size_t length = (n + 3) / 4 * 4;; length += 4) {
    std::size_t rest = length;
    for (const std::size_t prime : {2, 3, 5})
      while (rest % prime == 0) rest /= prime;
    if (rest == 1) return length;
  }
}

// products[m], and for m < 0 products[m + their number], = sum over i of a[i + m] b[i], |m| <= most
std::vector<double> sliding_products(std::vector<double> a, std::vector<double> b, long most) {
  const std::size_t length = fast_length(a.size() + std::size_t(most) + 1);
  a.resize(length), b.resize(length);
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> fa, fb;
  fft.fwd(fa, a);
  fft.fwd(fb, b);
  for (std::size_t k = 0; k < fa.size(); ++k) fa[k] *= std::conj(fb[k]);
  fft.inv(a, fa, long(length));
  return a;
}

// a curve less `mean`, with room to be made as long as a transform
std::vector<double> less(Samples y, double mean, long most) {
  std::vector<double> out;
  out.reserve(fast_length(y.size() + std::size_t(most) + 1));
  for (const double v : y) out.push_back(v - mean);
  return out;
}

double mean_of(Samples y) {
  double mean = 0;
  for (const double v : y) mean += v / double(y.size());
  return mean;
}

// sums of y and y^2 over an overlap that loses samples
struct Sums {
  double y = 0, yy = 0;
  void lose(double v) { y -= v, yy -= v * v; }
};
Sums sums_of(Samples y, double mean) {
  Sums s;
  for (const double v : y) s.y += v - mean, s.yy += (v - mean) * (v - mean);
  return s;
}

// correlation over `count` samples; sums of squares below `tiny` of the whole are rounding
struct Correlation {
  bool centred;
  double tiny_r, tiny_s;
  double operator()(double rs, Sums r, Sums s, double count) const {
    if (centred) r.yy -= r.y * r.y / count, s.yy -= s.y * s.y / count, rs -= r.y * s.y / count;
    return r.yy <= tiny_r || s.yy <= tiny_s ? 0.0 : rs / std::sqrt(r.yy * s.yy);
  }
};

}  // namespace

BestShift best_shift(Samples reference, Samples signal, long most, bool centred) {
  const long n = long(reference.size());
  most = std::min(most, n - 1);
  // a common mean changes nothing but the rounding
  const double mean_r = centred ? mean_of(reference) : 0, mean_s = centred ? mean_of(signal) : 0;
  const std::vector<double> products =
      sliding_products(less(reference, mean_r, most), less(signal, mean_s, most), most);
  const long length = long(products.size());
  // over the overlap: for m > 0 the reference loses its start and the signal its end
  Sums later_r = sums_of(reference, mean_r), earlier_s = sums_of(signal, mean_s);
  Sums earlier_r = later_r, later_s = earlier_s;
  const Correlation correlation{centred, 1e-14 * later_r.yy, 1e-14 * later_s.yy};

  BestShift best{0, correlation(products[0], later_r, earlier_s, double(n))};
  auto compete = [&](long shift, double value) {
    if (value > best.value + equal_to_rounding) best = {shift, value};
  };
  for (long m = 1; m <= most; ++m) {
    earlier_r.lose(reference[n - m] - mean_r), later_s.lose(signal[m - 1] - mean_s);
    later_r.lose(reference[m - 1] - mean_r), earlier_s.lose(signal[n - m] - mean_s);
    compete(-m, correlation(products[length - m], earlier_r, later_s, double(n - m)));
    compete(m, correlation(products[m], later_r, earlier_s, double(n - m)));
  }
  return best;
}

}  // namespace fabrica
