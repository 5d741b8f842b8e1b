#pragma once
// What a model is made of: nodes, elements, sections, materials, parts. Index -1 means "none".
// Units are the deck's own.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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

}  // namespace fabrica
