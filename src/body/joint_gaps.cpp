#include "body/joint_gaps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>

#include "body/error.h"
#include "body/joints/surface_gap.h"

namespace fabrica::body {

namespace {

constexpr double facing_margin = 1;  // [mm] beyond the least distance, of the nodes of (2)
const std::string header = "joint,kind,parts_a,parts_b";

// ids of the parts of a bone, or of a piece; its shells bound the bricks and do no harm
std::vector<std::int64_t> parts_of(const AssembledBody& assembled, int bone, int piece) {
  std::vector<std::int64_t> ids;
  for (const PartEntry& p : assembled.parts)
    if (bone >= 0 ? p.bone == bone : p.piece == piece) ids.push_back(p.id);
  return ids;
}

JointRow row_of(const Tie& tie, const AssembledBody& assembled) {
  JointRow row{tie.name, JointKind::tied, {}, {}};
  std::set<int> pieces;
  for (const PieceNode& n : tie.a)
    if (n.piece >= 0) pieces.insert(n.piece);
  for (const int piece : pieces)
    for (const std::int64_t id : parts_of(assembled, -1, piece)) row.a.push_back(id);
  row.b = parts_of(assembled, tie.b.quads.front()[0].bone, -1);
  return row;
}

std::vector<std::int64_t> ids_of(const std::string& text, int line) {
  std::vector<std::int64_t> ids;
  std::istringstream items(text);
  for (std::string item; std::getline(items, item, '+');) {
    std::int64_t id = 0;
    const char* end = item.data() + item.size();
    if (std::from_chars(item.data(), end, id).ptr != end || item.empty())
      throw BodyError(fmt::format("line {}: '{}' is not the id of a part", line, item));
    ids.push_back(id);
  }
  if (ids.empty())
    throw BodyError(fmt::format("line {}: a joint needs parts on either side", line));
  return ids;
}

}  // namespace

std::vector<JointRow> joint_rows(const Body& body, const AssembledBody& assembled) {
  std::vector<JointRow> rows;
  const std::vector<Articulation> joints = articulations(body.bones);
  for (std::size_t k = 0; k < body.joined.articulations.size(); ++k) {
    const ArticulationReport& made = body.joined.articulations[k];
    // what a layer joins stands with the ties
    if (!made.omitted.empty() || joints[k].kind == ArticulationKind::arch ||
        joints[k].kind == ArticulationKind::grown)
      continue;
    rows.push_back(
        {made.name,
         joints[k].kind == ArticulationKind::joined ? JointKind::tied : JointKind::sliding,
         parts_of(assembled, joints[k].a, -1), parts_of(assembled, joints[k].b, -1)});
  }
  for (const Tie& tie : body.between.ties) {
    if (tie.a.empty() || tie.b.quads.empty()) continue;
    if (std::any_of(tie.a.begin(), tie.a.end(), [](const PieceNode& n) { return n.piece >= 0; }))
      rows.push_back(row_of(tie, assembled));
  }
  return rows;
}

std::string joints_csv(const std::vector<JointRow>& rows) {
  std::string text = header + "\n";
  for (const JointRow& r : rows)
    text += fmt::format("{},{},{},{}\n", r.name, r.kind == JointKind::tied ? "tied" : "sliding",
                        fmt::join(r.a, "+"), fmt::join(r.b, "+"));
  return text;
}

std::vector<JointRow> read_joints(const std::string& text) {
  std::vector<JointRow> rows;
  std::istringstream lines(text);
  std::string line;
  int number = 0;
  while (std::getline(lines, line)) {
    if (++number == 1) {
      if (line != header) throw BodyError(fmt::format("line 1: expected {}", header));
      continue;
    }
    if (line.empty()) continue;
    std::vector<std::string> fields(1);
    for (const char c : line)
      if (c == ',')
        fields.emplace_back();
      else
        fields.back() += c;
    if (fields.size() != 4 || (fields[1] != "tied" && fields[1] != "sliding"))
      throw BodyError(fmt::format("line {}: expected {}, kind tied or sliding", number, header));
    rows.push_back({fields[0], fields[1] == "tied" ? JointKind::tied : JointKind::sliding,
                    ids_of(fields[2], number), ids_of(fields[3], number)});
  }
  return rows;
}

void JointFollower::take(double time, const std::vector<Point>& nodes) {
  const SurfaceGap gap(nodes, a_, b_);
  const double least = gap.least();
  if (!begun_) {
    begun_ = true;
    gap_.start = least;
    facing_ = gap.facing(least + facing_margin);
    gap_.facing = int(facing_.size());
    for (const int n : facing_) start_.push_back(gap.to_b(n));
    gap_.apart_time = gap_.open_time = time;
    return;
  }
  if (least - gap_.start > gap_.apart) gap_.apart = least - gap_.start, gap_.apart_time = time;
  for (std::size_t i = 0; i < facing_.size(); ++i) {
    const double growth = gap.to_b(facing_[i]) - start_[i];
    if (growth > gap_.open) gap_.open = growth, gap_.open_time = time;
  }
}

}  // namespace fabrica::body
