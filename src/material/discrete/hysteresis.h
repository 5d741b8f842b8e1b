#pragma once
// One-dimensional laws that load on one curve and unload on another. The positive and the negative
// side keep separate memories; on side s = +1 or -1 everything is seen as x = s d >= 0, y = s F >=
// 0.
//
//   loading     x >= m           : y = L(x), and m follows x
//   curve       x < m (option 1) : y = U(x - s0), U(m - s0) = L(m), between 0 and L(x)
//   stiffness   x < m (option 2) : y = y_old + k dx, kept between U(x) and L(x)
//   quadratic   x < m (option 3) : y = L(m) ((x - o) / (m - o))^2 for x > o = OFFSET m, else 0
//
// L, U: loading and unloading curve; m: largest x so far. Option 0 has no memory: y = L(x).
// Source: the public description of *MAT_119, read as the bounded elastic path it implies.
#include <algorithm>
#include <cmath>

#include "material/discrete/polyline.h"

namespace fabrica {

enum class Unloading { along_loading = 0, curve = 1, stiffness = 2, quadratic = 3 };

// memory of one side; all zero at the start
struct SideState {
  double furthest = 0;  // m
  double shift = 0;     // s0 of option 1
  double last = 0;      // x of the previous call
  double force = 0;     // y of the previous call
};

struct Hysteresis {
  Polyline loading, unloading;
  Unloading option = Unloading::along_loading;
  double stiffness = 0;  // k of option 2
  double offset = 0;     // OFFSET of option 3

  // force at deflection d and, in slope, its tangent; both sides' memories are updated
  double force(double d, SideState& positive, SideState& negative, double& slope) const {
    slope = 0;
    if (!loading) return 0;
    if (option == Unloading::along_loading) return loading.at(d, slope);
    double slope_positive = 0, slope_negative = 0;
    const double up = side(1, std::max(d, 0.0), positive, slope_positive);
    const double down = side(-1, std::max(-d, 0.0), negative, slope_negative);
    slope = d >= 0 ? slope_positive : slope_negative;
    return d >= 0 ? up : -down;
  }

  double largest_slope() const {
    return std::max({loading.steepest(), unloading.steepest(),
                     option == Unloading::stiffness ? stiffness : 0.0});
  }

 private:
  double on_side(const Polyline& c, int s, double x, double& slope) const {
    return s * c.at(s * x, slope);
  }

  double side(int s, double x, SideState& state, double& slope) const {
    double load_slope = 0;
    const double load = on_side(loading, s, x, load_slope);
    double y = load;
    slope = load_slope;
    if (option == Unloading::stiffness)
      y = bounded(s, x, load, load_slope, state, slope);
    else if (x < state.furthest)
      y = option == Unloading::curve ? shifted(s, x, load, state, slope)
                                     : parabola(s, x, state, slope);
    if (x > state.furthest) {
      state.furthest = x;
      if (option == Unloading::curve) state.shift = x - s * unloading.inverse(s * load);
    }
    state.last = x;
    state.force = y;
    return y;
  }

  double bounded(int s, double x, double load, double load_slope, const SideState& state,
                 double& slope) const {
    double unload_slope = 0;
    const double low = unloading ? on_side(unloading, s, x, unload_slope) : 0.0;
    const double trial = state.force + stiffness * (x - state.last);
    if (trial >= load) return slope = load_slope, load;
    if (trial <= low) return slope = unload_slope, low;
    return slope = stiffness, trial;
  }

  double shifted(int s, double x, double load, const SideState& state, double& slope) const {
    const double y = on_side(unloading, s, x - state.shift, slope);
    if (y <= 0) return slope = 0, 0.0;
    return std::min(y, std::max(load, 0.0));
  }

  double parabola(int s, double x, const SideState& state, double& slope) const {
    const double set = offset * state.furthest;
    if (x <= set) return slope = 0, 0.0;
    double unused = 0;
    const double peak = on_side(loading, s, state.furthest, unused);
    const double r = (x - set) / (state.furthest - set);
    slope = 2 * peak * r / (state.furthest - set);
    return peak * r * r;
  }
};

}  // namespace fabrica
