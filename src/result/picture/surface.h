#pragma once
// What of a grid can be seen from outside.
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

namespace fabrica {

// Shells, lines, points and the outer faces of solids, with their cell and point data. A face of a
// solid that a shell lies on, corner by corner, is left out: the two would flicker through each
// other.
vtkSmartPointer<vtkPolyData> visible_surface(vtkUnstructuredGrid* grid);

}  // namespace fabrica
