// Checks over the whole model: element shape, mass of nodes, competing constraints, joints, end of
// the run.
#include <algorithm>
#include <map>
#include <numeric>

#include "model/geometry.h"
#include "model/resolve.h"

namespace fabrica {
namespace {

double solid_volume(const Model& model, int e) {
  const auto& n = model.solids.node[e];
  std::array<int, 8> c{};
  const bool ten = n[8] >= 0;
  const int distinct = ten ? 4 : distinct_corners(n, c);
  if (ten) c = {0, 1, 2, 3};
  const auto x = [&](int k) { return model.nodes.x[n[k]]; };
  if (distinct < 4) return 0;
  if (distinct == 4) return tet_volume(x(c[0]), x(c[1]), x(c[2]), x(c[3]));
  Vec3d corners[8];
  for (int k = 0; k < 8; ++k) corners[k] = x(k);
  return brick_volume(corners);
}

// whether a deformable brick of eight points is folded at one of them
bool is_folded(const Model& model, int e) {
  const auto& n = model.solids.node[e];
  const int p = model.solids.part[e];
  std::array<int, 8> c{};
  if (p < 0 || model.parts[p].rigid || model.parts[p].section < 0 || n[8] >= 0) return false;
  const int formulation = model.sections[model.parts[p].section].formulation;
  if ((formulation != 2 && formulation >= 0) || distinct_corners(n, c) != 8) return false;
  Vec3d x[8];
  for (int k = 0; k < 8; ++k) x[k] = model.nodes.x[n[k]];
  return !(smallest_jacobian(x) > 0);
}

int root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

void Resolver::check_mesh() {
  auto& staging = builder_.staging_;
  const auto report = [&](const char* name, Location where, const char* keyword, std::int64_t id,
                          const char* what) {
    if (may_report(name))
      diagnostics_.error(name, where, keyword, "eid", "element " + std::to_string(id) + " " + what,
                         "Correct the node order or the positions of its nodes");
  };
  for (int e = 0; e < model_.solids.size(); ++e) {
    const auto& n = model_.solids.node[e];
    const int corners = n[8] >= 0 ? 4 : 8;  // those of ten nodes that make the volume
    if (*std::min_element(n.begin(), n.begin() + corners) < 0) continue;
    const double v = solid_volume(model_, e);
    if (v < 0)
      report("negative-volume", staging.solid_where[e], "ELEMENT_SOLID", model_.solids.id[e],
             "is inverted: its volume is negative");
    else if (!(v > 0))
      report("degenerate-element", staging.solid_where[e], "ELEMENT_SOLID", model_.solids.id[e],
             "has no volume");
    else if (is_folded(model_, e) && may_report("negative-jacobian"))
      diagnostics_.error("negative-jacobian", staging.solid_where[e], "ELEMENT_SOLID", "eid",
                         "element " + std::to_string(model_.solids.id[e]) +
                             " is folded: its Jacobian is negative at an integration point",
                         "Correct its shape, or use ELFORM 1, which has one point");
  }
  for (int e = 0; e < model_.shells.size(); ++e) {
    const auto& n = model_.shells.node[e];
    if (*std::min_element(n.begin(), n.end()) < 0) continue;
    Vec3d x[4];
    for (int k = 0; k < 4; ++k) x[k] = model_.nodes.x[n[k]];
    if (!(quad_area(x) > 0))
      report("degenerate-element", staging.shell_where[e], "ELEMENT_SHELL", model_.shells.id[e],
             "has no area");
  }
  for (int e = 0; e < model_.beams.size(); ++e) {
    const auto& n = model_.beams.node[e];
    const int p = model_.beams.part[e];
    if (n[0] < 0 || n[1] < 0 || p < 0 || model_.parts[p].section < 0) continue;
    const bool discrete = model_.sections[model_.parts[p].section].formulation == 6;
    if (!discrete && !(norm(model_.nodes.x[n[1]] - model_.nodes.x[n[0]]) > 0))
      report("degenerate-element", staging.beam_where[e], "ELEMENT_BEAM", model_.beams.id[e],
             "has no length");
  }
}

// A node that an element pulls on must have mass, be held, or belong to a rigid body.
void Resolver::check_mass() {
  std::vector<std::uint8_t> used(model_.nodes.id.size(), 0), heavy(model_.nodes.id.size(), 0);
  std::vector<int> nodes;
  for (int p = 0; p < int(model_.parts.size()); ++p) {
    const Part& part = model_.parts[p];
    const bool mass = part.material >= 0 && model_.materials[part.material].density > 0;
    for (int f = 1; f < 5; ++f)
      for (int e : elements_of_part(Family(f), p)) {
        nodes.clear();
        element_nodes(Family(f), e, nodes);
        for (int n : nodes) used[n] = 1, heavy[n] |= mass && Family(f) != Family::discrete;
      }
  }
  for (const NodalMass& m : model_.masses)
    if (m.node >= 0 && m.mass > 0) heavy[m.node] = 1;
  for (const NodalInertia& m : model_.inertias)
    if (m.node >= 0 && m.mass > 0) heavy[m.node] = 1;
  for (const ExtraNodes& e : model_.extra_nodes)
    for (int n : e.nodes) heavy[n] = 1;
  for (const NodalRigidBody& b : model_.nodal_rigid_bodies)
    for (int n : b.nodes) heavy[n] = 1;
  for (const SinglePointConstraint& c : model_.constraints)
    if (c.fixed[0] && c.fixed[1] && c.fixed[2])
      for (int n : c.nodes) heavy[n] = 1;
  for (int n = 0; n < model_.nodes.size(); ++n)
    if (used[n] && !heavy[n] && model_.nodes.translation_code[n] != 7 &&
        may_report("node-without-mass"))
      diagnostics_.warning(
          "node-without-mass", builder_.staging_.node_where[n], "NODE", "nid",
          "node " + std::to_string(model_.nodes.id[n]) + " belongs to an element but has no mass",
          "Add *ELEMENT_MASS, or hold the node");
}

// Rigid parts that share three nodes or more can only move together: they are merged. (Fewer shared
// nodes would make a hinge, which is reported with the other conflicts.)
void Resolver::merge_touching_parts(std::vector<int>& parent) {
  std::vector<int> owner(model_.nodes.id.size(), -1);
  std::map<std::pair<int, int>, int> shared;
  for (int p = 0; p < int(model_.parts.size()); ++p)
    if (model_.parts[p].rigid)
      for (int n : nodes_of_part(p)) {
        if (owner[n] >= 0) ++shared[{owner[n], p}];
        owner[n] = owner[n] >= 0 ? owner[n] : p;
      }
  for (const auto& [pair, count] : shared) {
    const int a = root(parent, pair.first), b = root(parent, pair.second);
    if (a == b || count < 3) continue;
    const auto id = [&](int p) { return std::to_string(model_.parts[p].id); };
    diagnostics_.warning("two-constraints-on-node", model_.parts[pair.second].where, "PART", "pid",
                         "rigid parts " + id(pair.first) + " and " + id(pair.second) + " share " +
                             std::to_string(count) + " nodes and move as one body",
                         "State it with *CONSTRAINED_RIGID_BODIES, or separate their nodes");
    model_.rigid_merges.push_back({a, b});
    parent[b] = a;
  }
}

// Every node may belong to one rigid body, and rigid nodes are not held or driven one by one.
void Resolver::check_rigid_nodes() {
  const int parts = int(model_.parts.size());
  std::vector<int> parent(model_.parts.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const RigidMerge& m : model_.rigid_merges)
    parent[root(parent, m.constrained)] = root(parent, m.lead);
  merge_touching_parts(parent);

  node_to_rigid_.assign(model_.nodes.id.size(), -1);
  const auto claim = [&](int n, int body, const std::string& owner) {
    if (node_to_rigid_[n] >= 0 && node_to_rigid_[n] != body &&
        may_report("two-constraints-on-node"))
      diagnostics_.error("two-constraints-on-node", builder_.staging_.node_where[n], "", "",
                         "node " + std::to_string(model_.nodes.id[n]) + " of " + owner +
                             " already belongs to another rigid body",
                         "Merge the two with *CONSTRAINED_RIGID_BODIES, or separate their nodes");
    node_to_rigid_[n] = body;
  };
  for (int p = 0; p < parts; ++p)
    if (model_.parts[p].rigid)
      for (int n : nodes_of_part(p))
        claim(n, root(parent, p), "part " + std::to_string(model_.parts[p].id));
  for (const ExtraNodes& e : model_.extra_nodes)
    for (int n : e.nodes)
      claim(n, root(parent, e.part), "part " + std::to_string(model_.parts[e.part].id));
  for (int b = 0; b < int(model_.nodal_rigid_bodies.size()); ++b)
    for (int n : model_.nodal_rigid_bodies[b].nodes)
      claim(n, parts + b, "a nodal rigid body or weld");

  const auto held = [&](int n, const char* keyword, const char* what) {
    if (node_to_rigid_[n] >= 0 && node_to_rigid_[n] < parts &&
        may_report("two-constraints-on-node"))
      diagnostics_.warning(
          "two-constraints-on-node", builder_.staging_.node_where[n], keyword, "",
          "node " + std::to_string(model_.nodes.id[n]) + " of a rigid body is " + what + " alone",
          "Constrain the body by CMO, CON1 and CON2 of *MAT_RIGID, or move it by "
          "*BOUNDARY_PRESCRIBED_MOTION_RIGID");
  };
  for (const SinglePointConstraint& c : model_.constraints)
    for (int n : c.nodes) held(n, "BOUNDARY_SPC", "held");
  check_motions_of_rigid_nodes();
}

// A node of a rigid body goes where its body goes.
void Resolver::check_motions_of_rigid_nodes() {
  for (std::size_t i = 0; i < motion_cards_.size(); ++i) {
    const Card& card = *motion_cards_[i];
    PrescribedMotion& m = model_.prescribed_motions[i];
    int count = 0, first = -1;
    for (const int n : m.nodes)
      if (node_to_rigid_[n] >= 0 && ++count == 1) first = n;
    m.rigid_nodes = count;
    if (count == 0) continue;
    const bool part = node_to_rigid_[first] < int(model_.parts.size());
    unsupported(card, card.has_field("nid") ? "nid" : "nsid", "motion-of-rigid-node",
                std::to_string(count) + " of " + std::to_string(m.nodes.size()) +
                    " nodes belong to rigid bodies, node " +
                    std::to_string(model_.nodes.id[first]) + " first, and cannot be moved alone",
                part ? "Move the body by *BOUNDARY_PRESCRIBED_MOTION_RIGID, and take its nodes out "
                       "of the set"
                     : "Take the nodes of nodal rigid bodies and welds out of the set");
  }
}

// Odd nodes on one body, even nodes on another; the first pair in one place.
void Resolver::check_joints() {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const Vec3d& x : model_.nodes.x)
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
  const double tolerance = 1e-4 * (model_.nodes.size() > 0 ? norm(high - low) : 1);

