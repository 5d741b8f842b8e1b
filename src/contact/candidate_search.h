#pragma once
// Every pair (point, box) with the point inside the box: cells of the size of a typical box, points
// sorted by cell key (x fastest), each box scans the rows of cells it overlaps. Deterministic: the
// result is sorted by point, then box, whatever the order of the search.
#include <vector>

#include "base/tensor.h"

namespace fabrica {

struct BoundingBox {
  Vec3d low, high;
  bool holds(const Vec3d& x) const {
    return x.x >= low.x && x.x <= high.x && x.y >= low.y && x.y <= high.y && x.z >= low.z &&
           x.z <= high.z;
  }
};

// boxes of point i: box[first[i]] .. box[first[i+1]-1], ascending
struct PointBoxPairs {
  std::vector<int> first, box;
};

// keep(point, box) says whether a pair is wanted at all.
class PairFilter {
 public:
  virtual ~PairFilter() = default;
  virtual bool keep(int point, int box) const = 0;
};

// Finds all pairs the filter keeps.
PointBoxPairs find_pairs(const std::vector<Vec3d>& points, const std::vector<BoundingBox>& boxes,
                         const PairFilter& filter);

}  // namespace fabrica
