#pragma once
// The signed distance of a bone's surface on a grid: negative inside, zero on the surface [mm].
//
// Of parallel slices: in each slice the 2-D signed distance of all its contours, linear between
// neighbouring slices (shape-based interpolation: Raya, Udupa 1990). A bulge that ends between two
// slices h apart, r deep in one and d away from the contours of the other, ends r h / (r + d) from
// the first, near it where what else there is lies far off. Halfway: where two slices differ in
// sign, both count h at most, so that a deep bulge ends h / 2 beyond its last slice. Beyond an end
// slice phi grows by r / 0.8 mm per mm, r the depth of the end contour, so that the surface closes
// within 0.8 mm. Each value is then divided by the norm of its own gradient, because a distance
// measured in slices is too long over flat tops. Of triangles: the exact distance in a band.
#include <array>
#include <vector>

#include "body/mesh/bone_mesh.h"

namespace fabrica::body {

// right-handed axes of the grid in the bone frame
struct Axes {
  Point e1{1, 0, 0}, e2{0, 1, 0}, n{0, 0, 1};
  Point to_grid(const Point& p) const { return {dot(e1, p), dot(e2, p), dot(n, p)}; }
  Point to_bone(const Point& q) const { return q.x * e1 + q.y * e2 + q.z * n; }
};

struct Box {
  Point low, high;
};

// closed polygons of one plane; outer ones run counter-clockwise, holes clockwise
struct Slice {
  double height = 0;  // along n
  std::vector<std::vector<std::array<double, 2>>> loops;
};

struct TriangleSurface {
  std::vector<Point> nodes;
  std::vector<std::array<int, 3>> triangles;  // outward normal, closed
};

// The point of triangle abc that is nearest to p, by the Voronoi regions of its corners, edges and
// face (Ericson, Real-Time Collision Detection, 2005, 5.1.5).
Point closest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c);

class DistanceField {
 public:
  // slices in rising height; spacing of the grid and margin around the contours in mm; halfway: as
  // in the head of this file
  static DistanceField of_slices(const std::vector<Slice>& slices, const Axes& axes, double spacing,
                                 double margin, bool halfway = false);
  static DistanceField of_triangles(const TriangleSurface& surface, double spacing, double margin);
  // any function of a point, negative inside
  template <class F>
  static DistanceField of_function(const Box& box, double spacing, double margin, F&& phi) {
    DistanceField field(box, Axes{}, spacing, margin);
    field.fill([&](const Point& q) { return phi(q); });
    return field;
  }

  // Divides each value by the norm of its gradient (at least 0.6): near the surface it then is a
  // distance.
  void divide_by_gradient();

  // Makes each value the distance to the surface, which stays where it is: exact beside a plane,
  // elsewhere to first order in the spacing, and no more than 8 spacings. Along slices that end
  // flat, what is read between them has plateaus and ridges that hold nodes back.
  void measure_distance();

  // The solid with the centre of its volume moved to y = 0, and halfway to its mirror image there:
  // the mean of the two distances, which are measured anew before and after where they shall be
  // exact. The grid mirrors itself; its second axis must be y.
  DistanceField symmetric(bool exact = false) const;

  // signed distance less the outward offset, at a point of the bone frame
  double value(const Point& p) const;
  double value(const Point& p, Point& gradient) const;
  double offset = 0;  // [mm] the surface is moved outward by this much

  // points of the surface (offset left out) where it crosses the lines of the grid, every
  // `stride`-th point of it
  std::vector<Point> surface_points(int stride) const;

  Box box() const;  // of the solid itself, in grid axes
  const Axes& axes() const { return axes_; }
  double spacing() const { return spacing_; }
  double volume() const;  // [mm3] where phi < 0
  // sets the outward offset, at most `most` mm either way, for which the field holds the volume
  // [mm3]
  void match_volume(double volume, double most);

 private:
  DistanceField(const Box& box, const Axes& axes, double spacing, double margin);
  template <class F>
  void fill(F&& phi) {
    for (int k = 0; k < count_[2]; ++k)
      for (int j = 0; j < count_[1]; ++j)
        for (int i = 0; i < count_[0]; ++i)
          at(i, j, k) = float(phi(
              Point{origin_.x + i * spacing_, origin_.y + j * spacing_, origin_.z + k * spacing_}));
  }
  float& at(int i, int j, int k) { return phi_[std::size_t(k * count_[1] + j) * count_[0] + i]; }
  float at(int i, int j, int k) const {
    return phi_[std::size_t(k * count_[1] + j) * count_[0] + i];
  }

  Axes axes_;
  Point origin_{};  // of the grid, in grid axes
  double spacing_ = 1;
  std::array<int, 3> count_{};
  std::vector<float> phi_;
};

}  // namespace fabrica::body
