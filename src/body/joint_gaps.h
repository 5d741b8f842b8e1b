#pragma once
// How far the joints of a body come apart in a run. Of each joint the surfaces of both sides are
// followed:
//   apart  growth of the least distance of the two surfaces                                   (1)
//   open   largest growth of the distance of a node of the first side, of those that were within
//          1 mm more than the least distance at the start, to the surface of the second       (2)
// Bones that slide or turn on one another keep (1) near 0 while (2) grows on the side that opens;
// where one side is tied to the other, (2) is how far the tie gives way.
#include <string>
#include <vector>

#include "body/assembly.h"

namespace fabrica::body {

enum class JointKind { sliding, tied };

// one joint by the ids of the parts on either side; the bricks among them count
struct JointRow {
  std::string name;
  JointKind kind = JointKind::sliding;
  std::vector<std::int64_t> a, b;
};

// The joints of a body: every articulation with surfaces, and every tie of a disc.
std::vector<JointRow> joint_rows(const Body& body, const AssembledBody& assembled);
// joint,kind,parts_a,parts_b, parts with a + between
std::string joints_csv(const std::vector<JointRow>& rows);
// Reads it; throws BodyError that names the line.
std::vector<JointRow> read_joints(const std::string& text);

struct JointGap {
  double start = 0;                      // [mm] least distance at the start
  double apart = 0, open = 0;            // [mm] (1) and (2), largest over the states
  double apart_time = 0, open_time = 0;  // of the states where they were
  int facing = 0;                        // nodes of (2)
};

// Follows one joint over states. The first state is the start.
class JointFollower {
 public:
  using Quads = std::vector<std::array<int, 4>>;
  JointFollower(Quads a, Quads b) : a_(std::move(a)), b_(std::move(b)) {}
  void take(double time, const std::vector<Point>& nodes);
  const JointGap& gap() const { return gap_; }

 private:
  Quads a_, b_;
  std::vector<int> facing_;
  std::vector<double> start_;
  bool begun_ = false;
  JointGap gap_;
};

}  // namespace fabrica::body
