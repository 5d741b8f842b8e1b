#include "body/placed_bone.h"

#include <fmt/format.h>

#include <cctype>

#include "body/skeleton.h"

namespace fabrica::body {

void place(PlacedBone& bone, const Skeleton& skeleton) {
  bone.placement = skeleton.bone(bone.mesh.name, bone.frame, bone.side);
  bone.nodes.clear();
  bone.nodes.reserve(bone.mesh.nodes.size());
  for (const Point& p : bone.mesh.nodes) bone.nodes.push_back(bone.placement(p));
}

const char* name_of(Region region) {
  static const char* const names[] = {"",        "head",   "neck", "thorax",
                                      "abdomen", "pelvis", "arm",  "leg"};
  return names[int(region)];
}

const char* name_of(Side side) {
  return side == Side::right ? "right" : side == Side::left ? "left" : "mid";
}

BoneName bone_named(const std::string& text) {
  for (const Side side : {Side::right, Side::left}) {
    const std::string prefix = std::string(name_of(side)) + ".";
    if (text.starts_with(prefix)) return {text.substr(prefix.size()), side, text};
  }
  return {text, Side::midline, text};
}

int find_bone(const std::vector<PlacedBone>& bones, const std::string& name, Side side) {
  for (std::size_t i = 0; i < bones.size(); ++i)
    if (bones[i].mesh.name == name && bones[i].side == side) return int(i);
  return -1;
}

std::string part_name(const PlacedBone& bone, const std::string& tissue) {
  // the number of a rib or cartilage gets two digits: names sort as the body does
  std::string name = bone.mesh.name;
  if (name.starts_with("rib") || name.starts_with("costal_cartilage")) {
    const std::size_t digit = name.find_first_of("0123456789");
    if (name.size() - digit == 1) name.insert(digit, "0");
  }
  return fmt::format("{}.{}.{}.{}", name_of(bone.region), name_of(bone.side), name, tissue);
}

}  // namespace fabrica::body
