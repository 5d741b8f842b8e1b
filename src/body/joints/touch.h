#pragma once
// Where two bones stand nearer to each other than they shall.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "body/joints/articulation.h"
#include "body/joints/bone_surfaces.h"

namespace fabrica::body {

// a surface node of bone a before a face of bone b
struct Touch {
  int a = 0, node = 0;
  int b = 0;
  std::array<int, 4> quad{};       // nodes of b
  std::array<double, 4> weight{};  // of them at the nearest point
  Point normal{0, 0, 1};           // of the face, unit
  double distance = 0;             // [mm] signed, negative: inside b
  double gap = 0;                  // [mm] wanted
};

// two bones that are near each other, and the gap [mm] that they shall have
struct NearPair {
  int a = 0, b = 0;
  double gap = 0;
  bool tied = false;
  // within 45 degrees of this axis, where there is one, another gap counts
  Point axis{0, 0, 0};
  double axial_gap = 0;
  double largest_gap() const { return std::max(gap, axial_gap); }
  double gap_at(const Point& normal) const {
    return std::abs(dot(normal, axis)) > 0.7 ? axial_gap : gap;
  }
};

class Surfaces {
 public:
  explicit Surfaces(const std::vector<PlacedBone>& bones) : bones_(bones), surfaces_(bones) {}
  void renew(int bone) { surfaces_.renew(bone); }  // after its nodes have moved
  const BoneSurface& operator[](int bone) const { return surfaces_[bone]; }
  // pairs whose boxes are within their gap: of a joint what the joint wants, 0.2 mm elsewhere
  std::vector<NearPair> near(const std::vector<Articulation>& joints) const;
  // the nodes of either bone that are nearer to the other than gap + margin; what is deeper than
  // reach [mm] inside is taken for the other side of the bone
  std::vector<Touch> touches(const NearPair& pair, double margin, double reach) const;

  // the nodes of either bone that are inside the other, at most reach deep, whatever face is near
  std::vector<Touch> overlapping(int a, int b, double reach) const;
  // [mm] how far bone a has to go along the unit axis until none of those nodes is inside the
  // other; at most reach
  double way_out(int a, const std::vector<Touch>& overlapping, const Point& axis,
                 double reach) const;

 private:
  void collect(const NearPair& pair, double margin, double reach, std::vector<Touch>& list) const;
  // where nodes of either bone touch the other
  std::vector<Touch> both_ways(NearPair pair, double margin, double reach) const;
  void part_along_axis(const NearPair& pair, double reach, std::vector<Touch>& list) const;
  const std::vector<PlacedBone>& bones_;
  BoneSurfaces surfaces_;
};

}  // namespace fabrica::body
