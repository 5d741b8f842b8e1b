#pragma once
// Turns what a Builder collected into a valid Model: user ids become indices, cards become typed
// definitions, blank or zero fields become the defaults of the manual. Problems are collected,
// never thrown.
//
// Order: nodes and definitions, sections and materials, parts, elements, sets, then everything that
// refers to them, then checks over the whole model. One file each: resolve_mesh, _part, _set,
// _contact, _constraint, _load, _output, _check.
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "model/function.h"
#include "model/id_table.h"
#include "model/model.h"

namespace fabrica {

// value of a field, or fallback where it is blank or zero: how the format states "default"
inline double nonzero(const Card& card, std::string_view field, double fallback) {
  const double value = card.real(field);
  return value != 0 ? value : fallback;
}

class Resolver {
 public:
  explicit Resolver(Builder& builder);
  void run();

 private:
  using Read = void (Resolver::*)(const Card&);
  struct Handler {
    std::string_view keyword;  // ends in '*': prefix
    Read read;
  };
  // calls the handler of each card that has one, in deck order
  void read_all(const std::vector<Handler>& handlers);

  // diagnostics
  void error(const Card& card, std::string_view field, std::string name, std::string message,
             std::string remedy);
  void warning(const Card& card, std::string_view field, std::string name, std::string message,
               std::string remedy);
  void unsupported(const Card& card, std::string_view field, std::string name, std::string message,
                   std::string remedy);
  // True if a report may be listed: at most some of one name, so that a wrong offset does not hide
  // all else, and none of missing entities where a file is missing that may hold them. The others
  // are counted.
  bool may_report(const std::string& name, Severity severity = Severity::error);
  void report_rest();

  // references: index, or -1 if the id is zero or unknown (which check_references reports)
  int node(std::int64_t id) const { return id == 0 ? -1 : nodes_.find(id); }
  int part(std::int64_t id) const { return id == 0 ? -1 : table("part").find(id); }
  int curve(const Card& card, std::string_view field) const;
  int reference(std::string_view kind, std::int64_t id) const;
  const IdTable& table(std::string_view kind) const;
  IdTable& table(std::string_view kind);
  // registers the definition of an entity; false (and an error) if the id exists
  bool define(std::string_view kind, std::int64_t id, int index, const Card& card,
              std::string_view field);
  void check_references();
  void check_reference(const Card& card, const FieldSchema& field, double value, Location where);

  // mesh
  void resolve_nodes();
  void resolve_elements();
  void resolve_solids();
  void resolve_shells();
  void resolve_beams();
  void resolve_discretes();
  void resolve_masses();
  int element_node(std::int64_t id, std::int64_t element, const char* keyword, Location where);
  int element_part(std::int64_t id, std::int64_t element, const char* keyword, Location where,
                   Family family);
  void index_parts();

  // definitions
  void read_curve(const Card& card);
  void read_smooth_curve(const Card& card);
  void read_function(const Card& card);
  void read_curve_function(const Card& card);
  void resolve_functions();
  void add_function(FunctionLibrary& library, const Card& card);
  void tabulate(FunctionLibrary& library, const Card& card, double end);
  void read_table(const Card& card);
  void read_box(const Card& card);
  void read_coordinate_system(const Card& card);
  void read_coordinate_nodes(const Card& card);
  void read_coordinate_vector(const Card& card);
  void read_transformation(const Card& card);
  void read_vector(const Card& card);
  void read_sd_orientation(const Card& card);
  void add_curve(const Card& card, Curve curve);
  void add_system(const Card& card, CoordinateSystem system, const Vec3d& x, const Vec3d& xy);
  void degenerate_system(const Card& card, const CoordinateSystem& system);
  void place_system(const Card& card, CoordinateSystem& system);
  void move_nodes();
  void finish_curves();
  void finish_tables();

  // parts
  void read_section(const Card& card);
  void read_beam_section(const Card& card, Section& section);
  void read_material(const Card& card);
  void read_rigid_material(const Card& card, Material& material);
  void read_eos(const Card& card);
  void read_hourglass(const Card& card);
  void read_part(const Card& card);
  std::optional<InertiaOverride> read_inertia(const Card& card, std::string_view system_field);
  void read_deformable_to_rigid(const Card& card);
  void check_formulation(const Card& card, const Section& section);
  void check_parts();

