#include "model/function.h"

#include <algorithm>
#include <cmath>

namespace fabrica {

FunctionLibrary::Function& FunctionLibrary::declare(const std::string& name) {
  auto& f = functions_[name];
  if (!f) f = std::make_unique<Function>();
  return *f;
}

void FunctionLibrary::reset() {
  for (auto& [name, f] : functions_) std::fill(f->variable.begin(), f->variable.end(), 0.0);
}

namespace {

constexpr long most_steps = 50'000'000;  // of C statements and calls for one curve
constexpr int first_samples = 1 << 14, most_samples = 1 << 21;

std::vector<double> sampled(const Value& f, double end, int pieces) {
  std::vector<double> y(std::size_t(pieces) + 1), none;
  long left = most_steps;
  for (int i = 0; i <= pieces; ++i) {
    Frame frame{&none, end * i / pieces, 0, &left, 0};
    y[std::size_t(i)] = f(frame);
    if (!std::isfinite(y[std::size_t(i)]))
      throw FunctionError("the value at time " + std::to_string(frame.time) + " is not a number",
                          false);
  }
  return y;
}

double range_of(const std::vector<double>& y) {
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  return *high - *low;
}

// Leaves out samples that lie within `tolerance` of the straight line between those that stay: a
// line from the last one kept must pass through the gate of every sample since.
Curve thinned(const std::vector<double>& y, double end, double tolerance) {
  const std::size_t n = y.size() - 1;
  const auto x = [&](std::size_t i) { return end * double(i) / double(n); };
  Curve out;
  const auto keep = [&](std::size_t i) { out.x.push_back(x(i)), out.y.push_back(y[i]); };
  keep(0);
  std::size_t from = 0;
  double low = -INFINITY, high = INFINITY;
  for (std::size_t i = 1; i <= n; ++i) {
    const double way = x(i) - x(from), slope = (y[i] - y[from]) / way;
    if (slope < low || slope > high) {
      keep(i - 1);
      from = i - 1, low = -INFINITY, high = INFINITY;
      --i;
      continue;
    }
    low = std::max(low, slope - tolerance / way), high = std::min(high, slope + tolerance / way);
  }
  keep(n);
  return out;
}

}  // namespace

Curve FunctionLibrary::tabulated(const Value& f, double end) {
  reset();
  std::vector<double> coarse = sampled(f, end, first_samples);
  for (int pieces = 2 * first_samples; pieces <= most_samples; pieces *= 2) {
    reset();
    std::vector<double> fine = sampled(f, end, pieces);
    const double range = range_of(fine);
    double moved = 0;
    for (std::size_t i = 0; i < coarse.size(); ++i)
      moved = std::max(moved, std::abs(fine[2 * i] - coarse[i]));
    if (moved <= 1e-3 * range) return thinned(fine, end, 1e-6 * range);
    coarse = std::move(fine);
  }
  throw FunctionError("its values depend on the step at which it is sampled, even at " +
                          std::to_string(most_samples / 2) + " steps",
                      false);
}

}  // namespace fabrica
