#pragma once
// Initial velocities of nodes and rigid bodies:  v = V + omega x (x - p),  w = omega.
// Bodies named by part take the formula at their centre; other bodies whose nodes were given
// velocities take V and w from the momentum of their nodes; velocities of *PART_INERTIA stand
// unless the deck says otherwise (IRIGID).
#include "model/model.h"
#include "model/state.h"
#include "solver/rigid_bodies.h"

namespace fabrica {

// Sets state.nodes[].v, state.spins[].w and the bodies' velocities; bodies must be finished.
void apply_initial_conditions(const Model& model, State& state, RigidBodies& bodies);

}  // namespace fabrica
