#include "app/joints.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <unordered_map>

#include "body/error.h"
#include "body/joint_gaps.h"
#include "body/turned_bricks.h"
#include "result/d3plot.h"

namespace fabrica {
namespace {

using body::BodyError;
using body::JointGap;
using body::JointKind;
using body::JointRow;

std::vector<JointRow> rows_of(const std::string& path) {
  std::ifstream in(path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw BodyError("cannot read " + path);
  try {
    return body::read_joints(text);
  } catch (const BodyError& e) {
    throw BodyError(path + ": " + e.what());
  }
}

// the outer faces of the bricks of some parts
class Surfaces {
 public:
  explicit Surfaces(const ResultMesh& mesh) : bricks_(mesh.part_id.size()) {
    for (std::size_t i = 0; i < mesh.part_id.size(); ++i) index_[mesh.part_id[i]] = i;
    for (int e = 0; e < mesh.solids(); ++e)
      bricks_[std::size_t(mesh.solid_part[std::size_t(e)])].push_back(mesh.solid[std::size_t(e)]);
  }
  std::vector<body::Quad> of(const JointRow& row, const std::vector<std::int64_t>& parts) const {
    std::vector<body::Brick> bricks;
    for (const std::int64_t id : parts) {
      const auto at = index_.find(id);
      if (at == index_.end())
        throw BodyError(fmt::format("joint {}: the result has no part {}", row.name, id));
      bricks.insert(bricks.end(), bricks_[at->second].begin(), bricks_[at->second].end());
    }
    if (bricks.empty()) throw BodyError(fmt::format("joint {}: a side has no bricks", row.name));
    return body::boundary_quads(bricks);
  }

 private:
  std::unordered_map<std::int64_t, std::size_t> index_;
  std::vector<std::vector<body::Brick>> bricks_;
};

void print_largest(const std::vector<JointRow>& rows, const std::vector<JointGap>& gaps,
                   JointKind kind, int count) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].kind == kind) order.push_back(i);
  const bool tied = kind == JointKind::tied;
  const auto figure = [&](std::size_t i) { return tied ? gaps[i].open : gaps[i].apart; };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return figure(i) > figure(j); });
  fmt::print(
      "\n{} joints, {}\n\n| joint | gap at the start mm | apart mm | at ms | open mm | at ms "
      "|\n| --- | --- | --- | --- | --- | --- |\n",
      order.size(), tied ? "tied, by open" : "not tied, by apart");
  for (std::size_t k = 0; k < order.size() && int(k) < count; ++k) {
    const JointGap& g = gaps[order[k]];
    fmt::print("| {} | {:.2f} | {:.2f} | {:.1f} | {:.2f} | {:.1f} |\n", rows[order[k]].name,
               g.start, g.apart, g.apart_time, g.open, g.open_time);
  }
}

void write_csv(const std::string& path, const std::vector<JointRow>& rows,
               const std::vector<JointGap>& gaps) {
  std::ofstream out(path);
  out << "joint,kind,start,apart,apart_time,open,open_time,facing\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const JointGap& g = gaps[i];
    out << fmt::format("{},{},{:.4f},{:.4f},{:g},{:.4f},{:g},{}\n", rows[i].name,
                       rows[i].kind == JointKind::tied ? "tied" : "sliding", g.start, g.apart,
                       g.apart_time, g.open, g.open_time, g.facing);
  }
  out.close();
  if (!out) throw BodyError("cannot write " + path);
}

void print_turned(const std::map<std::string, body::TurnedBricks>& kinds) {
  fmt::print(
      "\nbricks with a corner turned over\n\n| kind of part | bricks | most in a state | at ms | "
      "at the end | ever |\n| --- | --- | --- | --- | --- | --- |\n");
  for (const auto& [kind, n] : kinds)
    fmt::print("| {} | {} | {} | {:.1f} | {} | {} |\n", kind, n.bricks, n.most, n.most_time, n.last,
               n.ever);
  for (const auto& [kind, n] : kinds)
    for (const auto& [title, ever] : n.parts) fmt::print("{}: {}\n", title, ever);
}

body::TurnedBrickCounter counter_of(const ResultMesh& mesh) {
  std::vector<std::string> title;
  for (const int part : mesh.solid_part) title.push_back(mesh.part_title[std::size_t(part)]);
  return {mesh.solid, std::move(title)};
}

int joints_command(const JointsCommand& c) {
  const std::vector<JointRow> rows = rows_of(c.joints);
  const std::filesystem::path result = c.result;
  const D3plotReader reader(
      (std::filesystem::is_directory(result) ? result / "d3plot" : result).string());
  const Surfaces surfaces(reader.mesh());
  std::vector<body::JointFollower> followers;
  for (const JointRow& row : rows)
    followers.emplace_back(surfaces.of(row, row.a), surfaces.of(row, row.b));
  body::TurnedBrickCounter turned = counter_of(reader.mesh());
  std::vector<body::Point> nodes(std::size_t(reader.mesh().nodes()));
  for (std::size_t i = 0; i < reader.times().size(); ++i) {
    const AnimationState state = reader.state(int(i));
    for (std::size_t n = 0; n < nodes.size(); ++n)
      nodes[n] = {state.position[3 * n], state.position[3 * n + 1], state.position[3 * n + 2]};
    for (body::JointFollower& f : followers) f.take(state.time, nodes);
    turned.take(state.time, nodes, state.solid_alive);
  }
  std::vector<JointGap> gaps;
  for (const body::JointFollower& f : followers) gaps.push_back(f.gap());
  fmt::print("{} states, {:g} to {:g} ms\n", reader.times().size(),
             reader.times().empty() ? 0 : reader.times().front(),
             reader.times().empty() ? 0 : reader.times().back());
  print_largest(rows, gaps, JointKind::sliding, c.rows);
  print_largest(rows, gaps, JointKind::tied, c.rows);
  print_turned(turned.kinds());
  if (!c.csv.empty()) write_csv(c.csv, rows, gaps);
  return 0;
}

}  // namespace

void add_joints(CLI::App& app, JointsCommand& c) {
  auto* cmd = app.add_subcommand(
      "joints", "How far the joints of a body came apart in a run, and which bricks turned over");
  cmd->add_option("result", c.result, "folder of the run, or its d3plot")->required();
  cmd->add_option("--joints", c.joints, "NAME_joints.csv, as fabrica body writes it")
      ->required()
      ->check(CLI::ExistingFile);
  cmd->add_option("--rows", c.rows, "joints to print of either kind, the widest first")
      ->capture_default_str();
  cmd->add_option("--csv", c.csv, "write all joints here");
  cmd->callback([&c] { throw CLI::RuntimeError(joints_command(c)); });
}

}  // namespace fabrica
