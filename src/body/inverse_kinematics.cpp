// Inverse kinematics: the angles q of a chain that bring its points p(q) to their targets g,
//   minimise  sum |p(q) - g|^2 + w^2 |q - q0|^2   within the ranges, (1)
// by damped least squares (Levenberg and Marquardt) with a numerical Jacobian and steps that are
// cut at the ranges. w = 0.3 mm per degree keeps the posture near its start q0 without holding a
// reachable goal off by more than a millimetre.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "body/error.h"
#include "body/goals.h"
#include "body/skeleton.h"

namespace fabrica::body {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double reached = 5;  // [mm] a goal counts as met

struct Unknown {
  std::string name;  // as in Posture::angle
  double low, high;
};

std::vector<Unknown> unknowns(const std::vector<std::string>& joints, Side side) {
  std::vector<Unknown> list;
  const std::string s = side == Side::right ? ".right." : ".left.";
  for (const Joint& j : joint_tree())
    if (std::find(joints.begin(), joints.end(), j.name) != joints.end())
      for (const JointAxis& a : j.axes) list.push_back({j.name + s + a.coordinate, a.low, a.high});
  return list;
}

Point place(const Skeleton& skeleton, const Reach& r) {
  return skeleton.carried(r.frame, r.side, r.side == Side::left ? mirror(r.standing) : r.standing);
}

// One chain and its goals, (1).
class Chain {
 public:
  Chain(Posture& posture, const Subject& subject, std::vector<Unknown> unknown,
        const std::vector<Reach>& goals)
      : posture_(posture),
        subject_(subject),
        unknown_(std::move(unknown)),
        goals_(goals),
        q_(long(unknown_.size())) {
    for (long i = 0; i < q_.size(); ++i) q_[i] = posture_.angle[unknown_[std::size_t(i)].name];
    start_ = q_;
  }

  void solve() {
    double damping = 1e-2;
    Eigen::VectorXd r = residual(q_);
    for (int iteration = 0; iteration < 200 && damping < 1e8; ++iteration) {
      const Eigen::MatrixXd J = jacobian(r);
      const Eigen::MatrixXd A = J.transpose() * J;
      const Eigen::VectorXd b = J.transpose() * r;
      Eigen::MatrixXd damped = A;
      damped.diagonal() += damping * (A.diagonal().array() + 1e-3).matrix();
      const Eigen::VectorXd next = cut(q_ - damped.ldlt().solve(b));
      const Eigen::VectorXd after = residual(next);
      const double gain = r.squaredNorm() - after.squaredNorm();
      if (gain > 0) {
        q_ = next, r = after, damping *= 0.3;
        if (gain < 1e-9 * (1 + r.squaredNorm())) break;
      } else {
        damping *= 4;
      }
    }
    apply(q_);
    check();
  }

 private:
  Eigen::VectorXd cut(Eigen::VectorXd q) const {
    for (long i = 0; i < q.size(); ++i)
      q[i] = std::clamp(q[i], unknown_[std::size_t(i)].low, unknown_[std::size_t(i)].high);
    return q;
  }
  void apply(const Eigen::VectorXd& q) {
    for (long i = 0; i < q.size(); ++i) posture_.angle[unknown_[std::size_t(i)].name] = q[i];
  }
  Eigen::VectorXd residual(const Eigen::VectorXd& q) {
    constexpr double weight = 0.3;  // [mm / deg]
    apply(q);
    const Skeleton skeleton(subject_, posture_);
    Eigen::VectorXd r(long(3 * goals_.size()) + q.size());
    long k = 0;
    for (const Reach& g : goals_) {
      const Point d = place(skeleton, g) - g.target;
      r[k++] = d.x, r[k++] = d.y, r[k++] = d.z;
    }
    for (long i = 0; i < q.size(); ++i) r[k++] = weight * (q[i] - start_[i]);
    return r;
  }
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& r) {
    constexpr double h = 0.01;  // [deg]
    Eigen::MatrixXd J(r.size(), q_.size());
    for (long i = 0; i < q_.size(); ++i) {
      Eigen::VectorXd q = q_;
      // stay inside the range
      const double step = q[i] + h > unknown_[std::size_t(i)].high ? -h : h;
      q[i] += step;
      J.col(i) = (residual(q) - r) / step;
    }
    return J;
  }
  void check() const {
    const Skeleton skeleton(subject_, posture_);
    for (const Reach& g : goals_) {
      const Point at = place(skeleton, g);
      const double off = norm(at - g.target);
      if (off > reached)
        throw BodyError(
            fmt::format("goal {} [{:.0f}, {:.0f}, {:.0f}] is {:.0f} mm out of reach within the "
                        "joint ranges; the nearest "
                        "point is [{:.0f}, {:.0f}, {:.0f}]",
                        g.name, g.target.x, g.target.y, g.target.z, off, at.x, at.y, at.z));
    }
  }

