// Initial velocities, loads and damping.
#include <algorithm>

#include "model/resolve.h"

namespace fabrica {
namespace {

Vec3d triple(const Card& card, const char* x, const char* y, const char* z) {
  return {card.real(x), card.real(y), card.real(z)};
}
Vec3d row_triple(const Card& card, int row, int column) {
  return {card.row(row, column), card.row(row, column + 1), card.row(row, column + 2)};
}
bool equal(const Vec3d& a, const Vec3d& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

}  // namespace

// Names the rigid parts all of whose nodes are among the targets.
void Resolver::add_initial(InitialVelocity v) {
  const bool rigid =
      std::any_of(model_.parts.begin(), model_.parts.end(), [](const Part& p) { return p.rigid; });
  if (rigid && v.nodes.size() > 2) {
    std::vector<std::uint8_t> in(model_.nodes.id.size(), 0);
    for (int n : v.nodes) in[n] = 1;
    for (int p = 0; p < int(model_.parts.size()); ++p) {
      if (!model_.parts[p].rigid) continue;
      if (std::find(v.parts.begin(), v.parts.end(), p) != v.parts.end()) continue;
      const auto nodes = nodes_of_part(p);
      if (!nodes.empty() &&
          std::all_of(nodes.begin(), nodes.end(), [&](int n) { return in[n] != 0; }))
        v.parts.push_back(p);
    }
  }
  model_.initial_velocities.push_back(std::move(v));
}

void Resolver::read_initial_velocity(const Card& card) {
  const int system = reference("coordinate_system", card.id("icid"));
  InitialVelocity v;
  v.nodes = selected_nodes(card.id("nsid"), card.id("nsidex"), card.id("boxid"));
  v.velocity = to_global(system, triple(card, "vx", "vy", "vz"));
  v.angular_velocity = to_global(system, triple(card, "vxr", "vyr", "vzr"));
  v.override_inertia = card.integer("irigid") == 1 || card.integer("irigid") == -1;
  v.rigid_bodies_only = card.integer("irigid") == -2;
  add_initial(std::move(v));

  // the excluded nodes have a velocity of their own
  if (const int s = reference("node_set", card.id("nsidex")); s >= 0) {
    InitialVelocity e;
    e.nodes = model_.node_sets[s].nodes;
    e.velocity = to_global(system, triple(card, "vxe", "vye", "vze"));
    e.angular_velocity = to_global(system, triple(card, "vxre", "vyre", "vzre"));
    add_initial(std::move(e));
  }
}

// Rows with equal velocities are gathered.
void Resolver::read_initial_node(const Card& card) {
  InitialVelocity v;
  for (int i = 0; i < card.row_count(); ++i) {
    const int n = node(to_id(card.row(i, 0)));
    if (n < 0) continue;
    const int system = reference("coordinate_system", to_id(card.row(i, 7)));
    const Vec3d velocity = to_global(system, row_triple(card, i, 1));
    const Vec3d angular = to_global(system, row_triple(card, i, 4));
    if (!v.nodes.empty() && !(equal(velocity, v.velocity) && equal(angular, v.angular_velocity))) {
      add_initial(v);
      v.nodes.clear(), v.parts.clear();
    }
    v.velocity = velocity, v.angular_velocity = angular;
    v.nodes.push_back(n);
  }
  if (!v.nodes.empty()) add_initial(std::move(v));
}

void Resolver::read_initial_generation(const Card& card) {
  InitialVelocity v;
  const std::int64_t id = card.id("id");
  const int type = card.integer("styp");
  std::vector<int> parts;
  if (id == 0) {
    v.nodes = set_or_all(0);
  } else if (type == 3) {
    v.nodes = set_or_all(id);
    if (reference("node_set", id) < 0)
      error(card, "id", "missing-set", "there is no node set " + std::to_string(id), "Define it");
  } else if (type == 2) {
    parts = {part(id)};
    if (parts[0] < 0)
      error(card, "id", "missing-part", "there is no part " + std::to_string(id), "Define it");
  } else {
    const int s = reference("part_set", id);
    if (s >= 0) parts = model_.part_sets[s].parts;
    if (s < 0)
      error(card, "id", "missing-set", "there is no part set " + std::to_string(id), "Define it");
  }
  if (!parts.empty()) v.nodes = nodes_of_parts(parts);
  for (int p : parts)
    if (p >= 0 && model_.parts[p].rigid) v.parts.push_back(p);

  // translation, and rotation about the axis n through the point
  const int system = reference("coordinate_system", card.id("icid"));
  v.velocity = to_global(system, triple(card, "vx", "vy", "vz"));
  v.point = triple(card, "xc", "yc", "zc");
  Vec3d axis = triple(card, "nx", "ny", "nz");
  if (axis.x == -999) {
    const int from = node(to_id(axis.y)), to = node(to_id(axis.z));
    axis = from >= 0 && to >= 0 ? model_.nodes.x[to] - model_.nodes.x[from] : Vec3d{0, 0, 0};
  } else {
    axis = to_global(system, axis);
  }
  const double omega = card.real("omega");
  if (omega != 0) {
    if (!(norm(axis) > 0))
      error(card, "nx", "missing-axis", "the axis of the rotation is not given", "Give NX, NY, NZ");
    else
      v.angular_velocity = (omega / norm(axis)) * axis;
    v.about_axis = true;
  }
  v.override_inertia = card.integer("irigid") == 1;
  add_initial(std::move(v));
}

void Resolver::read_initial_rigid(const Card& card) {
  for (int i = 0; i < card.row_count(); ++i) {
    InitialVelocity v;
    const int p = part(to_id(card.row(i, 0)));
    if (p < 0) continue;
    const int system = reference("coordinate_system", to_id(card.row(i, 7)));
    v.parts = {p};
    v.velocity = to_global(system, row_triple(card, i, 1));
    v.angular_velocity = to_global(system, row_triple(card, i, 4));
    v.rigid_bodies_only = true;
    v.override_inertia = true;
    model_.initial_velocities.push_back(std::move(v));
  }
}

void Resolver::read_body_parts(const Card& card) {
  if (const int s = reference("part_set", card.id("psid")); s >= 0)
    body_parts_.insert(body_parts_.end(), model_.part_sets[s].parts.begin(),
                       model_.part_sets[s].parts.end());
}

void Resolver::read_body_load(const Card& card) {
  const int axis = card.schema->name.back() - 'X';
  Vec3d direction{0, 0, 0};
  direction[axis] = 1;
  BodyLoad load;
  load.direction = to_global(reference("coordinate_system", card.id("cid")), direction);
  load.curve = curve(card, "lcid");
  load.scale = nonzero(card, "sf", 1);
  load.parts = body_parts_;
  model_.body_loads.push_back(std::move(load));
}

void Resolver::read_node_load(const Card& card) {
  const std::string_view name = card.schema->name;
  for (int i = 0; i < card.row_count(); ++i) {
    NodalLoad load;
    load.where = card.where_of_row(i);
    const auto id = to_id(card.row(i, 0));
    if (name == "LOAD_RIGID_BODY")
      load.part = part(id);
    else if (name == "LOAD_NODE_SET")
      load.nodes = set_or_all(id);
    else if (const int n = node(id); n >= 0)
      load.nodes = {n};
    load.dof = to_int(card.row(i, 1));
    load.curve = reference("curve", to_id(card.row(i, 2)));
    load.scale = card.row(i, 3) != 0 ? card.row(i, 3) : 1;
    load.local_system = reference("coordinate_system", to_id(card.row(i, 4)));
    for (int k = 0; k < 3; ++k) load.follower[k] = node(to_id(card.row(i, 5 + k)));
    model_.nodal_loads.push_back(std::move(load));
  }
}

// Pressures with the same curve are gathered.
void Resolver::add_pressure(const PressureLoad& load) {
  auto& list = model_.pressure_loads;
  if (!list.empty() && list.back().curve == load.curve && list.back().scale == load.scale &&
      list.back().arrival == load.arrival)
    list.back().segments.insert(list.back().segments.end(), load.segments.begin(),
                                load.segments.end());
  else
    list.push_back(load);
}

void Resolver::read_segment_load(const Card& card) {
  PressureLoad load;
  load.curve = curve(card, "lcid");
  load.scale = nonzero(card, "sf", 1), load.arrival = card.real("at");
  if (card.schema->name == "LOAD_SEGMENT_SET") {
    if (const int s = reference("segment_set", card.id("ssid")); s >= 0)
      load.segments = model_.segment_sets[s].segments;
  } else {
    std::array<int, 4> s{node(card.id("n1")), node(card.id("n2")), node(card.id("n3")),
                         node(card.id("n4"))};
    if (s[3] < 0) s[3] = s[2];
    if (*std::min_element(s.begin(), s.end()) >= 0) load.segments.push_back(s);
  }
  add_pressure(load);
}

void Resolver::read_shell_load(const Card& card) {
  PressureLoad load;
  load.curve = curve(card, "lcid");
  load.scale = nonzero(card, "sf", 1), load.arrival = card.real("at");
  if (card.schema->name == "LOAD_SHELL_SET") {
    if (const int s = reference("shell_set", card.id("esid")); s >= 0)
      for (int e : model_.element_sets[s].elements) load.segments.push_back(model_.shells.node[e]);
  } else {
    const int e = table("shell").find(card.id("eid"));
    if (e >= 0) load.segments.push_back(model_.shells.node[e]);
    if (e < 0)
      error(card, "eid", "missing-element", "there is no shell " + std::to_string(card.id("eid")),
            "Correct the id");
  }
  add_pressure(load);
}

void Resolver::read_global_damping(const Card& card) {
  Damping d;
  d.curve = curve(card, "lcid");
  d.value = card.real("valdmp");
  const char* fields[6] = {"stx", "sty", "stz", "srx", "sry", "srz"};
  bool any = false;
  for (int k = 0; k < 6; ++k) {
    d.scale[k] = card.real(fields[k]);
    any |= d.scale[k] != 0;
  }
  if (!any) d.scale.fill(1);
  model_.global_damping.push_back(d);
}

void Resolver::read_part_damping(const Card& card) {
  const std::string_view name = card.schema->name;
  PartDamping d;
  if (name == "DAMPING_PART_MASS") {
    if (const int p = part(card.id("pid")); p >= 0) d.parts = {p};
    d.mass_curve = curve(card, "lcid");
    d.mass_scale = nonzero(card, "sf", 1);
    model_.part_damping.push_back(std::move(d));
    return;
  }
  for (int i = 0; i < card.row_count(); ++i) {
    const auto id = to_id(card.row(i, 0));
    d.parts.clear();
    if (name.ends_with("_SET")) {
      if (const int s = reference("part_set", id); s >= 0) d.parts = model_.part_sets[s].parts;
    } else if (const int p = part(id); p >= 0) {
      d.parts = {p};
    }
    d.stiffness = card.row(i, 1);
    if (!d.parts.empty()) model_.part_damping.push_back(d);
  }
}

}  // namespace fabrica
