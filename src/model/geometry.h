#pragma once
// Volumes and areas of elements in double, for checks and for reports before a run.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/tensor.h"

namespace fabrica {

// six times the volume of the tetrahedron of the origin and a, b, c
inline double triple_product(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return dot(cross(a, b), c);
}

// Corner numbers of the distinct nodes, in order of first appearance; returns their count.
inline int distinct_corners(const std::array<int, 10>& node, std::array<int, 8>& corner) {
  int count = 0;
  for (int k = 0; k < 8; ++k) {
    bool seen = node[k] < 0;
    for (int j = 0; j < count; ++j) seen |= node[corner[j]] == node[k];
    if (!seen) corner[count++] = k;
  }
  return count;
}

// faces of a brick, normals outwards
inline constexpr int brick_faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                          {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

// Signed volume of a tetrahedron; positive if 1, 2, 3 turn counterclockwise seen from 4.
inline double tet_volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return triple_product(b - a, c - a, d - a) / 6;
}

// Signed volume of a brick with bilinear faces, by the divergence theorem: the volume under a
// bilinear face is the mean of its two triangulations. Exact for wedges and pyramids that repeat
// nodes, not for tetrahedra.
inline double brick_volume(const Vec3d x[8]) {
  double six = 0;
  for (const auto& f : brick_faces) {
    const Vec3d a = x[f[0]] - x[0], b = x[f[1]] - x[0], c = x[f[2]] - x[0], d = x[f[3]] - x[0];
    six += 0.5 * (triple_product(a, b, c) + triple_product(a, c, d) + triple_product(a, b, d) +
                  triple_product(b, c, d));
  }
  return six / 6;
}

// Smallest det(dx/dxi) of a brick over the points of the 2 x 2 x 2 rule: at most 0 where the map is
// folded there.
inline double smallest_jacobian(const Vec3d x[8]) {
  constexpr int s[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                           {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  const double gauss = 1 / std::sqrt(3.0);
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& point : s) {
    Vec3d edge[3] = {};
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        edge[i] += (0.125 * s[a][i] * (1 + gauss * point[j] * s[a][j]) *
                    (1 + gauss * point[k] * s[a][k])) *
                   (x[a] - x[0]);
      }
    smallest = std::min(smallest, triple_product(edge[0], edge[1], edge[2]));
  }
  return smallest;
}

// area of a quadrilateral, or of a triangle that repeats its third node
inline double quad_area(const Vec3d x[4]) { return 0.5 * norm(cross(x[2] - x[0], x[3] - x[1])); }

}  // namespace fabrica
