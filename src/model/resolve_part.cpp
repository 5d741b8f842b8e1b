// Sections, materials, hourglass control and parts.
#include <algorithm>
#include <cmath>

#include "model/resolve.h"

namespace fabrica {
namespace {

Family family_of(std::string_view keyword) {
  if (keyword == "SECTION_SOLID") return Family::solid;
  if (keyword == "SECTION_SHELL") return Family::shell;
  if (keyword == "SECTION_BEAM") return Family::beam;
  if (keyword == "SECTION_DISCRETE") return Family::discrete;
  return Family::none;
}

// formulations with a kernel
bool supported(Family family, int formulation) {
  const auto any_of = [&](std::initializer_list<int> list) {
    return std::find(list.begin(), list.end(), formulation) != list.end();
  };
  switch (family) {
    case Family::solid:
      return any_of({0, 1, 2, -1, -2, 10, 13, 15});
    case Family::shell:
      return any_of({1, 2, 3, 4, 5, 9, 10, 16, -16, 17});
    case Family::beam:
      return any_of({1, 2, 3, 6});
    default:
      return true;
  }
}

}  // namespace

void Resolver::check_formulation(const Card& card, const Section& section) {
  if (supported(section.family, section.formulation)) return;
  unsupported(card, "elform", "unsupported-formulation",
              "element formulation " + std::to_string(section.formulation) + " is not computed",
              "Choose a formulation from the manual page of the keyword");
}

void Resolver::read_section(const Card& card) {
  Section s;
  s.id = card.id("secid");
  s.title = card.title;
  s.card = &card;
  s.family = family_of(card.schema->name);
  if (card.has_field("elform")) s.formulation = card.integer("elform");
  switch (s.family) {
    case Family::shell: {
      if (s.formulation == 0) s.formulation = model_.controls.shell_theory;
      s.through_thickness_points = to_int(nonzero(card, "nip", 2));
      s.shear_factor = nonzero(card, "shrf", 1);
      const double t1 = card.real("t1");
      s.thickness = {t1, nonzero(card, "t2", t1), nonzero(card, "t3", t1), nonzero(card, "t4", t1)};
      s.reference_location = card.real("nloc");
      s.area_mass = card.real("marea");
      s.quadrature = card.integer("qr");
      break;
    }
    case Family::beam:
      read_beam_section(card, s);
      break;
    case Family::discrete:
      s.torsional = card.integer("dro");
      s.dynamic_factor = card.real("kd"), s.test_velocity = card.real("v0");
      s.clearance = card.real("cl"), s.failure_deflection = card.real("fd");
      s.deflection_limit_compression = card.real("cdl");
      s.deflection_limit_tension = card.real("tdl");
      break;
    default:
      break;
  }
  check_formulation(card, s);
  if (define("section", s.id, int(model_.sections.size()), card, "secid"))
    model_.sections.push_back(std::move(s));
}

void Resolver::read_beam_section(const Card& card, Section& s) {
  if (s.formulation == 0) s.formulation = 1;
  s.shear_factor = nonzero(card, "shrf", 1);
  s.quadrature = to_int(nonzero(card, "qr", 2));
  s.cross_section = card.integer("cst");
  s.scoor = card.real("scoor");
  s.ts1 = card.real("ts1"), s.ts2 = nonzero(card, "ts2", s.ts1);
  s.tt1 = card.real("tt1"), s.tt2 = nonzero(card, "tt2", s.tt1);
  s.area = s.formulation == 3 ? card.real("a3") : card.real("a");
  s.iss = card.real("iss"), s.itt = nonzero(card, "itt", s.iss);
  s.j = nonzero(card, "j", s.iss + s.itt);
  s.shear_area = card.real("sa");
  s.volume = card.real("vol"), s.rotary_inertia = card.real("iner");
  s.local_system = reference("coordinate_system", card.id("cid"));
  s.ca = card.real("ca"), s.offset = card.real("offset");
  s.rrcon = card.real("rrcon"), s.srcon = card.real("srcon"), s.trcon = card.real("trcon");
}

void Resolver::read_material(const Card& card) {
  if (!card.has_field("mid")) return;
  Material m;
  m.id = card.id("mid");
  m.law = card.schema->name;
  m.title = card.title;
  m.card = &card;
  if (card.has_field("ro")) m.density = card.real("ro");
  if (m.law == "MAT_RIGID") read_rigid_material(card, m);
  // *MAT_ADD_* cards extend a law that stands elsewhere
  if (m.law.starts_with("MAT_ADD_")) return;
  if (define("material", m.id, int(model_.materials.size()), card, "mid"))
    model_.materials.push_back(std::move(m));
}

void Resolver::read_rigid_material(const Card& card, Material& m) {
  m.rigid = true;
  m.youngs = card.real("e"), m.poisson = card.real("pr");
  m.cmo = card.integer("cmo");
  m.con1 = card.integer("con1"), m.con2 = card.integer("con2");

  // CMO = -1: CON1 names the local system of the constraints. LCO names one for output: only where
  // the card does not give vectors instead.
  if (m.cmo == -1) {
    m.local_system = reference("coordinate_system", m.con1);
    if (m.con1 != 0 && m.local_system < 0)
      error(card, "con1", "missing-coordinate-system",
            "there is no coordinate system " + std::to_string(m.con1), "Define it");
    return;
  }
  const double lco = card.real("lco");
  bool vectors = false;
  for (const char* field : {"a2", "a3", "v1", "v2", "v3"}) vectors |= card.real(field) != 0;
  if (!vectors && lco > 0 && lco == std::floor(lco))
    m.local_system = reference("coordinate_system", to_id(lco));
}

void Resolver::read_eos(const Card& card) {
  define("eos", card.id("eosid"), card_index_[&card], card, "eosid");
}

void Resolver::read_hourglass(const Card& card) {
  const Hourglass& control = model_.controls.hourglass;
  Hourglass h;
  h.type = to_int(nonzero(card, "ihq", control.type));
  h.coefficient = nonzero(card, "qm", 0.1);
  h.quadratic_viscosity = nonzero(card, "q1", 1.5);
  h.linear_viscosity = nonzero(card, "q2", 0.06);
  h.bending = nonzero(card, "qb", h.coefficient);
  h.warping = nonzero(card, "qw", h.coefficient);
  if (define("hourglass", card.id("hgid"), int(hourglasses_.size()), card, "hgid"))
    hourglasses_.push_back(h);
}

void Resolver::read_part(const Card& card) {
  Part p;
  p.id = card.id("pid");
  p.title = card.title;
  p.where = card.where;
  p.section = reference("section", card.id("secid"));
  p.material = reference("material", card.id("mid"));
  p.eos = reference("eos", card.id("eosid"));
  if (const int h = reference("hourglass", card.id("hgid")); h >= 0) p.hourglass = hourglasses_[h];
  if (p.section >= 0) p.family = model_.sections[p.section].family;
  if (p.material >= 0) p.rigid = model_.materials[p.material].rigid;
  if (card.has_option("INERTIA")) {
    p.inertia = read_inertia(card, "cid");
    // a blank mass means that PART_INERTIA is not complete: the reference program needs both
    if (p.inertia->mass <= 0)
      error(card, "tm", "missing-mass", "the mass of the rigid body is not positive",
            "Give TM, or use *PART without _INERTIA");
  }
  if (card.has_option("CONTACT"))
    p.contact = PartContact{card.real("fs"),   card.real("fd"),  card.real("dc"), card.real("vc"),
                            card.real("optt"), card.real("sft"), card.real("ssf")};
  if (!define("part", p.id, int(model_.parts.size()), card, "pid")) return;
  model_.part_map_.emplace(p.id, int(model_.parts.size()));
  model_.parts.push_back(std::move(p));
}

// The inertia cards of *PART_INERTIA and *CONSTRAINED_NODAL_RIGID_BODY_INERTIA.
std::optional<InertiaOverride> Resolver::read_inertia(const Card& card,
                                                      std::string_view system_field) {
  InertiaOverride r{};
  r.center = {card.real("xc"), card.real("yc"), card.real("zc")};
  r.mass = card.real("tm");
  r.node = node(card.id("nodeid"));
  if (r.node >= 0) r.center = model_.nodes.x[r.node];
  const char* fields[6] = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
  for (int k = 0; k < 6; ++k) r.inertia[k] = card.real(fields[k]);
  r.velocity = {card.real("vtx"), card.real("vty"), card.real("vtz")};
  r.angular_velocity = {card.real("vrx"), card.real("vry"), card.real("vrz")};
  if (card.integer("ircs") != 1) return r;

  // local axes: a system, or two vectors from which an unnamed system is made
  r.local_system = reference("coordinate_system", card.id(system_field));
  if (r.local_system < 0) {
    const Vec3d x{card.real("xl"), card.real("yl"), card.real("zl")};
    const Vec3d xy{card.real("xlip"), card.real("ylip"), card.real("zlip")};
    const double length = norm(x), area = norm(cross(x, xy));
    if (length > 0 && area > 0) {
      const Vec3d ex = (1 / length) * x, ez = (1 / area) * cross(x, xy), ey = cross(ez, ex);
      CoordinateSystem s;
      s.origin = r.center;
      s.axes = {{{ex.x, ex.y, ex.z}, {ey.x, ey.y, ey.z}, {ez.x, ez.y, ez.z}}};
      r.local_system = int(model_.coordinate_systems.size());
      model_.coordinate_systems.push_back(s);
    }
  }
  return r;
}

void Resolver::read_deformable_to_rigid(const Card& card) {
  for (int i = 0; i < card.row_count(); ++i) {
    const auto id = to_id(card.row(i, 0));
    const int lead = part(to_id(card.row(i, 1)));
    const bool is_set = card.row_text(i, 2).starts_with("PSET");
    std::vector<int> parts;
    if (is_set) {
      if (const int s = reference("part_set", id); s >= 0) parts = model_.part_sets[s].parts;
    } else if (const int p = part(id); p >= 0) {
      parts = {p};
    }
    if (parts.empty() && id != 0)
      error(card, "", is_set ? "missing-set" : "missing-part",
            std::string("there is no part ") + (is_set ? "set " : "") + std::to_string(id),
            "Correct the id");
    for (int p : parts) {
      model_.parts[p].rigid = true;
      if (lead >= 0 && lead != p) model_.rigid_merges.push_back({lead, p});
    }
  }
}

// Parts that have elements need a section and a material.
void Resolver::check_parts() {
  std::unordered_map<std::int64_t, const Card*> card_of;
  for (const auto& c : model_.cards)
    if (c->schema && (c->schema->name == "PART" || c->schema->name == "PART_AVERAGED"))
      card_of.emplace(c->id("pid"), c.get());
  for (int p = 0; p < int(model_.parts.size()); ++p) {
    const Part& part = model_.parts[p];
    const auto it = card_of.find(part.id);
    if (it == card_of.end()) continue;
    const Card& card = *it->second;
    bool used = false;
    for (int f = 1; f < 5; ++f) used |= part_elements_[f].start[p] < part_elements_[f].start[p + 1];
    if (!used) continue;
    if (part.section < 0 && card.id("secid") == 0)
      error(card, "secid", "missing-section",
            "part " + std::to_string(part.id) + " has elements but no section", "Give SECID");
    if (part.material < 0 && card.id("mid") == 0)
      error(card, "mid", "missing-material",
            "part " + std::to_string(part.id) + " has elements but no material", "Give MID");
  }
}

}  // namespace fabrica
