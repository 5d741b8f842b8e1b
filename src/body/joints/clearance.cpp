#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "body/joints/articulation.h"
#include "body/joints/bone_surface.h"
#include "body/mesh/quality.h"

namespace fabrica::body {

namespace {

constexpr double least_gap = 0.2;  // [mm] where no joint is
constexpr double deepest = 5;      // [mm] deeper is another side of the bone, not penetration
constexpr double least_jacobian = 0.25;
constexpr double least_width = 0.85;  // of a face, of what it was: the step of shells depends on it
constexpr int passes = 14;

// neighbours of each node along the edges of the bricks
std::vector<std::vector<int>> edges_of(const BoneMesh& mesh) {
  std::vector<std::vector<int>> neighbours(mesh.nodes.size());
  for (const Brick& brick : mesh.bricks)
    for (int corner = 0; corner < 8; ++corner)
      for (int other : corner_neighbours[corner])
        neighbours[std::size_t(brick[std::size_t(corner)])].push_back(brick[std::size_t(other)]);
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbours;
}

// area over longest diagonal [mm]
double width(const std::vector<Point>& nodes, const Quad& quad) {
  const Point d1 = nodes[std::size_t(quad[2])] - nodes[std::size_t(quad[0])],
              d2 = nodes[std::size_t(quad[3])] - nodes[std::size_t(quad[1])];
  return 0.5 * norm(cross(d1, d2)) / std::max(norm(d1), norm(d2));
}

// A bone whose surface moves.
class Movable {
 public:
  explicit Movable(PlacedBone& bone) : bone(bone), shift_(bone.nodes.size()) { rebuild(); }

  void rebuild() { surface = std::make_unique<BoneSurface>(bone.nodes, bone.mesh.surface); }
  // the longest wish of a pass counts
  void wish(int node, const Point& shift) {
    Point& kept = shift_[std::size_t(node)];
    if (dot(shift, shift) > dot(kept, kept)) kept = shift;
  }
  // moves the surface nodes by their wishes and the inner ones along; says whether any moved
  bool move();
  // takes over the wishes of the bone on the other side, mirrored
  void share(const Movable& twin);
  // becomes the mirror image of the bone on the other side
  void mirror_of(const Movable& twin);

  PlacedBone& bone;
  std::unique_ptr<BoneSurface> surface;
  double total = 0;  // [mm] longest shift of a node so far

