#pragma once
// Brings the pubic bones of the tables to the width of a man's symphysis. The measured bones stand
// 8.7 mm apart and more, since hyaline cartilage was left out; computed tomography of 264 men gives
// 5.0 mm in the middle (Alicioglu 2008, in Becker 2010, J Anat 217:475, Table 2).
#include "body/placed_bone.h"

namespace fabrica::body {

// Moves the nodes of both hip bones towards the midline by s (1 - S((|y| - y0) / 20 mm)), y0 the
// least distance from it, S(t) = t^2 (3 - 2t) on 0..1, s what y0 exceeds half the width by, at most
// 3 mm. Bones of other subjects: the width scaled as theirs. Changes nodes and mesh.nodes; gives s.
double fit_symphysis(std::vector<PlacedBone>& bones);

}  // namespace fabrica::body
