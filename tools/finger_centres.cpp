// Prints the rows of data/anatomy/joint_tree.csv of the joints between metacarpals and phalanges:
// centres c about which the base of a phalanx glides around the head before it. The tables' bones
// overlap by up to 4 mm there; as the clearing of bones does, the phalanx is first drawn off along
// its ray until the least distance g of the two bones is g0 = 1.2, the room of their cartilage.
// Then the bend leaves its face there: over the angles f of the range in steps of 10 degrees and
// the nodes n of the base that are at most 3 mm farther from the head than the nearest, in the
// plane of bending through the middle of those nodes,
//   c = argmin  sum_f sum_n (d(c, f, n) - d(0, n))^2                                           (1)
// with d the distance of a node from the head, on fine meshes.
//   cmake --build build --target finger_centres && build/finger_centres
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "body/joints/bone_surface.h"
#include "body/skeleton.h"

using namespace fabrica::body;
using fabrica::Mat3d;

namespace {

constexpr double step = 10;     // [deg]
constexpr double wanted = 1.2;  // [mm] g0 of (1)
constexpr double reach = 15;    // [mm] farther bones count as that far

class FingerJoint {
 public:
  explicit FingerJoint(const Joint& joint)
      : joint_(joint),
        head_(placed(joint.name == "mcp1"            ? "metacarpal1"
                     : joint.name.starts_with("mcp") ? "metacarpal" + joint.name.substr(3)
                                                     : joint.parent)),
        base_(placed(joint.child)),
        on_head_(head_.nodes, head_.surface),
        on_base_(base_.nodes, base_.surface),
        ray_(unit(middle_of(base_.nodes) - middle_of(head_.nodes))) {
    for (double move = 1; std::abs(move) > 0.01;) {
      const double missing = wanted - gap(joint.centre, 0);
      move = std::clamp(missing, -1.0, 1.0);
      drawn_ += move;
    }
    for (const int n : on_base_.nodes()) {
      const Point& p = base_.nodes[std::size_t(n)];
      const SurfacePoint at = on_head_.nearest(p + drawn_ * ray_, reach);
      if (at.quad >= 0 && at.distance < wanted + 3) face_.emplace_back(p, at.distance);
    }
  }

  // least distance of the two bones
  double gap(const Point& c, double degrees) const {
    const Placement turned = turn(c, degrees);
    double least = reach;
    for (const int n : on_base_.nodes()) {
      const SurfacePoint at = on_head_.nearest(turned(base_.nodes[std::size_t(n)]), reach);
      if (at.quad >= 0) least = std::min(least, at.distance);
    }
    for (const int n : on_head_.nodes()) {
      const SurfacePoint at = on_base_.nearest(turned.inverse(head_.nodes[std::size_t(n)]), reach);
      if (at.quad >= 0) least = std::min(least, at.distance);
    }
    return least;
  }
  // E of (1)
  double energy(const Point& c) const {
    double sum = 0;
    const JointAxis& axis = joint_.axes.front();
    for (double f = step * std::ceil(axis.low / step); f <= axis.high; f += step) {
      const Placement turned = turn(c, f);
      for (const auto& [p, straight] : face_) {
        const SurfacePoint at = on_head_.nearest(turned(p), reach);
        const double off = (at.quad < 0 ? reach : at.distance) - straight;
        sum += off * off;
      }
    }
    return sum;
  }
  // of the base's face
  Point middle() const {
    Point sum{0, 0, 0};
    for (const auto& [p, straight] : face_) sum += p;
    return (1.0 / double(face_.size())) * sum + drawn_ * ray_;
  }
  // the c of (1): the best of a grid of 1 mm, then of 0.25 and of 0.1 around it
  Point best() const {
    constexpr int around = 8;  // steps
    const Point from = middle(), a = joint_.axes.front().axis,
                u = unit(cross(a, std::abs(a.z) < 0.9 ? Point{0, 0, 1} : Point{1, 0, 0})),
                v = cross(a, u);
    Point found = from;
    for (const double grid : {1.0, 0.25, 0.1}) {
      const Point about = found;
      double least = energy(found);
      for (int i = -around; i <= around; ++i)
        for (int j = -around; j <= around; ++j) {
          const Point c = about + i * grid * u + j * grid * v;
          if (const double e = energy(c); e < least) least = e, found = c;
        }
    }
    return found;
  }

 private:
  // drawn off, then bent
  Placement turn(const Point& c, double degrees) const {
    const Mat3d q = rotation_about(joint_.axes.front().axis, degrees * std::numbers::pi / 180);
    return {q, c + q * (drawn_ * ray_ - c)};
  }
  // as it stands
  static BoneMesh placed(const std::string& bone) {
    static const Skeleton standing(make_subject("male", 1750, 77), named_posture("standing"));
    BoneMesh mesh = mesh_bone({bone, Resolution::fine});
    const Placement place = standing.bone(bone, "hand", Side::right);
    for (Point& p : mesh.nodes) p = place(p);
    return mesh;
  }
  const Joint& joint_;
  BoneMesh head_, base_;
  BoneSurface on_head_, on_base_;
  Point ray_;
  std::vector<std::pair<Point, double>> face_;  // nodes of (1) as they stand, d(0, n)
  double drawn_ = 0;                            // [mm] of the phalanx along its ray
};

}  // namespace

int main() {
  for (const Joint& joint : joint_tree()) {
    if (!joint.child.starts_with("hand_phalanx")) continue;
    const FingerJoint finger(joint);
    const Point c = finger.best();
    fmt::print("{},{},{},1,{:.1f},{:.1f},{:.1f},made by build/finger_centres\n", joint.name,
               joint.parent, joint.child, c.x, c.y, c.z);
    fmt::print(stderr, "{}: {:.1f} mm from the middle, gap", joint.name, norm(c - finger.middle()));
    for (double f = joint.axes.front().low; f <= joint.axes.front().high + 0.1; f += step)
      fmt::print(stderr, " {:.1f}/{:.1f}", finger.gap(joint.centre, f), finger.gap(c, f));
    fmt::print(stderr, "\n");
  }
  return 0;
}
