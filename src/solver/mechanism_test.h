#pragma once
// Bodies made of point masses, for tests of constraints without elements.
#include <array>
#include <vector>

#include "model/model.h"
#include "model/state.h"
#include "solver/joints.h"
#include "solver/rigid_bodies.h"

namespace fabrica::mechanism {

struct Mechanism {
  Model model;
  State state;
  Diagnostics diagnostics;
  Team team{1};
  Vec3d gravity{};
  std::unique_ptr<RigidBodies> bodies;
  std::unique_ptr<Joints> joints;

  int node(const Vec3d& x) {
    model.nodes.id.push_back(model.nodes.size() + 1);
    model.nodes.x.push_back(x);
    model.nodes.translation_code.push_back(0);
    model.nodes.rotation_code.push_back(0);
    return model.nodes.size() - 1;
  }
  // a rigid part without elements whose nodes are extra nodes
  int part(const std::vector<int>& nodes) {
    Part p;
    p.id = std::int64_t(model.parts.size()) + 1;
    p.rigid = true;
    p.material = int(model.materials.size());
    Material m;
    m.rigid = true;
    model.materials.push_back(m);
    model.parts.push_back(p);
    model.extra_nodes.push_back({int(model.parts.size()) - 1, nodes});
    return int(model.parts.size()) - 1;
  }
  void inertia(int part, double mass, const Vec3d& center, const Vec3d& principal) {
    InertiaOverride i{};
    i.mass = mass, i.center = center;
    i.inertia = {principal.x, 0, 0, principal.y, 0, principal.z};
    model.parts[part].inertia = i;
  }
  int curve(std::vector<double> x, std::vector<double> y) {
    Curve c;
    c.x = std::move(x), c.y = std::move(y);
    model.curves.push_back(std::move(c));
    return int(model.curves.size()) - 1;
  }
  // masses of all nodes 1, or as given
  void start(const std::vector<double>& mass = {}, double spin_inertia = 0) {
    const int n = model.nodes.size();
    state.nodes.resize(n);
    for (int i = 0; i < n; ++i) {
      const double m = mass.empty() ? 1 : mass[i];
      state.nodes[i] = {model.nodes.x[i], {}, m, 1 / m};
    }
    state.physical_mass.assign(n, 1);
    for (int i = 0; i < n; ++i) state.physical_mass[i] = state.nodes[i].mass;
    state.force.assign(n, {});
    state.owner.assign(n, NodeOwner::free);
    state.interaction.resize(n, FixedScale::of(1e3));
    if (spin_inertia > 0) {
      state.spins.assign(n, NodeSpin{{}, spin_inertia, {1, 0, 0, 0}});
      state.moment.assign(n, {});
    }
    bodies = std::make_unique<RigidBodies>(model, state, diagnostics);
    bodies->finish(state, diagnostics);
    joints = std::make_unique<Joints>(model, *bodies, diagnostics);
  }
  // one cycle; nodal forces are in state.force
  void step(double dt) {
    state.dt = dt;
    bodies->gather(state, team);
    for (int b = 0; b < bodies->size(); ++b)
      bodies->add_force(b, (*bodies)[b].motion.mass * gravity, {});
    bodies->integrate(state, joints.get());
    bodies->place_nodes(state, team);
    state.time += dt;
    state.dt_previous = dt;
    ++state.cycle;
  }
  Vec3d momentum() const {
    Vec3d p{};
    for (int b = 0; b < bodies->size(); ++b) p += (*bodies)[b].motion.mass * (*bodies)[b].motion.v;
    return p;
  }
  // about the origin, at the half step
  Vec3d angular_momentum() const {
    Vec3d l{};
    for (int b = 0; b < bodies->size(); ++b) {
      const RigidMotion& m = (*bodies)[b].motion;
      l += m.momentum + m.mass * cross(m.x - (0.5 * state.dt_previous) * m.v, m.v);
    }
    return l;
  }
};

}  // namespace fabrica::mechanism
