#pragma once
// First principal strain of elements from the positions of their nodes, as any animation holds
// them.
//   F = (sum x_a dN_a) (sum X_a dN_a)^-1,  C = F^T F,  lam^2 its largest eigenvalue          (1)
//   logarithmic strain ln lam, Green's strain (lam^2 - 1)/2                                   (2)
// X start, x now, dN_a the gradients of the brick's trilinear functions at its centre: the mean of
// a brick, exact for a tetrahedron, whose nodes repeat. In a shell, C is that of the middle surface
// at the centre: bending is not in it.
#include <vector>

#include "result/d3plot.h"

namespace fabrica {

enum class StrainMeasure { logarithmic, green };

// Corners are 8 x 3 or 4 x 3 coordinates in LS-DYNA order; NaN where the element has no volume or
// area at the start.
double solid_strain(const double (&start)[8][3], const double (&now)[8][3], StrainMeasure measure);
double shell_strain(const double (&start)[4][3], const double (&now)[4][3], StrainMeasure measure);
// Volume [length^3] by the 2 x 2 x 2 rule, which is exact for the trilinear map; of a tetrahedron
// by its edges.
double solid_volume(const double (&corner)[8][3]);

// Per element of the mesh: the largest first principal strain over all states in which it is alive
// (0 if it is never pulled), and the volume of each solid at the start. Elements of parts that are
// not wanted stay at 0. Throws std::runtime_error where the file cannot be read or an element has
// no volume.
struct PeakStrains {
  std::vector<double> solid, shell, solid_volume;
};
PeakStrains peak_strains(const D3plotReader& file, const std::vector<bool>& wanted_part,
                         StrainMeasure measure);

}  // namespace fabrica
