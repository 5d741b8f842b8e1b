#include "body/rig.h"

#include "body/mesh/bone_mesh.h"
#include "body/rig_table.h"

namespace fabrica::body {
namespace {

constexpr std::array<const char*, 6> dof_names{"x", "y", "z", "rx", "ry", "rz"};

BoneName bone_name(RigTable& table, const std::string& key, const std::string& text) {
  const BoneName name = bone_named(text);
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

std::vector<BoneName> bones_of(RigTable& table, const std::string& key, const std::string& what) {
  std::vector<BoneName> names;
  for (const std::string& text : table.texts(key, what))
    names.push_back(bone_name(table, key, text));
  if (names.empty()) table.fail(key, "is empty; give " + what);
  return names;
}

// [[first, value], ...] with first rising
std::vector<std::pair<double, double>> read_points(const RigTable& table, const std::string& key,
                                                   const toml::node& points, const char* pairs,
                                                   const char* falls) {
  std::vector<std::pair<double, double>> out;
  if (!points.is_array() || points.as_array()->size() < 2)
    table.fail(key, fmt::format("must be a list of two or more {}", pairs));
  for (const toml::node& item : *points.as_array()) {
    const auto pair = table.numbers(key, item);
    if (pair.size() != 2) table.fail(key, fmt::format("must be a list of {}", pairs));
    if (!out.empty() && pair[0] <= out.back().first)
      table.fail(key, fmt::format("{} at {:g}; sort it", falls, pair[0]));
    out.emplace_back(pair[0], pair[1]);
  }
  return out;
}

// one of the kinds that are allowed here, by the key that gives it
RigCurve read_curve(RigTable table,
                    const std::vector<std::pair<const char*, RigCurve::Kind>>& kinds) {
  RigCurve curve;
  curve.dof = dof_named(table, "along", table.text("along", "x, y, z, rx, ry or rz"));
  std::vector<std::string> names, given;
  for (const auto& [name, kind] : kinds) {
    names.push_back(name);
    const toml::node* points = table.find(name);
    if (!points) continue;
    given.push_back(name);
    curve.kind = kind;
    curve.points = read_points(table, name, *points, "[time, value]", "goes back in time");
  }
  if (given.size() != 1)
    table.fail(given.empty() ? "along" : given.back(),
               fmt::format("wants {}", fmt::join(names, " or ")));
  table.finish();
  return curve;
}

RigSupport read_support(RigTable& table) {
  RigSupport support;
  if (table.find("free"))
    for (const std::string& text : table.texts("free", "degrees of freedom"))
      support.free[std::size_t(dof_named(table, "free", text))] = true;
  for (RigTable& motion : table.one_or_more("motion")) {
    const RigCurve curve = read_curve(
        motion, {{"velocity", RigCurve::velocity}, {"displacement", RigCurve::displacement}});
    const char* dof = dof_names[std::size_t(curve.dof)];
    if (support.free[std::size_t(curve.dof)])
      table.fail("free", fmt::format("holds {}, which the motion moves; take it out", dof));
    if (support.moves(curve.dof))
      table.fail("motion", fmt::format("moves {} twice; give one curve", dof));
    support.motions.push_back(curve);
  }
  for (RigTable& load : table.tables("load")) {
    support.loads.push_back(read_curve(load, {{"force", RigCurve::force}}));
    const int dof = support.loads.back().dof;
    if (support.moves(dof))
      table.fail("load", fmt::format("pushes along {}, which the motion moves; take one out",
                                     dof_names[std::size_t(dof)]));
  }
  if (const auto velocity = table.point("start_velocity")) support.velocity = *velocity;
  const double start[3] = {support.velocity.x, support.velocity.y, support.velocity.z};
  for (std::size_t d = 0; d < 3; ++d)
    if (start[d] != 0 && support.holds(d))
      table.fail("start_velocity",
                 fmt::format("goes along {}, which is held; add it to free", dof_names[d]));
  return support;
}

Point direction(RigTable& table, const std::string& key, const Point& value) {
  if (norm(value) == 0) table.fail(key, "must be a direction such as [0, 0, 1]");
  return unit(value);
}

RigPot read_pot(RigTable table) {
  RigPot pot;
  pot.name = table.text("name", "the name of the pot");
  pot.bones = bones_of(table, "bones", "the bones that get it");
  const auto toward = table.point("toward");
  if (!toward || norm(*toward) == 0)
    table.fail("toward", "must be a direction of the bone's frame such as [0, 0, 1]");
  pot.toward = direction(table, "toward", *toward);
  pot.depth = table.positive("depth", "the depth of the pot in mm");
  if (table.find("pivot")) pot.pivot = table.positive("pivot", "its distance from the open face");
  if (pot.pivot && *pot.pivot > pot.depth)
    table.fail("pivot", fmt::format("is {:g} mm behind the open face, but the pot is {:g} mm deep",
                                    *pot.pivot, pot.depth));
  pot.pivot_at = table.point("pivot_at");
  if (pot.pivot && pot.pivot_at)
    table.fail("pivot_at", "and pivot say where the pivot is; take one out");
  pot.mass = table.number("mass", 0);
  if (pot.mass < 0) table.fail("mass", "is below 0; give that of the cup in kg");
  if (table.find("foundation"))
    pot.foundation = table.positive("foundation", "that of the resin in kN/mm2");
  if (pot.foundation > 0 && !(pot.mass > 0))
    table.fail("foundation", "lets the bone move in its cup; give the mass of cup and resin in kg");
  pot.support = read_support(table);
  table.finish();
  return pot;
}

RigFixture::Pad read_pad(RigTable table) {
  RigFixture::Pad pad;
  pad.thickness = table.positive("thickness", "that of the layer in mm");
  pad.density = table.positive("density", "that of the foam in kg/mm3");
  pad.modulus = table.positive("modulus", "that of the foam in tension in GPa");
  pad.compression = read_points(
      table, "compression", table.need("compression", "a list of [nominal strain, stress in GPa]"),
      "[strain, stress]", "has falling strains");
  table.finish();
  return pad;
}

RigFixture read_fixture(RigTable table) {
  RigFixture fixture;
  fixture.name = table.text("name", "the name of the fixture");
  const std::string shape = table.text("shape", "ball, cylinder or box");
  if (shape != "ball" && shape != "cylinder" && shape != "box")
    table.fail("shape", fmt::format("'{}' is unknown; there are ball, cylinder, box", shape));
  fixture.shape = shape == "ball"       ? RigFixture::ball
                  : shape == "cylinder" ? RigFixture::cylinder
                                        : RigFixture::box;
  if (fixture.shape != RigFixture::box) fixture.radius = table.positive("radius", "that in mm");
  if (fixture.shape == RigFixture::cylinder)
    fixture.length = table.positive("length", "that in mm");
  if (fixture.shape == RigFixture::box) {
    const auto size = table.point("size");
    if (!size || !(size->x > 0) || !(size->y > 0) || !(size->z > 0))
      table.fail("size", "must be three lengths in mm: along axis, across, along toward");
    fixture.size = *size;
  }
  if (fixture.shape != RigFixture::ball)
    if (const auto axis = table.point("axis")) fixture.axis = direction(table, "axis", *axis);
  if (const auto at = table.point("at")) fixture.at = *at;
  if (const auto toward = table.point("toward"))
    fixture.toward = direction(table, "toward", *toward);
  if (fixture.shape != RigFixture::ball && std::abs(dot(fixture.axis, fixture.toward)) > 1e-6)
    table.fail("axis", "must be square to toward");
  fixture.gap = table.number("gap", fixture.gap);
  if (fixture.gap < 0) table.fail("gap", "is below 0, within the bone");
  fixture.element = table.number("element", fixture.element);
  if (!(fixture.element > 0)) table.fail("element", "is not above 0; give the edge in mm");
  fixture.mass = table.positive("mass", "that in kg");
  fixture.friction = table.number("friction", fixture.friction);
  fixture.touches = bones_of(table, "touches", "the bones that it touches");
  if (auto pad = table.table("pad")) fixture.pad = read_pad(*pad);
  if (fixture.pad && fixture.shape != RigFixture::box)
    table.fail("pad", "lies on a box; a ball or a cylinder has none");
  fixture.support = read_support(table);
  table.finish();
  return fixture;
}

RigSpecimen read_specimen(RigTable table, const std::vector<RigPot>& pots) {
  RigSpecimen specimen;
  specimen.bone = bone_name(table, "bone", table.text("bone", "a bone such as right.rib5"));
  if (table.find("with")) specimen.with = bones_of(table, "with", "the bones joined to it");
  if (table.find("along")) {
    const auto along = table.texts("along", "the pots on its x axis, [from, to]");
    if (along.size() != 2) table.fail("along", "must be two pots: [from, to]");
    specimen.from = along[0], specimen.to = along[1];
    const std::vector<BoneName> bones = specimen.bones();
    for (const std::string& name : along) {
      const bool found = std::any_of(pots.begin(), pots.end(), [&](const RigPot& pot) {
        return pot.name == name && std::any_of(bones.begin(), bones.end(),
                                               [&](auto& bone) { return holds(pot, bone); });
      });
      if (!found)
        table.fail("along", fmt::format("'{}' is no pot of {}; add a [[pot]] of that name with it",
                                        name, specimen.bone.text));
    }
  }
  specimen.offset = table.number("offset", 0);
  if (specimen.offset != 0 && specimen.from.empty())
    table.fail("offset", "is that of the second pot; give along, or take it out");
  if (const auto at = table.point("at")) specimen.at = *at;
  specimen.up = table.point("up");
  if (specimen.up && specimen.from.empty())
    table.fail("up", "turns a specimen about the line of its pots; give along, or take it out");
  if (table.find("faster"))
    specimen.faster = table.positive("faster", "by how much the run is faster than the test");
  table.finish();
  return specimen;
}

bool same(const BoneName& name, const PlacedBone& bone) {
  return name.bone == bone.mesh.name && name.side == bone.side;
}

}  // namespace

bool RigSupport::moves(int dof) const {
  return std::any_of(motions.begin(), motions.end(),
                     [&](const RigCurve& curve) { return curve.dof == dof; });
}

bool RigSupport::holds(std::size_t dof) const {
  return !free[dof] && !moves(int(dof)) &&
         std::none_of(loads.begin(), loads.end(),
                      [&](const RigCurve& curve) { return std::size_t(curve.dof) == dof; });
}

std::vector<BoneName> RigSpecimen::bones() const {
  std::vector<BoneName> out{bone};
  out.insert(out.end(), with.begin(), with.end());
  return out;
}

bool holds(const RigPot& pot, const BoneName& bone) {
  return std::any_of(pot.bones.begin(), pot.bones.end(),
                     [&](const BoneName& b) { return b.text == bone.text; });
}

bool Rig::joined() const {
  return std::any_of(specimens.begin(), specimens.end(),
                     [](const RigSpecimen& specimen) { return !specimen.with.empty(); });
}

std::vector<std::string> Rig::bones() const {
  std::vector<std::string> names;
  for (const RigSpecimen& specimen : specimens)
    for (const BoneName& bone : specimen.bones())
      if (std::find(names.begin(), names.end(), bone.text) == names.end())
        names.push_back(bone.text);
  return names;
}

bool Rig::tests(const PlacedBone& bone) const {
  for (const RigSpecimen& specimen : specimens)
    for (const BoneName& name : specimen.bones())
      if (same(name, bone)) return true;
  return false;
}

bool Rig::has(const BoneName& name) const {
  const std::vector<std::string> all = bones();
  return std::find(all.begin(), all.end(), name.text) != all.end();
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
    rig.damping = table.number("damping", 0);
    if (rig.damping < 0) table.fail("damping", "is below 0; give a rate in 1/ms");
    for (const RigTable& pot : table.tables("pot")) rig.pots.push_back(read_pot(pot));
    for (const RigTable& specimen : table.tables("specimen"))
      rig.specimens.push_back(read_specimen(specimen, rig.pots));
    if (rig.specimens.empty()) table.fail("specimen", "is missing; give a [[specimen]]");
    if (rig.joined() && rig.specimens.size() > 1)
      table.fail("specimen", "is one where bones are joined; write a file for each");
    for (const RigTable& fixture : table.tables("fixture"))
      rig.fixtures.push_back(read_fixture(fixture));
    const auto need_specimen = [&](const char* key, const std::string& name, const char* does,
                                   const std::vector<BoneName>& bones) {
      for (const BoneName& bone : bones)
        if (!rig.has(bone))
          table.fail(key, fmt::format("'{}' {} {}, which is in no [[specimen]]; add it", name, does,
                                      bone.text));
    };
    for (const RigPot& pot : rig.pots) need_specimen("pot", pot.name, "holds", pot.bones);
    for (const RigFixture& fixture : rig.fixtures)
      need_specimen("fixture", fixture.name, "touches", fixture.touches);
    table.finish();
    return rig;
  } catch (const toml::parse_error& e) {
    throw BodyError(
        fmt::format("{}:{}: {}; write key = value", path, e.source().begin.line, e.description()));
  }
}

}  // namespace fabrica::body