 private:
  void carry_inside();
  bool restore(const std::vector<Point>& before);
  std::vector<Point> shift_, start_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<char> on_surface_;
};

// inner nodes: the mean shift of their neighbours, Jacobi iteration of Laplace's equation
void Movable::carry_inside() {
  for (int sweep = 0; sweep < 12; ++sweep) {
    std::vector<Point> next = shift_;
    for (std::size_t n = 0; n < shift_.size(); ++n) {
      if (on_surface_[n] || neighbours_[n].empty()) continue;
      Point sum{0, 0, 0};
      for (int m : neighbours_[n]) sum += shift_[std::size_t(m)];
      next[n] = (1.0 / double(neighbours_[n].size())) * sum;
    }
    shift_ = std::move(next);
  }
}

// bricks and faces that would get too thin: their nodes go back; says whether any did
bool Movable::restore(const std::vector<Point>& before) {
  bool any = false;
  const auto back = [&](int n) {
    any = any || norm(bone.nodes[std::size_t(n)] - before[std::size_t(n)]) > 0;
    bone.nodes[std::size_t(n)] = before[std::size_t(n)];
  };
  for (const Brick& brick : bone.mesh.bricks)
    if (scaled_jacobian(corners_of(bone.nodes, brick)) < least_jacobian)
      for (int n : brick) back(n);
  for (const Quad& quad : bone.mesh.surface)
    if (width(bone.nodes, quad) < least_width * width(start_, quad))
      for (int n : quad) back(n);
  return any;
}

bool Movable::move() {
  bool any = false, inside = false;
  for (const Point& s : shift_) any = any || dot(s, s) > 0;
  if (!any) return false;
  if (start_.empty()) {
    start_ = bone.nodes;
    neighbours_ = edges_of(bone.mesh);
    on_surface_.assign(bone.nodes.size(), 0);
    for (int node : surface->nodes()) on_surface_[std::size_t(node)] = 1;
  }
  for (std::size_t n = 0; n < shift_.size(); ++n)
    inside = inside || (!on_surface_[n] && dot(shift_[n], shift_[n]) > 0);
  if (!inside) carry_inside();
  const std::vector<Point> before = bone.nodes;
  for (std::size_t n = 0; n < shift_.size(); ++n) bone.nodes[n] += shift_[n];
  for (int round = 0; round < 6 && restore(before); ++round) {
  }
  for (std::size_t n = 0; n < shift_.size(); ++n) {
    total = std::max(total, norm(bone.nodes[n] - start_[n]));
    shift_[n] = {0, 0, 0};
  }
  rebuild();
  return true;
}

void Movable::share(const Movable& twin) {
  for (std::size_t n = 0; n < shift_.size(); ++n) wish(int(n), mirror(twin.shift_[n]));
}

void Movable::mirror_of(const Movable& twin) {
  for (std::size_t n = 0; n < shift_.size(); ++n) {
    bone.nodes[n] = mirror(twin.bone.nodes[n]);
    shift_[n] = {0, 0, 0};
  }
  total = twin.total;
  rebuild();
}

// For each bone the index of the bone that is its mirror image, -1: none stands so.
std::vector<int> twins_of(const std::vector<PlacedBone>& bones) {
  std::vector<int> twins(bones.size(), -1);
  for (std::size_t r = 0; r < bones.size(); ++r) {
    if (bones[r].side != Side::right) continue;
    const int l = find_bone(bones, bones[r].mesh.name, Side::left);
    if (l < 0) continue;
    const std::vector<Point>&right = bones[r].nodes, &left = bones[std::size_t(l)].nodes;
    bool same = right.size() == left.size();
    for (std::size_t n = 0; same && n < right.size(); ++n)
      same = norm(right[n] - mirror(left[n])) < 1e-6;
    if (same) twins[r] = l, twins[std::size_t(l)] = int(r);
  }
  return twins;
}

// Moves all bones by their wishes. Mirror images move as one: the midline bones between them are
// not symmetric, and each side alone would give way differently.
bool move_all(std::vector<Movable>& bones, const std::vector<int>& twins) {
  bool any = false;
  for (std::size_t i = 0; i < bones.size(); ++i) {
    Movable& m = bones[i];
    if (twins[i] < 0) {
      any = m.move() || any;
    } else if (m.bone.side == Side::right) {
      Movable& left = bones[std::size_t(twins[i])];
      m.share(left);
      if (!m.move()) continue;
      left.mirror_of(m);
      any = true;
    }
  }
  return any;
}

struct Pair {
  int a, b;
  double gap;  // wanted
};

// how far two bones are in one another at a joint
struct Overlap {
  double depth = 0;                       // [mm] missing to the wanted gap
  Point place{0, 0, 0}, normal{0, 0, 0};  // from b to a, unit
};

void collect(const Movable& a, const Movable& b, double gap, double sign, Overlap& overlap,
             double& weight) {
  for (int node : a.surface->nodes()) {
    const Point& p = a.bone.nodes[std::size_t(node)];
    const SurfacePoint there = b.surface->nearest(p, 12);
    if (there.quad < 0 || there.distance >= gap) continue;
    if (there.distance < 0 && dot(a.surface->node_normal(node), there.normal) > 0.3) continue;
    const double depth = gap - there.distance;
    overlap.depth = std::max(overlap.depth, depth);
    overlap.normal += (sign * depth) * there.normal;
    overlap.place += depth * p;
    weight += depth;
  }
}

// Moves the end of a bone by a shift that fades over the distance L from the joint:
// u = shift (1 - (r/L)^2)^2; bricks are pressed together over L instead of dented.
void press(Movable& m, const Point& place, const Point& shift) {
  Point size = m.surface->high - m.surface->low;
  const double L = std::min(30.0, 0.7 * std::max({size.x, size.y, size.z}));
  for (std::size_t n = 0; n < m.bone.nodes.size(); ++n) {
    const double r = norm(m.bone.nodes[n] - place) / L;
    if (r < 1) m.wish(int(n), ((1 - r * r) * (1 - r * r)) * shift);
  }
}

// the wishes of the two ends at a joint; of bones that are joined only the first gives way
void press_joint(std::vector<Movable>& bones, const Articulation& joint) {
  Movable &a = bones[std::size_t(joint.a)], &b = bones[std::size_t(joint.b)];
  const double gap = std::min(wanted_gap(joint), 0.3);
  Overlap overlap;
  double weight = 0;
  collect(a, b, gap, 1, overlap, weight);
  collect(b, a, gap, -1, overlap, weight);
  const double length = norm(overlap.normal);
  if (overlap.depth < 0.15 || length == 0) return;
  const Point normal = (1 / length) * overlap.normal, place = (1 / weight) * overlap.place;
  const double share = joint.kind == ArticulationKind::joined ? 1 : 0.5;
  press(a, place, share * overlap.depth * normal);
  if (share < 1) press(b, place, (-share * overlap.depth) * normal);
}

// Ends of bones that reach into each other, first the joints as a whole: right and left of a row
// of the table at once.
void press_ends(std::vector<Movable>& bones, const std::vector<Articulation>& joints,
                const std::vector<int>& twins) {
  for (int pass = 0; pass < 3; ++pass)
    for (std::size_t k = 0; k < joints.size(); ++k) {
      press_joint(bones, joints[k]);
      const bool other_side = k + 1 < joints.size() && joints[k + 1].name == joints[k].name;
      if (!other_side) move_all(bones, twins);
    }
}

bool boxes_meet(const BoneSurface& a, const BoneSurface& b, double gap) {
  for (int i = 0; i < 3; ++i)
    if (a.low[i] > b.high[i] + gap || b.low[i] > a.high[i] + gap) return false;
  return true;
}

std::vector<Pair> near_pairs(const std::vector<Movable>& bones,
                             const std::vector<Articulation>& joints) {
  std::map<std::pair<int, int>, double> wanted;
  for (const Articulation& joint : joints)
    wanted[std::minmax(joint.a, joint.b)] =
        joint.kind == ArticulationKind::joined ? -1 : wanted_gap(joint);  // ties bridge the rest
  std::vector<Pair> pairs;
  for (int a = 0; a < int(bones.size()); ++a)
    for (int b = a + 1; b < int(bones.size()); ++b) {
      const auto joint = wanted.find({a, b});
      const double gap = joint == wanted.end() ? least_gap : joint->second;
      if (gap > 0 &&
          boxes_meet(*bones[std::size_t(a)].surface, *bones[std::size_t(b)].surface, gap))
        pairs.push_back({a, b, gap});
    }
  return pairs;
}

// wishes of the nodes of a against the surface of b; gives the least gap found
double push_apart(Movable& a, Movable& b, double gap) {
  double least = gap;
  for (int node : a.surface->nodes()) {
    const Point& p = a.bone.nodes[std::size_t(node)];
    const SurfacePoint there = b.surface->nearest(p, std::max(gap, deepest));
    if (there.quad < 0 || there.distance >= gap) continue;
    // on the far side of a thin bone the nearest face looks the same way as this one
    if (there.distance < 0 && dot(a.surface->node_normal(node), there.normal) > 0.3) continue;
    least = std::min(least, there.distance);
    const Point apart = (0.5 * (gap - there.distance) + 0.01) * there.normal;
    a.wish(node, apart);
    for (int corner : b.bone.mesh.surface[std::size_t(there.quad)]) b.wish(corner, -apart);
  }
  return least;
}

}  // namespace

ClearanceReport clear_bones(std::vector<PlacedBone>& bones) {
  const std::vector<Articulation> joints = articulations(bones);
  std::vector<Movable> movable;
  movable.reserve(bones.size());
  for (PlacedBone& bone : bones) movable.emplace_back(bone);
  const std::vector<int> twins = twins_of(bones);
  press_ends(movable, joints, twins);
  const std::vector<Pair> pairs = near_pairs(movable, joints);

  ClearanceReport report;
  for (int pass = 0; pass <= passes; ++pass) {
    report.least_gap = 1e30;
    for (const Pair& pair : pairs) {
      Movable &a = movable[std::size_t(pair.a)], &b = movable[std::size_t(pair.b)];
      const double gap = std::min(push_apart(a, b, pair.gap), push_apart(b, a, pair.gap));
      if (gap < report.least_gap) {
        report.least_gap = gap;
        report.least_gap_pair = part_name(a.bone, "") + " " + part_name(b.bone, "");
      }
      if (pass == passes && gap < 0)
        report.left.push_back(part_name(a.bone, "") + " " + part_name(b.bone, ""));
    }
    if (pass == passes) break;
    if (!move_all(movable, twins)) break;
  }
  for (Movable& m : movable) {
    if (m.total == 0) continue;
    if (m.total > report.largest_shift)
      report.largest_shift = m.total, report.largest_shift_bone = part_name(m.bone, "");
    for (std::size_t n = 0; n < m.bone.nodes.size(); ++n)
      m.bone.mesh.nodes[n] = m.bone.placement.inverse(m.bone.nodes[n]);
    for (const Brick& brick : m.bone.mesh.bricks) {
      const double jacobian = scaled_jacobian(corners_of(m.bone.nodes, brick));
      if (jacobian < report.least_scaled_jacobian)
        report.least_scaled_jacobian = jacobian,
        report.least_scaled_jacobian_bone = part_name(m.bone, "");
    }
  }
  return report;
}

}  // namespace fabrica::body
