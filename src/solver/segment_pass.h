#pragma once
// Segments against segments (SOFT=2): pairs of segments that face each other are pressed apart over
// their overlap (contact/segment_overlap.h). What does not face each other, edges that meet a
// surface, is left to ContactPass.
//   kappa = 0.5 SLSFAC SFS mu1 mu2/(mu1 + mu2)/dt_c^2     pressure per depth; mu: mass of a segment
//   per area n     = (m2 - m1)/|m2 - m1|                           m: normals towards the other
//   segment w     = (cosine of the angle between m1 and -m2 - 0.5)/0.2, limited to [0, 1]: share of
//   this pass
// dt_c: step at the start; follows only when the step grows by more than 5 %. The stiffness of all
// pairs of a segment adds up to at most kappa A, a fraction 0.5 SLSFAC SFS of its mass over dt_c^2.
// Penetration at the start is not pushed back; a pair that begins to touch takes over what its
// segments were allowed before. Source of the stiffness: LS-DYNA keyword manual (public), *CONTACT,
// SOFT=2.
#include <iosfwd>
#include <vector>

#include "base/team.h"
#include "contact/segment_overlap.h"
#include "model/state.h"
#include "solver/contact_friction.h"
#include "solver/contact_pass.h"

namespace fabrica {

// Force of a pair this cycle: on the corners of the first segment weight times force, on the second
// the opposite.
struct SegmentForce {
  int first, second;  // segments of the surfaces
  double weight_first[4], weight_second[4];
  Vec3d normal, friction;
};

class SegmentPass {
 public:
  // single: first and second are the same surface, each pair once.
  SegmentPass(const Model& model, const Contact& contact, int contact_index, ContactSurface first,
              ContactSurface second, bool single, const CarrierNodes& carriers);

  // Adds forces to state.interaction and the second half of the work of the last step to the
  // energies. step: what the stiffness takes for dt.
  void forces(State& state, Team& team, double step);
  // First half of the work of this step: forces at t(n), velocities at t(n+1/2).
  void account(State& state);

  int contact_index() const { return contact_index_; }
  const ContactSurface& first() const { return first_; }
  const ContactSurface& second() const { return second_; }
  const std::vector<std::vector<SegmentForce>>& active_forces() const { return chunk_forces_; }
  const std::vector<InitialPenetration>& initial_penetrations() const { return initial_; }
  const PenetrationCheck& penetration() const { return penetration_; }
  double energy() const { return energy_; }
  double friction_energy() const { return friction_energy_; }

  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  struct Pair {
    int first, second;
    int side = 0;  // of the second segment, where both have two sides; 0: not known
    bool touching = false;
    double baseline = 0;  // depth that is not pushed back
    double depth = 0;     // of the last cycle
    Vec3d friction{0, 0, 0};
  };
  struct Facing {
    Vec3d normal;  // from second to first
    double share;
  };

  void weigh_segments(const State& state);
  void search(const State& state);
  void cull(const State& state);
  double largest_displacement(const State& state, const std::vector<Vec3d>& reference) const;
  void remember(const State& state, std::vector<Vec3d>& reference) const;
  Facing facing(const Pair& pair, const Vec3d* X, const Vec3d* Y) const;
  void pair_force(State& state, Pair& pair, int chunk);
  void push(State& state, Pair& pair, const SegmentOverlap& overlap, const Facing& facing,
            int chunk);
  void inherit_baselines();
  void collect(State& state);
  void book(State& state, double normal_power, double friction_power);

  const Model& model_;
  const Contact& contact_;
  int contact_index_;
  ContactSurface first_, second_;
  bool single_;
  const CarrierNodes& carriers_;
  ContactFriction friction_;
  bool has_friction_;
  double scale_;  // 0.5 SLSFAC SFS
  double outer_skin_ = 0, inner_skin_ = 0;
  std::vector<int> nodes_;                        // of both surfaces, ascending
  std::vector<double> first_mass_, second_mass_;  // per area, by segment
  // history
  std::vector<Vec3d> outer_reference_, inner_reference_;
  std::vector<Pair> pairs_;                               // ascending first, then second
  std::vector<int> active_;                               // near pairs
  std::vector<double> first_baseline_, second_baseline_;  // by segment, of the last cycle
  bool started_ = false;
  double stiffness_step_ = 0;
  double energy_ = 0, friction_energy_ = 0;
  PenetrationCheck penetration_;
  // this cycle
  std::vector<std::vector<SegmentForce>> chunk_forces_;
  std::vector<Vec3d> chunk_power_;  // x: normal, y: friction
  std::vector<std::vector<InitialPenetration>> chunk_initial_;
  std::vector<PenetrationCheck> chunk_penetration_;
  std::vector<InitialPenetration> initial_;
};

}  // namespace fabrica
