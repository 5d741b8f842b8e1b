#include "solver/selective_mass.h"

#include <algorithm>

#include "solver/stream.h"

namespace fabrica {
namespace {

constexpr int chunk_nodes = 512;
constexpr double tolerance = 1e-6;  // of the residual against the force, both over the diagonal
constexpr int most_iterations = 200;

}  // namespace

int SelectiveMass::add(const int* node, const double* mass, int N, double scale) {
  Element e;
  e.corners = N, e.scale = scale;
  for (int a = 0; a < N; ++a) e.node[a] = node[a], e.mass[a] = mass[a], e.total += mass[a];
  elements_.push_back(e);
  indexed_ = false;
  return elements() - 1;
}

double SelectiveMass::set_scale(const State& state, int element, double scale) {
  Element& e = elements_[element];
  const auto velocity = [&](int n) { return state.nodes[n].v; };
  const double before = energy_of(e, velocity);
  e.scale = scale;
  return energy_of(e, velocity) - before;
}

bool SelectiveMass::all_free(const State& state, int element) const {
  const Element& e = elements_[element];
  return std::all_of(e.node, e.node + e.corners,
                     [&](int n) { return state.owner[n] == NodeOwner::free; });
}

double SelectiveMass::mass(int element) const {
  return elements_[element].scale * elements_[element].total;
}

// the coupled nodes and their elements; accelerations of nodes that were known before are kept
void SelectiveMass::index_nodes() {
  const std::vector<int> old = node_;
  const std::vector<Vec3d> old_a = a_;
  node_.clear();
  for (const Element& e : elements_) node_.insert(node_.end(), e.node, e.node + e.corners);
  std::sort(node_.begin(), node_.end());
  node_.erase(std::unique(node_.begin(), node_.end()), node_.end());
  const std::size_t n = node_.size();
  first_.assign(n + 1, 0);
  for (Element& e : elements_)
    for (int a = 0; a < e.corners; ++a) {
      e.local[a] = int(std::lower_bound(node_.begin(), node_.end(), e.node[a]) - node_.begin());
      ++first_[e.local[a] + 1];
    }
  for (std::size_t i = 0; i < n; ++i) first_[i + 1] += first_[i];
  element_.resize(first_[n]), corner_.resize(first_[n]);
  std::vector<int> at(first_.begin(), first_.end() - 1);
  for (int e = 0; e < elements(); ++e)
    for (int a = 0; a < elements_[e].corners; ++a) {
      const int place = at[elements_[e].local[a]]++;
      element_[place] = e, corner_[place] = a;
    }
  for (auto* v : {&a_, &residual_, &search_, &product_}) v->assign(n, Vec3d{0, 0, 0});
  for (std::size_t i = 0; i < old.size(); ++i)
    a_[std::size_t(std::lower_bound(node_.begin(), node_.end(), old[i]) - node_.begin())] =
        old_a[i];
  mass_.resize(n), diagonal_.resize(n), known_of_.assign(n, -1);
  mean_.resize(elements_.size());
  partial_.resize(Team::ranges(n, chunk_nodes));
  indexed_ = true;
}

// accelerations that supports and prescribed motions leave no choice
void SelectiveMass::take_known(const State& state, const NodeConstraints& constraints) {
  for (const Known& k : known_) known_of_[k.local] = -1;
  known_.clear();
  for (int entry = 0; entry < constraints.size(); ++entry) {
    const int node = constraints.reactions()[entry].node;
    const auto place = std::lower_bound(node_.begin(), node_.end(), node);
    if (place == node_.end() || *place != node || state.owner[node] != NodeOwner::free) continue;
    const Vec3d& v = state.nodes[node].v;
    std::array<NodeConstraints::Target, 3> target;
    Known k;
    k.local = int(place - node_.begin());
    k.count = constraints.targets(state, entry, false, v, target);
    for (int i = 0; i < k.count; ++i) {
      k.direction[i] = target[i].direction;
      k.value[i] = (target[i].velocity - dot(target[i].direction, v)) / state.mean_dt();
    }
    if (k.count == 0) continue;
    known_of_[k.local] = int(known_.size());
    known_.push_back(k);
  }
}

// takes the held components out of the vectors of nodes first..last
void SelectiveMass::hold(int first, int last, std::vector<Vec3d>& x) const {
  for (int n = first; n < last; ++n) {
    if (known_of_[n] < 0) continue;
    const Known& k = known_[known_of_[n]];
    for (int i = 0; i < k.count; ++i) x[n] -= dot(k.direction[i], x[n]) * k.direction[i];
  }
}

// s times the mass-weighted mean of each element
void SelectiveMass::element_means(const std::vector<Vec3d>& x, Team& team) {
  team.for_ranges(elements_.size(), chunk_nodes, [&](int, int first, int last) {
    for (int i = first; i < last; ++i) {
      const Element& e = elements_[i];
      Vec3d sum{0, 0, 0};
      for (int a = 0; a < e.corners; ++a) sum += e.mass[a] * x[e.local[a]];
      mean_[i] = (1 / e.total) * sum;
    }
  });
}

// (dM x) of a node, with the means of x known
Vec3d SelectiveMass::scaled(int n, const std::vector<Vec3d>& x) const {
  Vec3d sum{0, 0, 0};
  for (int k = first_[n]; k < first_[n + 1]; ++k) {
    const Element& e = elements_[element_[k]];
    sum += (e.scale * e.mass[corner_[k]]) * (x[n] - mean_[element_[k]]);
  }
  return sum;
}

double SelectiveMass::sum_of_chunks() const {
  double sum = 0;
  for (const double p : partial_) sum += p;
  return sum;
}

// first residual of (2) and search direction; reference: what the force, and the inertia of known
// accelerations, measure like it
double SelectiveMass::start(const State& state, Team& team, double& reference) {
  const std::size_t n = node_.size();
  team.for_ranges(n, chunk_nodes, [&](int, int first, int last) {
    hold(first, last, a_);
    for (int i = first; i < last; ++i) {
      mass_[i] = diagonal_[i] = state.nodes[node_[i]].mass;
      for (int k = first_[i]; k < first_[i + 1]; ++k) {
        const Element& e = elements_[element_[k]];
        const double m = e.mass[corner_[k]];
        diagonal_[i] += e.scale * m * (1 - m / e.total);
      }
      if (known_of_[i] < 0) continue;
      const Known& known = known_[known_of_[i]];
      for (int j = 0; j < known.count; ++j) a_[i] += known.value[j] * known.direction[j];
    }
  });
  double driven = 0;
  for (const Known& k : known_)
    for (int j = 0; j < k.count; ++j) driven += diagonal_[k.local] * k.value[j] * k.value[j];
  element_means(a_, team);
  team.for_ranges(n, chunk_nodes, [&](int c, int first, int last) {
    for (int i = first; i < last; ++i) product_[i] = state.force[node_[i]];
    hold(first, last, product_);
    double sum = 0;
    for (int i = first; i < last; ++i) {
      sum += dot(product_[i], product_[i]) / diagonal_[i];
      residual_[i] = state.force[node_[i]] - mass_[i] * a_[i] - scaled(i, a_);
    }
    partial_[c] = sum;
  });
  reference = sum_of_chunks() + driven;
  team.for_ranges(n, chunk_nodes, [&](int c, int first, int last) {
    hold(first, last, residual_);
    double sum = 0;
    for (int i = first; i < last; ++i) {
      search_[i] = (1 / diagonal_[i]) * residual_[i];
      sum += dot(residual_[i], search_[i]);
    }
    partial_[c] = sum;
  });
  return sum_of_chunks();
}

// one step of conjugate gradients; rho: the residual's measure before, returns it after
double SelectiveMass::iterate(double rho, Team& team) {
  const std::size_t n = node_.size();
  element_means(search_, team);
  team.for_ranges(n, chunk_nodes, [&](int c, int first, int last) {
    for (int i = first; i < last; ++i) product_[i] = mass_[i] * search_[i] + scaled(i, search_);
    hold(first, last, product_);
    double sum = 0;
    for (int i = first; i < last; ++i) sum += dot(search_[i], product_[i]);
    partial_[c] = sum;
  });
  const double along = rho / sum_of_chunks();
  team.for_ranges(n, chunk_nodes, [&](int c, int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i) {
      a_[i] += along * search_[i];
      residual_[i] -= along * product_[i];
      sum += dot(residual_[i], residual_[i]) / diagonal_[i];
    }
    partial_[c] = sum;
  });
  const double after = sum_of_chunks(), turn = after / rho;
  team.for_ranges(n, chunk_nodes, [&](int, int first, int last) {
    for (int i = first; i < last; ++i)
      search_[i] = (1 / diagonal_[i]) * residual_[i] + turn * search_[i];
  });
  return after;
}

