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

DiscSpace::DiscSpace(const std::vector<PlacedBone>& bones, const DiscRow& row, Section section)
    : frame_(disc_frame(bones, row)),
      upper_(bones[std::size_t(row.upper)].nodes, bones[std::size_t(row.upper)].mesh.surface),
      lower_(bones[std::size_t(row.lower)].nodes, bones[std::size_t(row.lower)].mesh.surface) {
  draw_outline(row, section);
  take_heights();
}

std::optional<DiscLine> DiscSpace::ray(double forward, double left) const {
  constexpr double back = 6, reach = 26;  // rays start inside the other bone
  constexpr double wall = 0.15;           // cosine: steeper faces are no endplate
  const Point p = frame_.centre + forward * frame_.forward + left * frame_.left;
  const SurfacePoint up = upper_.hit(p - back * frame_.normal, frame_.normal, reach);
  const SurfacePoint down = lower_.hit(p + back * frame_.normal, -frame_.normal, reach);
  if (up.quad < 0 || down.quad < 0) return {};
  if (dot(up.normal, frame_.normal) > -wall || dot(down.normal, frame_.normal) < wall) return {};
  return DiscLine{back - down.distance, up.distance - back};
}

// the ellipse, drawn in until both endplates are met and the gap is that of a disc, by a quarter at
// most and by a twentieth where the area is to be that of the table; then the mean of neighbours
void DiscSpace::draw_outline(const DiscRow& row, Section section) {
  double middle = 0;
  int count = 0;
  for (int i = 0; i < directions; i += 4)
    for (const double rho : {0.2, 0.5}) {
      const double phi = 2 * M_PI * i / directions;
      const auto found =
          ray(0.5 * rho * row.depth * std::cos(phi), 0.5 * rho * row.width * std::sin(phi));
      if (found) middle += found->height(), ++count;
    }
  middle = count > 0 ? std::max(middle / count, 1.0) : row.height;

  const bool whole = section == Section::table;
  const double scale = whole ? std::sqrt(row.area / (0.25 * M_PI * row.depth * row.width)) : 1;
  std::vector<double> found(directions);
  for (int i = 0; i < directions; ++i) {
    const double phi = 2 * M_PI * i / directions, c = std::cos(phi), s = std::sin(phi);
    double r = scale / std::hypot(c / (0.5 * row.depth), s / (0.5 * row.width));
    for (const double least = (whole ? 0.95 : 0.75) * r; r > least; r -= 0.3) {
      const auto line = ray(r * c, r * s);
      if (line && line->height() < 2.2 * middle && line->height() > 0.3 * middle) break;
    }
    found[std::size_t(i)] = r;
  }
  radius_.resize(directions);
  for (int i = 0; i < directions; ++i)
    radius_[std::size_t(i)] = 0.25 * found[std::size_t((i + directions - 1) % directions)] +
                              0.5 * found[std::size_t(i)] +
                              0.25 * found[std::size_t((i + 1) % directions)];
}

void DiscSpace::take_heights() {
  heights_.resize(std::size_t(rings + 1) * directions);
  std::vector<char> known(heights_.size(), 0);
  double sum = 0;
  int count = 0;
  for (int k = 0; k <= rings; ++k)
    for (int i = 0; i < directions; ++i) {
      const double phi = 2 * M_PI * i / directions;
      const double r = radius_[std::size_t(i)] * k / rings;
      const auto line = ray(r * std::cos(phi), r * std::sin(phi));
      if (!line) continue;
      at(k, i) = *line, known[std::size_t(k * directions + i)] = 1;
      sum += line->height(), ++count;
    }
  if (count == 0) throw BodyError("a disc finds no endplates that face each other");
  const double least = 0.4 * sum / count;
  // unknown: of the ring within; the innermost: the mean
  for (int k = 0; k <= rings; ++k)
    for (int i = 0; i < directions; ++i)
      if (!known[std::size_t(k * directions + i)])
        at(k, i) = k > 0 ? at(k - 1, i) : DiscLine{-0.5 * sum / count, 0.5 * sum / count};
  for (int pass = 0; pass < 6; ++pass) {
    const std::vector<DiscLine> old = heights_;
    const auto before = [&](int k, int i) {
      return old[std::size_t(k * directions + (i + directions) % directions)];
    };
    for (int k = 0; k <= rings; ++k)
      for (int i = 0; i < directions; ++i) {
        // of a line at the rim: no ring beyond; in the middle: across
        const DiscLine in = k > 0 ? before(k - 1, i) : before(1, i + directions / 2),
                       out = before(std::min(k + 1, rings), i), a = before(k, i - 1),
                       b = before(k, i + 1), here = before(k, i);
        at(k, i).lower = 0.5 * here.lower + 0.125 * (in.lower + out.lower + a.lower + b.lower);
        at(k, i).upper = 0.5 * here.upper + 0.125 * (in.upper + out.upper + a.upper + b.upper);
      }
    DiscLine middle;
    for (int i = 0; i < directions; ++i)
      middle.lower += at(0, i).lower / directions, middle.upper += at(0, i).upper / directions;
    for (int i = 0; i < directions; ++i) at(0, i) = middle;
  }
  for (DiscLine& line : heights_) {
    const double short_by = std::max(least - line.height(), 0.0);
    line.lower -= 0.5 * short_by, line.upper += 0.5 * short_by;
  }
}

double DiscSpace::radius(double phi) const {
  const double position = (phi < 0 ? phi + 2 * M_PI : phi) / (2 * M_PI) * directions;
  const int i = int(position);
  const double t = position - i;
  return (1 - t) * radius_[std::size_t(i % directions)] +
         t * radius_[std::size_t((i + 1) % directions)];
}

std::array<Point, 2> DiscSpace::ends(double forward, double left) const {
  const double r = std::hypot(forward, left), angle = std::atan2(left, forward);
  const double phi = angle < 0 ? angle + 2 * M_PI : angle;
  const double along = std::min(r / radius(phi), 1.0) * rings,
               around = phi / (2 * M_PI) * directions;
  const int k = std::min(int(along), rings - 1), i = int(around);
  const double s = along - k, t = around - i;
  const auto mix = [&](double DiscLine::*end) {
    return (1 - s) * ((1 - t) * (at(k, i).*end) + t * (at(k, i + 1).*end)) +
           s * ((1 - t) * (at(k + 1, i).*end) + t * (at(k + 1, i + 1).*end));
  };
  const Point p = frame_.centre + forward * frame_.forward + left * frame_.left;
  return {p + mix(&DiscLine::lower) * frame_.normal, p + mix(&DiscLine::upper) * frame_.normal};
}

double DiscSpace::mean_height() const {
  double sum = 0, weight = 0;
  for (int k = 1; k <= rings; ++k)
    for (int i = 0; i < directions; ++i) {
      const double area = k * radius_[std::size_t(i)] * radius_[std::size_t(i)];
      sum += area * at(k, i).height(), weight += area;
    }
  return sum / weight;
}

void DiscSpace::limit_mean_height(double most) {
  const std::vector<DiscLine> found = heights_;
  double low = 0, high = 0;
  for (const DiscLine& line : found) high = std::max(high, line.height());
  for (int pass = 0; pass < 40 && mean_height() != most; ++pass) {
    if (pass == 0 && mean_height() <= most) return;
    const double limit = 0.5 * (low + high);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double excess = std::max(found[i].height() - limit, 0.0);
      heights_[i] = {found[i].lower + 0.5 * excess, found[i].upper - 0.5 * excess};
    }
    (mean_height() < most ? low : high) = limit;
  }
}

}  // namespace fabrica::body
