#pragma once
// What acts on a model: contacts, walls, rigid bodies, joints, constraints, loads, damping. Index
// -1 means "none". Units are the deck's own.
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/parameters.h"
#include "base/tensor.h"
#include "model/define.h"

namespace fabrica {

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
  double friction = 0;                // 1: stick; 2: weld and slide, 3: weld and stick
  double velocity_limit = 0;          // WVEL: normal speed above which nodes weld
  struct Ortho {                      // friction along a and b = n x a
    double fs_a = 0, fs_b = 0, fd_a = 0, fd_b = 0, decay_a = 0, decay_b = 0;
    std::array<int, 2> node{-1, -1};  // a is the part of node 2 - node 1, or of the direction,
    Vec3d direction{};                // in the plane
  };
  std::optional<Ortho> ortho;
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
  Location where;
};
struct PrescribedMotion {
  enum class Target { nodes, rigid_body } target = Target::nodes;
  bool local = false;  // RIGID_LOCAL
  std::vector<int> nodes;
  int rigid_nodes = 0;  // how many of them are reported as nodes of rigid bodies
  int part = -1;
  int dof = 0;   // as in the deck
  int kind = 0;  // VAD 0 velocity, 1 acceleration, 2 displacement, 3 velocity by displacement,
                 // 4 displacement relative to a lead body
  int curve = -1;
  double scale = 1, birth = 0, death = 1e28;
  Vec3d direction{};                // of VID for dof 4, 8
  std::array<double, 2> offset{};   // of dof 9 to 11: where the axis pierces its plane
  int lead = -1;                    // part of the lead body, of kind 4
  std::array<int, 2> node{-1, -1};  // direction of kind 4; none: the line of the centres
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
  Location where;
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

}  // namespace fabrica
