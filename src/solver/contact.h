#pragma once
// All contacts of a run: penalty contacts (contact_pass.h), tied contacts (contact_tied.h), and
// what they report.
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/team.h"
#include "model/model.h"
#include "model/state.h"
#include "solver/contact_pass.h"
#include "solver/contact_surface.h"
#include "solver/contact_tied.h"
#include "solver/edge_pass.h"
#include "solver/segment_pass.h"

namespace fabrica {

// What a user compares with other codes before the run.
struct InitialReport {
  int penetrating_nodes = 0;
  double largest_penetration = 0;
  std::vector<InitialPenetration> worst;  // at most 20, deepest first
  int tied_nodes = 0;
  std::vector<int> untied_nodes;  // of tied contacts: too far from any segment
};

// What one direction of a contact saw so far.
struct ContactCheck {
  int contact;
  int initial_nodes;
  double initial_depth;
  PenetrationCheck deepest;
};

class Contacts {
 public:
  // Builds surfaces and ties. state: positions and masses at t = 0. What is not supported goes to
  // diagnostics.
  Contacts(const Model& model, State& state, const ContactInput& input, Diagnostics& diagnostics);
  Contacts(const Contacts&) = delete;
  Contacts& operator=(const Contacts&) = delete;

  // Adds the forces of all penalty contacts at t(n) to state.interaction; state.dt: the last step
  // (0 at the start).
  void forces(const Model& model, State& state, Team& team);
  // Books the work of the forces at t(n); call when velocities are at t(n+1/2). The other half
  // follows in forces().
  void account(State& state);

  // Moves forces (and moments of offsets) of tied nodes to the nodes that carry them, leaves before
  // roots.
  void transfer_tied_forces(State& state, Team& team);
  // Places tied nodes on their segments, roots before leaves; velocity and position.
  void place_tied_nodes(State& state, Team& team);
  // Nodes tied to rigid segments: to be extra nodes of that part's rigid body.
  const std::vector<RigidTie>& rigid_ties() const { return tied_->rigid_ties(); }

  // Forces on both sides at t(n), energies so far and masses, one entry a contact, in the order of
  // the model.
  struct Resultant {
    int contact = -1;
    Vec3d side_a{0, 0, 0}, side_b{0, 0, 0};
    double energy_a = 0, energy_b = 0, friction_energy = 0, mass_a = 0, mass_b = 0;
  };
  std::vector<Resultant> resultants() const;
  // How deep surfaces went into each other, one entry a direction of a contact.
  std::vector<ContactCheck> checks() const;
  // Complete after the first forces().
  const InitialReport& initial_report() const { return report_; }
  // Smallest 2 sqrt(m/k) over the nodes of contacts with SOFT=0 at the start.
  double stable_time_step() const { return stable_time_step_; }
  const std::vector<std::unique_ptr<ContactPass>>& passes() const { return passes_; }

  // Bit-exact history; load() belongs to the same model.
  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  void add_contact(const Model& model, int contact, const SurfaceSource& source,
                   Diagnostics& diagnostics);
  void add_edges(const Model& model, int contact, ContactSurface surface, Diagnostics& diagnostics);
  void add_transducer(const Model& model, int contact, const SurfaceSource& source);
  void add_to_transducers(std::vector<Resultant>& resultants) const;
  void complete_report();
  template <class Visit>
  void each_force(Visit visit) const;

  struct Transducer {
    int contact;
    std::vector<char> in_a, in_b;  // by node; in_b empty: against anything
  };
  CarrierNodes carriers_;
  std::unique_ptr<TiedNodes> tied_;
  std::vector<std::unique_ptr<ContactPass>> passes_;
  std::vector<char> second_pass_;                             // tracked side is b
  std::vector<std::unique_ptr<EdgePass>> edge_passes_;        // where edges_touch()
  std::vector<std::unique_ptr<SegmentPass>> segment_passes_;  // SOFT=2
  std::vector<Transducer> transducers_;
  std::vector<Resultant> fixed_;  // masses
  InitialReport report_;
  bool report_complete_ = false;
  double stable_time_step_ = 1e30, initial_dt_ = 0;
};

}  // namespace fabrica
