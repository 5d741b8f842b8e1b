#include "signal/cora.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fabrica {
namespace {

// Where the reference is not small: from its first sample above A_THRES Y to its last above B_THRES
// Y, longer by A_EVAL at both ends; the end comes forward while the reference stays within
// B_DELTA_END Y of its last value.
std::pair<double, double> automatic_interval(const Signal& reference, const CoraOptions& o) {
  check(reference);
  const double norm = reference_norm(reference.y);
  const std::vector<double>& y = reference.y;
  const std::size_t n = y.size();
  std::size_t first = 0, last = n - 1;
  while (first < n && std::abs(y[first]) < o.a_threshold * norm) ++first;
  while (last > first && std::abs(y[last]) < o.b_threshold * norm) --last;
  const double margin = o.a_evaluation * (reference.x[last] - reference.x[first]);
  const double low = std::max(reference.x[first] - margin, reference.x.front());
  double high = std::min(reference.x[last] + margin, reference.x.back());
  std::size_t end = std::size_t(std::upper_bound(reference.x.begin(), reference.x.end(), high) -
                                reference.x.begin()) -
                    1;
  if (o.b_delta_end > 0) {
    const double level = y[end];
    std::size_t i = end;
    while (i > first && std::abs(y[i - 1] - level) <= o.b_delta_end * norm) --i;
    if (i > first) end = i, high = reference.x[end];
  }
  return {low, high};
}

// sizes of the two curves over the overlap at a shift
double size_part(const RatingPair& p, long shift, double exponent) {
  const long n = long(p.reference.size());
  double reference = 0, signal = 0;
  for (long i = std::max(0L, -shift); i < n && i + shift < n; ++i) {
    reference += p.reference[i + shift] * p.reference[i + shift];
    signal += p.signal[i] * p.signal[i];
  }
  const double larger = std::max(reference, signal);
  return larger == 0 ? 0 : std::pow(std::min(reference, signal) / larger, exponent);
}

double phase_part(double shift, double interval, const CoraOptions& o) {
  const double low = o.d_min * interval, high = o.d_max * interval, distance = std::abs(shift);
  if (distance <= low) return 1;
  if (distance >= high) return 0;
  return std::pow((high - distance) / (high - low), o.k_p);
}

}  // namespace

double cora_correlation(double progression, double size, double phase, const CoraOptions& o) {
  return o.g_v * progression + o.g_g * size + o.g_p * phase;
}
double cora_total(double corridor, double correlation, const CoraOptions& o) {
  return o.g_1 * corridor + o.g_2 * correlation;
}

double cora_combined(const std::vector<double>& totals, const std::vector<double>& weights,
                     bool normalise) {
  if (totals.empty() || totals.size() != weights.size())
    throw SignalError("ragged-signal",
                      fmt::format("{} ratings and {} weights", totals.size(), weights.size()),
                      "Give one weight for each rating");
  double sum = 0, all = 0;
  for (std::size_t i = 0; i < totals.size(); ++i) sum += weights[i] * totals[i], all += weights[i];
  if (normalise && !(all > 0))
    throw SignalError("empty-weights", "the weights sum to zero", "Give a positive weight");
  return normalise ? sum / all : sum;
}

CoraRating cora(const Signal& reference, const Signal& signal, const CoraOptions& o,
                const std::vector<double>& deviation) {
  std::optional<double> low = o.t_min, high = o.t_max;
  if (!low || !high) {
    const auto [first, last] = automatic_interval(reference, o);
    low = low.value_or(first), high = high.value_or(last);
  }
  const RatingPair pair = rating_pair(reference, signal, low, high, deviation);
  const double norm =
      std::max(o.y_norm ? *o.y_norm : reference_norm(pair.reference), o.min_norm * o.group_norm);
  const CorridorWidths widths = corridor_widths(pair, norm, o.a_0, o.b_0, o.a_sigma, o.b_sigma);

  const double steps = double(pair.x.size() - 1);
  const BestShift best = best_shift(pair.reference, pair.signal,
                                    long(std::floor((1 - o.int_min) * steps + 1e-9)), false);

  CoraRating r;
  r.t_min = pair.x.front(), r.t_max = pair.x.back(), r.y_norm = norm;
  r.shift = double(best.shift) * pair.step, r.largest_k = best.value;
  r.corridor = corridor_score(pair, widths, o.k);
  r.progression = std::pow(0.5 * (best.value + 1), o.k_v);
  r.size = size_part(pair, best.shift, o.k_g);
  r.phase = phase_part(r.shift, pair.step * steps, o);
  r.correlation = cora_correlation(r.progression, r.size, r.phase, o);
  r.total = cora_total(r.corridor, r.correlation, o);
  if (o.edges) r.edges = corridor_edges(pair, widths);
  return r;
}

std::string cora_word(double total) {
  return total >= 0.86   ? "Excellent"
         : total >= 0.65 ? "Good"
         : total >= 0.44 ? "Fair"
         : total >= 0.26 ? "Marginal"
                         : "Unacceptable";
}

}  // namespace fabrica
