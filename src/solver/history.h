#pragma once
// Time-history databases of a run: which exist, what they hold, and their values at t(n).
// Names and units as LS-DYNA users know them (docs/manual/guide.md); all values in the deck's
// units.
#include <functional>
#include <string>
#include <vector>

#include "model/output.h"
#include "solver/simulation.h"

namespace fabrica {

// Kinetic energy, mass and momentum by part, at t(n): a part owns the mass that its elements give
// to a node, a rigid part what its body has.
struct PartSums {
  std::vector<double> kinetic, eroded_kinetic, mass, momentum[3];
};
PartSums part_sums(const Simulation& simulation);

// adds variables of a database, each of `length` values
inline void declare(HistoryDatabase& d, int length, std::initializer_list<const char*> names) {
  for (const char* n : names) d.variables.push_back({n, length, false});
}

class History {
 public:
  // The databases that the model asks for, with their intervals.
  explicit History(const Simulation& simulation);

  const std::vector<HistoryDatabase>& databases() const { return databases_; }
  // Values of a database now; call while the simulation samples.
  HistorySample sample(int database) const;

 private:
  using Fill = std::function<void(std::vector<std::vector<double>>&)>;
  HistoryDatabase* add(const std::string& path, const std::string& request);
  void add_glstat();
  void add_matsum();
  void add_nodout();
  void add_elout();
  void add_rbdout();
  void add_deforc();
  void add_jntforc();
  void add_rwforc();
  void add_rcforc();
  void add_sleout();
  void add_spcforc();
  void add_secforc();

  const Simulation& simulation_;
  std::vector<HistoryDatabase> databases_;
  std::vector<Fill> fills_;
};

// Force of the elements of a cross section on its nodes at t(n), moment about the mean of the
// nodes.
struct SectionForce {
  Vec3d force{0, 0, 0}, moment{0, 0, 0}, centroid{0, 0, 0};
};
SectionForce section_force(const Simulation& simulation, const CrossSection& section);

// The animation state at t(n); call while the simulation samples.
AnimationState animation_state(const Simulation& simulation);

}  // namespace fabrica
