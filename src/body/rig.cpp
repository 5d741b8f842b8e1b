#include "body/rig.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

#include "body/mesh/bone_mesh.h"

namespace fabrica::body {
namespace {

constexpr std::array<const char*, 6> dof_names{"x", "y", "z", "rx", "ry", "rz"};

// A table whose keys are asked for by name and type; `finish` refuses those that nobody asked for.
class RigTable {
 public:
  RigTable(const std::string& path, const toml::table& table, std::string prefix)
      : path_(path), table_(table), prefix_(std::move(prefix)) {}

  [[noreturn]] void fail(const std::string& key, const std::string& message) const {
    const toml::node* node = table_.get(key);
    const auto line = (node ? *node : static_cast<const toml::node&>(table_)).source().begin.line;
    throw BodyError(fmt::format("{}:{}: {}{} {}", path_, line, prefix_, key, message));
  }
  const toml::node* find(const std::string& key) {
    asked_.push_back(key);
    return table_.get(key);
  }
  const toml::node& need(const std::string& key, const std::string& what) {
    const toml::node* node = find(key);
    if (!node) fail(key, "is missing; give " + what);
    return *node;
  }
  double number(const std::string& key, double otherwise) {
    const toml::node* node = find(key);
    if (!node) return otherwise;
    const auto value = node->value<double>();
    if (!value) fail(key, "must be a number");
    return *value;
  }
  double positive(const std::string& key, const std::string& what) {
    need(key, what);
    const double value = number(key, 0);
    if (!(value > 0)) fail(key, fmt::format("is {:g}, which is not above 0; give {}", value, what));
    return value;
  }
  std::string text(const std::string& key, const std::string& what) {
    const auto value = need(key, what).value<std::string>();
    if (!value) fail(key, "must be a text; give " + what);
    return *value;
  }
  std::vector<std::string> texts(const std::string& key, const std::string& what) {
    std::vector<std::string> out;
    const toml::node& node = need(key, what);
    if (!node.is_array()) fail(key, "must be a list; give " + what);
    for (const toml::node& item : *node.as_array()) {
      const auto value = item.value<std::string>();
      if (!value) fail(key, "must be a list of texts; give " + what);
      out.push_back(*value);
    }
    return out;
  }
  std::optional<Point> point(const std::string& key) {
    const toml::node* node = find(key);
    if (!node) return {};
    const auto values = numbers(key, *node);
    if (values.size() != 3) fail(key, "must be three numbers such as [0, 0, 1]");
    return Point{values[0], values[1], values[2]};
  }
  std::vector<double> numbers(const std::string& key, const toml::node& node) const {
    std::vector<double> out;
    if (!node.is_array()) fail(key, "must be a list of numbers");
    for (const toml::node& item : *node.as_array()) {
      const auto value = item.value<double>();
      if (!value) fail(key, "must be a list of numbers");
      out.push_back(*value);
    }
    return out;
  }
  std::vector<RigTable> tables(const std::string& key) {
    std::vector<RigTable> out;
    const toml::node* node = find(key);
    if (!node) return out;
    if (!node->is_array_of_tables()) fail(key, fmt::format("is written as [[{}]]", key));
    for (const toml::node& item : *node->as_array())
      out.emplace_back(path_, *item.as_table(), fmt::format("{}[{}].", key, out.size() + 1));
    return out;
  }
  std::optional<RigTable> table(const std::string& key) {
    const toml::node* node = find(key);
    if (!node) return {};
    if (!node->is_table()) fail(key, "must be a table such as { along = \"x\", ... }");
    return RigTable(path_, *node->as_table(), prefix_ + key + ".");
  }
  void finish() const {
    for (const auto& [key, node] : table_) {
      if (std::find(asked_.begin(), asked_.end(), std::string(key.str())) != asked_.end()) continue;
      fail(std::string(key.str()),
           fmt::format("is no key here; there are {}", fmt::join(asked_, ", ")));
    }
  }

