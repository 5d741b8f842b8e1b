#pragma once
// Supports of nodes: the codes of *NODE and *BOUNDARY_SPC, one direction each; and axes of systems
// that follow their nodes.
#include <functional>

#include "model/model.h"
#include "model/state.h"

namespace fabrica {

struct NodeSupport {
  bool rotation = false;
  Vec3d direction{};  // global at the start; in components of the system if that moves
  int system = -1;    // moving coordinate system that carries the direction, or -1
  double birth = 0, death = 1e28;
  Location where{};  // the card of *BOUNDARY_SPC; none for codes of *NODE
};

// Which of x, y, z (bits 0, 1, 2) a code 0 to 7 of *NODE, *MAT_RIGID and NRB_SPC holds.
int constrained_axes(int code);

// Calls fn(node, support) for every support, codes of nodes first, in the order of the deck.
void for_each_support(const Model& model, const std::function<void(int, const NodeSupport&)>& fn);

// Rows: local axes in global components, now.
Mat3d axes_now(const CoordinateSystem& system, const State& state);

// `direction` in global components, now; system: the moving one that carries it, or -1.
Vec3d carried_direction(const Model& model, const State& state, const Vec3d& direction, int system);

}  // namespace fabrica