  Posture& posture_;
  const Subject& subject_;
  std::vector<Unknown> unknown_;
  const std::vector<Reach>& goals_;
  Eigen::VectorXd q_, start_;
};

double torso_angle(const Skeleton& skeleton) {
  const Point h =
      0.5 * (skeleton.joint_centre("hip", Side::right) + skeleton.joint_centre("hip", Side::left));
  const Point d = skeleton.joint_centre("C7") - h;
  return std::atan2(-d.x, d.z) / degree;
}
// pitch of the head, forward positive
double head_pitch(const Skeleton& skeleton) {
  const Mat3d& R = skeleton.frame("head").R;
  return std::atan2(R(0, 2), R(2, 2)) / degree;
}

// The whole body tips with the pelvis: one turn meets the angle exactly.
void set_torso(Posture& posture, const Subject& subject, double wanted) {
  const double now = torso_angle(Skeleton(subject, posture));
  posture.angle["pelvis.pitch"] -= wanted - now;
}

// The neck shares the turn among its levels, each as far as its range goes.
void level_head(Posture& posture, const Subject& subject) {
  double left = -head_pitch(Skeleton(subject, posture));
  for (const char* name : {"C7", "C6", "C5", "C4", "C3", "C2", "C1", "head"}) {
    // levels that are still to come take equal shares
    static const std::vector<std::string> all{"C7", "C6", "C5", "C4", "C3", "C2", "C1", "head"};
    const auto at = std::find(all.begin(), all.end(), name);
    const double share = left / double(all.end() - at);
    const JointAxis& axis = find_joint(name)->axes[0];
    double& angle = posture.angle[axis.joint + ".flexion"];
    const double before = angle;
    angle = std::clamp(before + share, axis.low, axis.high);
    left -= angle - before;
  }
  const double off = head_pitch(Skeleton(subject, posture));
  if (std::abs(off) > 1)
    throw BodyError(
        fmt::format("goal head_level: the neck's ranges leave the head {:.0f} degrees {}; the "
                    "nearest torso angle is {:.0f} "
                    "degrees",
                    std::abs(off), off > 0 ? "nodding" : "tipped back",
                    torso_angle(Skeleton(subject, posture)) + off));
}

std::vector<Reach> of_side(const std::vector<Reach>& goals, Side side) {
  std::vector<Reach> list;
  for (const Reach& g : goals)
    if (g.side == side) list.push_back(g);
  return list;
}

}  // namespace

void solve(Posture& posture, const Subject& subject, const Goals& goals) {
  posture.goals = goals.name;
  if (goals.torso_angle) {
    if (*goals.torso_angle < -30 || *goals.torso_angle > 95)
      throw BodyError(
          fmt::format("goal torso_angle {:g} degrees is outside -30 to 95; the nearest is {:g}",
                      *goals.torso_angle, std::clamp(*goals.torso_angle, -30.0, 95.0)));
    set_torso(posture, subject, *goals.torso_angle);
  }
  if (goals.h_point) {
    posture.pelvis.t = {0, 0, 0};
    const Skeleton s(subject, posture);
    posture.pelvis.t = *goals.h_point - 0.5 * (s.joint_centre("hip", Side::right) +
                                               s.joint_centre("hip", Side::left));
  }
  if (goals.head_level) level_head(posture, subject);
  for (const Side side : {Side::right, Side::left}) {
    if (const auto feet = of_side(goals.feet, side); !feet.empty()) {
      Chain(posture, subject, unknowns({"hip", "knee", "ankle", "subtalar"}, side), feet).solve();
      const std::string s = side == Side::right ? ".right" : ".left";
      set_angle(posture, "knee" + s,
                posture.angle["knee" + s + ".flexion"]);  // the patella follows
    }
    if (const auto hands = of_side(goals.hands, side); !hands.empty())
      Chain(posture, subject,
            unknowns({"clavicle", "scapula", "shoulder", "elbow", "forearm", "wrist"}, side), hands)
          .solve();
  }
  constexpr double fist =
      4 * (90 + 100 + 70) + 75;  // [deg] all joints of the grip at the end of their ranges
  if (goals.grip) set_angle(posture, "grip", 0.6 * fist);
}

}  // namespace fabrica::body
