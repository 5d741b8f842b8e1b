#pragma once
// One direction of a contact: tracked nodes against reference segments. Three stages:
//   candidates  cells, rare: pairs within contact distance + skin D; valid while 2 max |u| < D, u
//   the displacement
//               since the search less a common translation
//   active      from candidates, now and then: pairs within contact distance + d, valid while 2 max
//   |u| < d forces      every cycle over active pairs: closest point, penetration, penalty,
//   friction (contact/penalty.h)
// Nodes are worked on in fixed chunks and forces are added in fixed point: same bits for any number
// of threads.
#include <iosfwd>
#include <vector>

#include "base/team.h"
#include "contact/candidate_search.h"
#include "contact/closest_point.h"
#include "contact/penalty.h"
#include "model/state.h"
#include "solver/contact_friction.h"
#include "solver/contact_surface.h"
#include "solver/contact_tied.h"

namespace fabrica {

struct ContactCandidate {
  int segment;
  float r = 0, s = 0;    // last projection
  std::int8_t side = 0;  // of a two-sided segment the node is on; 0: not known
};

// What a node remembers of a segment it touches.
struct ContactSlot {
  int segment = -1;
  double baseline = 0;  // penetration that is not pushed back
  double depth = 0;     // of the last cycle
  Vec3d friction{0, 0, 0};
};

// A contact point with force this cycle.
struct ContactForce {
  int node, segment;  // node index of the model; segment of the reference surface
  double phi[4];
  Vec3d normal, friction;  // on the tracked node
};

struct InitialPenetration {
  int contact, node, segment;
  int segment_part;
  double depth;
};

// How well a contact held: the deepest penetration so far (less what was there at the start), and
// nodes that went so deep that they were let go.
struct PenetrationCheck {
  double depth = 0, time = 0;
  double allowed = 0;        // depth at which that node is let go
  int node = -1, part = -1;  // of the model; part of the segment
  std::int64_t released = 0;
  // joins what a part of the pairs saw at a time; the first of equals stays
  void take(const PenetrationCheck& c, double now) {
    const std::int64_t sum = released + c.released;
    if (c.depth > depth) *this = c, time = now;
    released = sum;
  }
};

class ContactPass {
 public:
  ContactPass(const Model& model, const Contact& contact, int contact_index, ContactSurface tracked,
              ContactSurface reference, const CarrierNodes& carriers);

  // Adds forces to state.interaction and the second half of the work of the last step to the
  // energies. step: what SOFT=1 takes for dt.
  void forces(State& state, Team& team, double step);
  // First half of the work of this step: forces at t(n), velocities at t(n+1/2).
  void account(State& state);
  // 2 sqrt(m/k) of the worst tracked node at the start.
  double stable_time_step(const State& state) const;

  int contact_index() const { return contact_index_; }
  const ContactSurface& tracked() const { return tracked_; }
  const ContactSurface& reference() const { return reference_; }
  const std::vector<std::vector<ContactForce>>& active_forces() const { return chunk_forces_; }
  const std::vector<InitialPenetration>& initial_penetrations() const { return initial_; }
  const PenetrationCheck& penetration() const { return penetration_; }
  double energy() const { return energy_; }
  double friction_energy() const { return friction_energy_; }
  int searches() const { return searches_; }
  std::vector<std::pair<int, int>> candidate_pairs() const;  // (node of the model, segment)

  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  struct Evaluation {
    SurfacePoint point;
    Vec3d gap;  // from the closest point to the node
    double distance;
    int candidate;
  };
  struct ActiveNode {
    int tracked, first, count;
  };
  struct Accepted {
    int evaluation;
    Vec3d direction;
    double depth;
  };
  static constexpr int max_pairs = 24, max_slots = 3;

  void monitor(const State& state, Team& team, double& outer, double& inner) const;
  void search(const State& state);
  void cull(const State& state, Team& team);
  void cull_node(const State& state, int node, std::vector<int>& pairs) const;
  int evaluate(const State& state, const ActiveNode& active, Evaluation* list);
  int select(const State& state, const ActiveNode& active, const Evaluation* list, int count,
             Accepted* accepted);
  void node_forces(State& state, const ActiveNode& active, int chunk);
  void push(State& state, int tracked, const Evaluation& e, const Accepted& a, ContactSlot& slot,
            int chunk);
  void remember_sides(const Evaluation* list, int count);
  double side_of(const Evaluation& e) const;
  bool in_contact(int tracked) const { return slots_[max_slots * tracked].segment >= 0; }
  bool shares_node(int segment_a, int segment_b) const;
  void corners(const State& state, const ContactSegment& s, Vec3d* X) const;
  SurfacePoint project(const State& state, int segment, const Vec3d& x, double r, double s) const;
  void see_neighbours();
  double reach(int tracked, int segment) const;
  double release_depth(int tracked, int segment) const;
  double own_share(const State& state, int tracked, const Vec3d& direction) const;
  void find_segments_around();
  void remember_positions(const State& state, std::vector<Vec3d>& reference) const;
  Vec3d translation(const State& state, const std::vector<Vec3d>& reference) const;

  const Contact& contact_;
  int contact_index_;
  ContactSurface tracked_, reference_;
  const CarrierNodes& carriers_;
  const std::vector<Vec3d>& start_;  // positions in the model
  ContactFriction friction_;
  bool has_friction_;
  int penalty_option_;
  double outer_skin_ = 0, inner_skin_ = 0, size_ = 0, largest_half_ = 0;
  std::vector<int> nodes_;  // all nodes of the pass, ascending
  // SOFT=2: segments around tracked node i, of the tracked surface; else empty
  std::vector<int> around_first_, around_;
  // history
  std::vector<Vec3d> outer_reference_, inner_reference_;
  std::vector<int> first_;  // candidates of tracked node i
  std::vector<ContactCandidate> candidates_;
  std::vector<ActiveNode> active_;
  std::vector<int> active_pairs_;
  std::vector<ContactSlot> slots_;  // max_slots a tracked node, filled from the front
  bool started_ = false;
  double step_ = 0;
  double energy_ = 0, friction_energy_ = 0;
  PenetrationCheck penetration_;
  // this cycle
  std::vector<std::vector<ContactForce>> chunk_forces_;
  std::vector<Vec3d> chunk_power_;  // x: normal, y: friction
  std::vector<std::vector<InitialPenetration>> chunk_initial_;
  std::vector<PenetrationCheck> chunk_penetration_;
  std::vector<InitialPenetration> initial_;
  int searches_ = 0;
};

}  // namespace fabrica
