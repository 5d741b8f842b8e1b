#include "body/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "body/landmarks.h"
#include "body/materials.h"
#include "body/mesh/quality.h"
#include "body/tables.h"

namespace fabrica::body {

Quality brick_quality(const Body& body) {
  std::vector<double> all;
  Quality q;
  const auto take = [&](const Corners& corners, const std::string& name) {
    const double j = scaled_jacobian(corners), size = size_of(corners);
    all.push_back(j);
    if (j < q.min_jacobian) q.min_jacobian = j, q.where_jacobian = name;
    if (size < q.min_size) q.min_size = size, q.where_size = name;
  };
  for (const PlacedBone& bone : body.bones)
    for (const auto& brick : bone.mesh.bricks) take(corners_of(bone.nodes, brick), bone.mesh.name);
  std::vector<std::vector<Point>> piece_nodes;
  for (const Piece& piece : body.between.pieces) {
    std::vector<Point>& nodes = piece_nodes.emplace_back();
    for (const PieceNode& n : piece.nodes)
      nodes.push_back(n.bone >= 0    ? body.bones[std::size_t(n.bone)].nodes[std::size_t(n.node)]
                      : n.piece >= 0 ? piece_nodes[std::size_t(n.piece)][std::size_t(n.node)]
                                     : n.x);
    for (const auto& brick : piece.bricks) take(corners_of(nodes, brick), piece.name);
  }
  std::sort(all.begin(), all.end());
  q.bricks = int(all.size());
  if (!all.empty()) q.p1_jacobian = all[all.size() / 100];
  return q;
}

namespace {

// [mm] root-mean-square distance of bone landmarks to a column of the table
double landmark_rms(const Skeleton& skeleton, const std::string& column) {
  double sum = 0;
  int n = 0;
  for (const Landmark& m : landmarks(skeleton, column))
    if (m.in_table) sum += dot(m.x - m.table, m.x - m.table), ++n;
  return n ? std::sqrt(sum / n) : 0;
}

// [mm] largest distance between a node and the mirror image of its partner on the other side
double asymmetry(const Body& body, std::string& where) {
  double worst = 0;
  for (const PlacedBone& right : body.bones) {
    if (right.side != Side::right) continue;
    const int left = find_bone(body.bones, right.mesh.name, Side::left);
    if (left < 0) continue;
    for (std::size_t i = 0; i < right.nodes.size(); ++i) {
      const double off = norm(right.nodes[i] - mirror(body.bones[std::size_t(left)].nodes[i]));
      if (off > worst) worst = off, where = right.mesh.name;
    }
  }
  return worst;
}

bool symmetric(const Posture& posture) {
  for (const auto& [name, degrees] : posture.angle) {
    const std::size_t at = name.find(".right.");
    if (at == std::string::npos) {
      if (degrees != 0 && (name.ends_with(".lateral") || name.ends_with(".rotation")) &&
          name.find(".left.") == std::string::npos)
        return false;
      continue;
    }
    const auto other = posture.angle.find(name.substr(0, at) + ".left." + name.substr(at + 7));
    if (other == posture.angle.end() || other->second != degrees) return false;
  }
  return true;
}

struct Topology {
  int wrong_euler = 0, open_edges = 0, duplicates = 0;
  std::string names;
};

Topology topology(const Body& body, const Model& model) {
  Topology t;
  for (const PlacedBone& bone : body.bones) {
    const MeshReport r = report(bone.mesh);
    if (r.euler != r.expected_euler) ++t.wrong_euler, t.names += " " + bone.mesh.name;
    std::map<std::pair<int, int>, int> edges;
    for (const auto& q : bone.mesh.surface)
      for (int k = 0; k < 4; ++k) {
        const int a = q[std::size_t(k)], b = q[std::size_t((k + 1) % 4)];
        edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
      }
    for (const auto& [edge, sum] : edges) t.open_edges += sum != 0;
  }
  std::set<std::vector<int>> seen;
  for (const auto& nodes : model.solids.node) {
    std::vector<int> key(nodes.begin(), nodes.begin() + 8);
    std::sort(key.begin(), key.end());
    t.duplicates += !seen.insert(key).second;
  }
  seen.clear();
  for (const auto& nodes : model.shells.node) {
    std::vector<int> key(nodes.begin(), nodes.end());
    std::sort(key.begin(), key.end());
    t.duplicates += !seen.insert(key).second;
  }
  return t;
}

// stature of the skeleton with the table's soft allowances: heel pad 11 mm, scalp 6 mm
double standing_stature(const Subject& subject) {
  const Skeleton standing(subject, named_posture("standing"));
  double top = 0, sole = 0;
  for (const Landmark& m : landmarks(standing)) {
    if (m.name == "vertex_skull") top = m.x.z + 6;
    if (m.name == "calcaneus_plantar" && m.side == Side::right) sole = m.x.z - 11;
  }
  return top - sole;
}

class Rows {
 public:
  std::vector<Measure> list;
  void add(const std::string& figure, const std::string& value, const std::string& must, bool holds,
           bool required = true) {
    list.push_back({figure, value, must, holds, required});
  }
};

void bone_rows(Rows& rows, const Body& body, Resolution resolution) {
  double volume = 0, error = 0;
  std::string worst_volume, worst_error;
  for (const PlacedBone& bone : body.bones) {
    if (bone.side == Side::left) continue;
    const MeshReport r = report(bone.mesh);
    const double off = r.table_volume > 0 ? std::abs(r.volume / r.table_volume - 1) : 0;
    if (off > volume) volume = off, worst_volume = bone.mesh.name;
    if (r.error_mean > error) error = r.error_mean, worst_error = bone.mesh.name;
  }
  const double limit = resolution == Resolution::coarse ? 1.5 : 0.8;
  rows.add("volume of a bone against its table, largest difference",
           fmt::format("{:.1f} % ({})", 100 * volume, worst_volume), "within 5 %", volume <= 0.05);
  rows.add("surface of a bone against its table, largest mean error",
           fmt::format("{:.2f} mm ({})", error, worst_error), fmt::format("at most {:g} mm", limit),
           error <= limit);
}

void scapula_row(Rows& rows, const Body& body) {
  const ScapulaRest& rest = body.scapulae;
  rows.add("shoulder blades under the hull of the ribs, after they turned to lie on it",
           fmt::format("{:.1f} mm; {:.1f} mm before, turned {:.1f} degrees, shoulder joint moved "
                       "{:.1f} mm",
                       rest.left, rest.depth, rest.turn, rest.arm),
           "at most 0.3 mm", rest.left <= 0.3);
}

// how the bones hang together: only where they were joined
void joint_rows(Rows& rows, const Body& body) {
  if (body.between.pieces.empty()) return;
  const ClearanceReport& clear = body.joined.clearance;
  std::string pairs;
  for (const std::string& pair : clear.left) pairs += "; " + pair;
  rows.add("pairs of bones that reach into one another, deepest",
           fmt::format("{}, {:.2f} mm ({}){}", clear.left.size(), std::max(0.0, -clear.least_gap),
                       clear.least_gap_pair, pairs),
           "0", clear.left.empty());
  rows.add("farthest that a bone was moved whole, with what hangs on it",
           fmt::format("{:.2f} mm ({})", clear.whole_shift, clear.whole_shift_bone), "reported",
           true, false);
  rows.add("farthest that a node gave way after that",
           fmt::format("{:.2f} mm ({})", clear.largest_shift, clear.largest_shift_bone), "reported",
           true, false);
  double area = 0, height = 0;
  std::string worst_area = "none", worst_height = "none";
  for (const DiscReport& disc : body.joined.discs) {
    const double a = std::abs(disc.area / disc.table_area - 1),
                 h = std::abs(disc.height / disc.wanted - 1);
    if (a > area) area = a, worst_area = disc.name;
    if (h > height) height = h, worst_height = disc.name;
  }
  rows.add("discs against their table, largest difference of area, of height",
           fmt::format("{:.0f} % ({}), {:.0f} % ({})", 100 * area, worst_area, 100 * height,
                       worst_height),
           "reported", true, false);
  const std::vector<std::string> alone = unconnected(body.bones, body.between);
  std::string names;
  for (const std::string& name : alone) names += " " + name;
  rows.add("bones and pieces that nothing connects with the rest",
           fmt::format("{}{}", alone.size(), names), "0", alone.empty());
}

void topology_rows(Rows& rows, const Body& body, const Model& model, const CheckReport& check) {
  const Topology t = topology(body, model);
  rows.add("bones whose Euler number is not that of anatomy",
           fmt::format("{}{}", t.wrong_euler, t.names), "0", t.wrong_euler == 0);
  rows.add("open edges of the bones' surfaces", fmt::format("{}", t.open_edges), "0",
           t.open_edges == 0);
  rows.add("elements that occur twice", fmt::format("{}", t.duplicates), "0", t.duplicates == 0);
  rows.add("nodes that belong to nothing", fmt::format("{}", check.unreferenced_nodes), "0",
           check.unreferenced_nodes == 0);
  if (symmetric(body.posture)) {
    std::string where = "none";
    const double off = asymmetry(body, where);
    rows.add("left against right, largest distance from the mirror image",
             fmt::format("{:.1e} mm ({})", off, where), "at most 1e-6 mm", off <= 1e-6);
  }
}

}  // namespace

std::vector<Measure> measure_body(const Body& body, const AssembledBody& assembled,
                                  const Model& model, const CheckReport& check,
                                  const OutsideMeasures& outside) {
  Rows rows;
  const double stature = standing_stature(body.subject);
  rows.add("stature, standing, from skull and heel with 17 mm of skin",
           fmt::format("{:.0f} mm", stature), fmt::format("{:g} +- 10 mm", body.subject.stature),
           std::abs(stature - body.subject.stature) <= 10);
  rows.add("mass of the skeleton", fmt::format("{:.2f} kg", check.mass), "reported", true, false);
  const bool of_tables = body.subject.stature == 1750 && body.subject.mass == 77;
  if (of_tables && body.posture.name == "standing" && body.posture.angle.empty()) {
    const double rms = landmark_rms(body.skeleton, "stand");
    rows.add("landmarks against the standing table, root mean square",
             fmt::format("{:.1f} mm", rms), "under 10 mm", rms < 10);
  }
  if (of_tables && body.posture.name == "driver" && body.posture.goals.empty()) {
    const double rms = landmark_rms(body.skeleton, "seat");
    rows.add("landmarks against the seated table (itself +-20 mm), root mean square",
             fmt::format("{:.1f} mm", rms), "under 15 mm", rms < 15);
  }
  bone_rows(rows, body, body.resolution);
  const Quality q = brick_quality(body);
  rows.add("smallest scaled Jacobian of the bricks",
           fmt::format("{:.2f} ({})", q.min_jacobian, q.where_jacobian), "at least 0.30",
           q.min_jacobian >= 0.30);
  rows.add("scaled Jacobian that 99 % exceed",
           fmt::format("{:.2f} of {} bricks", q.p1_jacobian, q.bricks), "above 0.42",
           q.p1_jacobian > 0.42);
  rows.add("smallest brick, volume / largest face",
           fmt::format("{:.2f} mm ({})", q.min_size, q.where_size), "reported", true, false);
  const double step = check.smallest.empty() ? 0 : 1000 * check.smallest.front().time_step;
  const double step_limit = body.resolution == Resolution::coarse ? 0.8 : 0.27;
  rows.add("smallest stable step, unscaled", fmt::format("{:.2f} us", step),
           body.resolution == Resolution::fine ? "reported"
                                               : fmt::format("at least {:g} us", step_limit),
           step >= step_limit || body.resolution == Resolution::fine,
           body.resolution != Resolution::fine);
  if (outside.searched) {
    rows.add("initial penetration of contacts",
             fmt::format("{:.2f} mm, {} nodes{}", outside.largest_penetration,
                         outside.penetrating_nodes, outside.penetrations),
             "at most 0.05 mm", outside.largest_penetration <= 0.05);
    rows.add("nodes of ties that find no surface", fmt::format("{}", outside.untied_nodes), "0",
             outside.untied_nodes == 0);
  }
  scapula_row(rows, body);
  joint_rows(rows, body);
  topology_rows(rows, body, model, check);
  rows.add("time to make the body, one core", fmt::format("{:.1f} s", outside.seconds),
           body.resolution == Resolution::standard ? "under 30 s" : "reported",
           body.resolution != Resolution::standard || outside.seconds < 30,
           body.resolution == Resolution::standard);
  rows.add("parts, nodes, bricks, shells, lines",
           fmt::format("{}, {}, {}, {}, {}", assembled.parts.size(), model.nodes.size(),
                       model.solids.size(), model.shells.size(),
                       model.beams.size() + model.discretes.size()),
           "reported", true, false);
  return std::move(rows.list);
}

namespace {

std::string bones_table(const Body& body) {
  std::string text =
      "\n## Bones\n\nRight side and midline. Error: distance of the surface to the table's, mean / "
      "95th percentile.\n\n"
      "| bone | bricks | nodes | SJ min | SJ 99 % | size mm | volume cm3 | off % | error mm | "
      "Euler |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const PlacedBone& bone : body.bones) {
    if (bone.side == Side::left) continue;
    const MeshReport r = report(bone.mesh);
    text += fmt::format(
        "| {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:+.1f} | {:.2f} / {:.2f} | {} |\n",
        bone.mesh.name, r.bricks, r.nodes, r.min_scaled_jacobian, r.p1_scaled_jacobian, r.min_size,
        r.volume / 1000, r.table_volume > 0 ? 100 * (r.volume / r.table_volume - 1) : 0,
        r.error_mean, r.error_p95, r.euler);
  }
  return text;
}

std::string menisci_table(const Body& body) {
  if (body.joined.menisci.empty()) return "";
  std::string text =
      "\n## Menisci\n\nAs meshed, horns left out. Drawn in: largest by which the inner edge gives "
      "way to bones that stand too close.\n\n"
      "| meniscus | bricks | without room | volume cm3 | rim mm | inner edge mm | height of the "
      "rim "
      "mm | drawn in mm | SJ min |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const MeniscusReport& m : body.joined.menisci)
    text += fmt::format("| {} | {} | {} | {:.2f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.2f} |\n",
                        m.name, m.bricks, m.without_room, m.volume / 1000, m.rim_length,
                        m.inner_length, m.rim_height, m.drawn_in, m.least_scaled_jacobian);
  return text;
}

std::string smallest_table(const AssembledBody& assembled, const Model& model,
                           const CheckReport& check) {
  std::unordered_map<std::int64_t, std::string> names;
  for (const PartEntry& p : assembled.parts) names[p.id] = p.name;
  std::unordered_map<std::int64_t, Point> place;
  for (int e = 0; e < model.solids.size(); ++e)
    place[model.solids.id[std::size_t(e)]] =
        model.nodes.x[std::size_t(model.solids.node[std::size_t(e)][0])];
  for (int e = 0; e < model.shells.size(); ++e)
    place[model.shells.id[std::size_t(e)]] =
        model.nodes.x[std::size_t(model.shells.node[std::size_t(e)][0])];
  std::string text =
      "\n## The twenty smallest steps\n\n| element | part | step us | x | y | z |\n| --- | --- | "
      "--- | --- | --- | --- |\n";
  for (const StepReport& s : check.smallest) {
    const Point x = place.count(s.element) ? place[s.element] : Point{0, 0, 0};
    text += fmt::format("| {} | {} | {:.3f} | {:.0f} | {:.0f} | {:.0f} |\n", s.element,
                        names[s.part], 1000 * s.time_step, x.x, x.y, x.z);
  }
  return text;
}

std::string parts_table(const AssembledBody& assembled, const CheckReport& check) {
  static const Table rows("materials.csv");
  std::map<std::string, int> row_of;
  for (int r = 0; r < rows.rows(); ++r) row_of[rows.text(r, "row")] = r;
  std::unordered_map<std::int64_t, const PartReport*> report;
  for (const PartReport& p : check.parts) report[p.id] = &p;
  std::string text =
      "\n## Parts\n\n| id | part | elements | mass g | step us | material | fracture | source |\n| "
      "--- "
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const PartEntry& p : assembled.parts) {
    std::string source = p.source, fracture = "none";
    if (const auto at = row_of.find(p.material); at != row_of.end()) {
      if (source.empty())
        source = rows.text(at->second, "source") + " [" + rows.text(at->second, "flag") + "]";
      fracture = rows.text(at->second, "criterion");
      if (fracture != "none") fracture += " " + rows.text(at->second, "value");
    }
    const PartReport& r = *report.at(p.id);
    const std::string step = r.time_step > 0 ? fmt::format("{:.3f}", 1000 * r.time_step) : "-";
    text +=
        fmt::format("| {} | {} | {} | {:.2f} | {} | {}{} | {} | {} |\n", p.id, p.name, p.elements,
                    1000 * r.mass, step, p.material, p.rigid ? " (rigid)" : "", fracture, source);
  }
  return text;
}

}  // namespace

std::string measures_text(const Body& body, const AssembledBody& assembled, const Model& model,
                          const CheckReport& check, const OutsideMeasures& outside) {
  std::string text = fmt::format(
      "# What this body measures\n\nMade by `fabrica body`: {}, {:g} mm, {:g} kg, {}, {}.\n\n"
      "| figure | measured | must be | holds |\n| --- | --- | --- | --- |\n",
      body.subject.sex, body.subject.stature, body.subject.mass, body.posture.name,
      name_of(body.resolution));
  for (const Measure& m : measure_body(body, assembled, model, check, outside))
    text += fmt::format("| {} | {} | {} | {} |\n", m.figure, m.value, m.must,
                        !m.required ? "-"
                        : m.holds   ? "yes"
                                    : "**no**");
  return text + smallest_table(assembled, model, check) + bones_table(body) + menisci_table(body) +
         parts_table(assembled, check);
}

}  // namespace fabrica::body
