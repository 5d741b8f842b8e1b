#include "body/scapulae.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "body/joints/bone_surface.h"

namespace fabrica::body {

namespace {

constexpr double near_enough = 0.3;   // [mm] of depth
constexpr double lever = 60;          // [mm] l of (2)
constexpr double softness = 0.02;     // s
constexpr double clavicle_cost = 10;  // w
constexpr double most_turn = 0.05;    // [rad] in one iteration
constexpr int iterations = 60, directions = 2000;

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// `directions` unit vectors, evenly spread (Fibonacci's lattice); of the left side the mirror
// images
std::vector<Point> even_directions(Side side) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Point> list;
  for (int k = 0; k < directions; ++k) {
    const double z = 1 - (2 * k + 1.0) / directions, r = std::sqrt(1 - z * z);
    const Point d{r * std::cos(golden * k), r * std::sin(golden * k), z};
    list.push_back(side == Side::left ? mirror(d) : d);
  }
  return list;
}

// (1)
class Hull {
 public:
  Hull(const std::vector<Point>& points, const Point& towards, Side side) {
    const Point out = towards - middle_of(points);
    for (const Point& d : even_directions(side)) {
      if (dot(d, out) <= 0) continue;
      double h = -1e30;
      for (const Point& p : points) h = std::max(h, dot(d, p));
      support_.push_back({d, h});
    }
  }
  struct Depth {
    double depth = 1e30;
    Point normal{0, 0, 1};
  };
  Depth at(const Point& p) const {
    Depth least;
    for (const auto& [d, h] : support_)
      if (const double depth = h - dot(d, p); depth < least.depth) least = {depth, d};
    return least;
  }

 private:
  struct Support {
    Point direction;
    double h;
  };
  std::vector<Support> support_;
};

std::vector<Point> surface_points(const PlacedBone& bone) {
  const BoneSurface surface(bone.nodes, bone.mesh.surface);
  std::vector<Point> points;
  for (const int n : surface.nodes()) points.push_back(bone.nodes[std::size_t(n)]);
  return points;
}

// turns of a clavicle about the sternum and then of a blade about the clavicle
struct Turns {
  Mat3d clavicle = identity3<double>(), blade = identity3<double>();
};

Mat3d turn_by(const Eigen::Vector3d& u) {
  const double angle = u.norm();
  if (angle < 1e-12) return identity3<double>();
  return rotation_about({u[0] / angle, u[1] / angle, u[2] / angle}, angle);
}

Placement about(const Point& centre, const Mat3d& turn) { return {turn, centre - turn * centre}; }

// the turns that (2) asks for, and the depths before and after
Turns turns_of(const Hull& hull, std::vector<Point> blade, const Point& sternum, Point clavicle,
               double& before, double& after) {
  Turns all;
  for (int iteration = 0; iteration <= iterations; ++iteration) {
    Matrix6 m = Matrix6::Zero();
    Vector6 rhs = Vector6::Zero();
    int under = 0;
    after = 0;
    for (const Point& x : blade) {
      const Hull::Depth at = hull.at(x);
      if (at.depth <= 0) continue;
      after = std::max(after, at.depth), ++under;
      const Point a = cross(x - sternum, at.normal), b = cross(x - clavicle, at.normal);
      const Vector6 row{{a.x, a.y, a.z, b.x, b.y, b.z}};
      m += row * row.transpose();
      rhs += at.depth * row;
    }
    if (iteration == 0) before = after;
    if (after < near_enough || iteration == iterations) break;
    for (int i = 0; i < 6; ++i)
      m(i, i) += softness * under * lever * lever * (i < 3 ? clavicle_cost : 1);
    Vector6 u = m.ldlt().solve(rhs);
    u *= std::min(1.0, most_turn / std::max(u.head<3>().norm(), u.tail<3>().norm()));
    const Mat3d first = turn_by(u.head<3>()), second = turn_by(u.tail<3>());
    const Placement carried = about(sternum, first);
    clavicle = carried(clavicle);
    const Placement turned = about(clavicle, second);
    for (Point& x : blade) x = turned(carried(x));
    all.clavicle = first * all.clavicle;
    all.blade = second * first * all.blade * transpose(first);
  }
  return all;
}

double angle_of(const Mat3d& turn) {
  const double cosine = 0.5 * (turn(0, 0) + turn(1, 1) + turn(2, 2) - 1);
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

Mat3d mirrored_turn(const Mat3d& turn) { return mirror(Placement{turn, {0, 0, 0}}).R; }

bool mirror_each_other(const PlacedBone& a, const PlacedBone& b) {
  for (std::size_t n = 0; n < a.nodes.size(); ++n)
    if (norm(a.nodes[n] - mirror(b.nodes[n])) > 1e-6) return false;
  return true;
}

// the frames of a side from the clavicle on
void turn_frames(Skeleton& skeleton, Side side, const Turns& turns, ScapulaRest& report) {
  const Point shoulder = skeleton.joint_centre("shoulder", side);
  skeleton.carry("clavicle", side, about(skeleton.joint_centre("clavicle", side), turns.clavicle));
  skeleton.carry("scapula", side, about(skeleton.joint_centre("scapula", side), turns.blade));
  const Point moved = skeleton.joint_centre("shoulder", side);
  const Mat3d blade = turns.blade * turns.clavicle;
  skeleton.carry("humerus", side, about(moved, transpose(blade)));
  report.turn = std::max(report.turn, angle_of(blade));
  report.arm = std::max(report.arm, norm(moved - shoulder));
}

}  // namespace

ScapulaRest rest_scapulae(Skeleton& skeleton, std::vector<PlacedBone>& bones) {
  ScapulaRest report;
  std::vector<Point> ribs;
  for (const PlacedBone& bone : bones)
    if (bone.mesh.name.starts_with("rib"))
      for (const Point& p : surface_points(bone)) ribs.push_back(p);
  const int right = find_bone(bones, "scapula", Side::right);
  Turns turns;
  bool turned = false;
  for (const Side side : {Side::right, Side::left}) {
    const int at = find_bone(bones, "scapula", side);
    if (ribs.empty() || at < 0 || find_bone(bones, "clavicle", side) < 0) continue;
    const PlacedBone& bone = bones[std::size_t(at)];
    const bool same =
        side == Side::left && right >= 0 && mirror_each_other(bones[std::size_t(right)], bone);
    if (same) {
      turns = {mirrored_turn(turns.clavicle), mirrored_turn(turns.blade)};
    } else {
      const std::vector<Point> blade = surface_points(bone);
      double before = 0, after = 0;
      turns = turns_of(Hull(ribs, middle_of(blade), side), blade,
                       skeleton.joint_centre("clavicle", side),
                       skeleton.joint_centre("scapula", side), before, after);
      report.depth = std::max(report.depth, before);
      report.left = std::max(report.left, after);
    }
    turn_frames(skeleton, side, turns, report);
    turned = true;
  }
  if (turned)
    for (PlacedBone& bone : bones)
      if (bone.region == Region::arm) place(bone, skeleton);
  return report;
}

}  // namespace fabrica::body
