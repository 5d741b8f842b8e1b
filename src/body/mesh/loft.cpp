#include "body/mesh/loft.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/lane_math.h"
#include "body/placement.h"

namespace fabrica::body {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double core_size = 0.52;  // half width of the O-grid's core in radii
constexpr double last_section =
    0.6;                        // height of the last section of bricks in a dome, in dome heights
constexpr double flared = 0.3;  // of the length from either end, where ends widen

double radius(const LoftStation& section, double phi) {
  double r = section.r0;
  for (int k = 1; k <= loft_harmonics; ++k)
    r += section.cosine[k - 1] * cos(k * phi) + section.sine[k - 1] * sin(k * phi);
  return std::max(r, 0.2 * section.r0);
}

// direction of the longer half width and the two half widths, from the second harmonic
struct Shape {
  double angle, a, b;
};

Shape shape_of(const LoftStation& s, double before) {
  const double flat = std::sqrt(s.cosine[1] * s.cosine[1] + s.sine[1] * s.sine[1]);
  double angle = 0.5 * std::atan2(s.sine[1], s.cosine[1]);
  // a square core looks the same after a quarter turn: turn as little as possible from the section
  // before
  const double turn = angle - before;
  const double rest = turn - 0.5 * pi * std::round(turn / (0.5 * pi));
  angle = before + rest * std::min(1.0, flat / (0.15 * s.r0));
  const double along = cos(2 * angle) * s.cosine[1] + sin(2 * angle) * s.sine[1];
  return {angle, std::max(s.r0 + along, 0.3 * s.r0), std::max(s.r0 - along, 0.3 * s.r0)};
}

// points of the O-grid in a unit disc: (angle in the sense of an even section, fraction of the
// radius)
struct DiscPoint {
  double psi, rho;
};

struct Disc {
  std::vector<DiscPoint> points;
  std::vector<Quad> quads;
};

// core x core squares; with a ring around them, or without: then the outer points are the grid's
// own rim
Disc o_grid(int core, bool ring) {
  Disc disc;
  const int row = core + 1;
  for (int j = 0; j < row; ++j)
    for (int i = 0; i < row; ++i) {
      const double x = 2.0 * i / core - 1, y = 2.0 * j / core - 1;
      const double most = std::max(std::abs(x), std::abs(y)), length = std::sqrt(x * x + y * y);
      // inside a ring the core is between a square and a disc, so that its corners keep obtuse
      // angles small
      const double rho = length == 0 ? 0
                         : ring      ? core_size * most * (0.45 + 0.55 * length / most)
                                     : most;
      disc.points.push_back({std::atan2(y, x), rho});
    }
  for (int j = 0; j < core; ++j)
    for (int i = 0; i < core; ++i)
      disc.quads.push_back(
          {j * row + i, j * row + i + 1, (j + 1) * row + i + 1, (j + 1) * row + i});
  if (!ring) return disc;
  std::vector<int> rim;  // counter-clockwise from the first corner
  for (int i = 0; i < core; ++i) rim.push_back(i);
  for (int j = 0; j < core; ++j) rim.push_back(j * row + core);
  for (int i = core; i > 0; --i) rim.push_back(core * row + i);
  for (int j = core; j > 0; --j) rim.push_back(j * row);
  const int first = int(disc.points.size()), count = int(rim.size());
  for (int m = 0; m < count; ++m) disc.points.push_back({disc.points[rim[m]].psi, 1.0});
  for (int m = 0; m < count; ++m) {
    const int next = (m + 1) % count;
    disc.quads.push_back({rim[m], first + m, first + next, rim[next]});
  }
  return disc;
}

}  // namespace

Point point_of(const LoftStation& section, double phi, double rho) {
  const double r = rho * radius(section, phi);
  return section.c + (r * cos(phi)) * section.e1 + (r * sin(phi)) * cross(section.n, section.e1);
}

Loft::Loft(std::vector<LoftStation> stations, double dome)
    : stations_(std::move(stations)), dome_{dome, dome} {
  measure();
}

void Loft::measure() {
  stations_.front().s = 0;
  for (std::size_t i = 1; i < stations_.size(); ++i)
    stations_[i].s = stations_[i - 1].s + norm(stations_[i].c - stations_[i - 1].c);
}