void SelectiveMass::correct(State& state, const NodeConstraints& constraints, Team& team) {
  if (!active()) return;
  if (!indexed_) index_nodes();
  take_known(state, constraints);
  double reference = 0;
  double rho = start(state, team, reference);
  // nothing moves or is pushed: the solution is zero, not what was left of the last step
  if (reference == 0) std::fill(a_.begin(), a_.end(), Vec3d{0, 0, 0}), rho = 0;
  const double enough = tolerance * tolerance * reference;
  int count = 0;
  for (; rho > enough && count < most_iterations; ++count) rho = iterate(rho, team);
  iterations_ += count, ++solves_;
  if (rho > enough) ++unconverged_;
  element_means(a_, team);
  team.for_ranges(node_.size(), chunk_nodes, [&](int, int first, int last) {
    for (int i = first; i < last; ++i) state.force[node_[i]] -= scaled(i, a_);
  });
}

void SelectiveMass::save(std::ostream& out) const {
  write_value(out, std::int64_t(elements_.size())), write_value(out, std::int64_t(node_.size()));
  write_value(out, indexed_);
  write_vector(out, elements_), write_vector(out, node_), write_vector(out, a_);
  write_value(out, iterations_), write_value(out, solves_), write_value(out, unconverged_);
}

void SelectiveMass::load(std::istream& in) {
  std::int64_t elements = 0, nodes = 0;
  read_value(in, elements), read_value(in, nodes), read_value(in, indexed_);
  elements_.resize(elements), node_.resize(nodes), a_.resize(nodes);
  read_vector(in, elements_), read_vector(in, node_), read_vector(in, a_);
  read_value(in, iterations_), read_value(in, solves_), read_value(in, unconverged_);
  // the places are made anew; they depend on the elements alone
  if (!elements_.empty() && indexed_) index_nodes();
}

}  // namespace fabrica
