#include "solver/supports.h"

#include <array>

namespace fabrica {

namespace {

Vec3d unit(int k) {
  Vec3d e{};
  e[k] = 1;
  return e;
}

}  // namespace

Mat3d axes_now(const CoordinateSystem& s, const State& state) {
  if (!s.moves || s.node[0] < 0 || s.node[1] < 0 || s.node[2] < 0) return s.axes;
  const Vec3d a = state.nodes[s.node[0]].x;
  Vec3d x = state.nodes[s.node[1]].x - a;
  x = (1 / norm(x)) * x;
  Vec3d z = cross(x, state.nodes[s.node[2]].x - a);
  z = (1 / norm(z)) * z;
  const Vec3d y = cross(z, x);
  return {{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
}

Vec3d carried_direction(const Model& model, const State& state, const Vec3d& direction,
                        int system) {
  if (system < 0) return direction;
  return transpose(axes_now(model.coordinate_systems[system], state)) * direction;
}

int constrained_axes(int code) {
  static constexpr std::array<int, 8> masks{0, 1, 2, 4, 3, 6, 5, 7};  // none x y z xy yz zx xyz
  return code >= 0 && code <= 7 ? masks[code] : 0;
}

void for_each_support(const Model& model, const std::function<void(int, const NodeSupport&)>& fn) {
  const auto mask = [&](const auto& codes, int n) {
    return n < int(codes.size()) ? constrained_axes(codes[n]) : 0;
  };
  for (int n = 0; n < model.nodes.size(); ++n) {
    const int t = mask(model.nodes.translation_code, n), r = mask(model.nodes.rotation_code, n);
    for (int k = 0; k < 3; ++k) {
      if (t >> k & 1) fn(n, {false, unit(k)});
      if (r >> k & 1) fn(n, {true, unit(k)});
    }
  }
  for (const SinglePointConstraint& s : model.constraints)
    for (int n : s.nodes)
      for (int k = 0; k < 6; ++k) {
        if (!s.fixed[k]) continue;
        const bool moves = s.local_system >= 0 && model.coordinate_systems[s.local_system].moves;
        // of a moving system the direction is kept in its components
        const Vec3d local = unit(k % 3);
        const Vec3d d = s.local_system < 0 || moves
                            ? local
                            : transpose(model.coordinate_systems[s.local_system].axes) * local;
        fn(n, {k >= 3, d, moves ? s.local_system : -1, s.birth, s.death, s.where});
      }
}

}  // namespace fabrica
