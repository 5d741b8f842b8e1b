#pragma once
// Selective mass scaling (*CONTROL_TIMESTEP, IMSCL): an element below the wanted step gets inertia
// against deformation, none against translation. With the corner masses m_a of the element, sum m,
//   dM = s (diag(m_a) - m_a m_b / m),  s = (|DT2MS| / dt_e)^2 - 1,  per component (1)
// so that sum_b dM_ab = 0, and every motion without mean is slower by 1 / sqrt(1 + s). The mesh
// then moves by
//   (M + dM) a = f (2)
// which is solved for all coupled nodes at once by conjugate gradients, with the diagonal of (2) as
// preconditioner and the accelerations of the last step as start. What follows sees the force
//   f - dM a (3)
// and the mass M alone; its sum over the nodes is that of f whatever the accuracy of a.
// Supports and prescribed motions are known accelerations in (2).
// A rigid rotation is a motion without mean: its inertia grows like that of a deformation.
// Source: Olovsson, Simonsson, Unosson, International Journal for Numerical Methods in Engineering
// 63 (2005) 1436.
#include <cstdint>
#include <istream>
#include <ostream>
#include <vector>

#include "base/team.h"
#include "model/state.h"
#include "solver/node_constraints.h"

namespace fabrica {

class SelectiveMass {
 public:
  bool active() const { return !elements_.empty(); }
  int elements() const { return int(elements_.size()); }
  // Adds an element of N <= 8 corners with their masses; returns its index.
  int add(const int* node, const double* mass, int N, double scale);
  // Sets s of an element; returns by how much kinetic energy grew.
  double set_scale(const State& state, int element, double scale);
  bool all_free(const State& state, int element) const;
  double scale(int element) const { return elements_[element].scale; }
  double mass(int element) const;  // s m
  const int* nodes(int element) const { return elements_[element].node; }
  int corners(int element) const { return elements_[element].corners; }
  double corner_mass(int element, int a) const { return elements_[element].mass[a]; }

  // Takes dM a of equation (3) from state.force; v is still v(n-1/2).
  void correct(State& state, const NodeConstraints& constraints, Team& team);
  // 1/2 v.dM.v of the velocities that `velocity(node)` gives
  template <class Velocity>
  double kinetic_energy(Velocity velocity) const {
    double sum = 0;
    for (const Element& e : elements_) sum += energy_of(e, velocity);
    return sum;
  }
  // mean number of iterations of a step, and steps that ended short of the tolerance
  double mean_iterations() const { return solves_ > 0 ? double(iterations_) / double(solves_) : 0; }
  std::int64_t unconverged() const { return unconverged_; }

  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  struct Element {
    int node[8] = {}, local[8] = {};
    double mass[8] = {};
    double total = 0, scale = 0;
    int corners = 0;
  };
  // known acceleration of a node: `count` orthonormal directions and the components along them
  struct Known {
    int local = -1, count = 0;
    Vec3d direction[3];
    double value[3];
  };
  template <class Velocity>
  static double energy_of(const Element& e, Velocity velocity) {
    double square = 0;
    Vec3d sum{0, 0, 0};
    for (int a = 0; a < e.corners; ++a) {
      const Vec3d v = velocity(e.node[a]);
      square += e.mass[a] * dot(v, v), sum += e.mass[a] * v;
    }
    return 0.5 * e.scale * (square - dot(sum, sum) / e.total);
  }
  void index_nodes();
  void take_known(const State& state, const NodeConstraints& constraints);
  void hold(int first, int last, std::vector<Vec3d>& x) const;
  void element_means(const std::vector<Vec3d>& x, Team& team);
  Vec3d scaled(int n, const std::vector<Vec3d>& x) const;
  double sum_of_chunks() const;
  double start(const State& state, Team& team, double& reference);
  double iterate(double rho, Team& team);

  std::vector<Element> elements_;
  bool indexed_ = false;
  std::vector<int> node_;                      // coupled nodes, ascending
  std::vector<int> first_, element_, corner_;  // elements of each, in order
  std::vector<double> mass_, diagonal_;        // M and the diagonal of (2)
  std::vector<Known> known_;                   // by local node
  std::vector<int> known_of_;                  // local node -> known_, or -1
  std::vector<Vec3d> a_, residual_, search_, product_;
  std::vector<Vec3d> mean_;      // of each element
  std::vector<double> partial_;  // sums of chunks
  std::int64_t iterations_ = 0, solves_ = 0, unconverged_ = 0;
};

}  // namespace fabrica