LoftStation Loft::section(double s) const {
  std::size_t i = 0;
  while (i + 2 < stations_.size() && stations_[i + 1].s < s) ++i;
  const LoftStation &a = stations_[i], &b = stations_[i + 1];
  const double width = b.s - a.s, t = std::clamp((s - a.s) / width, 0.0, 1.0);
  // cubic Hermite interpolation with slopes from the neighbours, one-sided at the ends
  const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 2, stations_.size() - 1);
  const double t2 = t * t, t3 = t2 * t;
  const auto cubic = [&](const auto& of) {
    const auto low = (width / (b.s - stations_[before].s)) * (of(b) - of(stations_[before]));
    const auto high = (width / (stations_[after].s - a.s)) * (of(stations_[after]) - of(a));
    return (2 * t3 - 3 * t2 + 1) * of(a) + (t3 - 2 * t2 + t) * low + (3 * t2 - 2 * t3) * of(b) +
           (t3 - t2) * high;
  };
  LoftStation r;
  r.s = s;
  r.c = cubic([](const LoftStation& p) { return p.c; });
  r.n = unit((1 - t) * a.n + t * b.n);
  const Point e = (1 - t) * a.e1 + t * b.e1;
  r.e1 = unit(e - dot(e, r.n) * r.n);
  r.r0 = cubic([](const LoftStation& p) { return p.r0; });
  const double from_end = std::max(std::min(s, length() - s), 0.0) / (flared * length());
  const double rest = std::max(1 - from_end, 0.0), scale = 1 + flare_ * rest * rest;
  r.r0 *= scale;
  for (int k = 0; k < loft_harmonics; ++k) {
    r.cosine[k] = scale * cubic([k](const LoftStation& p) { return p.cosine[k]; });
    r.sine[k] = scale * cubic([k](const LoftStation& p) { return p.sine[k]; });
  }
  return r;
}

double Loft::volume() const {
  const TriangleSurface closed = surface(32, 2.0);
  double six_times = 0;
  for (const auto& t : closed.triangles)
    six_times += dot(closed.nodes[t[0]], cross(closed.nodes[t[1]], closed.nodes[t[2]]));
  return six_times / 6;
}

void Loft::match_volume(double volume) {
  double low = 0.3, high = 1.8;
  for (int i = 0; i < 12; ++i) {
    dome_[0] = dome_[1] = 0.5 * (low + high);
    (this->volume() < volume ? low : high) = dome_[0];
  }
}

double Loft::dome_within(double s, double sign, const Point& low, const Point& high) const {
  const LoftStation end = section(s);
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(end.n[i]) > std::abs(end.n[axis])) axis = i;
  const double along = std::abs(end.n[axis]);
  const double room = sign * end.n[axis] > 0 ? high[axis] - end.c[axis] : end.c[axis] - low[axis];
  const double aside2 = end.r0 * end.r0 * (1 - along * along);
  return room * room > aside2 && room > 0 ? std::sqrt(room * room - aside2) / (along * end.r0) : 0;
}

void Loft::fit_ends(const Point& low, const Point& high, double volume) {
  constexpr double least = 0.4, most = 1.2;  // heights of domes in mean radii
  // ends that have no room even for a low dome draw back
  const double step = 0.01 * length();
  double first = 0, last = length();
  while (first < 0.3 * length() && dome_within(first, -1, low, high) < least) first += step;
  while (last > 0.7 * length() && dome_within(last, 1, low, high) < least) last -= step;
  std::vector<LoftStation> kept{section(first)};
  for (const LoftStation& s : stations_)
    if (s.s > first + step && s.s < last - step) kept.push_back(s);
  kept.push_back(section(last));
  stations_ = kept;
  measure();
  double thin = -0.2, wide = 0.8;
  for (int i = 0; i < 12; ++i) {
    flare_ = 0.5 * (thin + wide);
    dome_[0] = std::clamp(dome_within(0, -1, low, high), least, most);
    dome_[1] = std::clamp(dome_within(length(), 1, low, high), least, most);
    (this->volume() < volume ? thin : wide) = flare_;
  }
}

double Loft::nearest(const Point& p) const {
  const int samples = std::max(20, int(length() / 2));
  double best = 0, least = 1e18;
  for (int i = 0; i <= samples; ++i) {
    const double s = length() * i / samples;
    const Point d = section(s).c - p;
    if (dot(d, d) < least) least = dot(d, d), best = s;
  }
  return best;
}

