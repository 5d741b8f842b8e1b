#include "solver/contact_orientation.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fabrica {
namespace {

constexpr int samples_of_patch = 64;

int corners_of(const ContactSegment& s) { return s.triangle ? 3 : 4; }

void reverse(ContactSegment& s) {
  const int n = corners_of(s);
  std::reverse(s.node, s.node + n);
  if (s.triangle) s.node[3] = s.node[2];
  // corner i is now n-1-i; edge i -> i+1 is now edge n-2-i -> n-1-i
  std::uint8_t turned = 0;
  for (int i = 0; i < n; ++i) {
    if (s.free_features >> i & 1) turned |= 1 << ((2 * n - 2 - i) % n);
    if (s.free_features >> (4 + i) & 1) turned |= 16 << (n - 1 - i);
  }
  s.free_features = turned;
}

struct EdgeUse {
  int segment;
  bool forward;  // from the smaller node number to the larger
};

std::map<std::pair<int, int>, std::vector<EdgeUse>> edges_of(const ContactSurface& surface) {
  std::map<std::pair<int, int>, std::vector<EdgeUse>> edges;
  for (int i = 0; i < int(surface.segments.size()); ++i) {
    const ContactSegment& s = surface.segments[i];
    const int n = corners_of(s);
    for (int k = 0; k < n; ++k) {
      const int a = s.node[k], b = s.node[(k + 1) % n];
      edges[std::minmax(a, b)].push_back({i, a < b});
    }
  }
  return edges;
}

// segments of the patch of one seed, all in the sense of the seed
std::vector<int> collect_patch(ContactSurface& surface, int seed,
                               const std::map<std::pair<int, int>, std::vector<EdgeUse>>& edges,
                               std::vector<signed char>& sense) {
  std::vector<int> patch{seed};
  sense[seed] = 1;
  for (std::size_t at = 0; at < patch.size(); ++at) {
    const ContactSegment& s = surface.segments[patch[at]];
    const int n = corners_of(s);
    for (int k = 0; k < n; ++k) {
      const auto& uses = edges.at(std::minmax(s.node[k], s.node[(k + 1) % n]));
      if (uses.size() != 2)
        continue;  // a free edge, or a branch, where no sense follows from the neighbour
      const EdgeUse &own = uses[uses[0].segment == patch[at] ? 0 : 1],
                    &next = uses[uses[0].segment == patch[at] ? 1 : 0];
      if (sense[next.segment] != 0 || !surface.segments[next.segment].shell) continue;
      sense[next.segment] = own.forward == next.forward ? -sense[patch[at]] : sense[patch[at]];
      patch.push_back(next.segment);
    }
  }
  return patch;
}

// positive where the patch faces the other surface
double facing(const ContactSurface& surface, const std::vector<int>& patch,
              const std::vector<signed char>& sense, const ContactSurface& other,
              const std::vector<Vec3d>& x) {
  double sum = 0;
  const std::size_t stride = patch.size() / samples_of_patch + 1;
  for (std::size_t i = 0; i < patch.size(); i += stride) {
    const ContactSegment& s = surface.segments[patch[i]];
    const Vec3d &a = x[s.node[0]], &b = x[s.node[1]], &c = x[s.node[2]], &d = x[s.node[3]];
    const Vec3d area = s.triangle ? 0.5 * cross(b - a, c - a) : 0.5 * cross(c - a, d - b);
    const Vec3d centre = s.triangle ? (1.0 / 3) * (a + b + c) : 0.25 * (a + b + c + d);
    Vec3d nearest{0, 0, 0};
    double best = 1e300;
    for (const ContactNode& n : other.nodes) {
      const Vec3d to = x[n.node] - centre;
      if (const double distance = dot(to, to); distance < best) best = distance, nearest = to;
    }
    if (best > 0 && best < 1e300) sum += sense[patch[i]] * dot(area, nearest) / std::sqrt(best);
  }
  return sum;
}

}  // namespace

void face_each_other(ContactSurface& surface, const ContactSurface& other,
                     const std::vector<Vec3d>& start) {
  const auto edges = edges_of(surface);
  std::vector<signed char> sense(surface.segments.size(), 0);
  for (int seed = 0; seed < int(surface.segments.size()); ++seed) {
    if (sense[seed] != 0 || !surface.segments[seed].shell) continue;
    const std::vector<int> patch = collect_patch(surface, seed, edges, sense);
    const signed char turn = facing(surface, patch, sense, other, start) < 0 ? -1 : 1;
    for (int i : patch)
      if (turn * sense[i] < 0) reverse(surface.segments[i]);
  }
}

}  // namespace fabrica
