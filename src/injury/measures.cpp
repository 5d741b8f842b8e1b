#include "injury/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "injury/catalogue.h"

namespace fabrica {

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all = [] {
    std::vector<Measure> m;
    for (const auto& part :
         {head_measures(), neck_measures(), thorax_measures(), leg_measures(), tissue_measures()})
      m.insert(m.end(), part.begin(), part.end());
    return m;
  }();
  return all;
}

std::vector<Judged> judge(const Subject& subject, const Channels& channels) {
  std::vector<Judged> out;
  for (const Measure& m : measures()) {
    Judged j{&m, {}, "", false};
    for (const std::string& role : m.roles)
      if (channels.count(role) == 0) j.reason += (j.reason.empty() ? "no channel " : ", ") + role;
    if (j.reason.empty()) {
      try {
        j.finding = m.evaluate(subject, channels);
      } catch (const SignalError& e) {
        j.failed = true;
        j.reason = e.what();
      }
    }
    out.push_back(std::move(j));
  }
  return out;
}

void set_parameter(Subject& s, const std::string& text) {
  const std::map<std::string, double*> numbers{{"age", &s.age},
                                               {"chest_depth_mm", &s.chest_depth},
                                               {"vc_factor", &s.vc_factor},
                                               {"neck_arm_mm", &s.neck_arm},
                                               {"csdm_strain", &s.csdm_strain},
                                               {"rib_strain", &s.rib_strain}};
  const std::map<std::string, std::string*> words{{"neck", &s.neck}, {"leg", &s.leg}};
  const std::size_t equal = text.find('=');
  const std::string name = text.substr(0, equal),
                    value = equal == std::string::npos ? "" : text.substr(equal + 1);
  if (const auto w = words.find(name); w != words.end() && !value.empty()) {
    *w->second = value;
    return;
  }
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  const auto n = numbers.find(name);
  if (n == numbers.end() || value.empty() || *end != '\0' || !std::isfinite(number))
    throw SignalError(
        "unknown-parameter", "'" + text + "' is not NAME=VALUE of a setting",
        "There are: age, chest_depth_mm, vc_factor, neck_arm_mm, csdm_strain, rib_strain "
        "(numbers), neck (H3-50M, "
        "H3-05F, THOR-50M), leg (H3-50M, THOR-50M, H3-05F, H3-95M, revised)");
  *n->second = number;
}

const std::map<std::string, std::string>& roles() {
  static const std::map<std::string, std::string> all{
      {"head.ax", "acceleration of the head's centre of gravity, forward"},
      {"head.ay", "the same, to the side"},
      {"head.az", "the same, up or down"},
      {"head.wx", "angular velocity of the head about x"},
      {"head.wy", "about y"},
      {"head.wz", "about z"},
      {"neck.fx", "shear force of the upper neck"},
      {"neck.fz", "axial force of the upper neck, tension positive"},
      {"neck.my", "moment of the upper neck about y, flexion positive"},
      {"chest.deflection", "sternum towards spine"},
      {"chest.ax", "acceleration of the thoracic spine"},
      {"chest.ay", "the same, to the side"},
      {"chest.az", "the same, up or down"},
      {"femur_left.fz", "axial force of the femur, compression negative"},
      {"femur_right.fz", "the same, right"},
      {"tibia_left.fz", "axial force of the tibia, compression negative"},
      {"tibia_left.mx", "moment of the tibia about x"},
      {"tibia_left.my", "moment of the tibia about y"},
      {"tibia_right.fz", "as left"},
      {"tibia_right.mx", "as left"},
      {"tibia_right.my", "as left"},
      {"pelvis.ax", "acceleration of the pelvis"},
      {"pelvis.ay", "the same, to the side"},
      {"pelvis.az", "the same, up or down"},
      {"brain.strain", "elements: largest first principal strain over volume"},
      {"ribs.strain",
       "ribs: largest first principal strain of cortical bone over the rib's number"},
      {"cartilage.stress", "ribs: largest stress of the rib's cartilage over the rib's number"},
      {"liver.strain", "elements: largest first principal strain over volume"},
      {"spleen.strain", "as liver"},
      {"kidney.strain", "as liver"},
      {"heart.strain", "as liver"},
      {"lung.strain", "as liver"}};
  return all;
}

// object and position (2), location (4), fine locations (6), quantity (2), direction (1), filter
// class (1)
std::string role_of_code(const std::string& code) {
  if (code.size() < 15) return "";
  const std::string place = code.substr(2, 4), side = code.substr(6, 2),
                    quantity = code.substr(12, 2);
  const char axis = char(std::tolower(static_cast<unsigned char>(code[14])));
  std::string body = place == "HEAD"   ? "head"
                     : place == "NECK" ? "neck"
                     : place == "CHST" ? "chest"
                     : place == "THSP" ? "chest"
                     : place == "PELV" ? "pelvis"
                     : place == "FEMR" ? "femur"
                     : place == "TIBI" ? "tibia"
                                       : "";
  if (body.empty() || (body == "neck" && side == "LO")) return "";
  if (body == "femur" || body == "tibia") {
    if (side.substr(0, 2) != "LE" && side.substr(0, 2) != "RI") return "";
    body += side == "LE" ? "_left" : "_right";
  }
  if (body == "chest" && quantity == "DS") return axis == 'x' ? "chest.deflection" : "";
  const std::string letter = quantity == "AC"   ? "a"
                             : quantity == "AV" ? "w"
                             : quantity == "FO" ? "f"
                             : quantity == "MO" ? "m"
                                                : "";
  const std::string role = body + "." + letter + axis;
  return letter.empty() || roles().count(role) == 0 ? "" : role;
}

}  // namespace fabrica
