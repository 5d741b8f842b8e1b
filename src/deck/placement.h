#pragma once
// Where *INCLUDE_TRANSFORM puts what it includes: id offsets, unit factors and an affine map.
//   x' = A (l x) + b,  l the length factor
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "model/affine.h"
#include "model/card.h"

namespace fabrica {

struct Placement {
  std::int64_t node = 0, element = 0, part = 0, material = 0, set = 0, function = 0, define = 0,
               other = 0;
  double mass = 1, time = 1, length = 1;
  Affine map;
  bool offsets() const {
    return node || element || part || material || set || function || define || other;
  }
  bool factors() const { return mass != 1 || time != 1 || length != 1; }
  bool none() const { return map.identity && !offsets() && !factors(); }
  Vec3d point(const Vec3d& x) const { return map(factors() ? length * x : x); }
  // what is added to an id of a kind of entity ("node", "curve", "part_set", ...); 0 for an unknown
  // kind
  std::int64_t offset(std::string_view kind) const;
  // factor of a unit such as "mass/length^3" or "stress"; nothing if the unit is not understood
  std::optional<double> factor(std::string_view unit) const;
};

// `inner` as placed by `outer`
Placement nest(const Placement& outer, const Placement& inner);

// Moves the ids and converts the values of a card; calls problem(field, text) for what cannot be
// converted.
void place(const Placement& placement, Card& card,
           const std::function<void(const FieldSchema&, const std::string&)>& problem);

// kind of entity that a field of a keyword names or defines; empty if it is no id
std::string_view id_kind(const Card& card, const FieldSchema& field, int row);

// Moves the ids of curves (LC7) in the texts of functions; false if units would have to be
// converted.
bool place_functions(const Placement& placement, Card& card);

// Moves points and directions of a card; false if the keyword has some that this program cannot
// move.
bool move_geometry(const Placement& placement, Card& card);

}  // namespace fabrica
