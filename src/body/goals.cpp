#include "body/goals.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "body/tables.h"

namespace fabrica::body {
namespace {

// the man of the tables, right side: centre of a rod in the closed hand, under the heel, ball of
// the foot
Point standing_landmark(const std::string& name) {
  static const Table table("anatomy/landmarks.csv");
  for (int r = 0; r < table.rows(); ++r)
    if (table.text(r, "name") == name)
      return {table.number(r, "x_stand"), table.number(r, "y_stand"), table.number(r, "z_stand")};
  throw BodyError(fmt::format("anatomy/landmarks.csv has no landmark '{}'", name));
}

class GoalsReader {
 public:
  GoalsReader(const std::string& path, const toml::table& table) : path_(path), table_(table) {}

  Goals read() {
    Goals goals;
    goals.name = path_;
    known(table_, {"h_point", "torso_angle", "head_level", "wheel", "foot"});
    if (const auto* n = table_.get("h_point")) goals.h_point = point("h_point", *n);
    if (const auto* n = table_.get("torso_angle")) goals.torso_angle = number("torso_angle", *n);
    if (const auto* n = table_.get("head_level")) {
      if (!n->is_boolean()) fail("head_level", *n, "is true or false");
      goals.head_level = n->value_or(false);
    }
    if (const auto* n = table_.get("wheel")) wheel(goals, *n);
    if (const auto* n = table_.get("foot")) {
      if (!n->is_table()) fail("foot", *n, "is written as [foot.right] and [foot.left]");
      known(*n->as_table(), {"right", "left"});
      foot(goals, n->as_table()->get("right"), Side::right);
      foot(goals, n->as_table()->get("left"), Side::left);
    }
    return goals;
  }

 private:
  [[noreturn]] void fail(const std::string& key, const toml::node& node,
                         const std::string& message) const {
    throw BodyError(fmt::format("{}:{}: {} {}", path_, node.source().begin.line, key, message));
  }
  void known(const toml::table& table, const std::vector<std::string>& keys) const {
    for (const auto& [key, node] : table) {
      if (std::find(keys.begin(), keys.end(), std::string(key.str())) != keys.end()) continue;
      std::string list;
      for (const std::string& k : keys) list += (list.empty() ? "" : ", ") + k;
      fail(std::string(key.str()), node, "is no goal here; there are " + list);
    }
  }
  double number(const std::string& key, const toml::node& node) const {
    const auto value = node.value<double>();
    if (!value) fail(key, node, "must be a number");
    return *value;
  }
  Point point(const std::string& key, const toml::node& node) const {
    const auto* list = node.as_array();
    if (!list || list->size() != 3) fail(key, node, "must be a place such as [420, 0, 330] in mm");
    return {number(key, *list->get(0)), number(key, *list->get(1)), number(key, *list->get(2))};
  }
  const toml::node& need(const std::string& of, const toml::table& table, const char* key) const {
    const auto* node = table.get(key);
    if (!node) fail(of, table, fmt::format("lacks '{}'", key));
    return *node;
  }

  void wheel(Goals& goals, const toml::node& node) const {
    if (!node.is_table())
      fail("wheel", node, "is written as [wheel] with centre, diameter, tilt, hands");
    const toml::table& table = *node.as_table();
    known(table, {"centre", "diameter", "tilt", "hands"});
    const Point centre = point("wheel.centre", need("wheel", table, "centre"));
    const double radius = number("wheel.diameter", need("wheel", table, "diameter")) / 2;
    const double tilt = table.get("tilt") ? number("wheel.tilt", *table.get("tilt")) : 25;
    double hands[2] = {60, -60};
    if (const auto* n = table.get("hands")) {
      if (!n->is_array() || n->as_array()->size() != 2)
        fail("wheel.hands", *n, "must be two angles: right, left");
      for (std::size_t i = 0; i < 2; ++i) hands[i] = number("wheel.hands", *n->as_array()->get(i));
    }
    // palm: a rod of the rim's thickness lies 22 mm before the head of the third metacarpal
    // (estimated)
    const Point grip = standing_landmark("metacarpal3_head") + Point{22, 0, 6};
    const double deg = std::numbers::pi / 180, c = std::cos(tilt * deg), s = std::sin(tilt * deg);
    for (int i = 0; i < 2; ++i) {
      const double a = hands[i] * deg;
      const Point at = centre + radius * Point{std::cos(a) * s, -std::sin(a), std::cos(a) * c};
      goals.hands.push_back({i == 0 ? "right hand on the wheel" : "left hand on the wheel", "hand",
                             i == 0 ? Side::right : Side::left, grip, at});
    }
    goals.grip = true;
  }

  void foot(Goals& goals, const toml::node* node, Side side) const {
    if (!node) return;
    const std::string name = side == Side::right ? "foot.right" : "foot.left";
    if (!node->is_table()) fail(name, *node, "is a table with heel and ball");
    const toml::table& table = *node->as_table();
    known(table, {"heel", "ball"});
    // under the heel with its pad of 11 mm
    const Point heel = standing_landmark("calcaneus_plantar") + Point{0, 0, -11};
    if (const auto* n = table.get("heel"))
      goals.feet.push_back({name + ".heel", "foot", side, heel, point(name + ".heel", *n)});
    if (const auto* n = table.get("ball"))
      goals.feet.push_back({name + ".ball", "foot", side, standing_landmark("metatarsal1_head"),
                            point(name + ".ball", *n)});
  }

  std::string path_;
  const toml::table& table_;
};

}  // namespace

Goals read_goals(const std::string& path) {
  try {
    const toml::table table = toml::parse_file(path);
    return GoalsReader(path, table).read();
  } catch (const toml::parse_error& e) {
    throw BodyError(
        fmt::format("{}:{}: {}; write key = value", path, e.source().begin.line, e.description()));
  }
}

}  // namespace fabrica::body
