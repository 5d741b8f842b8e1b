#pragma once
// Where the bones of a knee meet: how near each condyle of the femur comes to its plateau, and each
// side of the patella to the femur. Distances go from every node of either bone to the nearest
// point of the other's surface, of faces that look at each other:
//   n(a) . n(b) < -0.4,                                                                     (1)
// on the plateau also with n within 45 degrees of the tibia's axis, so that its eminence does not
// count. The place of a contact is the mean of all pairs less than 1 mm more apart than the
// nearest, with weights that fall to 0 there.
#include "body/joints/bone_surface.h"
#include "body/placement.h"

namespace fabrica::body {

struct KneeContact {
  double gap = 1e30;     // [mm] least distance, negative: overlap
  Point place{0, 0, 0};  // [mm] mean place on the other bone, in its frame
};
struct KneeContacts {
  KneeContact medial, lateral;                  // femur to plateau, places on the tibia
  KneeContact medial_patella, lateral_patella;  // patella to femur, places on the femur
};

// The sphere that fits the back of a condyle of the femur by least squares, in the femur's frame,
// right side: nodes behind the epicondyles, without those more than 2 mm off (sides and notch).
struct CondyleSphere {
  Point centre{0, 0, 0};
  double radius = 0;  // [mm]
};
CondyleSphere posterior_condyle(const BoneMesh& femur, bool medial);

// Bones of one knee, right side or left, in their own frames; the meshes must outlive it.
class KneeSurfaces {
 public:
  KneeSurfaces(const BoneMesh& femur, const BoneMesh& tibia, const BoneMesh& patella, Side side);
  KneeContacts contacts(const Placement& femur, const Placement& tibia,
                        const Placement& patella) const;

 private:
  struct Pair;
  static std::vector<Pair> pairs(const BoneMesh& a, const BoneSurface& on_a, const BoneMesh& b,
                                 const BoneSurface& on_b, const Placement& a_in_b);
  const BoneMesh &femur_, &tibia_, &patella_;
  double medial_;  // sign of y on the medial side
  BoneSurface on_femur_, on_tibia_, on_patella_;
};

}  // namespace fabrica::body
