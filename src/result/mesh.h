#pragma once
// The geometry that animation writers and readers share: what a d3plot or a .vtu can say about a
// model.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/model.h"
#include "model/output.h"

namespace fabrica {

// Indices are from 0. Elements keep the order of the model; discrete elements follow the beams.
struct ResultMesh {
  std::string title;
  std::vector<std::int64_t> node_id, solid_id, shell_id, beam_id, part_id;
  std::vector<float> position;  // 3 per node, at the start
  std::vector<std::array<int, 8>>
      solid;  // LS-DYNA order; tets repeat node 4, wedges are 1 2 3 4 5 5 6 6
  std::vector<std::array<int, 4>> shell;  // triangle: the last node twice
  std::vector<std::array<int, 3>> beam;   // third: orientation node or -1
  std::vector<int> solid_part, shell_part, beam_part;
  std::vector<std::string> part_title;  // one per part, may be empty strings
  std::vector<Family> part_family;
  int discretes = 0;  // so many of the beams, the last ones, are discrete elements
  int nodes() const { return int(node_id.size()); }
  int solids() const { return int(solid.size()); }
  int shells() const { return int(shell.size()); }
  int beams() const { return int(beam.size()); }
  int parts() const { return int(part_id.size()); }
};

// The mesh of a model that is finished. A tet10 becomes its four corners; a grounded spring a
// point.
ResultMesh result_mesh(const Model& model);

// The same mesh with nodes, elements and parts in ascending order of their user ids, as other
// programs expect them in a d3plot, and the maps from the new order to the old: sorted.node_id[i] =
// mesh.node_id[node[i]].
struct SortedMesh {
  ResultMesh mesh;
  std::vector<int> node, solid, shell, beam, part;
};
SortedMesh sorted_by_id(const ResultMesh& mesh);

// The corners of a solid in VTK's order and its shape: 4 tet, 5 pyramid, 6 wedge, 8 brick (=
// corners used).
struct SolidCorners {
  int count;
  std::array<int, 8> node;
};
SolidCorners solid_corners(const std::array<int, 8>& solid);

// Throws std::runtime_error naming the array if a state does not fit the mesh. Element arrays may
// be empty.
void check_state(const ResultMesh& mesh, const AnimationState& state);

// Von Mises stress of xx yy zz xy yz zx.
float von_mises(const float* stress);

}  // namespace fabrica
