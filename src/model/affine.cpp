#include "model/affine.h"

#include <cmath>
#include <map>

namespace fabrica {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

// turn about the axis through p: Rodrigues' formula R = I + sin(t) K + (1 - cos(t)) K^2
std::optional<Affine> turn(const Vec3d& axis, const Vec3d& p, double angle) {
  const double length = norm(axis);
  if (!(length > 0)) return std::nullopt;
  const Vec3d u = (1 / length) * axis;
  const Mat3d k{{{0, -u.z, u.y}, {u.z, 0, -u.x}, {-u.y, u.x, 0}}};
  const Mat3d k2 = k * k;
  Affine t;
  t.identity = false;
  const double s = std::sin(angle * degree), c = 1 - std::cos(angle * degree);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.a(i, j) = (i == j) + s * k(i, j) + c * k2(i, j);
  t.b = p - t.a * p;
  return t;
}

// reflection at the plane through p with normal n: x' = x - 2 n (n . (x - p))
std::optional<Affine> mirror(const Vec3d& p, const Vec3d& normal) {
  const double length = norm(normal);
  if (!(length > 0)) return std::nullopt;
  const Vec3d n = (1 / length) * normal;
  Affine t;
  t.identity = false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.a(i, j) = (i == j) - 2 * n[i] * n[j];
  t.b = (2 * dot(n, p)) * n;
  return t;
}

using Points = std::map<std::int64_t, Vec3d>;

// ROTATE: axis a1-a3 through the point a4-a6 by a7 degrees, or about the line of points a1, a2 by
// a3
std::optional<Affine> rotation(const Card& card, int r, const double* a, const Points& points,
                               std::string& problem) {
  const bool by_points = a[3] == 0 && a[4] == 0 && a[5] == 0 && a[6] == 0 && !card.row_given(r, 7);
  if (!by_points) {
    const auto t = turn({a[0], a[1], a[2]}, {a[3], a[4], a[5]}, a[6]);
    if (!t) problem = "the axis of ROTATE has no length";
    return t;
  }
  const auto p = points.find(std::int64_t(a[0])), q = points.find(std::int64_t(a[1]));
  if (p == points.end() || q == points.end()) {
    if (a[2] == 0) return Affine();
    problem = "ROTATE names a POINT that is not defined above it";
    return std::nullopt;
  }
  const auto t = turn(q->second - p->second, p->second, a[2]);
  if (!t) problem = "the two points of ROTATE coincide";
  return t;
}

}  // namespace

Affine compose(const Affine& outer, const Affine& inner) {
  if (outer.identity) return inner;
  if (inner.identity) return outer;
  return {outer.a * inner.a, outer.a * inner.b + outer.b, false};
}

std::optional<Affine> affine_of(const Card& card, std::string& problem) {
  Affine whole;
  Points points;
  for (int r = 0; r < card.row_count(); ++r) {
    std::string option(card.row_text(r, 0));
    for (char& c : option)
      if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
    double a[7];
    for (int i = 0; i < 7; ++i) a[i] = i + 1 < card.columns() ? card.row(r, i + 1) : 0;
    std::optional<Affine> t = Affine();
    if (option == "TRANSL") {
      t->b = {a[0], a[1], a[2]};
      t->identity = false;
    } else if (option == "SCALE") {
      for (int i = 0; i < 3; ++i) t->a(i, i) = a[i] == 0 ? 1 : a[i];
      t->identity = false;
    } else if (option == "ROTATE") {
      t = rotation(card, r, a, points, problem);
    } else if (option == "MIRROR") {
      t = mirror({a[0], a[1], a[2]}, Vec3d{a[3], a[4], a[5]} - Vec3d{a[0], a[1], a[2]});
      if (!t) problem = "the normal of MIRROR has no length";
    } else if (option == "POINT") {
      points[std::int64_t(a[0])] = {a[1], a[2], a[3]};
    } else {
      problem = "transformation " + option + " is not supported";
      return std::nullopt;
    }
    if (!t) return std::nullopt;
    whole = compose(*t, whole);
  }
  return whole;
}

}  // namespace fabrica
