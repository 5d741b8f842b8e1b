#pragma once
// Nodes of a mechanism under supports, motions, walls, loads and damping, stepped without elements.
#include "solver/damping.h"
#include "solver/loads.h"
#include "solver/mechanism_test.h"
#include "solver/node_constraints.h"
#include "solver/rigid_walls.h"

namespace fabrica::mechanism {

// free nodes under everything this layer knows, in the order of a run
struct Run {
  Mechanism& m;
  Loads loads;
  NodeConstraints constraints;
  RigidWalls walls;
  MassDamping damping;
  double first_kinetic = 0, last_kinetic = 0;
  std::vector<Vec3d> extra;  // forces that a test adds to nodes
  double pending_work = 0,
         extra_work = 0;  // by them up to t(n), their half steps as energies have them
  explicit Run(Mechanism& m_, WallMethod method = WallMethod::impulse)
      : m(m_),
        loads(m_.model, m_.state, *m_.bodies, m_.diagnostics),
        constraints(m_.model, m_.state, m_.diagnostics),
        walls(m_.model, m_.state, m_.diagnostics, method),
        damping(m_.model, *m_.bodies),
        extra(m_.model.nodes.size(), Vec3d{}) {}
  void step(double dt) {
    State& s = m.state;
    s.dt = dt;
    std::vector<Vec3d> before;
    for (const NodeMotion& n : s.nodes) before.push_back(n.v);
    loads.forces(s, *m.bodies);
    walls.forces(s, m.team);
    for (int i = 0; i < m.model.nodes.size(); ++i)
      s.force[i] = extra[i] + s.interaction.take(std::size_t(i));
    loads.body_forces(s, *m.bodies, m.team);
    m.bodies->gather(s, m.team);
    for (int i = 0; i < m.model.nodes.size(); ++i) {
      if (s.owner[i] != NodeOwner::free) continue;
      s.nodes[i].v += (s.mean_dt() / s.nodes[i].mass) * s.force[i];
      if (!s.spins.empty()) s.spins[i].w += (s.mean_dt() / s.spins[i].inertia) * s.moment[i];
    }
    damping.apply(s, *m.bodies, m.team);
    constraints.apply(s);
    walls.apply(s, m.team);
    m.bodies->integrate(s, m.joints.get());
    // kinetic energy at t(n): 1/2 m v- . v+
    last_kinetic = 0;
    extra_work += pending_work;
    pending_work = 0;
    for (int i = 0; i < m.model.nodes.size(); ++i) {
      extra_work += 0.5 * s.dt_previous * dot(extra[i], before[i]);
      pending_work += 0.5 * dt * dot(extra[i], s.nodes[i].v);
    }
    for (int i = 0; i < m.model.nodes.size(); ++i)
      if (s.owner[i] == NodeOwner::free) {
        // the half step before the start is the mirror of the one after it
        const Vec3d v = s.cycle == 0 ? 2.0 * before[i] - s.nodes[i].v : before[i];
        last_kinetic += 0.5 * s.nodes[i].mass * dot(v, s.nodes[i].v);
      }
    if (s.cycle == 0) first_kinetic = last_kinetic;
    for (int i = 0; i < m.model.nodes.size(); ++i)
      if (s.owner[i] == NodeOwner::free) s.nodes[i].x += dt * s.nodes[i].v;
    m.bodies->place_nodes(s, m.team);
    s.time += dt, s.dt_previous = dt, ++s.cycle;
  }
};

}  // namespace fabrica::mechanism
