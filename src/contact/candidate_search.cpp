#include "contact/candidate_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace fabrica {
namespace {

constexpr int largest_index = (1 << 20) - 1;

struct Grid {
  Vec3d low;
  double cell;
  std::vector<std::uint64_t> key;  // ascending
  std::vector<int> point;          // in the order of the keys

  int index(double x, int axis) const {
    const double i = std::floor((x - low[axis]) / cell);
    return i <= 0 ? 0 : i >= largest_index ? largest_index : int(i);
  }
  static std::uint64_t pack(int i, int j, int k) {
    return std::uint64_t(k) << 42 | std::uint64_t(j) << 21 | std::uint64_t(i);
  }
};

// a cell is as large as the box at 80 % of the sizes, but never so small that indices overflow
double cell_size(const std::vector<BoundingBox>& boxes, const Vec3d& extent) {
  std::vector<double> size;
  size.reserve(boxes.size());
  for (const BoundingBox& b : boxes) {
    const Vec3d d = b.high - b.low;
    size.push_back(std::max({d.x, d.y, d.z}));
  }
  const std::size_t at = size.size() * 4 / 5;
  std::nth_element(size.begin(), size.begin() + std::ptrdiff_t(at), size.end());
  const double smallest = std::max({extent.x, extent.y, extent.z}) / (largest_index - 1);
  const double cell = std::max(size[at], smallest);
  return cell > 0 ? cell : 1;
}

Grid sort_points(const std::vector<Vec3d>& points, const std::vector<BoundingBox>& boxes) {
  Grid grid;
  Vec3d low = points[0], high = points[0];
  for (const Vec3d& x : points)
    for (int d = 0; d < 3; ++d) low[d] = std::min(low[d], x[d]), high[d] = std::max(high[d], x[d]);
  grid.low = low;
  grid.cell = cell_size(boxes, high - low);
  std::vector<std::pair<std::uint64_t, int>> order(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vec3d& x = points[p];
    order[p] = {Grid::pack(grid.index(x.x, 0), grid.index(x.y, 1), grid.index(x.z, 2)), int(p)};
  }
  std::sort(order.begin(), order.end());
  grid.key.reserve(order.size()), grid.point.reserve(order.size());
  for (const auto& [key, point] : order) grid.key.push_back(key), grid.point.push_back(point);
  return grid;
}

}  // namespace

PointBoxPairs find_pairs(const std::vector<Vec3d>& points, const std::vector<BoundingBox>& boxes,
                         const PairFilter& filter) {
  PointBoxPairs result;
  result.first.assign(points.size() + 1, 0);
  if (points.empty() || boxes.empty()) return result;
  const Grid grid = sort_points(points, boxes);
  std::vector<std::pair<int, int>> found;  // point, box; in the order of boxes
  auto test = [&](int point, int box) {
    if (boxes[box].holds(points[point]) && filter.keep(point, box)) found.push_back({point, box});
  };
  for (int b = 0; b < int(boxes.size()); ++b) {
    const BoundingBox& box = boxes[b];
    int i0[3], i1[3];
    for (int d = 0; d < 3; ++d)
      i0[d] = grid.index(box.low[d], d), i1[d] = grid.index(box.high[d], d);
    const double rows = double(i1[1] - i0[1] + 1) * double(i1[2] - i0[2] + 1);
    // a box over many rows is cheaper against all points
    if (rows * 8 > double(points.size())) {
      for (int p = 0; p < int(points.size()); ++p) test(p, b);
      continue;
    }
    for (int k = i0[2]; k <= i1[2]; ++k)
      for (int j = i0[1]; j <= i1[1]; ++j) {
        const std::uint64_t from = Grid::pack(i0[0], j, k), to = Grid::pack(i1[0], j, k);
        auto at = std::lower_bound(grid.key.begin(), grid.key.end(), from) - grid.key.begin();
        for (; at < std::ptrdiff_t(grid.key.size()) && grid.key[at] <= to; ++at)
          test(grid.point[at], b);
      }
  }
  // counting sort by point; boxes stay ascending
  for (const auto& pair : found) ++result.first[pair.first + 1];
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.box.resize(found.size());
  std::vector<int> next(result.first.begin(), result.first.end() - 1);
  for (const auto& [point, box] : found) result.box[next[point]++] = box;
  return result;
}

}  // namespace fabrica
