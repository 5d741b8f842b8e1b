#include "body/body.h"

#include <fmt/format.h>

#include <algorithm>

#include "body/joints/join_bones.h"
#include "body/tables.h"

namespace fabrica::body {
namespace {

bool is_vertebra(const std::string& frame, char letter) {
  return frame.size() > 1 && frame[0] == letter && frame[1] >= '0' && frame[1] <= '9';
}

// the frame that carries a bone, from data/anatomy/bones/index.csv, without its side
std::string frame_of_bone(const std::string& bone) {
  static const Table table("anatomy/bones/index.csv");
  if (bone == "talus") return "talus";
  for (int r = 0; r < table.rows(); ++r)
    if (table.text(r, "bone") == bone) {
      const std::string& frame = table.text(r, "frame");
      return frame.ends_with("_R") ? frame.substr(0, frame.size() - 2) : frame;
    }
  if (bone.starts_with("costal_cartilage")) return "thorax";
  throw BodyError(fmt::format("anatomy/bones/index.csv has no frame for bone '{}'", bone));
}

bool is_paired(const Skeleton& skeleton, const std::string& bone, const std::string& frame) {
  return skeleton.has_frame(frame, Side::right) || bone.starts_with("rib") ||
         bone.starts_with("costal_cartilage") || bone == "hip_bone";
}

PlacedBone placed(const BoneMesh& mesh, Side side, const std::string& frame,
                  const Skeleton& skeleton) {
  PlacedBone bone;
  bone.mesh = side == Side::left ? mirrored(mesh) : mesh;
  bone.side = side;
  bone.frame = frame;
  bone.region = region_of_frame(frame);
  place(bone, skeleton);
  return bone;
}

}  // namespace

Region region_of_frame(const std::string& frame) {
  static const std::vector<std::string> arm{"clavicle", "scapula", "humerus",
                                            "ulna",     "radius",  "hand"};
  if (frame == "head") return Region::head;
  if (is_vertebra(frame, 'C')) return Region::neck;
  if (is_vertebra(frame, 'T') || frame == "thorax") return Region::thorax;
  if (is_vertebra(frame, 'L')) return Region::abdomen;
  if (frame == "pelvis") return Region::pelvis;
  return std::find(arm.begin(), arm.end(), frame) != arm.end() ? Region::arm : Region::leg;
}

Resolution resolution_named(const std::string& name) {
  if (name == "coarse") return Resolution::coarse;
  if (name == "standard") return Resolution::standard;
  if (name == "fine") return Resolution::fine;
  throw BodyError(
      fmt::format("resolution '{}' is unknown; there are coarse, standard, fine", name));
}

const char* name_of(Resolution resolution) {
  return resolution == Resolution::coarse     ? "coarse"
         : resolution == Resolution::standard ? "standard"
                                              : "fine";
}

Body build_body(const BodyOptions& options) {
  Body body{options.subject,
            options.posture,
            Skeleton(options.subject, options.posture),
            options.resolution,
            {},
            {},
            {}};
  std::vector<BoneName> only;
  for (const std::string& text : options.only) {
    only.push_back(bone_named(text));
    if (std::find(bone_names().begin(), bone_names().end(), only.back().bone) == bone_names().end())
      throw BodyError(
          fmt::format("no bone is named '{}'; they are listed by `fabrica body --list`", text));
  }
  const auto wanted = [&](const std::string& name, Side side) {
    return only.empty() || std::any_of(only.begin(), only.end(), [&](const BoneName& b) {
             return b.bone == name &&
                    (b.side == Side::midline || side == Side::midline || b.side == side);
           });
  };
  for (const std::string& name : bone_names()) {
    if (!wanted(name, Side::midline)) continue;
    if (options.progress) options.progress(name);
    const std::string frame = frame_of_bone(name);
    const std::string carrier = frame == "talus" ? "foot" : frame;
    const BoneMesh mesh = mesh_bone({name, options.resolution, options.subject.scale_of(carrier)});
    if (is_paired(body.skeleton, name, frame)) {
      for (const Side side : {Side::right, Side::left})
        if (wanted(name, side)) body.bones.push_back(placed(mesh, side, frame, body.skeleton));
    } else {
      body.bones.push_back(placed(mesh, Side::midline, frame, body.skeleton));
    }
  }
  body.scapulae = rest_scapulae(body.skeleton, body.bones);
  if (options.joints) body.between = join_bones(body.bones, body.joined);
  return body;
}

}  // namespace fabrica::body
