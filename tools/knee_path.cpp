// Prints data/anatomy/joint_paths.csv: how femur, tibia and patella glide on one another
// (docs/theory/knee.md). Turns and shifts that were measured are taken from their source; what the
// shapes of the bones decide is solved for on the surfaces of the standard meshes, so that both
// condyles, and both sides of the patella, stand off by the thickness of their cartilage.
//   cmake --build build --target knee_path && build/knee_path > data/anatomy/joint_paths.csv
// With an argument, "report", prints gaps, contacts and lengths of ligaments along the path
// instead.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <numbers>

#include "body/joints/knee_contact.h"
#include "body/skeleton.h"
#include "body/tables.h"

using namespace fabrica::body;
using fabrica::Mat3d;

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double begin = 30;  // [deg] of the knee, from where on the cartilage has all its room
constexpr double tibiofemoral_gap = 4.9,
                 patellofemoral_gap = 5.6;  // [mm] cartilage and 0.1 between

// Walker, Rovick, Robertson 1988, J Biomech 21:965, f in degrees: turn of the tibia inwards [deg]
// and shift of the femur on it [mm], forward positive
double internal(double f) { return 0.3695 * f - 2.958e-3 * f * f + 7.666e-6 * f * f * f; }
double forward(double f) { return -0.1283 * f + 4.796e-4 * f * f; }

// share of the standing gaps in those that are asked for
double share(double knee) {
  const double left = std::max(0.0, 1 - knee / begin);
  return left * left;
}

// the x near which two gaps are what they shall be, by damped steps of Newton
Eigen::Vector2d rest(Eigen::Vector2d x,
                     const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& off) {
  constexpr double h = 0.4, most = 1.5;  // [deg] or [mm]
  Eigen::Vector2d best = x;
  double least = 1e30;
  for (int i = 0; i < 40 && least > 0.01; ++i) {
    const Eigen::Vector2d now = off(x);
    if (now.norm() < least) least = now.norm(), best = x;
    Eigen::Matrix2d j;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d e = h * Eigen::Vector2d::Unit(k);
      j.col(k) = (off(x + e) - off(x - e)) / (2 * h);
    }
    const Eigen::Matrix2d normal = j.transpose() * j + 1e-3 * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d step = normal.ldlt().solve(j.transpose() * now);
    // the nearest places jump from node to node: half steps once it is near
    x -= std::min(i < 12 ? 1.0 : 0.5, most / std::max(step.norm(), 1e-9)) * step;
  }
  return best;
}

class Knee {
 public:
  Knee()
      : surfaces_(femur_, tibia_, patella_, Side::right),
        standing_(make_subject("male", 1750, 77), named_posture("standing")),
        start_(surfaces_.contacts(frame("femur"), frame("tibia"), frame("patella"))) {}

  // the tibia's row at a flexion, near to the unknowns x = varus, height of the femur
  PathPoint tibia(double f, Eigen::Vector2d& x) const {
    const auto row = [&](const Eigen::Vector2d& u) {
      const Mat3d q = turn("knee", f, u[0], internal(f));
      return PathPoint{f, q * Point{-forward(f), 0, -u[1]}, u[0], internal(f)};
    };
    const auto off = [&](const Eigen::Vector2d& u) {
      const KneeContacts k =
          surfaces_.contacts(frame("femur"), placed("knee", row(u)), frame("patella"));
      const auto gap = [&](double start) {
        return tibiofemoral_gap + share(f) * (start - tibiofemoral_gap);
      };
      return Eigen::Vector2d(missing(k.medial, gap(start_.medial.gap)),
                             missing(k.lateral, gap(start_.lateral.gap)));
    };
    if (f > 0) x = rest(x, off);
    return row(x);
  }

  // the patella's row at its own flexion, x: shifts away from the joint's centre and to the left
  PathPoint patella(double p, Eigen::Vector2d& x) const {
    const Point out = turn("patella", p, 0, 0) * unit(middle() - joint("patella").centre);
    const auto row = [&](const Eigen::Vector2d& u) {
      return PathPoint{p, u[0] * out + Point{0, u[1], 0}, 0, 0};
    };
    const auto off = [&](const Eigen::Vector2d& u) {
      const KneeContacts k =
          surfaces_.contacts(frame("femur"), frame("tibia"), placed("patella", row(u)));
      return Eigen::Vector2d(missing(k.medial_patella, patellofemoral_gap),
                             missing(k.lateral_patella, patellofemoral_gap));
    };
    x = rest(x, off);
    return row(x);
  }

  void report() const;

