#pragma once
// Edges against edges (*CONTACT_AUTOMATIC_GENERAL, and SOFT=2 with DEPTH 5, 25, 35 ...): beams, of
// the former alone, as round bars of the radius sqrt(A/pi), free edges of shells as round rims of
// half the thickness.
//   d = r1 + r2 - |g|,  n = g/|g|       g: from the closest point of edge 2 to that of edge 1
//   (contact/closest_point.h) k = 0.5 SOFSCL m*/dt_c^2            as SOFT=1; m* from the shape
//   functions 1 - a, a of both edges
// The pair keeps n: where g turns over, the bars have crossed and d = r1 + r2 + |g|. Rims of shells
// count where n leans less than 60 degrees out of their plane; nearer to the normal the surfaces
// touch. At a node shared by edges one of them pushes: the one whose closest point lies inside,
// else the first.
#include <iosfwd>
#include <vector>

#include "contact/closest_point.h"
#include "model/state.h"
#include "solver/contact_friction.h"
#include "solver/contact_pass.h"

namespace fabrica {

struct EdgeForce {
  int first, second;       // edges of the surface
  double a, b;             // places on them
  Vec3d normal, friction;  // on the first
};

class EdgePass {
 public:
  EdgePass(const Model& model, const Contact& contact, int contact_index, ContactSurface surface,
           const CarrierNodes& carriers);

  // Adds forces to state.interaction and the second half of the work of the last step to the
  // energies.
  void forces(State& state, double step);
  // First half of the work of this step: forces at t(n), velocities at t(n+1/2).
  void account(State& state);

  int contact_index() const { return contact_index_; }
  int size() const { return int(surface_.edges.size()); }
  const ContactSurface& surface() const { return surface_; }
  const std::vector<EdgeForce>& active_forces() const { return forces_; }
  const std::vector<InitialPenetration>& initial_penetrations() const { return initial_; }
  const PenetrationCheck& penetration() const { return penetration_; }
  double energy() const { return energy_; }
  double friction_energy() const { return friction_energy_; }

  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  struct Pair {
    int first, second;
    bool touching = false;
    double baseline = 0;
    Vec3d direction{0, 0, 0};
    Vec3d friction{0, 0, 0};
  };
  double largest_displacement(const State& state) const;
  void search(const State& state);
  bool wanted(int first, int second) const;
  EdgePoints closest(const State& state, int first, int second) const;
  bool owns_place(const State& state, int edge, double place, int other) const;
  bool pushes_along(const State& state, int edge, const Vec3d& direction) const;
  void pair_force(State& state, Pair& pair);
  void push(State& state, Pair& pair, const EdgePoints& c, double depth);
  void book(State& state, double normal_power, double friction_power);

  const Contact& contact_;
  int contact_index_;
  ContactSurface surface_;
  const CarrierNodes& carriers_;
  ContactFriction friction_;
  double skin_ = 0;
  std::vector<int> nodes_;                  // of the edges, ascending
  std::vector<std::vector<int>> edges_of_;  // by node of the model
  // history
  std::vector<Vec3d> reference_;
  std::vector<Pair> pairs_;  // ascending first, then second
  bool started_ = false;
  double stiffness_step_ = 0;
  double energy_ = 0, friction_energy_ = 0;
  PenetrationCheck penetration_;
  // this cycle
  std::vector<EdgeForce> forces_;
  Vec3d power_{0, 0, 0};
  std::vector<InitialPenetration> initial_;
};

}  // namespace fabrica
