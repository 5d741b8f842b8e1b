#pragma once
// Bodies held together by joints and to the ground by conditions on their velocity, advanced in one
// step:
//   M (v+ - v_free) = J(t^n)^T lambda,   C(x^(n+1)) = 0 for joints,   d . v+ = target for ground
//   conditions
// solved by Newton steps with the matrix A = J M^-1 J^T at t^n. Joint positions are met to
// rounding, impulses act on common lines, so linear and angular momentum are kept; the scheme is
// the rigid-body form of SHAKE. Source: J.-P. Ryckaert, G. Ciccotti, H. J. C. Berendsen, J. Comput.
// Phys. 23, 1977; constraints at position level.
#include <algorithm>
#include <span>
#include <vector>

#include "constraint/dense.h"
#include "constraint/joint_rows.h"
#include "constraint/rigid_motion.h"

namespace fabrica {

// d . v or d . w of one body takes a value; d in global or (in_body) in principal body components.
struct GroundCondition {
  int body = 0;
  bool rotation = false, in_body = false;
  Vec3d direction{};
  double target = 0;
};
// One joint condition between bodies a and b of the component.
struct LinkCondition {
  int a = 0, b = 0;
  const JointGeometry* geometry = nullptr;
  const JointCondition* condition = nullptr;
};

class Component {
 public:
  // Completes trials (v, momentum and a first guess of w set) of all bodies; impulses follow
  // grounds then links. returns the number of Newton steps.
  int solve(std::span<const RigidMotion> bodies, std::span<RigidTrial> trials, double dt,
            std::span<const GroundCondition> grounds, std::span<const LinkCondition> links) {
    assemble(bodies, grounds, links);
    const int n = int(rows_.size());
    impulse.assign(n, 0);
    double scale = 0;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      advance_trial(bodies[i], dt, trials[i]);
      scale +=
          bodies[i].mass * dot(trials[i].v, trials[i].v) + dot(trials[i].w, trials[i].momentum);
    }
    double last = 0;
    for (int step = 1; step <= 30; ++step) {
      const std::vector<double> residual = residuals(trials, dt, grounds, links);
      std::vector<double> x(n);
      for (int i = 0; i < n; ++i) x[i] = -residual[i];
      factor_.solve(x);
      // r . A^-1 r is twice the kinetic energy of the correction
      double error = 0;
      for (int i = 0; i < n; ++i) error -= x[i] * residual[i];
      if (error <= 1e-32 * scale || (step > 2 && error > 0.25 * last)) return step;
      last = error;
      scale = std::max(scale, error);
      for (int i = 0; i < n; ++i) push(bodies, trials, i, x[i]);
      for (std::size_t i = 0; i < trials.size(); ++i) advance_trial(bodies[i], dt, trials[i]);
    }
    return 30;
  }

  struct Row {
    int a, b;  // -1: none
    ConstraintRow j;
  };
  const std::vector<Row>& rows() const { return rows_; }
  std::vector<double> impulse;

 private:
  void assemble(std::span<const RigidMotion> bodies, std::span<const GroundCondition> grounds,
                std::span<const LinkCondition> links) {
    rows_.clear();
    pose_.clear();
    for (const RigidMotion& b : bodies) pose_.push_back({b.x, b.q, matrix_of(b.q)});
    for (const GroundCondition& g : grounds) {
      Row r{-1, g.body, {}};
      (g.rotation ? r.j.b_w : r.j.b_v) = g.in_body ? pose_[g.body].R * g.direction : g.direction;
      rows_.push_back(r);
    }
    for (const LinkCondition& l : links)
      rows_.push_back({l.a, l.b, joint_row(*l.geometry, *l.condition, pose_[l.a], pose_[l.b])});
    const int n = int(rows_.size());
    std::vector<double> matrix(std::size_t(n) * n, 0);
    for (int j = 0; j < n; ++j) {
      const Row& rj = rows_[j];
      // M^-1 J^T of row j for both its bodies
      Vec3d av{}, aw{}, bv{}, bw{};
      if (rj.a >= 0) {
        av = (1 / bodies[rj.a].mass) * rj.j.a_v;
        aw = inverse_inertia_times(pose_[rj.a].R, bodies[rj.a].inertia, rj.j.a_w);
      }
      bv = (1 / bodies[rj.b].mass) * rj.j.b_v;
      bw = inverse_inertia_times(pose_[rj.b].R, bodies[rj.b].inertia, rj.j.b_w);
      for (int i = j; i < n; ++i) {
        const Row& ri = rows_[i];
        double s = 0;
        if (ri.a >= 0 && ri.a == rj.a) s += dot(ri.j.a_v, av) + dot(ri.j.a_w, aw);
        if (ri.a >= 0 && ri.a == rj.b) s += dot(ri.j.a_v, bv) + dot(ri.j.a_w, bw);
        if (ri.b == rj.a) s += dot(ri.j.b_v, av) + dot(ri.j.b_w, aw);
        if (ri.b == rj.b) s += dot(ri.j.b_v, bv) + dot(ri.j.b_w, bw);
        matrix[std::size_t(i) * n + j] = s;
      }
    }
    factor_.factor(std::move(matrix), n);
  }

  std::vector<double> residuals(std::span<const RigidTrial> trials, double dt,
                                std::span<const GroundCondition> grounds,
                                std::span<const LinkCondition> links) {
    std::vector<double> r;
    for (const GroundCondition& g : grounds) {
      const RigidTrial& t = trials[g.body];
      const Vec3d d = g.in_body ? matrix_of(t.q_half) * g.direction : g.direction;
      r.push_back(dot(d, g.rotation ? t.w : t.v) - g.target);
    }
    for (std::size_t i = 0; i < trials.size(); ++i)
      pose_[i] = {trials[i].x, trials[i].q, matrix_of(trials[i].q)};
    for (const LinkCondition& l : links)
      r.push_back(joint_error(*l.geometry, *l.condition, pose_[l.a], pose_[l.b]) / dt);
    return r;
  }

  void push(std::span<const RigidMotion> bodies, std::span<RigidTrial> trials, int i, double x) {
    const Row& r = rows_[i];
    impulse[i] += x;
    if (r.a >= 0) {
      trials[r.a].v += (x / bodies[r.a].mass) * r.j.a_v;
      trials[r.a].momentum += x * r.j.a_w;
    }
    trials[r.b].v += (x / bodies[r.b].mass) * r.j.b_v;
    trials[r.b].momentum += x * r.j.b_w;
  }

  std::vector<Row> rows_;
  std::vector<BodyPose> pose_;
  DenseFactor factor_;
};

}  // namespace fabrica