 private:
  static const Joint& joint(const std::string& name) { return *find_joint(name); }
  Placement frame(const std::string& name) const { return standing_.frame(name, Side::right); }
  static Mat3d turn(const std::string& name, double angle, double varus, double inwards) {
    return rotation_about(joint(name).axes.front().axis, angle * degree) *
           rotation_about({1, 0, 0}, varus * degree) * rotation_about({0, 0, 1}, inwards * degree);
  }
  // the joint's child, moved from standing as (1) of skeleton.h has it
  Placement placed(const std::string& name, const PathPoint& row) const {
    const Placement child = frame(joint(name).child);
    const Mat3d q = turn(name, row.angle, row.varus, row.internal);
    const Point& c = joint(name).centre;
    return {q * child.R, c + row.shift + q * (child.t - c)};
  }
  static double missing(const KneeContact& now, double gap) {
    constexpr double far = 20;  // [mm] where nothing is met
    return std::min(now.gap, far) - gap;
  }
  Point middle() const { return frame("patella")(middle_of(patella_.nodes)); }

  BoneMesh femur_ = mesh_bone({"femur", Resolution::standard}),
           tibia_ = mesh_bone({"tibia", Resolution::standard}),
           patella_ = mesh_bone({"patella", Resolution::standard});
  KneeSurfaces surfaces_;
  Skeleton standing_;
  KneeContacts start_;
};

void print(const char* joint, const PathPoint& row, const char* source) {
  fmt::print("{},{:g},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{}\n", joint, row.angle, row.shift.x,
             row.shift.y, row.shift.z, row.varus, row.internal, source);
}

// gaps, places of contact from where they are at 0 (standing body, forward positive), and how much
// longer than their reference the ligaments are, in steps of the joint's path
void Knee::report() const {
  for (const bool medial : {true, false}) {
    const CondyleSphere s = posterior_condyle(femur_, medial);
    const Point c = frame("femur")(s.centre);
    fmt::print("{} condyle: sphere of {:.1f} mm about {:.1f} {:.1f} {:.1f}\n",
               medial ? "medial" : "lateral", s.radius, c.x, c.y, c.z);
  }
  fmt::print(
      "\n| knee | gap medial, lateral | contact medial, lateral | gap of patella |\n"
      "| --- | --- | --- | --- |\n");
  for (int f = 0; f <= 140; f += 10) {
    Posture posture;
    set_angle(posture, "knee.right", f);
    const Skeleton s(standing_.subject(), posture);
    const KneeContacts k =
        surfaces_.contacts(s.frame("femur", Side::right), s.frame("tibia", Side::right),
                           s.frame("patella", Side::right));
    const auto moved = [&](const KneeContact& now, const KneeContact& start) {
      return (frame("tibia")(now.place) - frame("tibia")(start.place)).x;
    };
    fmt::print("| {} | {:.1f} {:.1f} | {:.1f} {:.1f} | {:.1f} {:.1f} |\n", f, k.medial.gap,
               k.lateral.gap, moved(k.medial, start_.medial), moved(k.lateral, start_.lateral),
               k.medial_patella.gap, k.lateral_patella.gap);
  }
  fmt::print(
      "\n| ligament | % longer than its reference at 0, 20, ... 140 degrees |\n| --- | --- |\n");
  const Table ligaments("anatomy/joints/ligaments.csv");
  for (int r = 0; r < ligaments.rows(); ++r) {
    if (ligaments.text(r, "region") != "knee" || ligaments.text(r, "attach") == "muscle") continue;
    fmt::print("| {} |", ligaments.text(r, "name"));
    for (int f = 0; f <= 140; f += 20) {
      Posture posture;
      set_angle(posture, "knee.right", f);
      const Skeleton s(standing_.subject(), posture);
      const auto end = [&](const std::string& n) {
        std::string bone = ligaments.text(r, "bone" + n);
        if (bone == "fibula") bone = "tibia";  // one frame
        return s.frame(bone,
                       Side::right)({ligaments.number(r, "x" + n), ligaments.number(r, "y" + n),
                                     ligaments.number(r, "z" + n)});
      };
      fmt::print(" {:+.0f}", 100 * (norm(end("1") - end("2")) / ligaments.number(r, "length") - 1));
    }
    fmt::print(" |\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Knee knee;
  if (argc > 1 && std::string(argv[1]) == "report") return knee.report(), 0;
  fmt::print(
      "# made by build/knee_path (docs/theory/knee.md). What the child of a joint does beside its "
      "turn by the joint's first angle\n"
      "# [deg]: shift x y z [mm] with the joint's centre, then turns [deg] about x (varus) and z "
      "(inwards); standing body, right side\n"
      "joint,angle,x,y,z,varus,internal,source\n");
  Eigen::Vector2d x(0, 0);
  for (int f = 0; f <= 140; f += 10)
    print("knee", knee.tibia(f, x),
          "\"internal, shift forwards: Walker, Rovick and Robertson 1988; varus, height: both "
          "condyles rest on 4.9 mm of cartilage\"");
  x = {0, 0};
  for (int p = 0; p <= 90; p += 5)
    print("patella", knee.patella(p, x), "both sides rest on 5.6 mm of cartilage");
  return 0;
}
