// What belongs to which rigid body, and the mass properties of bodies.
//   M = sum m,  x = sum m x_A / M,  I = sum m (r.r 1 - r r^T) + J_A 1
#include <algorithm>
#include <numeric>
#include <string>

#include "solver/rigid_bodies.h"

namespace fabrica {

namespace {

constexpr const char* nodal_keyword = "CONSTRAINED_NODAL_RIGID_BODY";

Mat3d sphere_shift(double mass, const Vec3d& r) {
  Mat3d m;
  const double rr = dot(r, r);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = mass * ((i == j ? rr : 0) - r[i] * r[j]);
  return m;
}

int root_of(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

RigidBodies::RigidBodies(const Model& model, State& state, Diagnostics& diagnostics)
    : model_(model),
      node_to_body_(model.nodes.size(), -1),
      part_to_body_(model.parts.size(), -1),
      motion_angle_(model.prescribed_motions.size(), 0),
      motion_reaction_(model.prescribed_motions.size(), 0) {
  std::vector<Seed> seeds;
  collect_parts(seeds);
  collect_nodal(seeds, diagnostics);
  merge(seeds, state, diagnostics);
  check_motions(diagnostics);
}

void RigidBodies::collect_parts(std::vector<Seed>& seeds) {
  const int n_parts = int(model_.parts.size());
  std::vector<int> seed_of(n_parts, -1);
  for (int p = 0; p < n_parts; ++p)
    if (model_.parts[p].rigid) seed_of[p] = int(seeds.size()), seeds.push_back({p, -1, {}});
  auto add = [&](int part, int node) {
    if (node >= 0 && part >= 0 && seed_of[part] >= 0) seeds[seed_of[part]].nodes.push_back(node);
  };
  for (int e = 0; e < model_.solids.size(); ++e)
    for (int n : model_.solids.node[e]) add(model_.solids.part[e], n);
  for (int e = 0; e < model_.shells.size(); ++e)
    for (int n : model_.shells.node[e]) add(model_.shells.part[e], n);
  for (int e = 0; e < model_.beams.size(); ++e)
    for (int i = 0; i < 2; ++i) add(model_.beams.part[e], model_.beams.node[e][i]);
  for (const ExtraNodes& x : model_.extra_nodes)
    for (int n : x.nodes) add(x.part, n);
  for (Seed& s : seeds) {
    std::sort(s.nodes.begin(), s.nodes.end());
    s.nodes.erase(std::unique(s.nodes.begin(), s.nodes.end()), s.nodes.end());
  }
}

void RigidBodies::collect_nodal(std::vector<Seed>& seeds, Diagnostics& diagnostics) {
  for (int i = 0; i < int(model_.nodal_rigid_bodies.size()); ++i) {
    Seed s{-1, i, model_.nodal_rigid_bodies[i].nodes};
    std::sort(s.nodes.begin(), s.nodes.end());
    s.nodes.erase(std::unique(s.nodes.begin(), s.nodes.end()), s.nodes.end());
    if (s.nodes.empty()) {
      diagnostics.warning(
          "empty-rigid-body", {}, nodal_keyword, "NSID",
          "nodal rigid body " + std::to_string(model_.nodal_rigid_bodies[i].id) + " has no nodes");
      continue;
    }
    seeds.push_back(std::move(s));
  }
}

// Bodies named by *CONSTRAINED_RIGID_BODIES and bodies that share nodes become one.
void RigidBodies::merge(std::vector<Seed>& seeds, State& state, Diagnostics& diagnostics) {
  const int n = int(seeds.size());
  std::vector<int> parent(n), seed_of_part(model_.parts.size(), -1),
      seed_of_node(model_.nodes.size(), -1);
  std::iota(parent.begin(), parent.end(), 0);
  for (int i = 0; i < n; ++i)
    if (seeds[i].part >= 0) seed_of_part[seeds[i].part] = i;
  for (const RigidMerge& m : model_.rigid_merges) {
    const int lead = m.lead >= 0 ? seed_of_part[m.lead] : -1;
    const int other = m.constrained >= 0 ? seed_of_part[m.constrained] : -1;
    if (lead < 0 || other < 0) {
      diagnostics.error("merge-of-deformable-part", {}, "CONSTRAINED_RIGID_BODIES",
                        lead < 0 ? "PIDM" : "PIDS", "one of the parts to merge is not rigid",
                        "give it *MAT_RIGID");
      continue;
    }
    const int a = root_of(parent, lead), b = root_of(parent, other);
    if (a != b) parent[b] = a;
  }
  for (int i = 0; i < n; ++i) {
    std::erase_if(seeds[i].nodes, [&](int node) {
      int& owner = seed_of_node[node];
      if (owner < 0) return owner = i, false;
      const int a = root_of(parent, owner), b = root_of(parent, i);
      if (a != b) {
        parent[b] = a;
        diagnostics.warning("rigid-bodies-share-nodes", {}, nodal_keyword, "",
                            "node " + std::to_string(model_.nodes.id[node]) +
                                " belongs to two rigid bodies; they are treated as one");
      }
      return true;
    });
  }
  // bodies in the order of their leads
  std::vector<int> body_of(n, -1);
  for (int i = 0; i < n; ++i)
    if (root_of(parent, i) == i) body_of[i] = int(seeds_.size()), seeds_.push_back({seeds[i]});
  for (int i = 0; i < n; ++i) {
    const int root = root_of(parent, i), b = body_of[root];
    if (seeds[i].part >= 0) part_to_body_[seeds[i].part] = b;
    if (root != i) seeds_[b].push_back(seeds[i]);
    for (int node : seeds[i].nodes) node_to_body_[node] = b, state.owner[node] = NodeOwner::rigid;
  }
}

bool RigidBodies::add_node(State& state, int part, int node) {
  const int b = part_to_body_[part];
  if (b < 0) return false;
  if (node_to_body_[node] == b) return true;
  if (node_to_body_[node] >= 0 || state.owner[node] != NodeOwner::free) return false;
  for (Seed& s : seeds_[b])
    if (s.part == part) s.nodes.push_back(node);
  node_to_body_[node] = b;
  state.owner[node] = NodeOwner::rigid;
  return true;
}

void RigidBodies::check_motions(Diagnostics& diagnostics) {
  motions_.resize(seeds_.size());
  for (int i = 0; i < int(model_.prescribed_motions.size()); ++i) {
    const PrescribedMotion& m = model_.prescribed_motions[i];
    if (m.target != PrescribedMotion::Target::rigid_body) continue;
    const int b = m.part >= 0 ? part_to_body_[m.part] : -1;
    const int lead = m.lead >= 0 ? part_to_body_[m.lead] : -1;
    const bool known = m.dof >= 1 && m.dof <= 8 && m.kind >= 0 && m.kind <= 4 && m.curve >= 0;
    if (b < 0)
      diagnostics.error("motion-of-deformable-part", m.where, "BOUNDARY_PRESCRIBED_MOTION_RIGID",
                        "PID", "the part is not rigid", "use *BOUNDARY_PRESCRIBED_MOTION_SET");
    else if (!known)
      diagnostics.error("unsupported-motion", m.where, "BOUNDARY_PRESCRIBED_MOTION_RIGID", "DOF",
                        "DOF " + std::to_string(m.dof) + " with VAD " + std::to_string(m.kind) +
                            " is not supported",
                        "use DOF 1-8 and VAD 0 to 4 with a curve");
    else if (m.kind == 4 && (lead < 0 || lead == b))
      diagnostics.error("motion-without-lead", m.where, "BOUNDARY_PRESCRIBED_MOTION_RIGID", "LRB",
                        "the lead is not another rigid body",
                        "name a part of *MAT_RIGID from whose centre the motion is measured");
    else
      motions_[b].push_back(i);
  }
}

const InertiaOverride* RigidBodies::override_of(const Seed& seed) const {
  const auto& given = seed.part >= 0 ? model_.parts[seed.part].inertia
                                     : model_.nodal_rigid_bodies[seed.nodal].inertia;
  return given ? &*given : nullptr;
}

RigidBodies::Mass RigidBodies::given_mass(const InertiaOverride& given) const {
  Mass m;
  m.mass = given.mass;
  m.center = given.node >= 0 ? model_.nodes.x[given.node] : given.center;
  const auto& i = given.inertia;
  m.inertia = {{{i[0], i[1], i[2]}, {i[1], i[3], i[4]}, {i[2], i[4], i[5]}}};
  if (given.local_system >= 0) {
    const Mat3d& axes = model_.coordinate_systems[given.local_system].axes;
    m.inertia = transpose(axes) * m.inertia * axes;
  }
  return m;
}

RigidBodies::Mass RigidBodies::mass_of(const State& state, const Seed& seed) const {
  if (const InertiaOverride* given = override_of(seed)) return given_mass(*given);
  Mass m;
  for (int n : seed.nodes) {
    m.mass += state.nodes[n].mass;
    m.center += state.nodes[n].mass * state.nodes[n].x;
  }
  if (m.mass > 0) m.center = (1 / m.mass) * m.center;
  for (int n : seed.nodes) {
    m.inertia = m.inertia + sphere_shift(state.nodes[n].mass, state.nodes[n].x - m.center);
    if (!state.spins.empty())
      for (int k = 0; k < 3; ++k) m.inertia(k, k) += state.spins[n].inertia;
  }
  for (const NodalInertia& own : model_.inertias) {
    if (!std::binary_search(seed.nodes.begin(), seed.nodes.end(), own.node)) continue;
    // in place of its mean, which the node carries
    const auto& i = own.inertia;
    const double mean = (i[0] + i[3] + i[5]) / 3;
    m.inertia =
        m.inertia +
        Mat3d{{{i[0] - mean, i[1], i[2]}, {i[1], i[3] - mean, i[4]}, {i[2], i[4], i[5] - mean}}};
  }
  return m;
}

void RigidBodies::set_principal(RigidBody& body, const Mass& mass, Diagnostics& diagnostics) {
  const PrincipalAxes p = principal_axes(mass.inertia);
  body.motion.mass = mass.mass;
  body.motion.x = mass.center;
  body.motion.q = quaternion_of(p.axes);
  body.motion.inertia = p.value;
  const double largest = std::max({p.value.x, p.value.y, p.value.z});
  // a body without extent only translates: any inertia will do
  if (!(largest > 0)) body.motion.inertia = {mass.mass, mass.mass, mass.mass};
  bool floored = false;
  for (int k = 0; k < 3; ++k)
    if (largest > 0 && body.motion.inertia[k] < 1e-4 * largest)
      body.motion.inertia[k] = 1e-4 * largest, floored = true;
  if (floored)
    diagnostics.warning(
        "slender-rigid-body", {}, body.part >= 0 ? "PART" : nodal_keyword, "",
        "the nodes of rigid body " + std::to_string(body.id) +
            " lie on a line; its inertia about the line is set to 1e-4 of the largest one");
  if (!(mass.mass > 0))
    diagnostics.error("rigid-body-without-mass", {}, body.part >= 0 ? "PART" : nodal_keyword, "",
                      "rigid body " + std::to_string(body.id) + " has no mass",
                      "give it density, nodes or inertia");
}

void RigidBodies::finish(const State& state, Diagnostics& diagnostics) {
  bodies_.assign(seeds_.size(), {});
  for (std::size_t b = 0; b < seeds_.size(); ++b) {
    RigidBody& body = bodies_[b];
    const Seed& lead = seeds_[b].front();
    body.part = lead.part, body.nodal = lead.nodal;
    body.id =
        lead.part >= 0 ? model_.parts[lead.part].id : model_.nodal_rigid_bodies[lead.nodal].id;
    for (Seed& s : seeds_[b]) {
      std::sort(s.nodes.begin(), s.nodes.end());
      body.nodes.insert(body.nodes.end(), s.nodes.begin(), s.nodes.end());
    }
    // the lead's given properties stand for the whole; else sum about the common centre
    Mass total = mass_of(state, lead);
    if (!override_of(lead) && seeds_[b].size() > 1) {
      std::vector<Mass> each;
      for (const Seed& s : seeds_[b]) each.push_back(mass_of(state, s));
      total = {};
      for (const Mass& m : each) total.mass += m.mass, total.center += m.mass * m.center;
      total.center = (1 / total.mass) * total.center;
      for (const Mass& m : each)
        total.inertia = total.inertia + m.inertia + sphere_shift(m.mass, m.center - total.center);
    }
    set_principal(body, total, diagnostics);
    body.start_x = body.motion.x, body.start_q = body.motion.q;
    const Mat3d back = transpose(matrix_of(body.motion.q));
    for (int n : body.nodes) body.r.push_back(back * (state.nodes[n].x - body.motion.x));
    if (const InertiaOverride* given = override_of(lead)) {
      body.overridden = true;
      Vec3d v = given->velocity, w = given->angular_velocity;
      if (given->local_system >= 0) {
        const Mat3d out = transpose(model_.coordinate_systems[given->local_system].axes);
        v = out * v, w = out * w;
      }
      set_velocity(int(b), v, w);
    }
  }
  collect_supports(diagnostics);
  components_known_ = false;
  make_chunks();
}

void RigidBodies::make_chunks() {
  constexpr int chunk_nodes = 1024;
  chunks_.clear();
  for (int b = 0; b < size(); ++b)
    for (int i = 0; i < int(bodies_[b].nodes.size()); i += chunk_nodes)
      chunks_.push_back({b, i, std::min(i + chunk_nodes, int(bodies_[b].nodes.size()))});
  partial_.assign(2 * chunks_.size(), {});
}

}  // namespace fabrica
