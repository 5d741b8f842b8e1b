#pragma once
// The skull: base and face from their contour stack, the vault from the spherical harmonics of its
// outer and inner surface (thickness after the literature: the measured vault is too thin), blended
// over a belt of the frontal, temporal and occipital squama. From standard resolution on the vault
// has three layers of bricks: outer table, diploe, inner table; at coarse it is diploe between
// shells.
#include "body/mesh/bone_tables.h"
#include "body/mesh/mesher.h"

namespace fabrica::body {

// stack: the field of the skull's slices
BoneShape skull_shape(const DistanceField& stack, double grid, double margin);

// Layers: 0 base and face, 1 outer table, 2 diploe, 3 inner table. Throws BodyError when no plane
// parts vault and base.
BoneMesh skull_mesh(BoneShape& shape, const CellOptions& options, Resolution resolution);

}  // namespace fabrica::body
