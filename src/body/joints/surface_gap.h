#pragma once
// Distance between two surfaces of quads, each quad two triangles: the least over all pairs of
// triangles, which is 0 where edges of one pass through the other, else that of a corner to a
// triangle or of two edges. No side is told apart: nothing is negative.
#include <vector>

#include "body/joints/bone_surface.h"

namespace fabrica::body {

// distance [mm] of the segments ab and cd
double segment_distance(const Point& a, const Point& b, const Point& c, const Point& d);

class SurfaceGap {
 public:
  // nodes of both surfaces in one list, which must outlive this and stay where it is
  SurfaceGap(const std::vector<Point>& nodes, const std::vector<std::array<int, 4>>& a,
             const std::vector<std::array<int, 4>>& b)
      : nodes_(nodes), quads_a_(a), quads_b_(b), a_(nodes, a), b_(nodes, b) {}
  // least distance [mm] of the two surfaces
  double least() const;
  // [mm] of a node of a to the surface b
  double to_b(int node) const;
  // nodes of the surface a that are within reach [mm] of b
  std::vector<int> facing(double reach) const;

 private:
  const std::vector<Point>& nodes_;
  const std::vector<std::array<int, 4>>&quads_a_, &quads_b_;
  BoneSurface a_, b_;
};

}  // namespace fabrica::body
