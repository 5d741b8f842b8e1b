// Masses, time steps and a summary of a model before it runs.
//   solids   dt = (V / A) / sqrt((K + 4G/3) / rho)      A: largest face
//   shells   dt = (A / s) / sqrt(E / ((1 - nu^2) rho))   s: longest side (ISDO 0) or diagonal (ISDO
//   1); triangles 2A / s beams    dt = L / sqrt(E / rho)
// All unscaled: the run multiplies by TSSFAC.
#include "model/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "model/geometry.h"

namespace fabrica {
namespace {

const char* name_of(Family family) {
  switch (family) {
    case Family::solid:
      return "solid";
    case Family::shell:
      return "shell";
    case Family::beam:
      return "beam";
    case Family::discrete:
      return "discrete";
    case Family::none:
      break;
  }
  return "none";
}

struct Moduli {
  double bulk = 0, shear = 0;
  double youngs() const { return bulk > 0 ? 9 * bulk * shear / (3 * bulk + shear) : 0; }
  double poisson() const { return (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear)); }
};
Moduli from_youngs(double E, double nu) {
  nu = std::min(nu, 0.4999);
  return {E / (3 * (1 - 2 * nu)), E / (2 * (1 + nu))};
}
Moduli from_shear(double G, double nu) { return from_youngs(2 * G * (1 + nu), nu); }

// Initial elastic moduli of a law from its card; zero where the card does not tell them.
Moduli moduli_of(const Card& card) {
  const auto value = [&](const char* f) { return card.has_field(f) ? card.real(f) : 0.0; };
  const std::string_view law = card.schema->name;
  const double nu = value("pr");
  if (law == "MAT_OGDEN_RUBBER") {
    double twice_shear = 0;
    for (int k = 1; k <= 8; ++k)
      twice_shear +=
          value(fmt::format("mu{}", k).c_str()) * value(fmt::format("alpha{}", k).c_str());
    return from_shear(0.5 * twice_shear, nu);
  }
  if (law == "MAT_MOONEY-RIVLIN_RUBBER") return from_shear(2 * (value("a") + value("b")), nu);
  if (law == "MAT_HYPERELASTIC_RUBBER") return from_shear(2 * (value("c10") + value("c01")), nu);
  if (law == "MAT_ELASTIC_FLUID") return {value("k"), 0};
  if (law == "MAT_NULL") return from_youngs(value("ym"), nu);
  if (card.has_field("g0")) return {value("bulk"), std::max(value("g0"), value("gi"))};
  if (card.has_field("e1")) return from_youngs(value("e1") + value("e2"), nu);
  return from_youngs(value("e"), nu);
}

double section_area(const Section& s) {
  if (s.formulation != 1) return s.area;
  if (s.cross_section == 1) return 0.25 * std::numbers::pi * (s.ts1 * s.ts1 - s.tt1 * s.tt1);
  return s.ts1 * s.tt1;
}

// What an element adds: its mass, its time step, and the corners that share the mass equally.
struct Measure {
  double mass = 0, time_step = 0;
  std::array<int, 10> node{};
  int corners = 0;
};

class Checker {
 public:
  Checker(const Model& model, CheckReport& report) : model_(model), report_(report) {
    report_.node_mass.assign(model.nodes.id.size(), 0);
    used_.assign(model.nodes.id.size(), 0);
    for (const Material& m : model.materials) moduli_.push_back(moduli_of(*m.card));
    for (const Part& p : model.parts) {
      PartReport r;
      r.id = p.id, r.title = p.title, r.family = p.family, r.rigid = p.rigid;
      if (p.section >= 0) r.formulation = model.sections[p.section].formulation;
      if (p.material >= 0) r.law = model.materials[p.material].law;
      report_.parts.push_back(r);
    }
  }

  void elements() {
    for (int e = 0; e < model_.solids.size(); ++e)
      add(model_.solids.part[e], model_.solids.id[e], Family::solid, solid(e));
    for (int e = 0; e < model_.shells.size(); ++e)
      add(model_.shells.part[e], model_.shells.id[e], Family::shell, shell(e));
    for (int e = 0; e < model_.beams.size(); ++e)
      add(model_.beams.part[e], model_.beams.id[e], Family::beam, beam(e));
    for (int e = 0; e < model_.discretes.size(); ++e) {
      Measure m;
      for (int n : model_.discretes.node[e])
        if (n >= 0) m.node[m.corners++] = n;
      add(model_.discretes.part[e], model_.discretes.id[e], Family::discrete, m);
    }
    std::stable_sort(
        report_.smallest.begin(), report_.smallest.end(),
        [](const StepReport& a, const StepReport& b) { return a.time_step < b.time_step; });
    if (report_.smallest.size() > 20) report_.smallest.resize(20);
  }

