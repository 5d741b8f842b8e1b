#pragma once
// User ids as they stand in a deck. A strong type per kind, so that a node id is never taken for a
// part id. Internal indices are plain `int`, in arrays named as maps (node_to_part).
#include <compare>
#include <cstdint>
#include <functional>

namespace fabrica {

template <class Tag>
struct Id {
  std::int64_t value = 0;
  auto operator<=>(const Id&) const = default;
  explicit operator bool() const { return value != 0; }
};
using NodeId = Id<struct NodeTag>;
using ElementId = Id<struct ElementTag>;
using PartId = Id<struct PartTag>;

}  // namespace fabrica

template <class Tag>
struct std::hash<fabrica::Id<Tag>> {
  std::size_t operator()(fabrica::Id<Tag> id) const noexcept {
    return std::hash<std::int64_t>{}(id.value);
  }
};
