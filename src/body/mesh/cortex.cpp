#include "body/mesh/cortex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "body/mesh/skull_vault.h"
#include "body/tables.h"

namespace fabrica::body {
namespace {

constexpr double limit = 1e6;  // [mm] of a box without one
constexpr double most_of_thickness = 0.45;

double number_or(const Table& table, int row, const char* column, double otherwise) {
  return table.text(row, column).empty() ? otherwise : table.number(row, column);
}

// name of the profile of a bone: "rib5" -> "rib", "hand_phalanx2_distal" -> "hand_phalanx"
std::string profile_name(const std::string& bone) {
  for (const char* group : {"rib", "metacarpal", "hand_phalanx", "metatarsal", "foot_phalanx"})
    if (bone.rfind(group, 0) == 0) return group;
  return bone;
}

// [mm] of bone along the inward normal from a point near the surface, counted up to `enough`
double thickness_behind(const DistanceField& field, const Point& place, const Point& outward,
                        double enough) {
  constexpr double step = 0.25, farthest_entry = 3.0;
  double inside = 0;
  for (double depth = 0; inside < enough; depth += step) {
    if (field.value(place - depth * outward) < 0)
      inside += step;
    else if (inside > 0 || depth > farthest_entry)
      break;
  }
  return inside > 0 ? std::min(std::max(inside, 0.5), enough) : enough;
}

}  // namespace

double table_thickness(const std::string& region) {
  const Table table("anatomy/bones/cortical_thickness.csv");
  for (int row = 0; row < table.rows(); ++row)
    if (table.text(row, "region") == region)
      return table.number(row, "thickness") * (table.text(row, "where") == "total" ? 0.5 : 1.0);
  throw BodyError(fmt::format("cortical_thickness.csv has no row for the region '{}'", region));
}

CortexTable::CortexTable(const std::string& bone, const BoneShape& shape)
    : bone_(bone), shape_(shape) {
  const Table thickness("anatomy/bones/cortical_thickness.csv"),
      regions("anatomy/bones/cortex_regions.csv");
  for (int row = 0; row < regions.rows(); ++row) {
    if (regions.text(row, "bone") != bone) continue;
    Region r;
    r.low = {number_or(regions, row, "xmin", -limit), number_or(regions, row, "ymin", -limit),
             number_or(regions, row, "zmin", -limit)};
    r.high = {number_or(regions, row, "xmax", limit), number_or(regions, row, "ymax", limit),
              number_or(regions, row, "zmax", limit)};
    r.facing = regions.text(row, "facing");
    r.thickness = table_thickness(regions.text(row, "region"));
    regions_.push_back(r);
  }
  const std::string profile = profile_name(bone);
  for (int row = 0; row < thickness.rows(); ++row)
    if (regions_.empty() && thickness.text(row, "region") == profile)
      profile_.push_back({thickness.number(row, "where"), thickness.number(row, "thickness")});
  // sections of the rays run from their proximal end, profiles from the distal one
  from_far_end_ = profile != bone && profile != "rib";
  if (regions_.empty() && profile_.empty())
    throw BodyError(fmt::format(
        "{}: cortical_thickness.csv has no profile and cortex_regions.csv no region of it", bone));
}

double CortexTable::fraction(const Point& place) const {
  if (shape_.loft) {
    const double along = shape_.loft->nearest(place) / shape_.loft->length();
    return from_far_end_ ? 1 - along : along;
  }
  if (bone_ == "clavicle")
    return (shape_.high.y - place.y) / (shape_.high.y - shape_.low.y);  // from the sternal end
  return (place.z - shape_.low.z) / (shape_.high.z - shape_.low.z);
}

double CortexTable::at(const Point& place, const Point& outward) const {
  for (const Region& r : regions_) {
    bool inside = true;
    for (int a = 0; a < 3; ++a) inside = inside && place[a] >= r.low[a] && place[a] <= r.high[a];
    if (r.facing == "up_down") inside = inside && std::abs(outward.z) > std::sqrt(0.5);
    if (r.facing == "out") inside = inside && dot(outward, place - vault_centre) > 0;
    if (r.facing == "in") inside = inside && dot(outward, place - vault_centre) < 0;
    if (inside) return r.thickness;
  }
  if (profile_.empty())
    throw BodyError(
        fmt::format("{}: no region of cortex_regions.csv holds ({:.1f}, {:.1f}, {:.1f})", bone_,
                    place.x, place.y, place.z));
  const double f = std::clamp(fraction(place), profile_.front()[0], profile_.back()[0]);
  std::size_t i = 0;
  while (i + 2 < profile_.size() && profile_[i + 1][0] < f) ++i;
  if (profile_.size() == 1) return profile_[0][1];
  const auto &a = profile_[i], &b = profile_[i + 1];
  return a[1] + (f - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
}

std::vector<double> cortex_of(const BoneMesh& mesh, const std::string& bone,
                              const BoneShape& shape) {
  const CortexTable table(bone, shape);
  std::vector<double> cortex;
  for (const Quad& q : mesh.surface) {
    const Point &a = mesh.nodes[q[0]], &b = mesh.nodes[q[1]], &c = mesh.nodes[q[2]],
                &d = mesh.nodes[q[3]];
    const Point normal = cross(c - a, d - b), outward = (1 / norm(normal)) * normal;
    const Point centre = 0.25 * (a + b + c + d);
    const double wanted = table.at(centre, outward);
    cortex.push_back(std::min(
        wanted, most_of_thickness *
                    thickness_behind(shape.field, centre, outward, wanted / most_of_thickness)));
  }
  return cortex;
}

}  // namespace fabrica::body
