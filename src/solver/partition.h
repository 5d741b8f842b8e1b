#pragma once
// Orders points so that consecutive groups of `size` are compact: recursive bisection along the
// longest side.
#include <algorithm>
#include <numeric>
#include <vector>

#include "base/tensor.h"

namespace fabrica {

namespace detail {
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
  const Vec3d side = high - low;
  const int axis = side.x >= side.y ? (side.x >= side.z ? 0 : 2) : (side.y >= side.z ? 1 : 2);
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
