#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "body/joints/articulation.h"
#include "body/joints/elastic.h"
#include "body/joints/mend.h"
#include "body/joints/shift_bones.h"
#include "body/joints/touch.h"
#include "body/mesh/quality.h"

namespace fabrica::body {

namespace {

constexpr double reach = 6;       // [mm] deeper is another side of the bone, not penetration
constexpr double margin = 0.6;    // [mm] touches this far beyond the gap are kept in view
constexpr double surplus = 0.03;  // [mm] asked for beyond the gap
constexpr double allowed = 0.02;  // [mm] of overlap that counts as none

// The touches as bones stand, kept by pairs: only pairs with a bone that has moved are sought anew.
class Touches {
 public:
  Touches(const std::vector<PlacedBone>& bones, const std::vector<Articulation>& joints)
      : surfaces(bones), joints_(joints), moved_(bones.size(), 1) {}
  void moved(int bone) {
    surfaces.renew(bone);
    moved_[std::size_t(bone)] = 1;
  }
  // of pairs that stand nearer than their gap somewhere
  std::vector<Touch> list() {
    std::vector<Touch> all;
    std::map<std::pair<int, int>, std::vector<Touch>> now;
    for (const NearPair& pair : surfaces.near(joints_)) {
      std::vector<Touch>& found = now[{pair.a, pair.b}];
      if (moved_[std::size_t(pair.a)] || moved_[std::size_t(pair.b)])
        found = of_pair(pair);
      else
        found = std::move(kept_[{pair.a, pair.b}]);
      all.insert(all.end(), found.begin(), found.end());
    }
    kept_ = std::move(now);
    std::fill(moved_.begin(), moved_.end(), char(0));
    return all;
  }

  Surfaces surfaces;

 private:
  std::vector<Touch> of_pair(const NearPair& pair) const {
    std::vector<Touch> found = surfaces.touches(pair, margin, reach);
    if (std::none_of(found.begin(), found.end(), [](const Touch& t) { return t.distance < t.gap; }))
      found.clear();
    for (Touch& t : found) t.gap += surplus;
    return found;
  }
  const std::vector<Articulation>& joints_;
  std::map<std::pair<int, int>, std::vector<Touch>> kept_;
  std::vector<char> moved_;
};

// bones that touches name, with their mirror images
std::vector<int> bones_of(const std::vector<Touch>& touches, const Mirror& mirrors) {
  std::set<int> named;
  for (const Touch& t : touches)
    for (const int b : {t.a, t.b}) {
      named.insert(b);
      if (const int twin = mirrors.twin[std::size_t(b)]; twin >= 0) named.insert(twin);
    }
  return {named.begin(), named.end()};
}

// Touches in groups that do not move the same nodes: on one bone those nearer to each other than
// twice the influence of a touch, with their mirror images.
std::vector<std::vector<Touch>> groups_of(const std::vector<Touch>& touches,
                                          const std::vector<PlacedBone>& bones,
                                          const Mirror& mirrors) {
  struct Spot {
    Point place;
    int touch;
  };
  std::map<int, std::vector<Spot>> on_bone;  // right or midline bone -> spots, right side
  for (std::size_t k = 0; k < touches.size(); ++k)
    for (const auto& [b, n] :
         {std::pair{touches[k].a, touches[k].node}, std::pair{touches[k].b, touches[k].quad[0]}}) {
      Point p = bones[std::size_t(b)].nodes[std::size_t(n)];
      const int twin = mirrors.twin[std::size_t(b)];
      const bool left = twin >= 0 && bones[std::size_t(b)].side == Side::left;
      if (left || (mirrors.own[std::size_t(b)] && p.y > 0)) p = mirror(p);
      on_bone[left ? twin : b].push_back({p, int(k)});
    }
  std::vector<int> root(touches.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[std::size_t(i)] != i)
      i = root[std::size_t(i)] = root[std::size_t(root[std::size_t(i)])];
    return i;
  };
  for (const auto& [bone, spots] : on_bone) {
    const double near = mirrors.own[std::size_t(bone)] ? 1e30 : 2 * ElasticBones::influence;
    for (std::size_t i = 0; i < spots.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (norm(spots[i].place - spots[j].place) < near)
          root[std::size_t(find(spots[i].touch))] = find(spots[j].touch);
  }
  std::map<int, std::vector<Touch>> groups;
  for (std::size_t k = 0; k < touches.size(); ++k) groups[find(int(k))].push_back(touches[k]);
  std::vector<std::vector<Touch>> list;
  for (auto& [first, group] : groups) list.push_back(std::move(group));
  return list;
}

void polish_all(std::vector<PlacedBone>& bones, const std::vector<Touch>& touches,
                const Mirror& mirrors, Touches& search) {
  for (const int b : bones_of(touches, mirrors)) {
    PlacedBone& bone = bones[std::size_t(b)];
    const int twin = mirrors.twin[std::size_t(b)];
    if (twin >= 0 && bone.side == Side::left) continue;
    mend(bone.mesh, bone.nodes, mirrors.own[std::size_t(b)], search.surfaces[b],
         planes_of(touches, b, twin, bones));
    search.moved(b);
    if (twin < 0) continue;
    for (std::size_t n = 0; n < bone.nodes.size(); ++n)
      bones[std::size_t(twin)].nodes[n] = mirror(bone.nodes[n]);
    search.moved(twin);
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
  const Mirror mirrors(bones);
  restore_symmetry(mirrors, bones);
  ClearanceReport report;
  const LargestShift whole = shift_bones(bones, joints, mirrors.twin);
  report.whole_shift = whole.shift;
  if (whole.bone >= 0) report.whole_shift_bone = part_name(bones[std::size_t(whole.bone)], "");

  std::vector<std::vector<Point>> start;
  for (const PlacedBone& bone : bones) start.push_back(bone.nodes);
  const ElasticBones elastic(bones, mirrors);
  Touches search(bones, joints);
  std::vector<Touch> touches = search.list();
  const auto press = [&](double weight, int iterations) {
    for (const std::vector<Touch>& group : groups_of(touches, bones, mirrors))
      elastic.press(bones, group, weight, iterations);
    for (const int b : bones_of(touches, mirrors)) search.moved(b);
    touches = search.list();
  };
  // a change spreads by about one brick an iteration: short of rest, bones lose volume at their
  // ends
  const bool fine = !bones.empty() && bones.front().mesh.resolution == Resolution::fine;
  const int iterations = fine ? 60 : 20;
  for (const double weight : {10.0, 50.0, 200.0, 600.0, 1500.0, 1500.0}) press(weight, iterations);
  const auto overlap = [&] {
    return std::any_of(touches.begin(), touches.end(),
                       [](const Touch& t) { return t.distance < -allowed; });
  };
  for (int round = 0; !touches.empty() && (round < 4 || (round < 12 && overlap())); ++round) {
    polish_all(bones, touches, mirrors, search);
    touches = search.list();
  }
  report_gaps(bones, touches, report);
  finish(bones, start, report);
  return report;
}

}  // namespace fabrica::body
