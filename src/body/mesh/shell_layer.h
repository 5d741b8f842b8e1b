#pragma once
// The thickness of a shell that stands for a layer under a curved surface. A layer of depth d under
// a face of area A(0) holds the volume
//     V = integral of A(z) dz from 0 to d = d/6 (A(0) + 4 A(d/2) + A(d))        (Simpson, exact:
// A(z) = A(0) (1 - 2 H z + K z^2) with the mean and Gaussian curvature H, K of the face), a shell
// of thickness t the volume t A(0). So t = V / A(0), d (1 - H d + K d^2/3): less than d where the
// surface is convex, as shells that lie inside it would overlap in the corners.
#include <vector>

#include "body/mesh/bone_mesh.h"

namespace fabrica::body {

// [mm] for each quad of the surface with its depth [mm]; at least half the depth, 0 stays 0
std::vector<double> shell_thickness(const BoneMesh& mesh, const std::vector<double>& depth);

}  // namespace fabrica::body