  // totals; rigid parts with *PART_INERTIA weigh what that says
  void totals() {
    for (std::size_t p = 0; p < report_.parts.size(); ++p)
      if (const auto& inertia = model_.parts[p].inertia) report_.parts[p].mass = inertia->mass;
    for (const NodalMass& m : model_.masses) point_mass(m.node, m.mass);
    for (const NodalInertia& m : model_.inertias) point_mass(m.node, m.mass);
    Vec3d moment{0, 0, 0};
    for (int n = 0; n < model_.nodes.size(); ++n) {
      report_.mass += report_.node_mass[n];
      moment += report_.node_mass[n] * model_.nodes.x[n];
    }
    for (const Part& p : model_.parts)
      if (p.inertia) report_.mass += p.inertia->mass, moment += p.inertia->mass * p.inertia->center;
    if (report_.mass > 0) report_.center = (1 / report_.mass) * moment;
  }

  void initial_motion() {
    std::vector<Vec3d> velocity(model_.nodes.id.size(), Vec3d{0, 0, 0});
    std::vector<std::uint8_t> moving(model_.nodes.id.size(), 0);
    for (const InitialVelocity& v : model_.initial_velocities)
      for (int n : v.nodes) {
        if (v.rigid_bodies_only) continue;
        velocity[n] = v.velocity;
        if (v.about_axis) velocity[n] += cross(v.angular_velocity, model_.nodes.x[n] - v.point);
        moving[n] = norm(velocity[n]) > 0;
      }
    for (int n = 0; n < model_.nodes.size(); ++n) {
      report_.kinetic_energy += 0.5 * report_.node_mass[n] * dot(velocity[n], velocity[n]);
      if (moving[n]) report_.moving_mass += report_.node_mass[n];
    }
    for (const Part& p : model_.parts)
      if (p.inertia && norm(p.inertia->velocity) > 0) {
        report_.kinetic_energy +=
            0.5 * p.inertia->mass * dot(p.inertia->velocity, p.inertia->velocity);
        report_.moving_mass += p.inertia->mass;
      }
  }

  int unused_nodes() {
    for (const ExtraNodes& e : model_.extra_nodes) mark(e.nodes);
    for (const NodalRigidBody& b : model_.nodal_rigid_bodies) mark(b.nodes);
    for (const Joint& j : model_.joints) mark(j.node);
    for (const auto& n : model_.beams.node) mark(n);
    for (const CoordinateSystem& s : model_.coordinate_systems) mark(s.node);
    for (const SdOrientation& s : model_.sd_orientations) mark(s.node);
    return int(std::count(used_.begin(), used_.end(), 0));
  }

 private:
  template <class List>
  void mark(const List& nodes) {
    for (int n : nodes)
      if (n >= 0) used_[n] = 1;
  }

  void point_mass(int node, double mass) {
    if (node < 0) return;
    report_.node_mass[node] += mass;
    used_[node] = 1;
  }

  const Section* section(int part) const {
    const int s = part >= 0 ? model_.parts[part].section : -1;
    return s >= 0 ? &model_.sections[s] : nullptr;
  }
  double density(int part) const {
    const int m = part >= 0 ? model_.parts[part].material : -1;
    return m >= 0 ? model_.materials[m].density : 0;
  }
  Moduli moduli(int part) const {
    const int m = part >= 0 ? model_.parts[part].material : -1;
    return m >= 0 ? moduli_[m] : Moduli{};
  }

  void add(int part, std::int64_t id, Family family, const Measure& m) {
    for (int k = 0; k < m.corners; ++k) used_[m.node[k]] = 1;
    if (part < 0) return;
    PartReport& p = report_.parts[part];
    ++p.elements;
    p.mass += m.mass;
    // the mass of *PART_INERTIA replaces that of the elements
    if (!model_.parts[part].inertia)
      for (int k = 0; k < m.corners; ++k) report_.node_mass[m.node[k]] += m.mass / m.corners;
    if (model_.parts[part].rigid || m.time_step <= 0) return;
    report_.smallest.push_back({id, p.id, family, m.time_step});
    p.time_step = p.time_step > 0 ? std::min(p.time_step, m.time_step) : m.time_step;
  }

