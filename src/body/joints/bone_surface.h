#pragma once
// Queries on the boundary of a meshed bone: nearest point with signed distance, first hit of a ray.
// Each quad counts as two triangles.
#include <array>
#include <vector>

#include "body/mesh/bone_mesh.h"

namespace fabrica::body {

struct SurfacePoint {
  int quad = -1;  // of the mesh's surface, -1: none found
  Point point{0, 0, 0};
  Point normal{0, 0, 1};  // outward, unit
  double distance = 0;    // [mm] negative inside (nearest query); along the ray (ray query)
};

class BoneSurface {
 public:
  // nodes and quads must outlive the surface, and the nodes stay where they are
  BoneSurface(const std::vector<Point>& nodes, const std::vector<std::array<int, 4>>& quads);

  // nearest point within reach [mm]; quad is -1 when there is none
  SurfacePoint nearest(const Point& p, double reach) const;
  // first hit from origin along the unit direction within reach [mm]
  SurfacePoint hit(const Point& origin, const Point& direction, double reach) const;
  // surface node nearest to p, and its distance
  int nearest_node(const Point& p, double& distance) const;

  const std::vector<int>& nodes() const { return nodes_; }  // of the surface, ascending
  // mean of the normals of the quads at a surface node, unit
  const Point& node_normal(int node) const { return node_normals_[std::size_t(node)]; }
  Point low{0, 0, 0}, high{0, 0, 0};

 private:
  struct Triangle {
    int quad;
    Point a, b, c, normal;
  };
  int cell(const Point& p, int axis) const;
  template <class F>
  void visit(const Point& from, const Point& to, F&& act) const;

  const std::vector<Point>& all_nodes_;
  std::vector<Triangle> triangles_;
  std::vector<int> nodes_;
  std::vector<Point> node_normals_;
  // grid of triangles by bounding box
  double spacing_ = 1;
  int count_[3] = {1, 1, 1};
  std::vector<std::vector<int>> cells_;
};

// unit outward normal of a quad
Point quad_normal(const Point& a, const Point& b, const Point& c, const Point& d);

inline constexpr double touching = 0.02;  // [mm] before a face that counts as behind it

// Does p stand less than `before` mm before a face or up to 3 mm behind it, or behind the edge
// where it forms a valley with its neighbour? Either diagonal counts, for a warped face lies
// between the two.
bool behind(const Point& p, const std::array<Point, 4>& face, double before);

}  // namespace fabrica::body
