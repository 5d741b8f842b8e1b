#include "solver/initial_conditions.h"

#include <vector>

namespace fabrica {

void apply_initial_conditions(const Model& model, State& state, RigidBodies& bodies) {
  // how a body gets its velocity: nothing, from nodes, or set
  enum class Source : unsigned char { none, nodes, set };
  std::vector<Source> source(bodies.size(), Source::none);
  for (int b = 0; b < bodies.size(); ++b)
    if (bodies[b].overridden) source[b] = Source::set;
  for (const InitialVelocity& iv : model.initial_velocities) {
    auto velocity_at = [&](const Vec3d& x) {
      return iv.about_axis ? iv.velocity + cross(iv.angular_velocity, x - iv.point) : iv.velocity;
    };
    if (!iv.rigid_bodies_only)
      for (int n : iv.nodes) {
        state.nodes[n].v = velocity_at(state.nodes[n].x);
        if (!state.spins.empty()) state.spins[n].w = iv.angular_velocity;
        const int b = bodies.body_of_node(n);
        if (b >= 0 && (!bodies[b].overridden || iv.override_inertia)) source[b] = Source::nodes;
      }
    for (int p : iv.parts) {
      const int b = bodies.body_of_part(p);
      if (b < 0 || (bodies[b].overridden && !iv.override_inertia)) continue;
      bodies.set_velocity(b, velocity_at(bodies[b].motion.x), iv.angular_velocity);
      source[b] = Source::set;
      // so that a later list of some of its nodes starts from the body's motion
      for (int n : bodies[b].nodes) {
        state.nodes[n].v =
            bodies[b].motion.v + cross(bodies[b].motion.w, state.nodes[n].x - bodies[b].motion.x);
        if (!state.spins.empty()) state.spins[n].w = bodies[b].motion.w;
      }
    }
  }
  for (int b = 0; b < bodies.size(); ++b)
    if (source[b] == Source::nodes) bodies.velocity_from_nodes(b, state);
  bodies.give_velocity_to_nodes(state);
}

}  // namespace fabrica