  Measure solid(int e) const {
    const auto& n = model_.solids.node[e];
    const int part = model_.solids.part[e];
    Measure m;
    std::array<int, 8> c{};
    const bool ten = n[8] >= 0;
    if (*std::min_element(n.begin(), n.begin() + (ten ? 10 : 8)) < 0)
      return m;  // a node is missing
    int distinct = ten ? 4 : distinct_corners(n, c);
    if (ten) c = {0, 1, 2, 3};
    if (distinct < 4) return m;
    Vec3d x[8];
    double volume, largest = 0;
    if (distinct == 4) {
      for (int k = 0; k < 4; ++k) x[k] = model_.nodes.x[n[c[k]]];
      volume = tet_volume(x[0], x[1], x[2], x[3]);
      for (const auto& f : {std::array{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}})
        largest = std::max(largest, 0.5 * norm(cross(x[f[1]] - x[f[0]], x[f[2]] - x[f[0]])));
    } else {
      for (int k = 0; k < 8; ++k) x[k] = model_.nodes.x[n[k]];
      volume = brick_volume(x);
      for (const auto& f : brick_faces) {
        const Vec3d face[4] = {x[f[0]], x[f[1]], x[f[2]], x[f[3]]};
        largest = std::max(largest, quad_area(face));
      }
    }
    // bricks that repeat nodes give these several shares
    m.corners = ten ? 10 : distinct == 4 ? 4 : 8;
    for (int k = 0; k < m.corners; ++k) m.node[k] = distinct == 4 && !ten ? n[c[k]] : n[k];
    m.mass = density(part) * volume;
    // three heights of the tetrahedron, one of the brick
    const double length = (distinct == 4 ? 3 : 1) * volume / largest;
    const Moduli a = moduli(part);
    const double wave = a.bulk + 4.0 / 3.0 * a.shear;
    if (wave > 0 && density(part) > 0) m.time_step = length / std::sqrt(wave / density(part));
    return m;
  }

  Measure shell(int e) const {
    const auto& n = model_.shells.node[e];
    const int part = model_.shells.part[e];
    Measure m;
    const Section* s = section(part);
    if (!s || *std::min_element(n.begin(), n.end()) < 0) return m;
    const bool triangle = n[3] == n[2];
    m.corners = triangle ? 3 : 4;
    Vec3d x[4];
    double thickness = 0, side = 0;
    for (int k = 0; k < 4; ++k) x[k] = model_.nodes.x[n[k]];
    for (int k = 0; k < m.corners; ++k) {
      m.node[k] = n[k];
      const float own = model_.shells.thickness.empty() ? 0 : model_.shells.thickness[e][k];
      thickness += (own > 0 ? double(own) : s->thickness[k]) / m.corners;
      side = std::max(side, norm(x[(k + 1) % m.corners] - x[k]));
    }
    if (model_.controls.shell_time_step == 1 && !triangle)
      side = std::max(norm(x[2] - x[0]), norm(x[3] - x[1]));
    const double area = quad_area(x), rho = density(part);
    m.mass = area * (thickness * rho + s->area_mass);
    const Moduli a = moduli(part);
    const double nu = a.bulk > 0 ? a.poisson() : 0;
    if (a.youngs() > 0 && rho > 0)
      m.time_step =
          (triangle ? 2 : 1) * area / side / std::sqrt(a.youngs() / ((1 - nu * nu) * rho));
    return m;
  }

  Measure beam(int e) const {
    const auto& n = model_.beams.node[e];
    const int part = model_.beams.part[e];
    Measure m;
    const Section* s = section(part);
    if (!s || n[0] < 0 || n[1] < 0) return m;
    m.corners = 2;
    m.node[0] = n[0], m.node[1] = n[1];
    const double length = norm(model_.nodes.x[n[1]] - model_.nodes.x[n[0]]), rho = density(part);
    if (s->formulation == 6) {
      m.mass = rho * s->volume;
      return m;
    }
    m.mass = rho * section_area(*s) * length;
    const double E = moduli(part).youngs();
    if (E > 0 && rho > 0) m.time_step = length / std::sqrt(E / rho);
    return m;
  }

