#include "body/subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "body/tables.h"

namespace fabrica::body {
namespace {

constexpr double base_stature = 1750, base_mass = 77;
constexpr double lowest_stature = 1500, highest_stature = 2000;
constexpr double lowest_mass = 45, highest_mass = 120;

// The external dimensions as regressions over stature and mass (data/anatomy/envelope_dims.csv).
class Dimensions {
 public:
  Dimensions() : table_("anatomy/envelope_dims.csv") {
    for (int r = 0; r < table_.rows(); ++r) row_[table_.text(r, "dimension")] = r;
  }
  double value(const std::string& name, double stature, double mass) const {
    if (name == "stature") return stature;
    const auto at = row_.find(name);
    if (at == row_.end())
      throw BodyError(fmt::format("anatomy/envelope_dims.csv has no dimension '{}'", name));
    const int r = at->second;
    return table_.number(r, "value_mm") +
           table_.number(r, "d_per_mm_stature") * (stature - base_stature) +
           table_.number(r, "d_per_kg") * (mass - base_mass);
  }
  // of "a" or "a-b"
  double length(const std::string& rule, double stature, double mass) const {
    const std::size_t minus = rule.find('-');
    if (minus == std::string::npos) return value(rule, stature, mass);
    return value(rule.substr(0, minus), stature, mass) -
           value(rule.substr(minus + 1), stature, mass);
  }
  // of a rule of scale_rules.csv against the man of the tables
  double factor(std::string rule, double stature, double mass) const {
    if (rule == "1") return 1;
    const bool root = rule.starts_with("root:");
    if (root) rule.erase(0, 5);
    const double f = length(rule, stature, mass) / length(rule, base_stature, base_mass);
    return root ? std::sqrt(f) : f;
  }

 private:
  Table table_;
  std::map<std::string, int> row_;
};

void require(const char* what, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  throw BodyError(fmt::format(
      "{} {:g} {} is outside {:g} to {:g} {}, where the tables hold; the nearest is {:g} {}", what,
      value, unit, low, high, unit, std::clamp(value, low, high), unit));
}

}  // namespace

Point Subject::scale_of(const std::string& frame) const {
  const auto at = scale.find(frame);
  return at == scale.end() ? Point{1, 1, 1} : at->second;
}

Subject make_subject(const std::string& sex, double stature, double mass) {
  if (sex != "male")
    throw BodyError(
        fmt::format("sex '{}': the tables hold a man's bones only; the nearest is male", sex));
  require("stature", stature, lowest_stature, highest_stature, "mm");
  require("mass", mass, lowest_mass, highest_mass, "kg");
  Subject subject{sex, stature, mass, {}};
  const Dimensions dimensions;
  const Table rules("anatomy/scale_rules.csv");
  for (int r = 0; r < rules.rows(); ++r) {
    const double bone_mass = base_mass + rules.number(r, "mass_share") * (mass - base_mass);
    Point f;
    int k = 0;
    for (const char* axis : {"x", "y", "z"})
      f[k++] = dimensions.factor(rules.text(r, axis), stature, bone_mass);
    std::istringstream frames(rules.text(r, "frames"));
    for (std::string frame; frames >> frame;) subject.scale[frame] = f;
  }
  return subject;
}

}  // namespace fabrica::body