TriangleSurface Loft::surface(int around, double step) const {
  TriangleSurface result;
  const auto add_ring = [&](const LoftStation& section, double rho, double height) {
    for (int m = 0; m < around; ++m)
      result.nodes.push_back(point_of(section, 2 * pi * m / around, rho) + height * section.n);
  };
  const auto dome_ring = [&](const LoftStation& section, double latitude, double sign) {
    add_ring(section, cos(latitude), sign * dome_[sign > 0] * section.r0 * sin(latitude));
  };
  constexpr int dome_rings = 6;
  const LoftStation first = section(0), last = section(length());
  for (int m = dome_rings - 1; m > 0; --m) dome_ring(first, 0.5 * pi * m / dome_rings, -1);
  const int sections = std::max(2, int(std::ceil(length() / step)));
  for (int i = 0; i <= sections; ++i) add_ring(section(length() * i / sections), 1, 0);
  for (int m = 1; m < dome_rings; ++m) dome_ring(last, 0.5 * pi * m / dome_rings, 1);

  const int rings = int(result.nodes.size()) / around;
  for (int i = 0; i + 1 < rings; ++i)
    for (int m = 0; m < around; ++m) {
      const int a = i * around + m, b = i * around + (m + 1) % around;
      result.triangles.push_back({a, b, b + around});
      result.triangles.push_back({a, b + around, a + around});
    }
  const int low = int(result.nodes.size()), high = low + 1;
  result.nodes.push_back(first.c - (dome_[0] * first.r0) * first.n);
  result.nodes.push_back(last.c + (dome_[1] * last.r0) * last.n);
  for (int m = 0; m < around; ++m) {
    result.triangles.push_back({low, (m + 1) % around, m});
    result.triangles.push_back(
        {high, (rings - 1) * around + m, (rings - 1) * around + (m + 1) % around});
  }
  return result;
}

BoneMesh Loft::bricks(int core, bool ring, double h) const {
  const Disc disc = o_grid(core, ring);
  BoneMesh mesh;
  double angle = 0;
  {  // start from the most flattened section, so that the core follows the flat faces
    double flattest = 0;
    for (const LoftStation& s : stations_) {
      const double flat = std::sqrt(s.cosine[1] * s.cosine[1] + s.sine[1] * s.sine[1]) / s.r0;
      if (flat > flattest) flattest = flat, angle = 0.5 * std::atan2(s.sine[1], s.cosine[1]);
    }
  }
  const auto add_section = [&](const LoftStation& section, double cap) {
    const Shape shape = shape_of(section, angle);
    angle = shape.angle;
    const double scale = cap == 0 ? 1 : std::sqrt(1 - last_section * last_section);
    for (const DiscPoint& p : disc.points) {
      const double phi = shape.angle + std::atan2(std::sqrt(shape.b) * sin(p.psi),
                                                  std::sqrt(shape.a) * cos(p.psi));
      const double rho = scale * p.rho;
      const double height = cap * dome_[cap > 0] * section.r0 * std::sqrt(1 - rho * rho);
      mesh.nodes.push_back(point_of(section, phi, rho) + height * section.n);
    }
  };
  // the first and last sections stand inside the domes, the others evenly between them
  const LoftStation first = section(0), last = section(length());
  const double before = last_section * dome_[0] * first.r0,
               after = last_section * dome_[1] * last.r0;
  const double span = before + length() + after;
  const int layers = std::max(2, int(std::lround(span / h)));
  add_section(first, -1);
  for (int i = 1; i < layers; ++i)
    add_section(section(std::clamp(span * i / layers - before, 0.0, length())), 0);
  add_section(last, 1);
  const int per_section = int(disc.points.size());
  for (int i = 0; i < layers; ++i)
    for (const Quad& q : disc.quads) {
      const int low = i * per_section, high = low + per_section;
      mesh.bricks.push_back({low + q[0], low + q[1], low + q[2], low + q[3], high + q[0],
                             high + q[1], high + q[2], high + q[3]});
    }
  mesh.brick_layer.assign(mesh.bricks.size(), 0);
  mesh.surface = boundary_quads(mesh.bricks);
  return mesh;
}

}  // namespace fabrica::body
