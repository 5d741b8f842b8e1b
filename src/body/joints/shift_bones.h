#pragma once
// First step of clearing: bones that reach into one another are moved apart whole, each with all
// that hangs on it (a finger with its metacarpal, the arm with the scapula). The shift of a group
// is the t that minimises
//   sum_i max(0, g - d_i - n_i . t)^2 + s N |t|^2                                        (1)
// over the N nodes of the group and of others nearer to each other than the gap g (d signed
// distance, n normal away from the others), a step of Gauss-Newton at a time.
#include "body/joints/touch.h"

namespace fabrica::body {

// Moves the bones and their placements, by at most 2 mm (the scapula 4) against what each
// hangs on; meshes in their own frames stay.
// `twins`: the bone that is the mirror image, or -1; mirror images stay so. Gives the largest
// shift [mm] and the bone that it was.
struct LargestShift {
  double shift = 0;
  int bone = -1;
};
LargestShift shift_bones(std::vector<PlacedBone>& bones, const std::vector<Articulation>& joints,
                         const std::vector<int>& twins);

}  // namespace fabrica::body
