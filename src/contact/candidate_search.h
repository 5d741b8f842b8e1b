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

// The pairs found, ascending by first, then second; one that stands in `old`, in the same order,
// keeps its history. Pair: an aggregate that begins with the integers `first` (point) and `second`
// (box).
template <class Pair>
std::vector<Pair> carry_over(const PointBoxPairs& found, const std::vector<Pair>& old) {
  std::vector<Pair> pairs;
  pairs.reserve(found.box.size());
  auto known = old.begin();
  for (int i = 0; i + 1 < int(found.first.size()); ++i)
    for (int p = found.first[i]; p < found.first[i + 1]; ++p) {
      const Pair pair{i, found.box[p]};
      while (known != old.end() &&
             (known->first < i || (known->first == i && known->second < pair.second)))
        ++known;
      const bool same = known != old.end() && known->first == i && known->second == pair.second;
      pairs.push_back(same ? *known : pair);
    }
  return pairs;
}

}  // namespace fabrica
