#include "body/joints/touch.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fabrica::body {

namespace {

constexpr double elsewhere = 0.2;  // [mm] gap where no joint is
constexpr double grown_on = 0.05;  // [mm] gap where bones are tied to each other

// barycentric coordinates of the projection of p on triangle abc, clipped to it
std::array<double, 3> barycentric(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point u = b - a, v = c - a, w = p - a;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
  const double det = uu * vv - uv * uv;
  if (det <= 0) return {1, 0, 0};
  const double s = std::max((vv * wu - uv * wv) / det, 0.0),
               t = std::max((uu * wv - uv * wu) / det, 0.0), sum = std::max(s + t, 1.0);
  return {1 - (s + t) / sum, s / sum, t / sum};
}

// weights of the corners of a quad at a point of its triangles (0 1 2) and (0 2 3)
std::array<double, 4> weights(const std::vector<Point>& nodes, const std::array<int, 4>& quad,
                              const Point& p) {
  Point x[4];
  for (std::size_t i = 0; i < 4; ++i) x[i] = nodes[std::size_t(quad[i])];
  const auto first = barycentric(p, x[0], x[1], x[2]), second = barycentric(p, x[0], x[2], x[3]);
  const double d1 = norm(p - (first[0] * x[0] + first[1] * x[1] + first[2] * x[2])),
               d2 = norm(p - (second[0] * x[0] + second[1] * x[2] + second[2] * x[3]));
  if (d1 <= d2) return {first[0], first[1], first[2], 0};
  return {second[0], 0, second[1], second[2]};
}

bool boxes_meet(const BoneSurface& a, const BoneSurface& b, double gap) {
  for (int i = 0; i < 3; ++i)
    if (a.low[i] > b.high[i] + gap || b.low[i] > a.high[i] + gap) return false;
  return true;
}

}  // namespace

std::vector<NearPair> Surfaces::near(const std::vector<Articulation>& joints) const {
  std::map<std::pair<int, int>, const Articulation*> joint_of;
  for (const Articulation& joint : joints)
    if (joint.kind != ArticulationKind::arch) joint_of[std::minmax(joint.a, joint.b)] = &joint;
  std::vector<NearPair> pairs;
  const int count = int(bones_.size());
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) {
      const auto joint = joint_of.find({a, b});
      const bool tied = joint != joint_of.end() && joint->second->kind == ArticulationKind::joined;
      const double gap = joint == joint_of.end() ? elsewhere
                         : tied                  ? grown_on
                                                 : wanted_gap(*joint->second);
      NearPair pair{a, b, gap, tied};
      if (joint != joint_of.end() && joint->second->kind == ArticulationKind::meniscal) {
        const Articulation& knee = *joint->second;
        pair.axis = bones_[std::size_t(knee.b)].placement.R * Point{0, 0, 1};
        pair.axial_gap = plateau_gap(knee);
      }
      if (boxes_meet((*this)[a], (*this)[b], pair.largest_gap())) pairs.push_back(pair);
    }
  return pairs;
}

void Surfaces::collect(const NearPair& pair, double margin, double reach,
                       std::vector<Touch>& list) const {
  const std::vector<Point>&here = bones_[std::size_t(pair.a)].nodes,
        &there = bones_[std::size_t(pair.b)].nodes;
  const BoneSurface &a = (*this)[pair.a], &b = (*this)[pair.b];
  for (int node : a.nodes()) {
    const Point& p = here[std::size_t(node)];
    const SurfacePoint at = b.nearest(p, std::max(pair.largest_gap() + margin, reach));
    if (at.quad < 0) continue;
    const double gap = pair.gap_at(at.normal);
    if (at.distance >= gap + margin) continue;
    // on the far side of a thin bone the nearest face looks the same way as this one; the blunt
    // ends of bones that are tied leave in any direction
    const double alike = dot(a.node_normal(node), at.normal);
    if (!pair.tied && at.distance < 0 && alike > 0.5) continue;
    const auto& quad = bones_[std::size_t(pair.b)].mesh.surface[std::size_t(at.quad)];
    list.push_back(
        {pair.a, node, pair.b, quad, weights(there, quad, at.point), at.normal, at.distance, gap});
  }
}

std::vector<Touch> Surfaces::both_ways(NearPair pair, double margin, double reach) const {
  std::vector<Touch> list;
  collect(pair, margin, reach, list);
  std::swap(pair.a, pair.b);
  collect(pair, margin, reach, list);
  return list;
}

std::vector<Touch> Surfaces::overlapping(int a, int b, double reach) const {
  return both_ways({a, b, 0, true}, 0, reach);
}

double Surfaces::way_out(int a, const std::vector<Touch>& overlapping, const Point& axis,
                         double reach) const {
  double way = 0;
  for (const Touch& t : overlapping) {
    const Point& p = bones_[std::size_t(t.a)].nodes[std::size_t(t.node)];
    const SurfacePoint exit = (*this)[t.b].hit(p, (t.a == a ? 1.0 : -1.0) * axis, reach);
    way = std::max(way, exit.quad < 0 ? reach : exit.distance);
  }
  return way;
}

// Ends that are grown together part along one axis, the one with the shortest way among the normals
// by which they overlap. What leaves the other bone by its side or its far face would wrap the one
// around the other: its depth counts along the axis.
void Surfaces::part_along_axis(const NearPair& pair, double reach, std::vector<Touch>& list) const {
  constexpr double along = 0.5;        // cosine
  constexpr std::size_t choices = 16;  // normals that are tried
  std::vector<Touch> overlapping;
  for (const Touch& t : list)
    if (t.distance < 0) overlapping.push_back(t);
  Point axis{0, 0, 0};
  double least = 1e30;
  const std::size_t stride = std::max<std::size_t>(overlapping.size() / choices, 1);
  for (std::size_t i = 0; i < overlapping.size(); i += stride) {
    const Point n = (overlapping[i].a == pair.a ? 1.0 : -1.0) * overlapping[i].normal;
    const double way = way_out(pair.a, overlapping, n, 2 * reach);
    if (way < least) least = way, axis = n;
  }
  std::erase_if(list, [&](Touch& t) {
    const Point out = (t.a == pair.a ? 1.0 : -1.0) * axis;
    if (dot(t.normal, out) > along || overlapping.empty()) return false;
    if (t.distance >= 0) return true;
    const PlacedBone& other = bones_[std::size_t(t.b)];
    const Point& p = bones_[std::size_t(t.a)].nodes[std::size_t(t.node)];
    const SurfacePoint exit = (*this)[t.b].hit(p, out, reach);
    if (exit.quad < 0) return true;
    t.quad = other.mesh.surface[std::size_t(exit.quad)];
    t.weight = weights(other.nodes, t.quad, exit.point);
    t.normal = out, t.distance = -exit.distance;
    return false;
  });
}

std::vector<Touch> Surfaces::touches(const NearPair& pair, double margin, double reach) const {
  std::vector<Touch> list = both_ways(pair, margin, reach);
  if (pair.tied) part_along_axis(pair, reach, list);
  return list;
}

}  // namespace fabrica::body