  const Model& model_;
  CheckReport& report_;
  std::vector<Moduli> moduli_;
  std::vector<std::uint8_t> used_;
};

const char* name_of(ContactKind kind) {
  static const char* const names[] = {"automatic single surface",
                                      "automatic surface to surface",
                                      "automatic nodes to surface",
                                      "automatic general",
                                      "one way surface to surface",
                                      "surface to surface",
                                      "nodes to surface",
                                      "tied nodes to surface",
                                      "tied surface to surface",
                                      "tied shell edge to surface",
                                      "force transducer"};
  return names[int(kind)];
}

std::string side_of(const Model& model, const ContactSide& side) {
  switch (side.kind) {
    case ContactSide::Kind::none:
      return "itself";
    case ContactSide::Kind::segments:
      return side.set < 0
                 ? "missing segments"
                 : fmt::format("{} segments", model.segment_sets[side.set].segments.size());
    case ContactSide::Kind::shells:
      return side.set < 0 ? "missing shells"
                          : fmt::format("{} shells", model.element_sets[side.set].elements.size());
    case ContactSide::Kind::nodes:
      return side.set < 0 ? "missing nodes"
                          : fmt::format("{} nodes", model.node_sets[side.set].nodes.size());
    default:
      return fmt::format("{} parts", side.parts.size());
  }
}

}  // namespace

CheckReport check_model(const Model& model, Diagnostics& diagnostics) {
  CheckReport report;
  Checker checker(model, report);
  checker.elements();
  checker.totals();
  checker.initial_motion();

  std::map<std::pair<int, int>, int> counts;
  for (const PartReport& p : report.parts)
    if (p.elements > 0) counts[{int(p.family), p.formulation}] += p.elements;
  for (const auto& [key, n] : counts)
    report.formulations.push_back({Family(key.first), key.second, n});
  for (const Contact& c : model.contacts)
    report.contacts.push_back(fmt::format("{} {}: {} against {}, friction {:g}", c.id,
                                          name_of(c.kind), side_of(model, c.a), side_of(model, c.b),
                                          c.fs));

  report.unreferenced_nodes = checker.unused_nodes();
  if (report.unreferenced_nodes > 0)
    diagnostics.warning(
        "unreferenced-nodes", {}, "NODE", "",
        fmt::format("{} nodes belong to no element, mass or rigid body", report.unreferenced_nodes),
        "Remove them if they are not meant");
  return report;
}

std::string format_check(const CheckReport& report, const Diagnostics& diagnostics) {
  std::string text = "parts\n";
  for (const PartReport& p : report.parts)
    text += fmt::format("  {:>10}  {:<8} {:>3} {:>8} elements  mass {:<12.6g} {}{}  {}\n", p.id,
                        name_of(p.family), p.formulation, p.elements, p.mass, p.law,
                        p.rigid ? " (rigid)" : "", p.title);
  text += "formulations\n";
  for (const FormulationCount& f : report.formulations)
    text += fmt::format("  {:<8} {:>3} {:>10} elements\n", name_of(f.family), f.formulation,
                        f.elements);
  text += fmt::format("mass {:.6g}, centre {:.6g} {:.6g} {:.6g}\n", report.mass, report.center.x,
                      report.center.y, report.center.z);
  text += fmt::format("moving mass {:.6g}, kinetic energy {:.6g}\n", report.moving_mass,
                      report.kinetic_energy);
  text += "smallest time steps\n";
  for (const StepReport& s : report.smallest)
    text += fmt::format("  {:<12.6g} {} {} of part {}\n", s.time_step, name_of(s.family), s.element,
                        s.part);
  const auto list = [&](const char* heading, const std::vector<std::string>& lines) {
    if (lines.empty()) return;
    text += std::string(heading) + "\n";
    for (const std::string& line : lines) text += "  " + line + "\n";
  };
  list("contacts", report.contacts);
  list("initial penetrations", report.penetrations);
  for (const Diagnostic& d : diagnostics.list()) text += diagnostics.format(d) + "\n";
  text += fmt::format("check: {} errors, {} unsupported, {} ignored, {} warnings\n",
                      diagnostics.count(Severity::error), diagnostics.count(Severity::unsupported),
                      diagnostics.count(Severity::ignored), diagnostics.count(Severity::warning));
  return text;
}

}  // namespace fabrica
