#pragma once
// Animation states for ParaView: one .vtu (unstructured grid, appended raw data) per state and a
// .pvd that gives their times. Cells are solids, shells, beams, discrete elements, in this order.
//   points  displacement, velocity, acceleration, node_id
//   cells   part_id, element_id, stress (xx yy zz xy yz xz; shells: first layer), von_mises and
//   plastic_strain
//           (shells: largest of the layers), vtkGhostType (32, hidden, for deleted elements)
#include <string>
#include <utility>
#include <vector>

#include "result/mesh.h"

namespace fabrica {

struct VtuOptions {
  bool compress = true;  // zlib
};

class VtuWriter {
 public:
  // `path` is that of the .pvd; the states stand beside it as <stem>_0000.vtu. Throws
  // std::runtime_error.
  VtuWriter(const std::string& path, const ResultMesh& mesh, const VtuOptions& options = {});
  // Goes on after a restart: later states are dropped from the series.
  VtuWriter(const std::string& path, const ResultMesh& mesh, const VtuOptions& options,
            double restart_time);
  void write(const AnimationState& state);

 private:
  std::string path_;
  ResultMesh mesh_;
  VtuOptions options_;
  std::vector<std::pair<double, std::string>> series_;  // time, file name
};

// Times and files of a .pvd, in its order; files are relative to it. Throws std::runtime_error.
std::vector<std::pair<double, std::string>> read_pvd(const std::string& path);

// Per cell in the order above, for one state: largest of the layers for shells, axial force for
// beams is not a stress and gives 0. Arrays the state does not carry give zeros.
std::vector<float> cell_von_mises(const ResultMesh& mesh, const AnimationState& state);
std::vector<float> cell_plastic_strain(const ResultMesh& mesh, const AnimationState& state);
// 1 for elements that take part, 0 for deleted ones.
std::vector<std::uint8_t> cell_alive(const ResultMesh& mesh, const AnimationState& state);

// The cells in VTK's terms: connectivity, end of each cell in it, cell types.
struct VtkCells {
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
};
VtkCells vtk_cells(const ResultMesh& mesh);

}  // namespace fabrica
