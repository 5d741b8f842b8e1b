#include "body/joints/disc_frame.h"

#include <algorithm>
#include <cmath>

#include "body/tables.h"

namespace fabrica::body {

namespace {

// both ends of the row "ALL_L3_L4", global
std::array<Point, 2> ligament_ends(const std::vector<PlacedBone>& bones, const DiscRow& disc,
                                   const std::string& ligament) {
  const Table table("anatomy/joints/ligaments.csv");
  const std::string name = ligament + "_" + disc.name;
  for (int row = 0; row < table.rows(); ++row) {
    if (table.text(row, "name") != name) continue;
    std::array<Point, 2> ends;
    for (int e : {0, 1}) {
      const std::string n = std::to_string(e + 1);
      const PlacedBone& bone = bones[std::size_t(e == 0 ? disc.upper : disc.lower)];
      Point p{table.number(row, "x" + n), 0, table.number(row, "z" + n)};
      for (int i = 0; i < 3; ++i) p[i] *= bone.mesh.scale[i];
      ends[std::size_t(e)] = bone.placement(p);
    }
    return ends;
  }
  throw BodyError("anatomy/joints/ligaments.csv: no row " + name + ", which the disc needs");
}

Point unit(const Point& a) { return (1 / norm(a)) * a; }

}  // namespace

std::vector<DiscRow> disc_rows(const std::vector<PlacedBone>& bones) {
  const Table table("anatomy/joints/discs.csv");
  std::vector<DiscRow> rows;
  for (int row = 0; row < table.rows(); ++row) {
    const int upper = find_bone(bones, table.text(row, "upper"), Side::midline),
              lower = find_bone(bones, table.text(row, "lower"), Side::midline);
    if (upper < 0 || lower < 0) continue;
    const Point& s = bones[std::size_t(upper)].mesh.scale;
    rows.push_back({table.text(row, "disc"), upper, lower, s.y * table.number(row, "width"),
                    s.x * table.number(row, "depth"), s.x * s.y * table.number(row, "area"),
                    s.z * table.number(row, "height"), s.z * table.number(row, "height_am50")});
  }
  return rows;
}

DiscFrame disc_frame(const std::vector<PlacedBone>& bones, const DiscRow& row) {
  const auto front = ligament_ends(bones, row, "ALL"), back = ligament_ends(bones, row, "PLL");
  const Point f = 0.5 * (front[0] + front[1]), b = 0.5 * (back[0] + back[1]);
  const Mat3d &ru = bones[std::size_t(row.upper)].placement.R,
              &rl = bones[std::size_t(row.lower)].placement.R;
  const Point left = Point{ru(0, 1), ru(1, 1), ru(2, 1)} + Point{rl(0, 1), rl(1, 1), rl(2, 1)};
  DiscFrame frame;
  frame.centre = 0.5 * (f + b);
  frame.forward = unit(f - b);
  frame.normal = unit(cross(frame.forward, left));
  frame.left = cross(frame.normal, frame.forward);
  return frame;
}

DiscSpace::DiscSpace(const std::vector<PlacedBone>& bones, const DiscRow& row)
    : frame_(disc_frame(bones, row)),
      row_(row),
      upper_(bones[std::size_t(row.upper)].nodes, bones[std::size_t(row.upper)].mesh.surface),
      lower_(bones[std::size_t(row.lower)].nodes, bones[std::size_t(row.lower)].mesh.surface) {
  // the ellipse, drawn in until both endplates are met and the gap is that of a disc
  const double middle = std::max(mean_height(), 1.0);
  std::vector<double> found(directions);
  for (int i = 0; i < directions; ++i) {
    const double phi = 2 * M_PI * i / directions, c = std::cos(phi), s = std::sin(phi);
    double r = 1 / std::hypot(c / (0.5 * row.depth), s / (0.5 * row.width));
    for (const double least = 0.5 * r; r > least; r -= 0.3) {
      const auto at = line(r * c, r * s);
      if (at && at->height < 2.2 * middle && at->height > 0.3 * middle) break;
    }
    found[std::size_t(i)] = r;
  }
  // a smooth outline: the least of the neighbours, then their mean
  const auto at = [&](const std::vector<double>& v, int i) {
    return v[std::size_t((i + directions) % directions)];
  };
  std::vector<double> least(directions);
  for (int i = 0; i < directions; ++i)
    least[std::size_t(i)] = std::min({at(found, i - 1), at(found, i), at(found, i + 1)});
  radius_.resize(directions);
  for (int i = 0; i < directions; ++i)
    radius_[std::size_t(i)] =
        0.25 * at(least, i - 1) + 0.5 * at(least, i) + 0.25 * at(least, i + 1);
}

std::optional<DiscLine> DiscSpace::line(double forward, double left) const {
  constexpr double back = 6, reach = 26;  // rays start inside the other bone
  const Point p = frame_.centre + forward * frame_.forward + left * frame_.left;
  DiscLine found;
  found.upper = upper_.hit(p - back * frame_.normal, frame_.normal, reach);
  found.lower = lower_.hit(p + back * frame_.normal, -frame_.normal, reach);
  if (found.upper.quad < 0 || found.lower.quad < 0) return {};
  if (dot(found.upper.normal, frame_.normal) > -0.4 || dot(found.lower.normal, frame_.normal) < 0.4)
    return {};
  found.height = dot(found.upper.point - found.lower.point, frame_.normal);
  return found;
}

double DiscSpace::radius(double phi) const {
  const double at = (phi < 0 ? phi + 2 * M_PI : phi) / (2 * M_PI) * directions;
  const int i = int(at);
  const double t = at - i;
  return (1 - t) * radius_[std::size_t(i % directions)] +
         t * radius_[std::size_t((i + 1) % directions)];
}

double DiscSpace::mean_height() const {
  // over rho = 1/8, 3/8, 5/8, 7/8 of the ellipse, weighted by area
  double sum = 0, weight = 0;
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 16; ++i) {
      const double rho = (k + 0.5) / 4, phi = 2 * M_PI * i / 16;
      const auto at =
          line(0.45 * rho * row_.depth * std::cos(phi), 0.45 * rho * row_.width * std::sin(phi));
      if (!at) continue;
      sum += rho * at->height, weight += rho;
    }
  return weight > 0 ? sum / weight : 0;
}

}  // namespace fabrica::body