  // sets
  void resolve_sets();
  void read_node_set(const Card& card);
  void read_part_set(const Card& card);
  void read_segment_set(const Card& card);
  void read_element_set(const Card& card);
  struct Marks;
  bool general_nodes(const Card& card, Marks& marks);
  bool general_elements(const Card& card, Family family, Marks& marks);
  bool general_segments(const Card& card, std::vector<std::array<int, 4>>& segments);
  void segments_of_part(int part, std::vector<std::array<int, 4>>& segments) const;
  std::vector<std::int64_t> generated_ids(const Card& card,
                                          const std::vector<std::int64_t>& all) const;
  std::vector<int> nodes_of_elements(Family family, const std::vector<int>& elements) const;
  std::vector<int> nodes_of_part(int part) const;
  std::vector<int> nodes_of_parts(const std::vector<int>& parts) const;
  std::vector<int> elements_of_part(Family family, int part) const;
  bool in_box(const Box& box, int node) const;
  int element_count(Family family) const;
  void element_nodes(Family family, int element, std::vector<int>& nodes) const;
  // nodes of a set, in its order; of id 0: all nodes
  std::vector<int> set_or_all(std::int64_t id) const;
  std::vector<int> selected_nodes(std::int64_t set, std::int64_t excluded, std::int64_t box) const;

  // contacts and walls
  void read_contact(const Card& card);
  ContactSide contact_side(const Card& card, std::string_view id, std::string_view type,
                           std::string_view box, bool may_be_all);
  void read_wall(const Card& card);
  void read_wall_friction(const Card& card, RigidWall& w);
  void read_wall_shape(const Card& card, RigidWall& wall);

  // constraints
  void read_rigid_bodies(const Card& card);
  void read_extra_nodes(const Card& card);
  void read_nodal_rigid_body(const Card& card);
  void read_spotweld(const Card& card);
  void read_generalized_spot(const Card& card);
  void read_joint(const Card& card);
  void read_spc(const Card& card);
  void read_prescribed_motion(const Card& card);
  void read_motion_extras(const Card& card, PrescribedMotion& m);

  // loads and initial conditions
  void read_initial_velocity(const Card& card);
  void read_initial_node(const Card& card);
  void read_initial_generation(const Card& card);
  void read_initial_rigid(const Card& card);
  void add_initial(InitialVelocity v);
  void read_body_load(const Card& card);
  void read_body_parts(const Card& card);
  void read_node_load(const Card& card);
  void read_segment_load(const Card& card);
  void read_shell_load(const Card& card);
  void add_pressure(const PressureLoad& load);
  void read_global_damping(const Card& card);
  void read_part_damping(const Card& card);
  Vec3d to_global(int system, const Vec3d& v) const;

  // control and output
  void read_control(const Card& card);
  void read_selective_mass(const Card& card);
  void read_timestep(const Card& card);
  void check_erosion(const Card& card);
  void read_control_contact(const Card& card);
  void read_database(const Card& card);
  void read_history(const Card& card);
  void read_extent(const Card& card);
  void read_cross_section_set(const Card& card);
  void read_cross_section_plane(const Card& card);
  void read_plane_elements(const Card& card, CrossSection& section);

  // whole-model checks
  void check_mesh();
  void check_mass();
  void merge_touching_parts(std::vector<int>& parent);
  void check_rigid_nodes();
  void check_motions_of_rigid_nodes();
  void check_joints();
  void check_termination();

  Builder& builder_;
  Model& model_;
  Diagnostics& diagnostics_;
  IdTable nodes_;
  std::map<std::string, IdTable, std::less<>> tables_;
  std::map<std::pair<std::string, Severity>, int> reports_;
  bool files_missing_ = false;
  std::vector<const Card*> table_cards_, function_cards_;
  // *DEFINE_CURVE_FUNCTION: of each curve, its card; null while it is evaluated and afterwards
  std::map<std::int64_t, const Card*> curve_functions_;
  std::unordered_map<const Card*, int> card_index_;
  std::vector<Vec3d> vectors_;
  std::vector<Hourglass> hourglasses_;
  std::vector<int> eos_cards_;
  std::vector<int> body_parts_;
  // part -> elements, compressed rows per family
  struct Rows {
    std::vector<int> start, element;
  };
  std::array<Rows, 5> part_elements_;
  // node -> rigid body (number of the merged group), -1: none; filled by check_rigid_nodes
  std::vector<int> node_to_rigid_;
  std::vector<const Card*> motion_cards_;  // of each of the prescribed motions
};

}  // namespace fabrica
