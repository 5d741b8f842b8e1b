#pragma once
// Measures of the head from its motion. Signals are time histories in any units of their kind, at a
// constant step.
//   HIC = max over t1 < t2 <= t1 + W of (t2 - t1) [1/(t2 - t1) integral a dt]^2.5, a in g, t in s
//         (Versace 1971, SAE 710881; W 15 or 36 ms: FMVSS 208)
//   clip = the highest level at or above which the polygon of the samples stays for 3 ms: without a
//         break (NHTSA's program CLIP 2.1 for FMVSS 208 S6.3) or in all (UN R94, annex 4)
//   BrIC = sqrt(sum (max |w_i| / w_i,c)^2), w_c = 66.25, 56.45, 42.87 rad/s  (Takhounts et al.
//         2013, Stapp 57)
//   DAMAGE: M d'' + C d' + K d = M alpha, 2.9903 max |d|  (Gabler, Crandall, Panzer 2019; Euro NCAP
//         TB 035)
#include <array>

#include "signal/curve.h"

namespace fabrica {

// HIC of a resultant acceleration with the window that gives it [s].
struct Hic {
  double value = 0, from = 0, to = 0;
};
Hic hic(const Signal& acceleration, double window_s);

// The highest level that is held for `duration_s`, in units of the signal.
enum class Clip { unbroken, cumulative };
double clip(const Signal& signal, double duration_s, Clip kind = Clip::unbroken);

double bric(const std::array<Signal, 3>& angular_velocity);

// Of angular acceleration about x, y, z of the head.
double damage(const std::array<Signal, 3>& angular_acceleration);

}  // namespace fabrica