 private:
  const std::string& path_;
  const toml::table& table_;
  std::string prefix_;
  std::vector<std::string> asked_;
};

BoneName bone_name(RigTable& table, const std::string& key, const std::string& text) {
  BoneName name{text, Side::midline, text};
  for (const Side side : {Side::right, Side::left})
    if (text.starts_with(std::string(name_of(side)) + "."))
      name.side = side, name.bone = text.substr(std::string(name_of(side)).size() + 1);
  const auto& known = bone_names();
  if (std::find(known.begin(), known.end(), name.bone) == known.end())
    table.fail(key, fmt::format("'{}' is no bone; write right.rib5 or sacrum, with a name that "
                                "`fabrica body --list` prints",
                                text));
  return name;
}

int dof_named(RigTable& table, const std::string& key, const std::string& text) {
  for (std::size_t d = 0; d < dof_names.size(); ++d)
    if (text == dof_names[d]) return int(d);
  table.fail(key, fmt::format("'{}' is no degree of freedom; there are {}", text,
                              fmt::join(dof_names, ", ")));
}

RigMotion read_motion(RigTable table) {
  RigMotion motion;
  motion.dof = dof_named(table, "along", table.text("along", "x, y, z, rx, ry or rz"));
  const toml::node* velocity = table.find("velocity");
  const toml::node* displacement = table.find("displacement");
  if (!velocity == !displacement)
    table.fail(velocity ? "velocity" : "along", "wants either velocity or displacement");
  motion.velocity = velocity;
  const std::string key = velocity ? "velocity" : "displacement";
  const toml::node& points = velocity ? *velocity : *displacement;
  if (!points.is_array() || points.as_array()->size() < 2)
    table.fail(key, "must be a list of two or more [time, value]");
  for (const toml::node& item : *points.as_array()) {
    const auto pair = table.numbers(key, item);
    if (pair.size() != 2) table.fail(key, "must be a list of [time, value]");
    if (!motion.points.empty() && pair[0] <= motion.points.back().first)
      table.fail(key, fmt::format("goes back in time at {:g} ms; sort it by time", pair[0]));
    motion.points.emplace_back(pair[0], pair[1]);
  }
  table.finish();
  return motion;
}

RigPot read_pot(RigTable table) {
  RigPot pot;
  pot.name = table.text("name", "the name of the pot");
  for (const std::string& text : table.texts("bones", "the bones that get it"))
    pot.bones.push_back(bone_name(table, "bones", text));
  const auto toward = table.point("toward");
  if (!toward || norm(*toward) == 0)
    table.fail("toward", "must be a direction of the bone's frame such as [0, 0, 1]");
  pot.toward = (1 / norm(*toward)) * *toward;
  pot.depth = table.positive("depth", "the depth of the pot in mm");
  if (table.find("free"))
    for (const std::string& text : table.texts("free", "degrees of freedom"))
      pot.free[std::size_t(dof_named(table, "free", text))] = true;
  if (auto motion = table.table("motion")) pot.motion = read_motion(*motion);
  if (pot.motion && pot.free[std::size_t(pot.motion->dof)])
    table.fail("free", fmt::format("holds {}, which the motion moves; take it out",
                                   dof_names[std::size_t(pot.motion->dof)]));
  table.finish();
  return pot;
}

RigSpecimen read_specimen(RigTable table, const std::vector<RigPot>& pots) {
  RigSpecimen specimen;
  specimen.bone = bone_name(table, "bone", table.text("bone", "a bone such as right.rib5"));
  const auto along = table.texts("along", "the pots on its x axis, [from, to]");
  if (along.size() != 2) table.fail("along", "must be two pots: [from, to]");
  specimen.from = along[0], specimen.to = along[1];
  for (const std::string& name : along) {
    const bool found = std::any_of(pots.begin(), pots.end(), [&](const RigPot& pot) {
      return pot.name == name && std::any_of(pot.bones.begin(), pot.bones.end(), [&](auto& bone) {
               return bone.text == specimen.bone.text;
             });
    });
    if (!found)
      table.fail("along", fmt::format("'{}' is no pot of {}; add a [[pot]] of that name with it",
                                      name, specimen.bone.text));
  }
  if (const auto at = table.point("at")) specimen.at = *at;
  specimen.up = table.point("up");
  table.finish();
  return specimen;
}

bool same(const BoneName& name, const PlacedBone& bone) {
  return name.bone == bone.mesh.name && name.side == bone.side;
}

}  // namespace

std::vector<std::string> Rig::bones() const {
  std::vector<std::string> names;
  for (const RigSpecimen& specimen : specimens)
    if (std::find(names.begin(), names.end(), specimen.bone.bone) == names.end())
      names.push_back(specimen.bone.bone);
  return names;
}

bool Rig::tests(const PlacedBone& bone) const {
  return std::any_of(specimens.begin(), specimens.end(),
                     [&](const RigSpecimen& specimen) { return same(specimen.bone, bone); });
}

Rig read_rig(const std::string& path) {
  try {
    const toml::table file = toml::parse_file(path);
    RigTable table(path, file, "");
    Rig rig;
    rig.path = path;
    rig.end_time = table.positive("end_time", "the time that the test runs in ms");
    rig.output_every = table.number("output_every", rig.output_every);
    rig.states_every = table.number("states_every", rig.end_time / 20);
    for (const RigTable& pot : table.tables("pot")) rig.pots.push_back(read_pot(pot));
    for (const RigTable& specimen : table.tables("specimen"))
      rig.specimens.push_back(read_specimen(specimen, rig.pots));
    if (rig.specimens.empty()) table.fail("specimen", "is missing; give a [[specimen]]");
    for (const RigPot& pot : rig.pots)
      for (const BoneName& bone : pot.bones)
        if (std::none_of(rig.specimens.begin(), rig.specimens.end(),
                         [&](auto& s) { return s.bone.text == bone.text; }))
          table.fail("pot", fmt::format("'{}' holds {}, which is no [[specimen]]; add it", pot.name,
                                        bone.text));
    table.finish();
    return rig;
  } catch (const toml::parse_error& e) {
    throw BodyError(
        fmt::format("{}:{}: {}; write key = value", path, e.source().begin.line, e.description()));
  }
}

}  // namespace fabrica::body
