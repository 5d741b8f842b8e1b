#pragma once
// Compensated sum of many small terms (Kahan 1965): time is a sum of a million steps.

#include "base/real.h"

namespace fabrica {

class KahanSum {
 public:
  FABRICA_FN void add(double x) {
    const double y = x - lost_, t = sum_ + y;
    lost_ = (t - sum_) - y;
    sum_ = t;
  }
  FABRICA_FN double value() const { return sum_; }
  double sum_ = 0, lost_ = 0;  // public for restart files
};

}  // namespace fabrica
