#pragma once
// The model: everything a run needs, validated and with ids resolved to indices. Immutable once
// built.
//
// Bulk arrays (nodes, elements) and cards come from a reader or a generator through Builder;
// finish() resolves them into the typed definitions below. Index -1 means "none" everywhere. Units
// are the deck's own.
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/diagnostics.h"
#include "base/parameters.h"
#include "base/tensor.h"
#include "model/card.h"
#include "model/define.h"
#include "model/interaction.h"
#include "model/mesh.h"

namespace fabrica {

struct Controls {
  double end_time = 0;
  int end_cycle = 0;
  double minimum_time_step_factor = 0;  // DTMIN
  double time_step_scale = 0.9;         // TSSFAC
  double initial_time_step = 0;         // DTINIT
  int shell_time_step = 0;              // ISDO
  int shell_viscosity = 0;  // bulk viscosity of shells: 0 none, 1 without its energy, 2 with it
  double mass_scaling_time_step = 0;  // DT2MS
  bool mass_scaling_first_cycle_only = false;
  bool selective_mass_all = false;        // IMSCL = 1
  std::vector<int> selective_mass_parts;  // of the part set -IMSCL
  int time_step_curve = -1;               // LCTM
  bool erode = false;
  Hourglass hourglass;    // *CONTROL_HOURGLASS and *CONTROL_BULK_VISCOSITY; type 0: family default
  int shell_update = 0;   // ISTUPD
  int shell_warping = 2;  // BWC
  int shell_projection = 0;  // PROJ
  int shell_theory = 2;
  double contact_scale = 0.1;     // SLSFAC
  double rigid_wall_penalty = 0;  // RWPNAL
  int contact_ignore = 0;
  int contact_orientation = 1;  // ORIEN
  int penalty_option = 1;
  int shell_thickness_option = 0;  // SHLTHK
  bool tied_projection = true;     // TIEDPRJ = 0
  int node_numbering = 1;          // INN
  int objective_update = 0;        // OSU
};

struct OutputRequests {
  // interval of each requested database by lower-case name: "glstat", "d3plot", ...
  std::unordered_map<std::string, double> interval;
  std::unordered_map<std::string, int> interval_curve;
  std::vector<int> nodes, solids, shells, beams, discretes;  // DATABASE_HISTORY_*
  std::vector<std::string> node_names;  // same length as nodes; may hold empty strings
  bool write_strains = false;
  int shell_layers = 3;  // MAXINT
};

class Builder;

class Model {
 public:
  std::string title;
  Nodes nodes;
  Solids solids;
  Shells shells;
  Beams beams;
  Discretes discretes;
  std::vector<NodalMass> masses;
  std::vector<NodalInertia> inertias;
  std::vector<Part> parts;
  std::vector<Section> sections;
  std::vector<Material> materials;
  std::vector<Curve> curves;
  std::vector<Table> tables;
  std::vector<NodeSet> node_sets;
  std::vector<PartSet> part_sets;
  std::vector<SegmentSet> segment_sets;
  std::vector<ElementSet> element_sets;
  std::vector<Box> boxes;
  std::vector<CoordinateSystem> coordinate_systems;
  std::vector<SdOrientation> sd_orientations;
  std::vector<Contact> contacts;
  std::vector<RigidWall> rigid_walls;
  std::vector<RigidMerge> rigid_merges;
  std::vector<ExtraNodes> extra_nodes;
  std::vector<NodalRigidBody> nodal_rigid_bodies;
  std::vector<Joint> joints;
  std::vector<SinglePointConstraint> constraints;
  std::vector<PrescribedMotion> prescribed_motions;
  std::vector<InitialVelocity> initial_velocities;
  std::vector<BodyLoad> body_loads;
  std::vector<NodalLoad> nodal_loads;
  std::vector<PressureLoad> pressure_loads;
  std::vector<Damping> global_damping;
  std::vector<PartDamping> part_damping;
  std::vector<CrossSection> cross_sections;
  Controls controls;
  OutputRequests output;
  std::vector<std::unique_ptr<Card>> cards;  // everything as read, in order, for the writer

  // index of a user id, or -1
  int node_index(std::int64_t id) const;
  int part_index(std::int64_t id) const;
  int curve_index(std::int64_t id) const;
  int table_index(std::int64_t id) const;

  // A hash of the whole content (bulk arrays and cards), independent of file layout.
  std::uint64_t content_hash() const;

 private:
  friend class Builder;
  friend class Resolver;
  std::unordered_map<std::int64_t, int> node_map_, part_map_, curve_map_, table_map_;
};

// Collects nodes, elements and cards; finish() turns user ids into indices and cards into
// definitions.
class Builder {
 public:
  // where the source of diagnostics is named
  explicit Builder(Diagnostics& diagnostics)
      : diagnostics_(diagnostics), model_(std::make_unique<Model>()) {}

  // Before finish() the element arrays hold user ids, in int64 staging:
  void reserve_nodes(std::size_t n);
  void add_node(std::int64_t id, Vec3d x, int tc = 0, int rc = 0, Location where = {});
  void add_solid(std::int64_t id, std::int64_t part, const std::int64_t* nodes, int count,
                 Location where = {});
  void add_shell(std::int64_t id, std::int64_t part, const std::int64_t* nodes, int count,
                 const double* thickness = nullptr, double beta = 0, Location where = {});
  void add_beam(std::int64_t id, std::int64_t part, std::int64_t n1, std::int64_t n2,
                std::int64_t n3, const Vec3d* orientation = nullptr, Location where = {});
  void add_discrete(std::int64_t id, std::int64_t part, std::int64_t n1, std::int64_t n2,
                    std::int64_t orientation, double scale, double offset, Location where = {});
  void add_mass(std::int64_t id, std::int64_t node, double mass, std::int64_t part,
                Location where = {});
  void add_inertia(std::int64_t id, std::int64_t node, double mass,
                   const std::array<double, 6>& inertia, Location where = {});
  Card& add_card(Card card);
  Card& add_card(std::string_view keyword) { return add_card(Card(keyword)); }
  void set_title(std::string title);

  // Resolves and validates. Problems go to the diagnostics; the model is usable only if none is an
  // error.
  std::unique_ptr<Model> finish();

 private:
  friend class Resolver;
  Diagnostics& diagnostics_;
  std::unique_ptr<Model> model_;
  struct Staging {
    std::vector<std::array<std::int64_t, 10>> solid_nodes;
    std::vector<std::array<std::int64_t, 4>> shell_nodes;
    std::vector<std::array<std::int64_t, 3>> beam_nodes;
    std::vector<std::array<std::int64_t, 3>> discrete_nodes;  // n1, n2, orientation id
    std::vector<std::int64_t> solid_part, shell_part, beam_part, discrete_part, mass_node,
        mass_part, inertia_node;
    std::vector<Location> node_where, solid_where, shell_where, beam_where, discrete_where,
        mass_where, inertia_where;
  } staging_;
};

// Reads the parameters of a law from a card of the model.
class CardParameters : public Parameters {
 public:
  CardParameters(const Model& model, const Card& card) : model_(model), card_(card) {}
  double real(std::string_view field) const override;
  bool given(std::string_view field) const override;
  CurveView curve(std::string_view field) const override;
  TableView table(std::string_view field) const override;
  int rows() const override;
  double row(int i, std::string_view field) const override;

 private:
  const Model& model_;
  const Card& card_;
};

}  // namespace fabrica
