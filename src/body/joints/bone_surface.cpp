#include "body/joints/bone_surface.h"

#include <algorithm>
#include <cmath>

#include "body/mesh/distance_field.h"

namespace fabrica::body {

namespace {

// of what may have no length
Point unit_or_z(const Point& a) {
  const double length = norm(a);
  return length > 0 ? (1 / length) * a : Point{0, 0, 1};
}

}  // namespace

Point quad_normal(const Point& a, const Point& b, const Point& c, const Point& d) {
  return unit_or_z(cross(c - a, d - b));
}

bool behind(const Point& p, const std::array<Point, 4>& face, double before) {
  constexpr double on_face = 1e-3;  // [mm] beside a face that counts as over it
  // behind a valley between two faces the nearest place is its edge: so far beside a face counts as
  // behind it, of the depth, for valleys of up to 53 degrees
  constexpr double in_valley = 0.5;
  static constexpr int triangles[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
  return std::any_of(std::begin(triangles), std::end(triangles), [&](const int(&t)[3]) {
    const Point &a = face[std::size_t(t[0])], &b = face[std::size_t(t[1])],
                &c = face[std::size_t(t[2])];
    const Point normal = cross(b - a, c - a), to = p - closest_on_triangle(p, a, b, c);
    const double length = norm(normal), along = length > 0 ? dot(to, normal) / length : 0;
    const double aside2 = dot(to, to) - along * along,
                 beside = std::max(on_face, -in_valley * along);
    return length > 0 && aside2 < beside * beside && along < before && along > -3;
  });
}

BoneSurface::BoneSurface(const std::vector<Point>& nodes,
                         const std::vector<std::array<int, 4>>& quads)
    : all_nodes_(nodes) {
  node_normals_.assign(nodes.size(), Point{0, 0, 0});
  const auto at = [&](int node) { return nodes[std::size_t(node)]; };
  low = {1e30, 1e30, 1e30}, high = {-1e30, -1e30, -1e30};
  double edge = 0;
  for (std::size_t q = 0; q < quads.size(); ++q) {
    const auto& s = quads[q];
    const Point x[4] = {at(s[0]), at(s[1]), at(s[2]), at(s[3])};
    const Point normal = cross(x[2] - x[0], x[3] - x[1]);
    for (int corner = 0; corner < 4; ++corner) {
      node_normals_[std::size_t(s[std::size_t(corner)])] += normal;
      nodes_.push_back(s[std::size_t(corner)]);
      for (int i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], x[corner][i]);
        high[i] = std::max(high[i], x[corner][i]);
      }
    }
    edge += norm(x[1] - x[0]);
    triangles_.push_back({int(q), x[0], x[1], x[2], unit_or_z(cross(x[1] - x[0], x[2] - x[0]))});
    triangles_.push_back({int(q), x[0], x[2], x[3], unit_or_z(cross(x[2] - x[0], x[3] - x[0]))});
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  for (Point& normal : node_normals_) normal = unit_or_z(normal);

  // cells of about two edges
  spacing_ = std::max(2 * edge / double(std::max<std::size_t>(quads.size(), 1)), 1e-3);
  for (int i = 0; i < 3; ++i) count_[i] = std::max(1, int((high[i] - low[i]) / spacing_) + 1);
  cells_.resize(std::size_t(count_[0]) * std::size_t(count_[1]) * std::size_t(count_[2]));
  for (std::size_t k = 0; k < triangles_.size(); ++k) {
    const Triangle& t = triangles_[k];
    Point from, to;
    for (int i = 0; i < 3; ++i) {
      from[i] = std::min({t.a[i], t.b[i], t.c[i]});
      to[i] = std::max({t.a[i], t.b[i], t.c[i]});
    }
    visit(from, to, [&](std::size_t c) { cells_[c].push_back(int(k)); });
  }
}

int BoneSurface::cell(const Point& p, int axis) const {
  return std::clamp(int(std::floor((p[axis] - low[axis]) / spacing_)), 0, count_[axis] - 1);
}

template <class F>
void BoneSurface::visit(const Point& from, const Point& to, F&& act) const {
  for (int k = cell(from, 2); k <= cell(to, 2); ++k)
    for (int j = cell(from, 1); j <= cell(to, 1); ++j)
      for (int i = cell(from, 0); i <= cell(to, 0); ++i)
        act((std::size_t(k) * std::size_t(count_[1]) + std::size_t(j)) * std::size_t(count_[0]) +
            std::size_t(i));
}

SurfacePoint BoneSurface::nearest(const Point& p, double reach) const {
  SurfacePoint best;
  for (int i = 0; i < 3; ++i)
    if (p[i] < low[i] - reach || p[i] > high[i] + reach) return best;
  double least = reach, facing = 0;
  const Point r{reach, reach, reach};
  visit(p - r, p + r, [&](std::size_t c) {
    for (int k : cells_[c]) {
      const Triangle& t = triangles_[std::size_t(k)];
      const Point x = closest_on_triangle(p, t.a, t.b, t.c);
      const double distance = norm(p - x);
      if (distance > least + 1e-9) continue;
      // at an edge or corner the face that p sees most squarely decides about inside and outside
      const double square = std::abs(dot(p - x, t.normal));
      if (distance > least - 1e-9 && best.quad >= 0 && square <= facing) continue;
      least = std::min(least, distance), facing = square;
      best = {t.quad, x, t.normal, dot(p - x, t.normal) < 0 ? -distance : distance};
    }
  });
  return best;
}

SurfacePoint BoneSurface::hit(const Point& origin, const Point& direction, double reach) const {
  SurfacePoint best;
  double first = reach;
  const Point end = origin + reach * direction;
  Point from, to;
  for (int i = 0; i < 3; ++i) {
    from[i] = std::min(origin[i], end[i]), to[i] = std::max(origin[i], end[i]);
    if (to[i] < low[i] || from[i] > high[i]) return best;
  }
  visit(from, to, [&](std::size_t c) {
    for (int k : cells_[c]) {
      const Triangle& t = triangles_[std::size_t(k)];
      // Moeller, Trumbore 1997
      const Point e1 = t.b - t.a, e2 = t.c - t.a, h = cross(direction, e2);
      const double determinant = dot(e1, h);
      if (std::abs(determinant) < 1e-12) continue;
      const Point s = origin - t.a;
      const double u = dot(s, h) / determinant;
      const Point q = cross(s, e1);
      const double v = dot(direction, q) / determinant;
      if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) continue;
      const double along = dot(e2, q) / determinant;
      if (along < 0 || along > first) continue;
      first = along;
      best = {t.quad, origin + along * direction, t.normal, along};
    }
  });
  return best;
}

int BoneSurface::nearest_node(const Point& p, double& distance) const {
  int best = -1;
  distance = 1e30;
  for (int node : nodes_) {
    const double d = norm(all_nodes_[std::size_t(node)] - p);
    if (d < distance) distance = d, best = node;
  }
  return best;
}

}  // namespace fabrica::body
