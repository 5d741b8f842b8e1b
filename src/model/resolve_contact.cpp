// Contacts and rigid walls.
#include <algorithm>
#include <cstdlib>

#include "model/resolve.h"

namespace fabrica {
namespace {

struct KindOfContact {
  std::string_view stem;  // keyword without "CONTACT_" and without offset suffixes
  ContactKind kind;
};
constexpr KindOfContact contact_kinds[] = {
    {"AUTOMATIC_SINGLE_SURFACE", ContactKind::automatic_single_surface},
    {"AUTOMATIC_SURFACE_TO_SURFACE", ContactKind::automatic_surface_to_surface},
    {"AUTOMATIC_NODES_TO_SURFACE", ContactKind::automatic_nodes_to_surface},
    {"AUTOMATIC_GENERAL", ContactKind::automatic_general},
    {"AUTOMATIC_ONE_WAY_SURFACE_TO_SURFACE", ContactKind::one_way_surface_to_surface},
    {"ONE_WAY_SURFACE_TO_SURFACE", ContactKind::one_way_surface_to_surface},
    {"SURFACE_TO_SURFACE", ContactKind::surface_to_surface},
    {"NODES_TO_SURFACE", ContactKind::nodes_to_surface},
    {"TIED_NODES_TO_SURFACE", ContactKind::tied_nodes_to_surface},
    {"TIED_SURFACE_TO_SURFACE", ContactKind::tied_surface_to_surface},
    {"TIED_SHELL_EDGE_TO_SURFACE", ContactKind::tied_shell_edge_to_surface},
    {"FORCE_TRANSDUCER_PENALTY", ContactKind::force_transducer},
};

// removes a suffix and says whether it was there
bool take_suffix(std::string_view& name, std::string_view suffix) {
  if (!name.ends_with(suffix)) return false;
  name.remove_suffix(suffix.size());
  return true;
}

// The id of *CONTACT_..._TITLE, which stands in front of the heading.
std::int64_t leading_id(const std::string& title) {
  return std::strtoll(title.substr(0, 10).c_str(), nullptr, 10);
}

bool one_sided(ContactKind kind) {
  return kind == ContactKind::automatic_single_surface || kind == ContactKind::automatic_general;
}

}  // namespace

// SSTYP: 0 segment set, 1 shell set, 2 part set, 3 part, 4 node set, 5 all, 6 all but a part set
ContactSide Resolver::contact_side(const Card& card, std::string_view id_field,
                                   std::string_view type_field, std::string_view box_field,
                                   bool may_be_all) {
  ContactSide side;
  const std::int64_t id = card.id(id_field);
  const int type = card.integer(type_field);
  side.box = reference("box", card.id(box_field));
  const auto all_parts = [&] {
    for (int p = 0; p < int(model_.parts.size()); ++p)
      if (model_.parts[p].family != Family::none && model_.parts[p].family != Family::discrete)
        side.parts.push_back(p);
  };
  if (type == 5 || (id == 0 && may_be_all)) {
    side.kind = ContactSide::Kind::all;
    all_parts();
    return side;
  }
  if (id == 0) return side;

  const auto find = [&](const char* kind, const char* missing) {
    const int i = reference(kind, id);
    if (i < 0)
      error(card, id_field, missing,
            "there is no set or part " + std::to_string(id) + " of type " + std::to_string(type),
            "Define it, or correct the type of the side");
    return i;
  };
  switch (type) {
    case 0:
      side.kind = ContactSide::Kind::segments;
      side.set = find("segment_set", "missing-set");
      break;
    case 1:
      side.kind = ContactSide::Kind::shells;
      side.set = find("shell_set", "missing-set");
      break;
    case 2:
      side.kind = ContactSide::Kind::parts;
      side.set = find("part_set", "missing-set");
      if (side.set >= 0) side.parts = model_.part_sets[side.set].parts;
      break;
    case 3:
      side.kind = ContactSide::Kind::part;
      if (const int p = find("part", "missing-part"); p >= 0) side.parts = {p};
      break;
    case 4:
      side.kind = ContactSide::Kind::nodes;
      side.set = find("node_set", "missing-set");
      break;
    case 6: {
      side.kind = ContactSide::Kind::parts;
      all_parts();
      if (const int s = find("part_set", "missing-set"); s >= 0) {
        const auto& out = model_.part_sets[s].parts;
        std::erase_if(side.parts,
                      [&](int p) { return std::find(out.begin(), out.end(), p) != out.end(); });
      }
      break;
    }
    default:
      unsupported(card, type_field, "unsupported-contact-side",
                  "a side of type " + std::to_string(type) + " is not computed",
                  "Use a segment, shell, part or node set");
  }
  return side;
}

void Resolver::read_contact(const Card& card) {
  std::string_view name = std::string_view(card.schema->name).substr(8);
  Contact c{};
  c.beam_offset = take_suffix(name, "_BEAM_OFFSET");
  c.constrained_offset = !c.beam_offset && take_suffix(name, "_CONSTRAINED_OFFSET");
  c.offset = !c.beam_offset && !c.constrained_offset && take_suffix(name, "_OFFSET");
  const auto known = std::find_if(std::begin(contact_kinds), std::end(contact_kinds),
                                  [&](const KindOfContact& k) { return k.stem == name; });
  if (known == std::end(contact_kinds)) return;
  c.kind = known->kind;
  c.oriented =
      !name.starts_with("AUTOMATIC") && !name.starts_with("TIED") && !name.starts_with("FORCE");
  c.where = card.where;
  c.title = card.title;
  c.id = card.has_field("cid") ? card.id("cid") : 0;
  if (c.title.empty()) c.title = std::string(card.text("heading"));
  if (c.id == 0 && card.has_option("TITLE")) c.id = leading_id(c.title);
  if (c.id == 0) c.id = std::int64_t(model_.contacts.size()) + 1;

  // sides: a single surface has one, and names everything where it names nothing
  c.a = contact_side(card, "ssid", "sstyp", "sboxid", one_sided(c.kind));
  if (!one_sided(c.kind)) {
    c.b = contact_side(card, "msid", "mstyp", "mboxid", false);
    const bool needs_two = c.kind != ContactKind::force_transducer;
    if (needs_two && (c.a.kind == ContactSide::Kind::none || c.b.kind == ContactSide::Kind::none))
      error(card, c.a.kind == ContactSide::Kind::none ? "ssid" : "msid", "missing-contact-side",
            "a side of the contact is not given", "Give SSID and MSID");
  }

  // numbers; zero stands for the default
  c.fs = card.real("fs"), c.fd = card.real("fd"), c.dc = card.real("dc");
  c.vc = card.real("vc"), c.vdc = card.real("vdc");
  c.birth = card.real("bt"), c.death = nonzero(card, "dt", 1e28);
  c.sfs = nonzero(card, "sfs", 1), c.sfm = nonzero(card, "sfm", 1);
  c.sst = card.real("sst"), c.mst = card.real("mst");
  c.sfst = nonzero(card, "sfst", 1), c.sfmt = nonzero(card, "sfmt", 1);
  c.fsf = nonzero(card, "fsf", 1), c.vsf = nonzero(card, "vsf", 1);
  c.soft = card.integer("soft");
  c.sofscl = nonzero(card, "sofscl", 0.1), c.maxpar = nonzero(card, "maxpar", 1.025);
  c.sbopt = to_int(nonzero(card, "sbopt", 2)), c.depth = to_int(nonzero(card, "depth", 2));
  c.penmax = card.real("penmax"), c.thkopt = card.integer("thkopt");
  c.shlthk = to_int(nonzero(card, "shlthk", model_.controls.shell_thickness_option));
  c.snlog = card.integer("snlog");
  c.ignore = card.given("ignore") ? card.integer("ignore") : model_.controls.contact_ignore;
  model_.contacts.push_back(std::move(c));
}

void Resolver::read_wall(const Card& card) {
  const std::string_view name = card.schema->name;
  RigidWall w;
  w.id = card.has_option("ID") ? card.id("id") : 0;
  if (w.id == 0) w.id = std::int64_t(model_.rigid_walls.size()) + 1;
  w.title =
      card.has_option("ID") && card.title.empty() ? std::string(card.text("heading")) : card.title;
  w.all_nodes = card.id("nsid") == 0;
  w.nodes = selected_nodes(card.id("nsid"), card.id("nsidex"), card.id("boxid"));
  w.tail = {card.real("xt"), card.real("yt"), card.real("zt")};
  w.head = {card.real("xh"), card.real("yh"), card.real("zh")};
  w.friction = card.real("fric");
  w.birth = card.real("birth"), w.death = nonzero(card, "death", 1e28);
  if (name == "RIGIDWALL_PLANAR") {
    w.velocity_limit = card.real("wvel");
    w.offset = card.real("offset");
    if (card.has_option("ORTHO")) read_wall_friction(card, w);
    if (card.has_option("FINITE")) {
      w.edge = {card.real("xhev"), card.real("yhev"), card.real("zhev")};
      w.length_l = card.real("lenl"), w.length_m = card.real("lenm");
    }
    if (card.has_option("MOVING")) {
      w.moving = true;
      w.mass = card.real("mass"), w.velocity = card.real("v0");
    }
  } else {
    read_wall_shape(card, w);
  }
  if (!(norm(w.head - w.tail) > 0) && w.shape != RigidWall::Shape::sphere)
    error(card, "xh", "degenerate-wall", "the normal or axis of the wall has no length",
          "Give a head that differs from the tail");
  model_.rigid_walls.push_back(std::move(w));
}

void Resolver::read_wall_friction(const Card& card, RigidWall& w) {
  RigidWall::Ortho o;
  o.fs_a = card.real("sfrica"), o.fs_b = card.real("sfricb");
  o.fd_a = card.real("dfrica"), o.fd_b = card.real("dfricb");
  o.decay_a = card.real("decaya"), o.decay_b = card.real("decayb");
  o.node = {node(card.id("node1")), node(card.id("node2"))};
  o.direction = {card.real("dx"), card.real("dy"), card.real("dz")};
  Vec3d d = o.direction;
  if (o.node[0] >= 0 && o.node[1] >= 0) d = model_.nodes.x[o.node[1]] - model_.nodes.x[o.node[0]];
  const Vec3d n = w.head - w.tail;
  if (!(norm(cross(n, d)) > 1e-6 * norm(n) * norm(d)))
    error(card, "dx", "degenerate-wall", "the direction of the friction does not lie in the wall",
          "Give two nodes or a direction that is not along the normal");
  w.ortho = o;
}

void Resolver::read_wall_shape(const Card& card, RigidWall& w) {
  const std::string_view name = card.schema->name;
  if (name == "RIGIDWALL_GEOMETRIC_CYLINDER") {
    w.shape = RigidWall::Shape::cylinder;
    w.radius = card.real("radcyl"), w.length = card.real("lencyl");
  } else if (name == "RIGIDWALL_GEOMETRIC_SPHERE") {
    w.shape = RigidWall::Shape::sphere;
    w.radius = card.real("radsph");
  } else {
    const bool prism = name == "RIGIDWALL_GEOMETRIC_PRISM";
    w.shape = prism ? RigidWall::Shape::prism : RigidWall::Shape::flat;
    w.edge = {card.real("xhev"), card.real("yhev"), card.real("zhev")};
    w.length_l = card.real("lenl"), w.length_m = card.real("lenm");
    if (prism) w.length = card.real("lenp");
  }
  if (card.has_option("MOTION")) {
    w.motion_curve = curve(card, "lcid");
    w.motion_option = card.integer("opt");
    const Vec3d v{card.real("vx"), card.real("vy"), card.real("vz")};
    if (norm(v) > 0) w.motion_direction = (1 / norm(v)) * v;
  }
}

}  // namespace fabrica
