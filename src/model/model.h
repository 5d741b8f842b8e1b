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

#include "base/curve.h"
#include "base/diagnostics.h"
#include "base/parameters.h"
#include "base/tensor.h"
#include "model/card.h"

namespace fabrica {

struct Nodes {
  std::vector<std::int64_t> id;
  std::vector<Vec3d> x;
  std::vector<std::uint8_t> translation_code;  // TC 0-7 of *NODE
  std::vector<std::uint8_t> rotation_code;     // RC
  int size() const { return int(id.size()); }
};

// Element families. node arrays hold indices into Nodes after finish() (user ids before).
struct Solids {
  std::vector<std::int64_t> id;
  std::vector<int> part;
  std::vector<std::array<int, 10>>
      node;  // 8 used by bricks; unused entries -1; wedges and tets keep deck order
  int size() const { return int(id.size()); }
};
struct Shells {
  std::vector<std::int64_t> id;
  std::vector<int> part;
  std::vector<std::array<int, 4>> node;  // triangle: node[3] == node[2]
  std::vector<std::array<float, 4>>
      thickness;            // of *ELEMENT_SHELL_THICKNESS, 0: section default; may be empty
  std::vector<float> beta;  // may be empty
  int size() const { return int(id.size()); }
};
struct Beams {
  std::vector<std::int64_t> id;
  std::vector<int> part;
  std::vector<std::array<int, 3>> node;  // third: orientation node or -1
  std::vector<Vec3d> orientation;        // of _ORIENTATION; may be empty
  int size() const { return int(id.size()); }
};
struct Discretes {
  std::vector<std::int64_t> id;
  std::vector<int> part;
  std::vector<std::array<int, 2>> node;  // second -1: grounded
  std::vector<int> orientation;          // index into Model::sd_orientations or -1 (vid)
  std::vector<double> scale;
  std::vector<double> offset;
  int size() const { return int(id.size()); }
};
struct NodalMass {
  std::int64_t id;
  int node;
  double mass;
  int part;
};
struct NodalInertia {
  std::int64_t id;
  int node;
  double mass;
  std::array<double, 6> inertia;  // xx xy xz yy yz zz
};

enum class Family { none, solid, shell, beam, discrete };

struct Section {
  std::int64_t id = 0;
  Family family = Family::none;
  std::string title;
  int formulation = 0;  // ELFORM
  const Card* card = nullptr;
  // shells
  int through_thickness_points = 2;
  double shear_factor = 1;
  std::array<double, 4> thickness{};
  double reference_location = 0;  // NLOC
  double area_mass = 0;           // MAREA
  int quadrature = 0;             // QR/IRID: 0 Gauss, 1 Lobatto...
  // beams: area, inertias as the card gives them
  double area = 0, iss = 0, itt = 0, j = 0, shear_area = 0;
  int cross_section = 0;  // CST 0 rectangular, 1 tubular
  double ts1 = 0, ts2 = 0, tt1 = 0, tt2 = 0;
  double volume = 0, rotary_inertia = 0;  // discrete beam VOL, INER
  int local_system = -1;                  // CID index
  double ca = 0, offset = 0, rrcon = 0, srcon = 0, trcon = 0, scoor = 0;
  // discrete elements
  int torsional = 0;  // DRO
  double dynamic_factor = 0, test_velocity = 0, clearance = 0, failure_deflection = 0,
         deflection_limit_compression = 0, deflection_limit_tension = 0;
};

struct Hourglass {
  int type = 0;              // IHQ; 0: default of the family
  double coefficient = 0.1;  // QM
  double quadratic_viscosity = 1.5, linear_viscosity = 0.06;
  double bending = 0, warping = 0;  // QB, QW
};

struct InertiaOverride {  // *PART_INERTIA
  Vec3d center;
  double mass;
  std::array<double, 6> inertia;  // xx xy xz yy yz zz about the centre
  Vec3d velocity, angular_velocity;
  int local_system = -1;
  int node = -1;
};

struct Material {
  std::int64_t id = 0;
  std::string law;  // canonical keyword: "MAT_ELASTIC"
  std::string title;
  double density = 0;
  const Card* card = nullptr;
  bool rigid = false;
  // MAT_RIGID: elastic constants for contact, and the constraint code
  double youngs = 0, poisson = 0;
  int cmo = 0, con1 = 0, con2 = 0;
  int local_system = -1;  // con1 of cmo = -1, or LCO
};

struct PartContact {  // *PART_CONTACT
  double fs = 0, fd = 0, dc = 0, vc = 0, thickness = 0, thickness_scale = 0, stiffness_scale = 0;
};

struct Part {
  std::int64_t id = 0;
  std::string title;
  int section = -1;
  int material = -1;
  int eos = -1;  // index into Model::cards of the EOS card, or -1
  std::optional<Hourglass> hourglass;
  std::optional<InertiaOverride> inertia;
  std::optional<PartContact> contact;
  Family family = Family::none;
  bool rigid = false;  // MAT_RIGID, or made rigid by *DEFORMABLE_TO_RIGID from the start
  Location where;
};

struct Curve {
  std::int64_t id = 0;
  std::string title;
  std::vector<double> x, y;  // scaled and offset; x ascending
  bool for_stress_initialisation = false;
  // value at t, constant outside (time curves)
  double at(double t) const;
  double slope_integral(double a,
                        double b) const;  // exact integral of y over [a, b], end values outside
  // storage for the kernels' views
  std::vector<Real> x_real, y_real;
  CurveView view(bool extrapolate = true) const {
    return {x_real.data(), y_real.data(), int(x_real.size()), extrapolate};
  }
};
struct Table {
  std::int64_t id = 0;
  std::vector<double> rate;
  std::vector<int> curve;  // index into curves
  std::vector<Real> rate_real;
  std::vector<CurveView> views;
  bool log_rate = false;
};

struct NodeSet {
  std::int64_t id = 0;
  std::string title;
  std::vector<int> nodes;
};
struct PartSet {
  std::int64_t id = 0;
  std::string title;
  std::vector<int> parts;
};
struct SegmentSet {
  std::int64_t id = 0;
  std::string title;
  std::vector<std::array<int, 4>> segments;
};
struct ElementSet {
  std::int64_t id = 0;
  Family family = Family::none;
  std::string title;
  std::vector<int> elements;
};
struct Box {
  std::int64_t id = 0;
  Vec3d low, high;
};
struct CoordinateSystem {
  std::int64_t id = 0;
  Vec3d origin;
  Mat3d axes;                           // rows: local x, y, z in global components, at the start
  std::array<int, 3> node{-1, -1, -1};  // of *DEFINE_COORDINATE_NODES
  bool moves = false;                   // FLAG = 1
};
struct SdOrientation {
  std::int64_t id = 0;
  int option = 0;  // IOP
  Vec3d direction;
  std::array<int, 2> node{-1, -1};
};

// which entities one side of a contact holds
struct ContactSide {
  enum class Kind { none, segments, shells, parts, part, nodes, all } kind = Kind::none;
  int set = -1;            // index into the set list of that kind
  std::vector<int> parts;  // resolved part indices (parts, part, all)
  int box = -1;
};
enum class ContactKind {
  automatic_single_surface,
  automatic_surface_to_surface,
  automatic_nodes_to_surface,
  automatic_general,
  one_way_surface_to_surface,
  surface_to_surface,
  nodes_to_surface,
  tied_nodes_to_surface,
  tied_surface_to_surface,
  tied_shell_edge_to_surface,
  force_transducer
};
struct Contact {
  std::int64_t id = 0;
  std::string title;
  ContactKind kind;
  bool offset = false;              // tied: _OFFSET (penalty)
  bool constrained_offset = false;  // tied: _CONSTRAINED_OFFSET
  bool beam_offset = false;
  bool oriented = false;  // shells touch only on the side their normal points to
  ContactSide a, b;       // tracked (slave) and reference (master)
  double fs = 0, fd = 0, dc = 0, vc = 0, vdc = 0;
  double birth = 0, death = 1e28;
  double sfs = 1, sfm = 1, sst = 0, mst = 0, sfst = 1, sfmt = 1, fsf = 1, vsf = 1;
  int soft = 0;
  double sofscl = 0.1, maxpar = 1.025, penmax = 0;
  int sbopt = 2, depth = 2, ignore = 0, thkopt = 0, shlthk = 0, snlog = 0;
  Location where;
};

struct RigidWall {
  std::int64_t id = 0;
  std::string title;
  enum class Shape { plane, flat, prism, cylinder, sphere } shape = Shape::plane;
  std::vector<int> nodes;  // resolved: set less excluded, or all nodes
  bool all_nodes = false;
  Vec3d tail, head;                   // normal or axis from tail to head
  Vec3d edge;                         // finite plane: end of edge vector l
  double length_l = 0, length_m = 0;  // 0: infinite
  double radius = 0, length = 0;      // cylinder (0: infinite), sphere
  double friction = 0;                // 1: stick
  double velocity_limit = 0;          // WVEL
  double offset = 0, birth = 0, death = 1e28;
  bool moving = false;
  double mass = 0, velocity = 0;  // _MOVING
  int motion_curve = -1;          // _MOTION: curve, option (0 velocity, 1 displacement), direction
  int motion_option = 0;
  Vec3d motion_direction{};
};

struct RigidMerge {  // *CONSTRAINED_RIGID_BODIES
  int lead, constrained;
};
struct ExtraNodes {
  int part;
  std::vector<int> nodes;
};
struct NodalRigidBody {  // *CONSTRAINED_NODAL_RIGID_BODY, welds, spotwelds
  std::int64_t id = 0;
  std::vector<int> nodes;
  int local_system = -1;
  int pnode = -1;
  int cmo = 0, con1 = 0, con2 = 0;
  std::optional<InertiaOverride> inertia;
  // weld failure; infinite if none
  double failure_time = std::numeric_limits<double>::infinity();
  double normal_force = 0, shear_force = 0, normal_exponent = 2,
         shear_exponent = 2;  // 0: no force criterion
  enum class Kind { rigid, spotweld, generalized_spot } kind = Kind::rigid;
};
enum class JointKind {
  spherical,
  revolute,
  cylindrical,
  planar,
  translational,
  universal,
  locking
};
struct Joint {
  std::int64_t id = 0;
  std::string title;
  JointKind kind;
  std::array<int, 6> node{-1, -1, -1, -1, -1, -1};
  double penalty_scale = 1, damping = 1;  // RPS, DAMP
  bool lagrange = false;                  // LMF
};

struct SinglePointConstraint {
  std::vector<int> nodes;
  int local_system = -1;
  std::array<bool, 6> fixed{};
  double birth = 0, death = 1e28;
};
struct PrescribedMotion {
  enum class Target { nodes, rigid_body } target = Target::nodes;
  bool local = false;  // RIGID_LOCAL
  std::vector<int> nodes;
  int part = -1;
  int dof = 0;   // as in the deck
  int kind = 0;  // VAD 0 velocity, 1 acceleration, 2 displacement
  int curve = -1;
  double scale = 1, birth = 0, death = 1e28;
  Vec3d direction{};  // of VID for dof 4, 8
  Location where;
};
struct InitialVelocity {  // applied in order; later ones override
  std::vector<int> nodes;
  std::vector<int> parts;  // rigid parts among the targets (GENERATION, RIGID_BODY)
  Vec3d velocity{}, angular_velocity{};
  bool about_axis = false;  // GENERATION: v = velocity + omega x (x - point)
  Vec3d point{};
  bool rigid_bodies_only = false;
  bool override_inertia = false;  // IRIGID
};
struct BodyLoad {
  Vec3d direction;  // unit; base acceleration: body force is -mass * value * direction
  int curve = -1;
  double scale = 1;
  std::vector<int> parts;  // empty: all
};
struct NodalLoad {
  std::vector<int> nodes;
  int part = -1;  // *LOAD_RIGID_BODY
  int dof = 0;    // 1-3 force, 5-7 moment, 4/8 follower
  int curve = -1;
  double scale = 1;
  std::array<int, 3> follower{-1, -1, -1};
  int local_system = -1;
};
struct PressureLoad {
  std::vector<std::array<int, 4>> segments;
  int curve = -1;
  double scale = 1, arrival = 0;
};
struct Damping {
  // global mass damping
  int curve = -1;
  double value = 0;
  std::array<double, 6> scale{1, 1, 1, 1, 1, 1};
};
struct PartDamping {
  std::vector<int> parts;
  double stiffness = 0;  // COEF of *DAMPING_PART_STIFFNESS
  int mass_curve = -1;   // *DAMPING_PART_MASS
  double mass_scale = 0;
};
struct CrossSection {  // *DATABASE_CROSS_SECTION_SET
  std::int64_t id = 0;
  std::string title;
  std::vector<int> nodes;
  std::vector<int> solids, shells, beams, discretes;
  int local_system = -1;
};

struct Controls {
  double end_time = 0;
  int end_cycle = 0;
  double minimum_time_step_factor = 0;  // DTMIN
  double time_step_scale = 0.9;         // TSSFAC
  double initial_time_step = 0;         // DTINIT
  int shell_time_step = 0;              // ISDO
  double mass_scaling_time_step = 0;    // DT2MS
  bool mass_scaling_first_cycle_only = false;
  bool selective_mass_scaling = false;  // IMSCL
  int time_step_curve = -1;             // LCTM
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
