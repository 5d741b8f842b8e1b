#pragma once
// Tiles: fixed groups of 256 (tetrahedra 512) elements of one part and one kind, the unit of work
// on every target. A tile owns its elements' history, its list of nodes and one partial force per
// node. Partition and order depend on the model alone, never on threads.
#include <memory>
#include <vector>

#include "base/aligned.h"
#include "base/team.h"
#include "model/model.h"
#include "model/state.h"
#include "solver/kernel.h"
#include "solver/nodal_pressure.h"

namespace fabrica {

struct TileClass {
  ElementKind kind;
  Family family;
  int part;
  ElementParameters parameters;
  std::shared_ptr<Kernel> kernel;
  int fields;  // Reals of history per element
};

struct Tile {
  int tile_class;
  int first, count;            // range in Tiles::element
  int node_first, node_count;  // range in Tiles::node
  int anchor;                  // the node that positions are taken relative to
  std::size_t connectivity, state, step;
  // results of the last pass
  double internal = 0, hourglass = 0, damping = 0;
  double eroded_internal = 0, eroded_hourglass = 0;  // what elements held that failed in it
  int failed = 0;
  Real time_step = 0, smallest_volume = 0;
};

// where an element's history is
struct ElementPlace {
  int tile = -1;
  int slot = 0;  // within the tile
};

class Tiles {
 public:
  // Builds classes and tiles of all deformable parts and initialises the history. Problems go to
  // diagnostics.
  Tiles(const Model& model, Diagnostics& diagnostics);

  // Element forces at t(n) into the partials; energies and steps into the tiles.
  void forces(State& state, Team& team);
  // Adds the partials of nodes [a, b) in tile order to state.force (and state.moment), which it
  // overwrites.
  void sum_partials(State& state, int a, int b) const;

  // lumped mass and rotary inertia of the nodes from the deformable and rigid elements of the model
  void add_mass(std::vector<double>& mass, std::vector<double>& inertia) const {
    add_into(mass, inertia);
  }

  ElementReadout read(const Model& model, const State& state, Family family, int element) const;
  // time step of every element of a tile, and the failed ones; runs the kernel on a copy of the
  // history
  void element_steps(const State& state, int tile, std::vector<Real>& steps) const;
  // Nodes, forces and moments of one element from its present stress; returns the number of
  // corners, 0 if it has no tile.
  int corner_forces(const State& state, Family family, int element, int* node, Vec3d* force,
                    Vec3d* moment) const;

  void save(std::ostream&) const;
  void load(std::istream&);

  std::vector<TileClass> classes;
  std::vector<Tile> tiles;
  std::vector<int> element;       // element index in its family, tile by tile
  std::vector<int> node;          // global node of each tile node
  std::vector<double> node_mass;  // what the tile's elements give to it, parallel to `node`
  std::vector<std::uint16_t> connectivity;
  AlignedVector<Real> state_;
  AlignedVector<ForceRecord> force;         // partials, parallel to `node`
  AlignedVector<ForceRecord> moment;        // partials, or empty
  std::vector<int> partial_first, partial;  // node -> places in `force`, in tile order
  std::vector<ElementPlace> place_of_solid, place_of_shell, place_of_beam;
  bool any_rotations = false;
  // when set, forces() leaves every element's own stable step in `steps`, at tile.step + slot
  bool record_steps = false;
  AlignedVector<Real> steps;
  // of elements that may fail, at tile.step + slot; empty if none may
  std::vector<ElementEnergy> energies;
  bool has_failed(int tile, int slot) const {
    return !energies.empty() && energies[tiles[tile].step + slot].failed;
  }
  int elements() const { return int(element.size()); }

  const std::vector<ElementPlace>& places(Family family) const;

 private:
  void add_into(std::vector<double>& mass, std::vector<double>& inertia) const;
  void initialise(const Model& model);
  void fill_nodes(const State& state, const Tile& tile, NodeRecord* nodes, SpinRecord* spins) const;
  TileView view_of(const Tile& tile, const NodeRecord* nodes, const SpinRecord* spins);
  NodesAhead nodes_of(const State& state, int tile) const;
  void nodal_rates(State& state, Team& team);
  std::vector<double> mass_, inertia_;
  void arrange(int shares);
  std::vector<int> nodal_tiles_;
  std::vector<int> order_;  // in which tiles are worked off; results do not depend on it
  int shares_ = 0;          // threads that the order was made for
  NodalPressure nodal_pressure_;
};

// Lumped masses of elements of rigid parts, which have no tiles.
void add_rigid_part_mass(const Model& model, std::vector<double>& mass,
                         std::vector<double>& inertia);

// Which kernel a section's formulation and an element's shape ask for; throws
// std::invalid_argument.
ElementKind element_kind(const Model& model, const Part& part, Family family, int corners);
ElementParameters element_parameters(const Model& model, const Part& part, const Elastic& elastic);

// thickness of the four corners of a shell, from the element or its section
std::array<double, 4> shell_thickness(const Model& model, int shell);

// distinct corners of a brick in element order: 8 brick, 6 wedge, 4 tetrahedron (nodes reordered
// for the kernel)
int solid_shape(const std::array<int, 10>& deck, std::array<int, 8>& nodes);

}  // namespace fabrica
