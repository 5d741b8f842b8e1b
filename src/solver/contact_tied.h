#pragma once
// Nodes tied to segments at t = 0. With c = sum phi_i x_i and W_i the exact derivative of the turn
// of the segment's frame by the place of its corner i:
//   velocity   v = sum phi_i v_i + (sum W_i v_i) x o,   o = x - c turns with the frame
//   force      f_i += phi_i f + W_i^T (o x f + m)
// The second line is the transpose of the first: a tie does no work, a penalty is the gradient of
// its energy, linear and angular momentum are kept.
//   constraint          node put on the segment (TIEDPRJ = 0), o = 0; its mass goes to the corners
//   constrained offset  the same with o as found
//   offset              penalty k between the node and its place on the segment; both stay free
#include <iosfwd>
#include <vector>

#include "base/diagnostics.h"
#include "base/team.h"
#include "model/state.h"
#include "solver/contact_surface.h"

namespace fabrica {

// For tied nodes: the nodes that carry node i; empty for all others.
using CarrierNodes = std::vector<std::vector<int>>;

struct RigidTie {
  int node, part;
};

struct Tie {
  int contact, node;
  int corner[4];
  int corners;  // 3 or 4
  double phi[4];
  double offset[3];  // in the frame of the segment
  double stiffness;  // of the penalty; 0: constraint
  int level = 0;     // 1 + the highest level among the corners
};

class TiedNodes {
 public:
  explicit TiedNodes(const Model& model) : model_(model) {}
  // Finds the pairs of one tied contact. dt: the expected step, for penalties on segments without
  // an element.
  void add(int contact, const ContactSurface& tracked, const ContactSurface& reference,
           State& state, double dt, Diagnostics& diagnostics);
  // After the last add(): orders chains, moves masses, takes the nodes over.
  void finish(State& state);

  void transfer_forces(State& state) const;
  void place_nodes(State& state) const;
  // penalty ties: forces, and the halves of their work as in ContactPass
  void forces(State& state);
  void account(State& state);

  const std::vector<RigidTie>& rigid_ties() const { return rigid_ties_; }
  const std::vector<Tie>& constraints() const { return constraints_; }
  const std::vector<Tie>& penalties() const { return penalties_; }
  const std::vector<int>& untied() const { return untied_; }
  int count() const { return int(constraints_.size() + penalties_.size() + rigid_ties_.size()); }
  CarrierNodes carriers() const;
  // force on the tracked nodes of a contact this cycle (penalty and constraint)
  Vec3d force_of(int contact) const;
  bool has_ties(int contact) const;
  double energy() const { return energy_; }
  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  bool carried_by(int node, int by) const;
  const Model& model_;
  std::vector<Tie> constraints_, penalties_;
  std::vector<Vec3d> penalty_force_;
  mutable std::vector<Vec3d> constraint_force_;
  std::vector<int> tie_of_;  // by node: index into constraints_ before finish(), or -1
  std::vector<RigidTie> rigid_ties_;
  std::vector<int> untied_;
  double energy_ = 0;
};

}  // namespace fabrica
