#pragma once
// The exact step of a Maxwell branch whose strain rate is constant in the step.
//   s(t) = int G e^(-b (t-u)) de/du du:   h <- e^(-b dt) h + G phi(b dt) de,   phi(x) = (1 -
//   e^(-x)) / x      (1)
// Source: Taylor, Pister, Goudreau, Int. J. Num. Meth. Eng. 2 (1970).
#include "base/lane_math.h"

namespace fabrica {

// e^(-x) in decay; returns phi(x), x >= 0
template <class L>
FABRICA_FN L relaxation(const L& x, L& decay) {
  const L less = expm1(-x);
  decay = L(1.0) + less;
  const auto still = x < L(1e-30);
  return select(still, L(1.0), -less / select(still, L(1.0), x));
}

// Tangent modulus with a viscous stress of `ratio` x (density x sound speed x length) x rate: the
// stable step of a wave with linear viscosity Q is l / (Q c + sqrt(Q^2 c^2 + c^2)), as if c were (Q
// + sqrt(1 + Q^2)) c.
template <class L>
FABRICA_FN L damped_modulus(const L& modulus, const L& ratio) {
  const L growth = ratio + sqrt(fma(ratio, ratio, L(1.0)));
  return modulus * growth * growth;
}

}  // namespace fabrica
