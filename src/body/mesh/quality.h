#pragma once
// What bricks measure: scaled Jacobian, size, volume, boundary, Euler number, distance of the
// boundary to a field.
#include <array>
#include <vector>

#include "body/mesh/bone_mesh.h"
#include "body/mesh/distance_field.h"

namespace fabrica::body {

using Brick = std::array<int, 8>;
using Quad = std::array<int, 4>;

// outward faces of a brick in LS-DYNA corner order: -x, +x, -y, +y, -z, +z of the unit cube
inline constexpr int brick_faces[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                          {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
// the three neighbours of each corner, right-handed
inline constexpr int corner_neighbours[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                                {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};

// the corners in ascending order: the same for all quads on them
Quad sorted(Quad quad);

using Corners = std::array<Point, 8>;
Corners corners_of(const std::vector<Point>& nodes, const Brick& brick);

// the smallest over the corners of det(edges) / product of edge lengths; 1 for a box, negative when
// turned over
double scaled_jacobian(const Corners& corners);
// [mm3] of the trilinear brick
double volume_of(const Corners& corners);
// [mm] volume / largest face: what a wave must cross
double size_of(const Corners& corners);

// [mm] area / longest side of a shell
double shell_size(const std::vector<Point>& nodes, const Quad& quad);

// [mm] mean length of a brick's edges along each of its three directions
std::array<float, 3> edge_lengths(const Corners& corners);

// outward quads that belong to one brick only, in the order of the bricks
std::vector<Quad> boundary_quads(const std::vector<Brick>& bricks);
// V - E + F of a surface
int euler_number(const std::vector<Quad>& quads);

struct SurfaceError {
  double mean = 0, p95 = 0;  // [mm]
};
// |phi| at 3 x 3 points of each boundary quad, weighted by area
SurfaceError surface_error(const BoneMesh& mesh, const DistanceField& field);

// [mm] what 95 % of the field's surface (offset left out) stay within of the mesh's: large where
// the mesh lacks a process
double missing_p95(const BoneMesh& mesh, const DistanceField& field);

// fills all geometric figures of a report but those that need the bone's table
MeshReport measure(const BoneMesh& mesh);

}  // namespace fabrica::body
