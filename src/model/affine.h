#pragma once
// Affine maps x' = A x + b and the sequences of moves of *DEFINE_TRANSFORMATION.
#include <optional>
#include <string>

#include "base/tensor.h"
#include "model/card.h"

namespace fabrica {

struct Affine {
  Mat3d a = identity3<double>();
  Vec3d b{0, 0, 0};
  bool identity = true;
  Vec3d operator()(const Vec3d& x) const { return identity ? x : a * x + b; }
  Vec3d direction(const Vec3d& v) const { return identity ? v : a * v; }
};

// first `inner`, then `outer`
Affine compose(const Affine& outer, const Affine& inner);

// The map of a *DEFINE_TRANSFORMATION card, its rows applied in order; nothing, and what is wrong
// in `problem`, if a row cannot be applied.
std::optional<Affine> affine_of(const Card& card, std::string& problem);

}  // namespace fabrica
