#include "result/picture/surface.h"

#include <vtkCellData.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkIdList.h>
#include <vtkNew.h>

#include <algorithm>
#include <set>
#include <vector>

namespace fabrica {
namespace {

std::vector<vtkIdType> corners_of(vtkPolyData* surface, vtkIdType cell) {
  vtkNew<vtkIdList> points;
  surface->GetCellPoints(cell, points);
  std::vector<vtkIdType> corners(points->begin(), points->end());
  std::sort(corners.begin(), corners.end());
  return corners;
}

}  // namespace

vtkSmartPointer<vtkPolyData> visible_surface(vtkUnstructuredGrid* grid) {
  vtkNew<vtkDataSetSurfaceFilter> filter;
  filter->SetInputData(grid);
  filter->PassThroughCellIdsOn();
  filter->Update();
  vtkSmartPointer<vtkPolyData> surface = filter->GetOutput();
  const char* const name = filter->GetOriginalCellIdsName();
  vtkDataArray* const origin = surface->GetCellData()->GetArray(name);
  auto dimension = [&](vtkIdType cell) {
    return grid->GetCell(vtkIdType(origin->GetTuple1(cell)))->GetCellDimension();
  };

  surface->BuildCells();
  std::set<std::vector<vtkIdType>> shells;
  std::vector<vtkIdType> faces;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c) {
    const int d = dimension(c);
    if (d == 2) shells.insert(corners_of(surface, c));
    if (d == 3) faces.push_back(c);
  }
  bool covered = false;
  for (const vtkIdType c : faces)
    if (!shells.empty() && shells.count(corners_of(surface, c)) > 0)
      surface->DeleteCell(c), covered = true;
  if (covered) surface->RemoveDeletedCells();
  surface->GetCellData()->RemoveArray(name);
  return surface;
}

}  // namespace fabrica
