#pragma once
// The frames of all bones of a subject in a posture. The skeleton is a tree of frames; every joint
// turns its child about a fixed centre c in its parent and, where it has a path, shifts it:
//
//   child = parent o shift(d) o turn(c, Q),   Q = R(a1, q1) R(a2, q2) R(a3, q3) R(x, v) R(z, i) (1)
//
// with the axes a of data/anatomy/joint_axes.csv in the global axes of the standing body and the
// angles q from there; d, v and i follow from q1 by the curves of data/anatomy/joint_paths.csv
// (knee and patella, docs/theory/knee.md), 0 elsewhere. All angles zero give the standing placement
// of data/anatomy/assembly.csv exactly, but that the patella has room for its cartilage. Left
// joints mirror right ones. Ribs, cartilages and sternum ride the thorax frame; each rib then turns
// about its head so that it follows its vertebra while its front end stays with the sternum
// (rib_placement).
#include <map>
#include <string>
#include <vector>

#include "body/placement.h"
#include "body/posture.h"
#include "body/subject.h"

namespace fabrica::body {

class Skeleton {
 public:
  // Throws BodyError when an angle is out of its range.
  Skeleton(const Subject& subject, const Posture& posture);

  // placement of a frame: "pelvis", "L5", "thorax", "head", "femur" with side, ...; throws
  // BodyError if unknown
  const Placement& frame(const std::string& name, Side side = Side::midline) const;
  bool has_frame(const std::string& name, Side side) const;
  // a joint centre [mm, global]: "hip", "knee", "L5" (disc below L5), "shoulder", ...
  Point joint_centre(const std::string& joint, Side side = Side::midline) const;
  // placement of a bone whose carrier is `frame`; that of ribs and cartilages follows vertebra and
  // sternum
  Placement bone(const std::string& bone, const std::string& frame, Side side) const;
  // moves a frame of a side, its joint and all that hangs on it
  void carry(const std::string& frame, Side side, const Placement& motion);
  // where a point of the standing man of the tables [mm, global] is, carried and scaled with a
  // frame of a side or, where the frame has none, of the midline
  Point carried(const std::string& frame, Side side, const Point& standing) const;
  const Subject& subject() const { return subject_; }

 private:
  Subject subject_;
  std::map<std::pair<std::string, Side>, Placement> frames_;
  std::map<std::pair<std::string, Side>, Point> centres_;
};

}  // namespace fabrica::body
