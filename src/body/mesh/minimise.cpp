#include "body/mesh/minimise.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace fabrica::body {
namespace {

using Field = std::vector<Point>;

double inner(const Field& a, const Field& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

void add(Field& a, double s, const Field& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += s * b[i];
}

struct Memory {
  Field step, change;
  double rho;
};

// the quasi-Newton direction -H g from the last steps (two-loop recursion)
Field direction(const std::deque<Memory>& memory, const Field& gradient) {
  Field d = gradient;
  std::vector<double> alpha(memory.size());
  for (std::size_t m = memory.size(); m-- > 0;) {
    alpha[m] = memory[m].rho * inner(memory[m].step, d);
    add(d, -alpha[m], memory[m].change);
  }
  if (!memory.empty()) {
    const Memory& last = memory.back();
    const double scale = 1 / (last.rho * inner(last.change, last.change));
    for (Point& p : d) p = scale * p;
  }
  for (std::size_t m = 0; m < memory.size(); ++m)
    add(d, alpha[m] - memory[m].rho * inner(memory[m].change, d), memory[m].step);
  for (Point& p : d) p = -p;
  return d;
}

}  // namespace

void minimise(const NodeEnergy& function, std::vector<Point>& nodes, double longest_move,
              int iterations) {
  constexpr std::size_t pairs = 7;
  std::deque<Memory> memory;
  Field gradient(nodes.size()), trial, trial_gradient(nodes.size());
  double energy = function(nodes, gradient);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Field d = direction(memory, gradient);
    double slope = inner(d, gradient);
    if (slope >= 0) {
      memory.clear();
      d = direction(memory, gradient);
      slope = inner(d, gradient);
    }
    if (slope == 0) return;
    double longest = 0;
    for (const Point& p : d) longest = std::max(longest, dot(p, p));
    double step = std::min(1.0, longest_move / std::sqrt(longest));
    if (memory.empty()) step = std::min(step, 0.1 * longest_move / std::sqrt(longest));
    double trial_energy = energy;
    bool accepted = false;
    for (int cut = 0; cut < 12 && !accepted; ++cut, step *= 0.4) {
      trial = nodes;
      add(trial, step, d);
      trial_energy = function(trial, trial_gradient);
      accepted = trial_energy <= energy + 1e-4 * step * slope;
    }
    if (!accepted) {
      if (memory.empty()) return;
      memory.clear();
      continue;
    }
    Memory pair{trial, trial_gradient, 0};
    add(pair.step, -1, nodes);
    add(pair.change, -1, gradient);
    const double curvature = inner(pair.step, pair.change);
    const bool converged = energy - trial_energy < 1e-7 * energy;
    nodes.swap(trial);
    gradient.swap(trial_gradient);
    energy = trial_energy;
    if (converged) return;
    if (curvature > 1e-12 * inner(pair.step, pair.step)) {
      pair.rho = 1 / curvature;
      memory.push_back(std::move(pair));
      if (memory.size() > pairs) memory.pop_front();
    }
  }
}

}  // namespace fabrica::body
