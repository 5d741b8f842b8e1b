#include "body/mesh/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace fabrica::body {
namespace {

// are the cells of a 2 x 2 x 2 pattern (bit = x + 2 y + 4 z) connected through faces?
bool connected(unsigned pattern) {
  if (pattern == 0) return true;
  unsigned reached = pattern & (~pattern + 1), before = 0;
  while (reached != before) {
    before = reached;
    for (int a = 0; a < 8; ++a)
      if (reached >> a & 1)
        for (int axis = 1; axis < 8; axis *= 2) reached |= 1u << (a ^ axis) & pattern;
  }
  return reached == pattern;
}

struct VertexTable {
  std::array<bool, 256> good;
  VertexTable() {
    for (unsigned p = 0; p < 256; ++p) good[p] = connected(p) && connected(~p & 255u);
  }
};

// pattern of the cells around grid vertex (i, j, k); the vertex is the low corner of cell (i, j, k)
unsigned pattern(const CellGrid& grid, int i, int j, int k) {
  unsigned p = 0;
  for (int c = 0; c < 8; ++c)
    p |= unsigned(grid.inside[grid.index(i - 1 + (c & 1), j - 1 + (c >> 1 & 1), k - 1 + (c >> 2))])
         << c;
  return p;
}

bool bad(const CellGrid& grid, const VertexTable& table, int i, int j, int k) {
  return !table.good[pattern(grid, i, j, k)];
}

int bad_around(const CellGrid& grid, const VertexTable& table, int i, int j, int k) {
  int count = 0;
  for (int c = 0; c < 8; ++c)
    count += bad(grid, table, i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
  return count;
}

// the row of cells that mirrors row j; of a grid that is not symmetric the row itself
int image_row(const CellGrid& grid, int j) { return grid.symmetric ? grid.count[1] - 1 - j : j; }

// flips a cell and its mirror image
void flip(CellGrid& grid, int i, int j, int k) {
  grid.inside[grid.index(i, j, k)] ^= 1;
  if (grid.symmetric) grid.inside[grid.index(i, image_row(grid, j), k)] ^= 1;
}

// flips one of the eight cells at a bad vertex: the one that leaves fewest bad vertices and loses
// least volume
void flip_cheapest(CellGrid& grid, const VertexTable& table, std::vector<unsigned char>& flips,
                   int i, int j, int k) {
  int best = -1;
  double least = 1e9;
  for (int c = 0; c < 8; ++c) {
    const int x = i - 1 + (c & 1), y = j - 1 + (c >> 1 & 1), z = k - 1 + (c >> 2);
    if (x < 1 || y < 1 || z < 1 || x > grid.count[0] - 2 || y > grid.count[1] - 2 ||
        z > grid.count[2] - 2)
      continue;
    const int cell = grid.index(x, std::min(y, image_row(grid, y)), z);
    const int before = bad_around(grid, table, x, y, z);
    flip(grid, x, y, z);
    const int after = bad_around(grid, table, x, y, z);
    const double gained = grid.inside[cell] ? grid.fraction[cell] : 1 - grid.fraction[cell];
    flip(grid, x, y, z);
    // a little noise that depends on the cell alone breaks circles
    const double noise =
        0.1 * double((std::uint32_t(cell) * 2654435761u + flips[cell] * 40503u) >> 8 & 1023) / 1023;
    const double cost = after - before + 1.5 * (1 - 2 * gained) + 0.8 * flips[cell] + noise;
    if (cost < least) least = cost, best = cell;
  }
  if (best < 0) return;
  flip(grid, best % grid.count[0], best / grid.count[0] % grid.count[1],
       best / (grid.count[0] * grid.count[1]));
  if (flips[best] < 255) ++flips[best];
}

bool make_manifold(CellGrid& grid, const VertexTable& table, std::vector<unsigned char>& flips) {
  // of a symmetric grid the right half and the middle
  const int rows = grid.symmetric ? grid.count[1] / 2 + 1 : grid.count[1];
  for (int sweep = 0; sweep < 400; ++sweep) {
    bool found = false;
    for (int k = 1; k < grid.count[2]; ++k)
      for (int j = 1; j < rows; ++j)
        for (int i = 1; i < grid.count[0]; ++i)
          if (bad(grid, table, i, j, k)) found = true, flip_cheapest(grid, table, flips, i, j, k);
    if (!found) return true;
  }
  return false;
}

// marks the pieces of cells with value `value`, face to face; returns their sizes, labels from 1
std::vector<int> pieces(const CellGrid& grid, unsigned char value, std::vector<int>& label) {
  label.assign(grid.inside.size(), 0);
  std::vector<int> sizes, stack;
  for (int k = 0; k < grid.count[2]; ++k)
    for (int j = 0; j < grid.count[1]; ++j)
      for (int i = 0; i < grid.count[0]; ++i) {
        const int start = grid.index(i, j, k);
        if (grid.inside[start] != value || label[start]) continue;
        sizes.push_back(0);
        stack.push_back(start);
        label[start] = int(sizes.size());
        while (!stack.empty()) {
          const int cell = stack.back();
          stack.pop_back();
          ++sizes.back();
          const int x = cell % grid.count[0], y = cell / grid.count[0] % grid.count[1],
                    z = cell / (grid.count[0] * grid.count[1]);
          const int next[6][3] = {{x - 1, y, z}, {x + 1, y, z}, {x, y - 1, z},
                                  {x, y + 1, z}, {x, y, z - 1}, {x, y, z + 1}};
          for (const auto& n : next) {
            if (n[0] < 0 || n[1] < 0 || n[2] < 0 || n[0] >= grid.count[0] ||
                n[1] >= grid.count[1] || n[2] >= grid.count[2])
              continue;
            const int other = grid.index(n[0], n[1], n[2]);
            if (grid.inside[other] != value || label[other]) continue;
            label[other] = int(sizes.size());
            stack.push_back(other);
          }
        }
      }
  return sizes;
}

// keeps the largest piece and fills cavities; true when something changed
bool keep_one_piece(CellGrid& grid) {
  bool changed = false;
  std::vector<int> label;
  const std::vector<int> solids = pieces(grid, 1, label);
  if (solids.size() > 1) {
    const int keep = 1 + int(std::max_element(solids.begin(), solids.end()) - solids.begin());
    for (std::size_t c = 0; c < label.size(); ++c)
      if (label[c] && label[c] != keep) grid.inside[c] = 0;
    changed = true;
  }
  const std::vector<int> voids = pieces(grid, 0, label);
  if (voids.size() > 1) {
    const int outside = label[0];
    for (std::size_t c = 0; c < label.size(); ++c)
      if (label[c] && label[c] != outside) grid.inside[c] = 1;
    changed = true;
  }
  return changed;
}

// writes each quad of the left half as the mirror image of its partner, which keeps the diagonal
void mirror_quads(BoneMesh& mesh) {
  const auto aside = [&](const Quad& q) {
    double y = 0;
    for (const int n : q) y += mesh.nodes[n].y;
    return y;
  };
  std::map<Quad, Quad> left;
  for (const Quad& q : mesh.surface) {
    if (aside(q) > 0) continue;
    const Quad other{mesh.image[q[0]], mesh.image[q[3]], mesh.image[q[2]], mesh.image[q[1]]};
    left[sorted(other)] = other;
  }
  for (Quad& q : mesh.surface)
    if (aside(q) > 0) q = left.at(sorted(q));
}

}  // namespace

CellGrid rasterise(const DistanceField& field, double spacing, double growth, const Point& shift,
                   bool symmetric) {
  CellGrid grid;
  grid.symmetric = symmetric;
  grid.axes = field.axes();
  grid.spacing = spacing;
  const Box box = field.box();
  for (int a = 0; a < 3; ++a) {
    const double padding = growth + 2.5 * spacing;
    grid.count[a] = int(std::ceil((box.high[a] - box.low[a] + 2 * padding) / spacing)) + 1;
    const double middle = 0.5 * (box.low[a] + box.high[a]);
    grid.origin[a] = middle - 0.5 * grid.count[a] * spacing + shift[a] * spacing;
    if (!symmetric || a != 1) continue;
    grid.count[a] += grid.count[a] % 2;
    grid.origin[a] = -0.5 * grid.count[a] * spacing;
  }
  grid.inside.assign(std::size_t(grid.count[0]) * grid.count[1] * grid.count[2], 0);
  grid.fraction.assign(grid.inside.size(), 0.0f);
  for (int k = 0; k < grid.count[2]; ++k)
    for (int j = 0; j < grid.count[1]; ++j)
      for (int i = 0; i < grid.count[0]; ++i) {
        const Point low = grid.origin + spacing * Point{double(i), double(j), double(k)};
        const double phi =
            field.value(grid.axes.to_bone(low + (0.5 * spacing) * Point{1, 1, 1})) - growth;
        const int cell = grid.index(i, j, k);
        if (std::abs(phi) > 1.2 * spacing) {
          grid.fraction[cell] = phi < 0;
        } else {
          int inside = 0;
          for (int s = 0; s < 64; ++s) {
            const Point at{(s & 3) + 0.5, (s >> 2 & 3) + 0.5, (s >> 4) + 0.5};
            inside += field.value(grid.axes.to_bone(low + (0.25 * spacing) * at)) < growth;
          }
          grid.fraction[cell] = float(inside) / 64;
        }
        grid.inside[cell] = grid.fraction[cell] > 0.5f;
      }
  if (!symmetric) return grid;
  for (int k = 0; k < grid.count[2]; ++k)  // to the last sample
    for (int j = grid.count[1] / 2; j < grid.count[1]; ++j)
      for (int i = 0; i < grid.count[0]; ++i) {
        const int cell = grid.index(i, j, k), image = grid.index(i, image_row(grid, j), k);
        grid.fraction[cell] = grid.fraction[image], grid.inside[cell] = grid.inside[image];
      }
  return grid;
}

bool repair(CellGrid& grid) {
  static const VertexTable table;
  std::vector<unsigned char> flips(grid.inside.size(), 0);
  keep_one_piece(grid);
  for (int round = 0; round < 20; ++round) {
    if (!make_manifold(grid, table, flips)) return false;
    if (!keep_one_piece(grid)) return true;
  }
  return false;
}

BoneMesh bricks_of(const CellGrid& grid) {
  BoneMesh mesh;
  const int nx = grid.count[0] + 1, ny = grid.count[1] + 1;
  std::vector<int> node(std::size_t(nx) * ny * (grid.count[2] + 1), -1);
  for (int k = 0; k < grid.count[2]; ++k)
    for (int j = 0; j < grid.count[1]; ++j)
      for (int i = 0; i < grid.count[0]; ++i) {
        if (!grid.inside[grid.index(i, j, k)]) continue;
        Brick brick;
        const int steps[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
        for (int c = 0; c < 8; ++c) {
          const int x = i + steps[c][0], y = j + steps[c][1], z = k + steps[c][2];
          int& id = node[std::size_t(z * ny + y) * nx + x];
          if (id < 0) {
            id = int(mesh.nodes.size());
            mesh.nodes.push_back(grid.axes.to_bone(
                grid.origin + grid.spacing * Point{double(x), double(y), double(z)}));
          }
          brick[c] = id;
        }
        mesh.bricks.push_back(brick);
      }
  mesh.brick_layer.assign(mesh.bricks.size(), 0);
  mesh.surface = boundary_quads(mesh.bricks);
  if (!grid.symmetric) return mesh;
  mesh.image.resize(mesh.nodes.size());
  for (int k = 0; k <= grid.count[2]; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        if (const int n = node[std::size_t(k * ny + j) * nx + i]; n >= 0)
          mesh.image[n] = node[std::size_t(k * ny + ny - 1 - j) * nx + i];
  mirror_quads(mesh);
  return mesh;
}

std::vector<Twins> add_pillow(BoneMesh& mesh, const std::vector<char>& region, double depth) {
  std::vector<Brick> members;
  for (std::size_t e = 0; e < mesh.bricks.size(); ++e)
    if (region[e]) members.push_back(mesh.bricks[e]);
  const std::vector<Quad> boundary = boundary_quads(members);
  std::vector<Point> inward(
      mesh.nodes.size(),
      Point{0, 0, 0});  // sum of the centres of the region's bricks around a node
  std::vector<int> uses(mesh.nodes.size(), 0);
  for (const Brick& brick : members) {
    Point centre{0, 0, 0};
    for (const int n : brick) centre += 0.125 * mesh.nodes[n];
    for (const int n : brick) inward[n] += centre, ++uses[n];
  }
  std::vector<int> twin(mesh.nodes.size(), -1);
  std::vector<Twins> pairs;
  for (const Quad& quad : boundary)
    for (const int n : quad) {
      if (twin[n] >= 0) continue;
      twin[n] = int(mesh.nodes.size());
      const Point to = (1.0 / uses[n]) * inward[n] - mesh.nodes[n];
      mesh.nodes.push_back(mesh.nodes[n] + (depth / std::max(norm(to), 1e-9)) * to);
      pairs.push_back({n, twin[n]});
    }
  for (std::size_t e = 0; e < region.size(); ++e)
    if (region[e])
      for (int& n : mesh.bricks[e])
        if (twin[n] >= 0) n = twin[n];
  // a face seen from outside runs counter-clockwise: twins below, surface above
  for (const Quad& q : boundary) {
    mesh.bricks.push_back({twin[q[0]], twin[q[1]], twin[q[2]], twin[q[3]], q[0], q[1], q[2], q[3]});
    mesh.brick_layer.push_back(1);
  }
  return pairs;
}

}  // namespace fabrica::body