  std::size_t j = 0;
  for (const auto& owned : model_.cards) {
    const Card& card = *owned;
    if (!card.schema || !card.schema->name.starts_with("CONSTRAINED_JOINT_") ||
        card.schema->support != Support::full)
      continue;
    if (j >= model_.joints.size()) break;
    const Joint& joint = model_.joints[j++];
    int body[2] = {-1, -1};
    for (int k = 0; k < 6; ++k) {
      const int n = joint.node[k];
      if (n < 0) continue;
      const int b = node_to_rigid_[n];
      if (b < 0 || (body[k % 2] >= 0 && body[k % 2] != b))
        error(card, "n" + std::to_string(k + 1), "joint-not-on-rigid-bodies",
              "node " + std::to_string(model_.nodes.id[n]) +
                  (b < 0 ? " is on no rigid body" : " is on another body than its side"),
              "Nodes 1, 3, 5 belong to one rigid body, 2, 4, 6 to another; add them with "
              "*CONSTRAINED_EXTRA_NODES");
      body[k % 2] = b;
    }
    const int a = joint.node[0], b = joint.node[1];
    const bool together = joint.kind != JointKind::cylindrical &&
                          joint.kind != JointKind::translational && joint.kind != JointKind::planar;
    if (together && a >= 0 && b >= 0 && norm(model_.nodes.x[a] - model_.nodes.x[b]) > tolerance)
      warning(card, "n1", "joint-nodes-apart",
              "nodes " + std::to_string(model_.nodes.id[a]) + " and " +
                  std::to_string(model_.nodes.id[b]) + " do not coincide",
              "Move one onto the other");
  }
}

void Resolver::check_termination() {
  if (model_.controls.end_time > 0 || model_.controls.end_cycle > 0) return;
  // a file that is missing may hold it
  const Severity severity = files_missing_ ? Severity::warning : Severity::error;
  diagnostics_.add({severity,
                    "no-termination",
                    {0, 1},
                    "CONTROL_TERMINATION",
                    "endtim",
                    "the run has no end time",
                    "Give *CONTROL_TERMINATION with ENDTIM"});
}

}  // namespace fabrica
