// Free and heavy tops, rotations, dense solves.
#include "constraint/rigid_motion.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "constraint/dense.h"

using namespace fabrica;

namespace {

RigidTrial start_of(const RigidMotion& b) { return {b.v, b.momentum, b.w, b.x, b.q, b.q}; }
void accept(RigidMotion& b, const RigidTrial& t) {
  b.v = t.v, b.momentum = t.momentum, b.w = t.w, b.x = t.x, b.q = t.q;
}

}  // namespace

TEST_CASE("a free asymmetric top tumbles at the times of the exact solution") {
  // Euler's equations with I = (1, 2, 3), w = (.01, 1, .01): w2 changes sign
  // at 10.9169, 30.4697, 50.0226
  RigidMotion b;
  b.mass = 1, b.inertia = {1, 2, 3}, b.w = {0.01, 1, 0.01}, b.momentum = {0.01, 2, 0.03};
  const double dt = 0.01, size = norm(b.momentum);
  double t = 0, last = 1, ripple = 0;
  const double energy = 0.5 * dot(b.w, b.momentum);
  std::vector<double> zeros;
  while (t < 52) {
    RigidTrial s = start_of(b);
    advance_trial(b, dt, s);
    const Vec3d body = transpose(matrix_of(s.q_half)) * s.w;
    const double middle = t + 0.5 * dt;
    if (last * body.y < 0) zeros.push_back(middle - dt * body.y / (body.y - last));
    last = body.y;
    accept(b, s);
    ripple = std::max(ripple, std::abs(0.5 * dot(b.w, b.momentum) / energy - 1));
    t += dt;
  }
  REQUIRE(zeros.size() == 3);
  CHECK(zeros[0] == doctest::Approx(10.9169).epsilon(1e-4));
  CHECK(zeros[1] == doctest::Approx(30.4697).epsilon(1e-4));
  CHECK(zeros[2] == doctest::Approx(50.0226).epsilon(1e-4));
  CHECK(ripple < 1e-5);
  CHECK(std::abs(norm(b.momentum) / size - 1) < 1e-14);
  MESSAGE("zeros " << zeros[0] << " " << zeros[1] << " " << zeros[2] << ", energy ripple "
                   << ripple);
}

TEST_CASE("a heavy top precesses steadily") {
  // disc of radius .1 at .1 from the pivot, spin 200 rad/s, 30 degrees; pivot moved into the
  // equations: I1 = m r^2/4 + m l^2, I3 = m r^2/2; steady precession solves
  //   I1 cos(a) W^2 - I3 s W + m g l = 0 with s the angular velocity about the axis; W = .9916452
  const double m = 1, r = 0.1, l = 0.1, g = 9.81, a = 30 * M_PI / 180, spin = 200;
  const double I1 = m * r * r / 4 + m * l * l, I3 = m * r * r / 2;
  const double A = I1 * std::cos(a), B = I3 * spin;
  const double W = 2 * m * g * l / (B + std::sqrt(B * B - 4 * A * m * g * l));
  RigidMotion b;
  b.mass = m, b.inertia = {I1, I1, I3};
  b.q = exponential({0, a, 0});  // axis in the xz plane
  const Vec3d axis = matrix_of(b.q) * Vec3d{0, 0, 1};
  b.w = spin * axis + W * (Vec3d{0, 0, 1} - std::cos(a) * axis);
  CHECK(W == doctest::Approx(0.9916452).epsilon(1e-7));
  b.momentum = inertia_times(matrix_of(b.q), b.inertia, b.w);
  // half-step start, then 2 s
  const double dt = 1e-3;
  double angle = 0, last_azimuth = 0, nutation = 0;
  const int steps = 2000;
  for (int i = 0; i < steps; ++i) {
    const Vec3d e = matrix_of(b.q) * Vec3d{0, 0, 1};
    RigidTrial s = start_of(b);
    s.momentum += (i == 0 ? 0.5 : 1.0) * dt * cross(l * e, Vec3d{0, 0, -m * g});
    advance_trial(b, dt, s);
    accept(b, s);
    const Vec3d n = matrix_of(b.q) * Vec3d{0, 0, 1};
    const double azimuth = std::atan2(n.y, n.x);
    angle += std::remainder(azimuth - last_azimuth, 2 * M_PI);
    last_azimuth = azimuth;
    nutation = std::max(nutation, std::abs(std::acos(n.z) - a) * 180 / M_PI);
  }
  MESSAGE("precession " << angle / (steps * dt) << " of " << W << ", nutation " << nutation
                        << " degrees");
  CHECK(std::abs(angle / (steps * dt) / W - 1) < 1e-5);
  CHECK(nutation < 1e-3);
}

TEST_CASE("rotation vectors and quaternions are inverse to each other") {
  for (const Vec3d a :
       {Vec3d{0.3, -0.2, 0.9}, Vec3d{1e-9, 2e-9, -1e-9}, Vec3d{3.1, 0, 0}, Vec3d{0, -1e-5, 2e-5}}) {
    const Vec3d b = logarithm(exponential(a));
    CHECK(norm(b - a) <= 1e-14 * norm(a));
    const Quaternion q = exponential(a), p = quaternion_of(matrix_of(q));
    CHECK(std::abs(std::abs(q.w * p.w + q.x * p.x + q.y * p.y + q.z * p.z) - 1) < 1e-15);
  }
  const Mat3d m{{{4, 1, -0.5}, {1, 3, 0.2}, {-0.5, 0.2, 2}}};
  const PrincipalAxes p = principal_axes(m);
  CHECK(det(p.axes) == doctest::Approx(1).epsilon(1e-14));
  for (int k = 0; k < 3; ++k) {
    const Vec3d e{p.axes(0, k), p.axes(1, k), p.axes(2, k)};
    CHECK(norm(m * e - p.value[k] * e) < 1e-14);
  }
}

TEST_CASE("a dense system with a redundant row is solved") {
  // rows 0 and 2 are the same condition
  DenseFactor f;
  f.factor({2, 0, 2, 1, 3, 1, 2, 1, 2}, 3);
  std::vector<double> b{4, 5, 4};
  f.solve(b);
  CHECK(2 * b[0] + b[1] + 2 * b[2] == doctest::Approx(4).epsilon(1e-14));
  CHECK(b[0] + 3 * b[1] + b[2] == doctest::Approx(5).epsilon(1e-14));
}
