#include "app/body_draws.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <random>

#include "body/body.h"
#include "body/measures.h"

namespace fabrica {
namespace {

// uniform in the middle `share` of a range, the same on every machine
double draw(std::mt19937_64& random, double low, double high, double share) {
  const double unit = double(random() >> 11) * 0x1p-53;
  return 0.5 * (low + high) + share * (unit - 0.5) * (high - low);
}

std::mt19937_64 first_draw() { return std::mt19937_64(1543); }

body::BodyOptions next_body(std::mt19937_64& random) {
  body::BodyOptions options;
  const double stature = draw(random, 1550, 1900, 1), mass = draw(random, 50, 110, 1);
  options.subject = body::make_subject("male", stature, mass);
  for (const body::Joint& joint : body::joint_tree()) {
    if (joint.name == "pelvis" || joint.name == "patella")
      continue;  // the root is free, the patella follows the knee
    for (const body::JointAxis& axis : joint.axes)
      for (const char* side : {".right.", ".left."}) {
        if (!joint.paired && side[1] == 'l') continue;
        const std::string name = joint.name + (joint.paired ? side : ".") + axis.coordinate;
        body::set_angle(options.posture, name, draw(random, axis.low, axis.high, 0.8));
      }
  }
  options.posture.name = "random";
  return options;
}

}  // namespace

body::BodyOptions drawn_body(int number) {
  std::mt19937_64 random = first_draw();
  for (int i = 1; i < number; ++i) next_body(random);
  return next_body(random);
}

int draw_bodies(int count, const std::string& resolution, bool joints,
                const std::vector<std::string>& bones) {
  std::mt19937_64 random = first_draw();
  int failures = 0, good = 0, whole = 0;
  double worst = 1;
  for (int i = 1; i <= count; ++i) {
    body::BodyOptions options = next_body(random);
    options.resolution = body::resolution_named(resolution);
    options.joints = joints;
    options.only = bones;
    const std::string who =
        fmt::format("{:3}: {:.0f} mm {:.0f} kg", i, options.subject.stature, options.subject.mass);
    try {
      const body::Body made = body::build_body(options);
      const body::Quality q = body::brick_quality(made);
      worst = std::min(worst, q.min_jacobian);
      good += q.min_jacobian >= 0.30;
      failures += q.min_jacobian <= 0;
      const std::vector<std::string> alone =
          joints ? body::unconnected(made.bones, made.between) : std::vector<std::string>{};
      whole += alone.empty();
      fmt::print("{}: {} bricks, scaled Jacobian {:.2f} ({}), 99 % above {:.2f}{}{}\n", who,
                 q.bricks, q.min_jacobian, q.where_jacobian, q.p1_jacobian,
                 alone.empty() ? "" : fmt::format(", nothing connects {}", fmt::join(alone, " ")),
                 q.min_jacobian <= 0 ? " FAILED" : "");
    } catch (const body::BodyError& e) {
      ++failures;
      fmt::print("{}: FAILED: {}\n", who, e.what());
    }
  }
  fmt::print(
      "{} of {} bodies made with positive Jacobians, {} of them at least 0.30; smallest {:.2f}\n",
      count - failures, count, good, worst);
  if (joints) fmt::print("{} of them have no bone or piece that nothing connects\n", whole);
  return failures ? 1 : 0;
}

}  // namespace fabrica
