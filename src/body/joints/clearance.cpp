#include <algorithm>
#include <cmath>
#include <map>

#include "body/joints/articulation.h"
#include "body/joints/elastic.h"
#include "body/joints/shift_bones.h"
#include "body/joints/touch.h"
#include "body/mesh/polish.h"
#include "body/mesh/quality.h"

namespace fabrica::body {

namespace {

constexpr double reach = 6;       // [mm] deeper is another side of the bone, not penetration
constexpr double margin = 0.6;    // [mm] touches this far beyond the gap are kept in view
constexpr double surplus = 0.03;  // [mm] asked for beyond the gap
constexpr double allowed = 0.02;  // [mm] of overlap that counts as none
constexpr double wish = 0.44;     // of the scaled Jacobian, for the local stage

// For each bone the index of the bone that is its mirror image, -1: none stands so.
std::vector<int> twins_of(const std::vector<PlacedBone>& bones) {
  std::vector<int> twins(bones.size(), -1);
  for (std::size_t r = 0; r < bones.size(); ++r) {
    if (bones[r].side != Side::right) continue;
    const int l = find_bone(bones, bones[r].mesh.name, Side::left);
    if (l < 0) continue;
    const std::vector<Point>&right = bones[r].nodes, &left = bones[std::size_t(l)].nodes;
    bool same = right.size() == left.size();
    for (std::size_t n = 0; same && n < right.size(); ++n)
      same = norm(right[n] - mirror(left[n])) < 1e-6;
    if (same) twins[r] = l, twins[std::size_t(l)] = int(r);
  }
  return twins;
}

std::vector<Touch> all_touches(const std::vector<PlacedBone>& bones,
                               const std::vector<Articulation>& joints, Surfaces& surfaces) {
  for (int b = 0; b < int(bones.size()); ++b) surfaces.renew(b);
  std::vector<Touch> list;
  for (const NearPair& pair : surfaces.near(joints)) {
    const std::vector<Touch> found = surfaces.touches(pair, margin, reach);
    const bool close =
        std::any_of(found.begin(), found.end(), [](const Touch& t) { return t.distance < t.gap; });
    if (close) list.insert(list.end(), found.begin(), found.end());
  }
  for (Touch& t : list) t.gap += surplus;
  return list;
}

// The local stage for one bone: its worst bricks and shells, surfaces kept where they are, other
// bones at their distance.
void polish_bone(PlacedBone& bone, int index, const std::vector<Touch>& touches,
                 const std::vector<PlacedBone>& bones, const BoneSurface& surface) {
  UntangleProblem problem;
  problem.bricks = bone.mesh.bricks;
  problem.spacing = 0;
  for (const Brick& brick : bone.mesh.bricks)
    for (float l : edge_lengths(corners_of(bone.nodes, brick)))
      problem.spacing += l / (3.0 * double(bone.mesh.bricks.size()));
  double least_shell = 1e30;
  for (std::size_t q = 0; q < bone.mesh.cortex.size(); ++q)
    if (bone.mesh.cortex[q] > 0) problem.shells.push_back(bone.mesh.surface[q]);
  for (const Quad& quad : problem.shells)
    least_shell = std::min(least_shell, shell_size(bone.mesh.nodes, quad));
  for (int n : surface.nodes())
    problem.planes.push_back({n, bone.nodes[std::size_t(n)], surface.node_normal(n), 100, false});
  for (const Touch& t : touches) {
    if (t.a != index) continue;
    Point place{0, 0, 0};
    for (std::size_t i = 0; i < 4; ++i)
      place += t.weight[i] * bones[std::size_t(t.b)].nodes[std::size_t(t.quad[i])];
    problem.planes.push_back({t.node, place + t.gap * t.normal, t.normal, 2000, true});
  }
  PolishOptions options;
  options.jacobian = wish;
  options.size = 0.25 * problem.spacing;
  options.shell_size = problem.shells.empty() ? 0 : least_shell;
  options.sweeps = 30;
  polish(problem, bone.nodes, options);
}

void polish_all(std::vector<PlacedBone>& bones, const std::vector<Touch>& touches,
                const std::vector<int>& twins, Surfaces& surfaces) {
  std::vector<char> touched(bones.size(), 0);
  for (const Touch& t : touches) touched[std::size_t(t.a)] = touched[std::size_t(t.b)] = 1;
  for (int b = 0; b < int(bones.size()); ++b) {
    PlacedBone& bone = bones[std::size_t(b)];
    const int twin = twins[std::size_t(b)];
    if (!touched[std::size_t(b)] || (twin >= 0 && bone.side == Side::left)) continue;
    surfaces.renew(b);
    polish_bone(bone, b, touches, bones, surfaces[b]);
    if (twin < 0) continue;
    for (std::size_t n = 0; n < bone.nodes.size(); ++n)
      bones[std::size_t(twin)].nodes[n] = mirror(bone.nodes[n]);
  }
}

std::string pair_name(const std::vector<PlacedBone>& bones, int a, int b) {
  return part_name(bones[std::size_t(a)], "") + " " + part_name(bones[std::size_t(b)], "");
}

void report_gaps(const std::vector<PlacedBone>& bones, const std::vector<Touch>& touches,
                 ClearanceReport& report) {
  report.least_gap = 1e30;
  std::map<std::pair<int, int>, double> least;
  for (const Touch& t : touches) {
    double& gap = least.try_emplace(std::minmax(t.a, t.b), 1e30).first->second;
    gap = std::min(gap, t.distance);
  }
  for (const auto& [pair, gap] : least) {
    const std::string name = pair_name(bones, pair.first, pair.second);
    if (gap < report.least_gap) report.least_gap = gap, report.least_gap_pair = name;
    if (gap < -allowed) report.left.push_back(name);
  }
}

// takes the shifts over into the meshes of the bones' own frames
void finish(std::vector<PlacedBone>& bones, const std::vector<std::vector<Point>>& start,
            ClearanceReport& report) {
  for (std::size_t b = 0; b < bones.size(); ++b) {
    PlacedBone& bone = bones[b];
    double shift = 0;
    for (std::size_t n = 0; n < bone.nodes.size(); ++n)
      shift = std::max(shift, norm(bone.nodes[n] - start[b][n]));
    if (shift == 0) continue;
    if (shift > report.largest_shift)
      report.largest_shift = shift, report.largest_shift_bone = part_name(bone, "");
    for (std::size_t n = 0; n < bone.nodes.size(); ++n)
      bone.mesh.nodes[n] = bone.placement.inverse(bone.nodes[n]);
    for (const Brick& brick : bone.mesh.bricks) {
      const double jacobian = scaled_jacobian(corners_of(bone.nodes, brick));
      if (jacobian < report.least_scaled_jacobian)
        report.least_scaled_jacobian = jacobian,
        report.least_scaled_jacobian_bone = part_name(bone, "");
    }
  }
}

}  // namespace

ClearanceReport clear_bones(std::vector<PlacedBone>& bones) {
  const std::vector<Articulation> joints = articulations(bones);
  const std::vector<int> twins = twins_of(bones);
  ClearanceReport report;
  const LargestShift whole = shift_bones(bones, joints, twins);
  report.whole_shift = whole.shift;
  if (whole.bone >= 0) report.whole_shift_bone = part_name(bones[std::size_t(whole.bone)], "");

  std::vector<std::vector<Point>> start;
  for (const PlacedBone& bone : bones) start.push_back(bone.nodes);
  const ElasticBones elastic(bones, twins);
  Surfaces surfaces(bones);
  std::vector<Touch> touches = all_touches(bones, joints, surfaces);
  for (const double weight : {10.0, 50.0, 200.0, 600.0, 1500.0, 1500.0}) {
    if (touches.empty()) break;
    elastic.press(bones, touches, weight, 20);
    touches = all_touches(bones, joints, surfaces);
  }
  for (int round = 0; round < 4 && !touches.empty(); ++round) {
    polish_all(bones, touches, twins, surfaces);
    touches = all_touches(bones, joints, surfaces);
  }
  report_gaps(bones, touches, report);
  finish(bones, start, report);
  return report;
}

}  // namespace fabrica::body
