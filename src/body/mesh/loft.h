#pragma once
// A bone as sections along a centre-line: r(phi) = r0 + sum_k c_k cos k phi + s_k sin k phi in the
// plane through c with normal n, phi from e1 towards n x e1. The ends close as domes: ellipsoids
// over the end sections.
#include <array>
#include <vector>

#include "body/mesh/distance_field.h"
#include "body/mesh/quality.h"

namespace fabrica::body {

inline constexpr int loft_harmonics = 6;

struct LoftStation {
  Point c, n, e1;
  double r0 = 1;
  std::array<double, loft_harmonics> cosine{}, sine{};
  double s = 0;  // [mm] along the centre-line
};

class Loft {
 public:
  // stations in order; dome: height of the end domes in mean radii of the end sections
  Loft(std::vector<LoftStation> stations, double dome);

  double length() const { return stations_.back().s; }
  // chooses the height of the domes, 0.3 to 1.8 mean radii, that brings the volume [mm3] nearest
  void match_volume(double volume);
  // Ends of a bone that lie in a box [mm]: domes of 0.4 to 1.2 mean radii reach to the faces of the
  // box that they look at, end sections without room for that draw back; the volume comes from the
  // girth, which grows by the factor 1 + a (1 - t / 0.3)^2, t the distance from either end in
  // lengths.
  void fit_ends(const Point& low, const Point& high, double volume);
  // section at s [mm] in [0, length]: cubic between the stations
  LoftStation section(double s) const;
  // s of the point of the centre-line nearest to p
  double nearest(const Point& p) const;
  // closed surface with `around` points a section, sections `step` mm apart
  TriangleSurface surface(int around, double step) const;

  // O-grid bricks: core x core squares, inside a ring or without one, sections h apart, closed
  // domes
  BoneMesh bricks(int core, bool ring, double h) const;

 private:
  void measure();  // s of the stations
  double volume() const;
  // height in mean radii of a dome over the section at s, towards sign n, that reaches to the box
  double dome_within(double s, double sign, const Point& low, const Point& high) const;

  std::vector<LoftStation> stations_;
  std::array<double, 2> dome_;  // at the start and at the end
  double flare_ = 0;            // a of the girth
};

// the point of a section at angle phi and fraction rho of the radius
Point point_of(const LoftStation& section, double phi, double rho);

}  // namespace fabrica::body
