#include "body/joints/knee_contact.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace fabrica::body {

namespace {

constexpr double reach = 15;        // [mm] farther bones do not meet
constexpr double facing = -0.4;     // (1)
constexpr double on_plateau = 0.7;  // cosine of 45 degrees
constexpr double around = 1;        // [mm] beyond the least distance: part of the contact

}  // namespace

struct KneeSurfaces::Pair {
  double distance;
  Point a, b;      // in the frames of both bones
  Point normal_b;  // in that of b
};

KneeSurfaces::KneeSurfaces(const BoneMesh& femur, const BoneMesh& tibia, const BoneMesh& patella,
                           Side side)
    : femur_(femur),
      tibia_(tibia),
      patella_(patella),
      medial_(side == Side::left ? -1 : 1),
      on_femur_(femur.nodes, femur.surface),
      on_tibia_(tibia.nodes, tibia.surface),
      on_patella_(patella.nodes, patella.surface) {}

std::vector<KneeSurfaces::Pair> KneeSurfaces::pairs(const BoneMesh& a, const BoneSurface& on_a,
                                                    const BoneMesh& b, const BoneSurface& on_b,
                                                    const Placement& a_in_b) {
  std::vector<Pair> list;
  const auto near = [](const Point& p, const BoneSurface& s) {
    bool in = true;
    for (int k = 0; k < 3; ++k) in = in && p[k] > s.low[k] - reach && p[k] < s.high[k] + reach;
    return in;
  };
  for (const int n : on_a.nodes()) {
    const Point &p = a.nodes[std::size_t(n)], there = a_in_b(p);
    if (!near(there, on_b)) continue;
    const SurfacePoint found = on_b.nearest(there, reach);
    if (found.quad < 0 || dot(a_in_b.R * on_a.node_normal(n), found.normal) > facing) continue;
    list.push_back({found.distance, p, found.point, found.normal});
  }
  for (const int n : on_b.nodes()) {
    const Point &p = b.nodes[std::size_t(n)], there = a_in_b.inverse(p);
    if (!near(there, on_a)) continue;
    const SurfacePoint found = on_a.nearest(there, reach);
    if (found.quad < 0 || dot(a_in_b.R * found.normal, on_b.node_normal(n)) > facing) continue;
    list.push_back({found.distance, found.point, p, on_b.node_normal(n)});
  }
  return list;
}

namespace {

// b as seen from a
Placement relative(const Placement& a, const Placement& b) {
  return {transpose(a.R) * b.R, a.inverse(b.t)};
}

template <class P, class F>
KneeContact contact_of(const std::vector<P>& pairs, F&& take) {
  KneeContact c;
  for (const P& p : pairs)
    if (take(p)) c.gap = std::min(c.gap, p.distance);
  double sum = 0;
  for (const P& p : pairs) {
    const double weight = take(p) ? 1 - (p.distance - c.gap) / around : 0;
    if (weight > 0) c.place += weight * p.b, sum += weight;
  }
  if (sum > 0) c.place = (1 / sum) * c.place;
  return c;
}

}  // namespace

KneeContacts KneeSurfaces::contacts(const Placement& femur, const Placement& tibia,
                                    const Placement& patella) const {
  KneeContacts found;
  const std::vector<Pair> below =
      pairs(femur_, on_femur_, tibia_, on_tibia_, relative(tibia, femur));
  const auto plateau = [](const Pair& p) { return p.normal_b.z > on_plateau; };
  // the femur's frame lies in the middle between its epicondyles
  found.medial =
      contact_of(below, [&](const Pair& p) { return plateau(p) && medial_ * p.a.y > 0; });
  found.lateral =
      contact_of(below, [&](const Pair& p) { return plateau(p) && medial_ * p.a.y < 0; });
  const std::vector<Pair> before =
      pairs(patella_, on_patella_, femur_, on_femur_, relative(femur, patella));
  // and so does the floor of its groove, nearly
  found.medial_patella = contact_of(before, [&](const Pair& p) { return medial_ * p.b.y > 0; });
  found.lateral_patella = contact_of(before, [&](const Pair& p) { return medial_ * p.b.y < 0; });
  return found;
}

// |x - c|^2 = r^2 is linear in c and r^2 - |c|^2
CondyleSphere posterior_condyle(const BoneMesh& femur, bool medial) {
  constexpr double off = 2, highest = 28;  // [mm] highest: above the lowest place of the condyle
  std::vector<Point> points;
  double low = 1e30;
  const BoneSurface surface(femur.nodes, femur.surface);
  for (const int n : surface.nodes()) {
    const Point& p = femur.nodes[std::size_t(n)];
    if ((p.y > 0) == medial) low = std::min(low, p.z);
  }
  for (const int n : surface.nodes()) {
    const Point &p = femur.nodes[std::size_t(n)], &normal = surface.node_normal(n);
    if ((p.y > 0) != medial || p.z > low + highest * femur.scale.z) continue;
    if (p.x < 0 && normal.x < 0.3 && std::abs(normal.y) < 0.5) points.push_back(p);
  }
  CondyleSphere sphere;
  for (int pass = 0; pass < 6; ++pass) {
    Eigen::MatrixXd a(long(points.size()), 4);
    Eigen::VectorXd b(long(points.size()));
    for (long i = 0; i < a.rows(); ++i) {
      const Point& p = points[std::size_t(i)];
      a.row(i) << 2 * p.x, 2 * p.y, 2 * p.z, 1;
      b[i] = dot(p, p);
    }
    const Eigen::VectorXd s = a.colPivHouseholderQr().solve(b);
    sphere.centre = {s[0], s[1], s[2]};
    sphere.radius = std::sqrt(s[3] + dot(sphere.centre, sphere.centre));
    std::erase_if(points, [&](const Point& p) {
      return std::abs(norm(p - sphere.centre) - sphere.radius) > off;
    });
  }
  return sphere;
}

}  // namespace fabrica::body
