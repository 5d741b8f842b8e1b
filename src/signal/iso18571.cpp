#include "signal/iso18571.h"

#include <algorithm>
#include <cmath>

#include "signal/time_warping.h"

namespace fabrica {
namespace {

// 1 without error, 0 from `most` on, ((most - error) / most)^exponent between
double score(double error, double most, double exponent) {
  return error >= most ? 0 : std::pow((most - error) / most, exponent);
}

std::vector<double> derivative(Samples y, double step) {
  const std::size_t n = y.size();
  std::vector<double> d(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1, after = i + 1 == n ? i : i + 1;
    d[i] = (y[after] - y[before]) / (double(after - before) * step);
  }
  return d;
}

// mean of nine samples, of 1, 3, 5, 7 at the ends
std::vector<double> smoothed(const std::vector<double>& y) {
  const std::size_t n = y.size();
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t reach = std::min({std::size_t(4), i, n - 1 - i});
    double sum = 0;
    for (std::size_t k = i - reach; k <= i + reach; ++k) sum += y[k];
    out[i] = sum / double(2 * reach + 1);
  }
  return out;
}

double slope_difference(Samples signal, Samples reference, double step) {
  const std::vector<double> s = smoothed(derivative(signal, step)),
                            r = smoothed(derivative(reference, step));
  double difference = 0, sum = 0;
  for (std::size_t i = 0; i < s.size(); ++i)
    difference += std::abs(s[i] - r[i]), sum += std::abs(r[i]);
  return sum > 0 ? difference / sum : difference > 0 ? 1e300 : 0;
}

// the two curves over their overlap at a shift
RatingPair aligned(const RatingPair& p, long shift) {
  const std::size_t r0 = std::max(0L, shift), s0 = std::max(0L, -shift);
  const std::size_t count = p.x.size() - std::size_t(std::abs(shift));
  RatingPair out;
  out.step = p.step;
  out.reference = p.reference.subspan(r0, count);
  out.signal = p.signal.subspan(s0, count);
  return out;
}

// linear interpolation to the least step of the standard, where sampling is finer
Signal thinned(const Signal& s, double least_step) {
  return least_step > 0 && sample_interval(s) < 0.999 * least_step ? resampled(s, least_step) : s;
}

}  // namespace

Iso18571Rating iso18571(const Signal& reference, const Signal& signal, const Iso18571Options& o) {
  if (o.least_step > 0 && sample_interval(reference) < 0.999 * o.least_step) {
    rating_pair(reference, signal, o.t_min, o.t_max);  // errors speak of what was given
    Iso18571Options once = o;
    once.least_step = 0;
    Signal alike = signal;
    alike.x = reference.x;  // same times, perhaps in another unit
    alike.x_unit = reference.x_unit;
    return iso18571(thinned(reference, o.least_step), thinned(alike, o.least_step), once);
  }
  const RatingPair pair = rating_pair(reference, signal, o.t_min, o.t_max);
  const double norm = reference_norm(pair.reference);
  const CorridorWidths widths = corridor_widths(pair, norm, o.a_0, o.b_0);
  const double most = (1 - o.init_min) * double(pair.x.size());
  const BestShift best =
      best_shift(pair.reference, pair.signal, long(std::floor(most + 1e-9)), true);
  const RatingPair match = aligned(pair, best.shift);

  Iso18571Rating r;
  r.t_min = pair.x.front(), r.t_max = pair.x.back(), r.norm = norm;
  r.shift = double(best.shift) * pair.step, r.largest_correlation = best.value;
  r.corridor = corridor_score(pair, widths, o.k_z);
  r.phase = score(std::abs(double(best.shift)), most, o.k_p);
  const WarpedSums sums = warped_sums(match.signal, match.reference,
                                      long(std::ceil(o.window * double(match.signal.size()))));
  r.magnitude_error = sums.reference > 0    ? sums.difference / sums.reference
                      : sums.difference > 0 ? 1e300
                                            : 0;
  r.magnitude = score(r.magnitude_error, o.eps_m, o.k_m);
  r.slope_error = slope_difference(match.signal, match.reference, pair.step);
  r.slope = score(r.slope_error, o.e_s, o.k_s);
  r.total = o.w_z * r.corridor + o.w_p * r.phase + o.w_m * r.magnitude + o.w_s * r.slope;
  if (o.edges) r.edges = corridor_edges(pair, widths);
  return r;
}

std::string iso18571_word(double total) {
  return total > 0.94 ? "Excellent" : total > 0.80 ? "Good" : total > 0.58 ? "Fair" : "Poor";
}

}  // namespace fabrica
