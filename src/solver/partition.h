#pragma once
// Orders points so that consecutive groups of `size` are compact: recursive bisection along the
// longest side.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/tensor.h"

namespace fabrica {

namespace detail {
// Which axis to cut across: the longest side, or, of sides that are as long to a tenth, the one
// that the deck counts along (greatest covariance of number and place). Nodes are shared out among
// threads by number, so that few of them then lie on the cut between the tiles of two threads.
inline int cut_axis(const std::vector<Vec3d>& x, const int* first, const int* last,
                    const Vec3d& side) {
  const double n = double(last - first), longest = std::max({side.x, side.y, side.z});
  const auto long_enough = [&](int d) { return !(side[d] < 0.9 * longest); };
  if (long_enough(0) + long_enough(1) + long_enough(2) == 1)
    return long_enough(0) ? 0 : long_enough(1) ? 1 : 2;
  double number = 0;
  Vec3d middle{0, 0, 0}, along{0, 0, 0};
  for (const int* i = first; i != last; ++i) number += *i / n, middle += (1 / n) * x[*i];
  for (const int* i = first; i != last; ++i) along += (*i - number) * (x[*i] - middle);
  int axis = -1;
  for (int d = 0; d < 3; ++d) {
    if (!long_enough(d)) continue;
    // a clear difference only, as that between equal sides is rounding
    if (axis < 0 || std::abs(along[d]) > 1.2 * std::abs(along[axis])) axis = d;
  }
  return axis;
}

inline void bisect(const std::vector<Vec3d>& x, int* first, int* last, int size) {
  const long n = last - first;
  if (n <= size) {
    // inside a tile keep the deck's order: neighbours in the mesh are neighbours in the deck
    std::sort(first, last);
    return;
  }
  Vec3d low = x[*first], high = low;
  for (int* i = first; i != last; ++i)
    for (int d = 0; d < 3; ++d)
      low[d] = std::min(low[d], x[*i][d]), high[d] = std::max(high[d], x[*i][d]);
  const int axis = cut_axis(x, first, last, high - low);
  // the left part is a whole number of tiles
  const long tiles = (n + size - 1) / size, left = (tiles / 2) * size;
  std::nth_element(first, first + left, last, [&](int a, int b) {
    return x[a][axis] != x[b][axis] ? x[a][axis] < x[b][axis] : a < b;
  });
  bisect(x, first, first + left, size);
  bisect(x, first + left, last, size);
}
}  // namespace detail

inline std::vector<int> compact_order(const std::vector<Vec3d>& x, int size) {
  std::vector<int> order(x.size());
  std::iota(order.begin(), order.end(), 0);
  detail::bisect(x, order.data(), order.data() + order.size(), size);
  return order;
}

}  // namespace fabrica
