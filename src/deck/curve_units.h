#pragma once
// Unit factors of *INCLUDE_TRANSFORM on curves. A *DEFINE_CURVE says nothing about its units; they
// follow from the field that uses it: a curve named by LCID of *LOAD_NODE_SET with DOF 1 is a force
// over time. So the factors wait until all keywords are read, and go into SFA and SFO.
#include <vector>

#include "deck/placement.h"

namespace fabrica {

class Context;

class CurveUnits {
 public:
  // Every card as it enters the model; placement: of the file that it stands in. Both must outlive
  // this but for the placement, which is copied.
  void add(Card& card, const Placement& placement);
  // Converts the curves of files with factors; those whose units are not known become errors.
  void convert(Context& context);

 private:
  struct Pending {
    Card* card;
    Placement placement;
  };
  std::vector<Pending> pending_;
  std::vector<const Card*> users_;  // cards that may name a curve
};

}  // namespace fabrica
