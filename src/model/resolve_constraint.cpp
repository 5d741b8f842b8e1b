// Rigid bodies, welds, joints, supports and prescribed motions.
#include <algorithm>
#include <cstdlib>

#include "model/resolve.h"

namespace fabrica {

void Resolver::read_rigid_bodies(const Card& card) {
  for (int i = 0; i < card.row_count(); ++i) {
    const int lead = part(to_id(card.row(i, 0)));
    const int constrained = part(to_id(card.row(i, 1)));
    if (lead < 0 || constrained < 0) continue;
    for (int p : {lead, constrained})
      if (!model_.parts[p].rigid)
        error(card, "", "part-not-rigid",
              "part " + std::to_string(model_.parts[p].id) + " is not rigid",
              "Only rigid parts can be merged: give it *MAT_RIGID");
    model_.rigid_merges.push_back({lead, constrained});
  }
}

void Resolver::read_extra_nodes(const Card& card) {
  const bool by_set = card.schema->name.ends_with("_SET");
  for (int i = 0; i < card.row_count(); ++i) {
    ExtraNodes e;
    e.part = part(to_id(card.row(i, 0)));
    const auto id = to_id(card.row(i, 1));
    if (e.part < 0 || id == 0) continue;
    if (by_set)
      e.nodes = set_or_all(id);
    else if (const int n = node(id); n >= 0)
      e.nodes = {n};
    if (!model_.parts[e.part].rigid)
      error(card, "", "part-not-rigid",
            "part " + std::to_string(model_.parts[e.part].id) + " is not rigid",
            "Extra nodes belong to rigid parts: give it *MAT_RIGID");
    // rows for one body are gathered
    auto& list = model_.extra_nodes;
    if (!list.empty() && list.back().part == e.part)
      list.back().nodes.insert(list.back().nodes.end(), e.nodes.begin(), e.nodes.end());
    else
      list.push_back(std::move(e));
  }
}

void Resolver::read_nodal_rigid_body(const Card& card) {
  NodalRigidBody b;
  b.id = card.id("pid");
  b.nodes = set_or_all(card.id("nsid") != 0 ? card.id("nsid") : b.id);
  b.local_system = reference("coordinate_system", card.id("cid"));
  b.pnode = node(card.id("pnode"));
  if (card.has_option("SPC")) {
    b.cmo = card.integer("cmo");
    b.con1 = card.integer("con1"), b.con2 = card.integer("con2");
    if (b.cmo == -1) b.local_system = reference("coordinate_system", b.con1);
  }
  if (card.has_option("INERTIA")) b.inertia = read_inertia(card, "cid2");
  if (b.nodes.empty())
    error(card, "nsid", "missing-set", "nodal rigid body " + std::to_string(b.id) + " has no nodes",
          "Give a node set");
  model_.nodal_rigid_bodies.push_back(std::move(b));
}

namespace {

void set_failure(const Card& card, NodalRigidBody& b, std::string_view time) {
  b.normal_force = card.real("sn"), b.shear_force = card.real("ss");
  b.normal_exponent = nonzero(card, "n", 2), b.shear_exponent = nonzero(card, "m", 2);
  const double t = card.real(time);
  if (t > 0 && t < 1e19) b.failure_time = t;
}

}  // namespace

void Resolver::read_spotweld(const Card& card) {
  NodalRigidBody b;
  b.kind = NodalRigidBody::Kind::spotweld;
  b.id = card.has_option("ID") ? card.id("wid") : 0;
  for (const char* field : {"n1", "n2"})
    if (const int n = node(card.id(field)); n >= 0) b.nodes.push_back(n);
  set_failure(card, b, "tf");
  if (b.nodes.size() == 2) model_.nodal_rigid_bodies.push_back(std::move(b));
}

void Resolver::read_generalized_spot(const Card& card) {
  NodalRigidBody b;
  b.kind = NodalRigidBody::Kind::generalized_spot;
  b.id = card.has_option("ID") ? card.id("wid") : 0;
  b.nodes = set_or_all(card.id("nsid"));
  b.local_system = reference("coordinate_system", card.id("cid"));
  set_failure(card, b, "tfail");
  if (b.nodes.size() >= 2) model_.nodal_rigid_bodies.push_back(std::move(b));
}

void Resolver::read_joint(const Card& card) {
  static const std::pair<std::string_view, JointKind> kinds[] = {
      {"SPHERICAL", JointKind::spherical},
      {"REVOLUTE", JointKind::revolute},
      {"CYLINDRICAL", JointKind::cylindrical},
      {"PLANAR", JointKind::planar},
      {"TRANSLATIONAL", JointKind::translational},
      {"UNIVERSAL", JointKind::universal},
      {"LOCKING", JointKind::locking}};
  const auto stem = std::string_view(card.schema->name).substr(18);
  for (const auto& [word, kind] : kinds) {
    if (word != stem) continue;
    Joint j{};
    j.kind = kind;
    j.id = card.has_option("ID") ? card.id("jid") : 0;
    if (j.id == 0) j.id = std::int64_t(model_.joints.size()) + 1;
    j.title = card.has_option("ID") ? std::string(card.text("heading")) : card.title;
    for (int k = 0; k < 6; ++k) j.node[k] = node(card.id("n" + std::to_string(k + 1)));
    j.penalty_scale = nonzero(card, "rps", 1);
    j.damping = nonzero(card, "damp", 1);
    const int needed = kind == JointKind::spherical ? 2
                       : kind == JointKind::revolute || kind == JointKind::cylindrical ||
                               kind == JointKind::planar || kind == JointKind::universal
                           ? 4
                           : 6;
    for (int k = 0; k < needed; ++k)
      if (card.id("n" + std::to_string(k + 1)) == 0)
        error(card, "n" + std::to_string(k + 1), "missing-node", "the joint needs this node",
              "Give the node");
    model_.joints.push_back(std::move(j));
  }
}

void Resolver::read_spc(const Card& card) {
  SinglePointConstraint c;
  c.where = card.where;
  const bool by_set = card.schema->name.ends_with("_SET");
  c.nodes = by_set ? set_or_all(card.id("nsid")) : std::vector<int>{node(card.id("nid"))};
  std::erase(c.nodes, -1);
  c.local_system = reference("coordinate_system", card.id("cid"));
  const char* fields[6] = {"dofx", "dofy", "dofz", "dofrx", "dofry", "dofrz"};
  for (int k = 0; k < 6; ++k) c.fixed[k] = card.integer(fields[k]) != 0;
  if (card.has_option("BIRTH_DEATH")) {
    c.birth = card.real("birth");
    c.death = nonzero(card, "death", 1e28);
  }

  // single nodes with equal constraints are gathered
  auto& list = model_.constraints;
  if (!list.empty()) {
    auto& last = list.back();
    if (last.local_system == c.local_system && last.fixed == c.fixed && last.birth == c.birth &&
        last.death == c.death) {
      last.nodes.insert(last.nodes.end(), c.nodes.begin(), c.nodes.end());
      return;
    }
  }
  list.push_back(std::move(c));
}

// The axis of rotations, the lead of relative motions, and what cannot be computed.
void Resolver::read_motion_extras(const Card& card, PrescribedMotion& m) {
  const bool rigid = m.target == PrescribedMotion::Target::rigid_body;
  const int dof = std::abs(m.dof);
  m.offset = {card.real("offset1"), card.real("offset2")};
  if (m.kind == 4) {
    m.lead = reference("part", card.id("lrb"));
    m.node = {node(card.id("node1")), node(card.id("node2"))};
    if (m.lead < 0 || !model_.parts[m.lead].rigid)
      error(card, "lrb", "missing-lead", "the lead rigid body of the relative motion is not given",
            "Give LRB, a rigid part");
  }
  const bool of_bodies = m.dof >= 1 && m.dof <= 8;
  const bool of_nodes = of_bodies || (dof >= 9 && dof <= 11) || m.dof == -4 || m.dof == -8;
  if (!(rigid ? of_bodies : of_nodes))
    unsupported(card, "dof", "unsupported-motion",
                "motion of degree of freedom " + std::to_string(m.dof) + " is not computed",
                rigid ? "Use 1 to 8" : "Use 1 to 11, -4 or -8 to -11");
  if (m.kind > (rigid ? 4 : dof >= 9 ? 2 : 3))
    unsupported(card, "vad", "unsupported-motion",
                "motion of kind VAD = " + std::to_string(m.kind) + " is not computed",
                rigid ? "Use 0 to 4" : "Use 0 (velocity), 1 (acceleration) or 2 (displacement)");
  if (m.kind == 3 && m.local)
    unsupported(card, "vad", "unsupported-motion",
                "velocity by displacement is not computed in the axes of a body",
                "Use *BOUNDARY_PRESCRIBED_MOTION_RIGID");
}

void Resolver::read_prescribed_motion(const Card& card) {
  const std::string_view name = card.schema->name;
  PrescribedMotion m;
  m.where = card.where;
  m.dof = card.integer("dof");
  m.kind = card.integer("vad");
  m.curve = curve(card, "lcid");
  m.scale = nonzero(card, "sf", 1);
  m.birth = card.real("birth"), m.death = nonzero(card, "death", 1e28);
  if (const int v = reference("vector", card.id("vid")); v >= 0) m.direction = vectors_[v];
  m.local = name.ends_with("_LOCAL");
  if (name.ends_with("_NODE")) {
    if (const int n = node(card.id("nid")); n >= 0) m.nodes = {n};
  } else if (name.ends_with("_SET")) {
    m.nodes = set_or_all(card.id("nsid"));
  } else {
    m.target = PrescribedMotion::Target::rigid_body;
    m.part = part(card.id("pid"));
    if (m.part >= 0 && !model_.parts[m.part].rigid)
      error(card, "pid", "part-not-rigid",
            "part " + std::to_string(card.id("pid")) + " is not rigid",
            "Use *BOUNDARY_PRESCRIBED_MOTION_SET for deformable parts");
  }
  read_motion_extras(card, m);
  if (m.kind != 4 && std::abs(m.dof) % 4 == 0 && !(norm(m.direction) > 0))
    error(card, "vid", "missing-vector", "the direction of the motion is not given",
          "Give VID and *DEFINE_VECTOR");
  model_.prescribed_motions.push_back(std::move(m));
  motion_cards_.push_back(&card);
}

}  // namespace fabrica
