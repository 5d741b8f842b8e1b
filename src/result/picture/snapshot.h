#pragma once
// States as VTK grids, whatever file they come from.
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <cstdint>
#include <string>
#include <vector>

#include "result/picture.h"

namespace fabrica {

struct Snapshot {
  double time = 0;
  vtkSmartPointer<vtkUnstructuredGrid>
      grid;  // cell array "part_id"; deleted and unwanted cells are gone
};
struct Snapshots {
  std::string title;
  std::vector<std::int64_t> part_id;    // ascending
  std::vector<std::string> part_title;  // one per part, may be empty
  std::vector<Snapshot> list;
};

// Reads the states the options ask for. Throws std::runtime_error.
Snapshots load_snapshots(const PictureOptions& options);

}  // namespace fabrica
