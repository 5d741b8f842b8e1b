#pragma once
// What lies between the bones, as plain lists: solids, membranes, tension-only lines, contacts and
// ties. The makers of joints fill them; the assembly gives ids and turns them into parts of the
// model. Units: mm, ms, kg, kN, GPa.
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "body/placed_bone.h"

namespace fabrica::body {

// A node of a piece: its own, or one that it shares with a bone or with an earlier piece.
struct PieceNode {
  Point x{0, 0, 0};  // [mm] global; of a shared node the place of its owner counts
  int bone = -1;     // index into the list of placed bones: shares node `node` of that bone
  int piece = -1;    // index into the list of pieces (an earlier one): shares its node `node`
  int node = -1;
};

// A material law that is not a row of data/materials.csv: a keyword with its fields, and where it
// has a curve the field that names it.
struct Law {
  std::string keyword;  // "MAT_ELASTIC"; empty: the piece names a row
  std::vector<std::pair<std::string, double>> fields;  // without the id
  std::string curve_field;                             // "lcd"; empty: no curve
  std::vector<std::pair<double, double>> curve;        // e.g. deflection [mm], force [kN]
  std::string source, flag;                            // as in data/materials.csv
};

enum class PieceKind {
  brick,     // 8-node solids
  shell,     // quads that bend
  membrane,  // quads that do not bend
  truss,     // lines with an area
  spring,    // discrete elements: law from a force-deflection curve
};

// Elements of one kind, section and material: becomes one part.
struct Piece {
  std::string name;  // region.side.tissue, "leg.right.knee.acl"
  Region region = Region::thorax;
  PieceKind kind = PieceKind::brick;
  int formulation =
      0;  // ELFORM; 0: the default of the kind (solid 1, shell 2, membrane 5, truss 3)
  std::vector<PieceNode> nodes;
  std::vector<std::array<int, 8>>
      bricks;  // indices into nodes; LS-DYNA order; a wedge repeats nodes
  std::vector<std::array<int, 4>> quads;  // a triangle repeats its last node
  std::vector<std::array<int, 2>> lines;
  std::vector<double> line_scale;  // springs: factor of the force of each line; empty: 1
  double thickness = 0;            // [mm] of quads
  double area = 0;                 // [mm2] of trusses
  std::string material;            // row of data/materials.csv; empty: law
  Law law;
  std::string bone_a,
      bone_b;  // what it connects, for the connectivity check; names as part_name without tissue
  std::string source;  // of geometry and stiffness
};

// One side of a contact or tie: quads of bones and pieces, outward normals.
struct SurfacePatch {
  std::vector<std::array<PieceNode, 4>> quads;  // shared nodes only: bone or piece set
};
struct ContactPair {
  std::string name;  // "leg.right.knee.tibiofemoral"
  SurfacePatch a, b;
  double friction = 0;
  std::string source;
};
struct Tie {  // nodes of a glued to the surface b
  std::string name;
  std::vector<PieceNode> a;
  SurfacePatch b;
};

struct BetweenBones {
  std::vector<Piece> pieces;
  std::vector<ContactPair> contacts;
  std::vector<Tie> ties;
};

}  // namespace fabrica::body
