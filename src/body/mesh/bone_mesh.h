#pragma once
// A bone as bricks: what every mesh maker of the body gives and what placement, joints and assembly
// take. Lengths in mm, in the bone's own frame (X forward, Y left, Z up); right side or midline.
// The left bone is the mirror image y -> -y of the right one, node by node (mirrored()).
#include <array>
#include <string>
#include <vector>

#include "base/tensor.h"
#include "body/error.h"

namespace fabrica::body {

enum class Resolution { coarse, standard, fine };

using Point = Vec3d;

struct BoneMesh {
  std::string name;  // "femur", "L3", "rib5", "costal_cartilage3", "hip_bone", "metacarpal2", ...
  Resolution resolution = Resolution::coarse;
  Point scale{1, 1, 1};                    // applied to the table's shape, about the frame's origin
  std::vector<Point> nodes;                // [mm], bone frame
  std::vector<std::array<int, 8>> bricks;  // LS-DYNA corner order, positive volume
  std::vector<int> brick_layer;  // 0 trabecular (or the only tissue), 1 solid cortex; the skull's
                                 // vault: 0 other bone, 1 outer table, 2 diploe, 3 inner table
  std::vector<std::array<int, 4>> surface;  // boundary quads of the solid, outward normal
  // [mm] shell thickness of each boundary quad, 0 where the cortex behind it is solid; empty where
  // it is solid all over
  std::vector<double> cortex;
  double shell_wish = 0;  // [mm] area / longest side that was asked of its shells; 0: nothing was
  // of a bone of the midline that is its own mirror image: the node on the other side, of a node in
  // the plane y = 0 itself; empty: it is not
  std::vector<int> image;
};

struct BoneRequest {
  std::string name;
  Resolution resolution = Resolution::coarse;
  Point scale{1, 1, 1};  // about the frame's origin; the cortex keeps its thickness
};

// What a mesh measures. The scaled Jacobian of a brick is the smallest over its corners; size is
// volume / largest face.
struct MeshReport {
  std::string name;
  std::string maker;                     // "overlay", "overlay with solid cortex", "loft", "skull"
  int nodes = 0, bricks = 0, euler = 0;  // euler: of the boundary surface, V - E + F
  int expected_euler = 2;          // as anatomy has it: 2, or 0 for a bone with one hole through it
  double min_scaled_jacobian = 0;  // [-]
  double p1_scaled_jacobian = 0;   // [-] 99 % of the bricks are above
  double min_size = 0;             // [mm] volume / largest face of a brick
  double min_cortex_size =
      0;  // [mm] the same of bricks of solid cortex and, area / longest side, of shells
  double volume = 0,
         table_volume = 0;  // [mm3] of the bricks; of the scaled table (0: the table states none)
  double error_mean = 0, error_p95 = 0;  // [mm] distance of the mesh's surface to the table's
  double missing_p95 =
      0;               // [mm] the other way: 95 % of the table's surface is nearer to the mesh's
  double offset = 0;   // [mm] by which the table's surface was moved out to hold its volume
  double seconds = 0;  // of one core, to make the mesh
};

// The mesh of one bone; throws BodyError naming bone, stage and figure when the name is unknown or
// a gate fails.
BoneMesh mesh_bone(const BoneRequest& request);

// The figures of a mesh made by mesh_bone.
MeshReport report(const BoneMesh& mesh);

// Every bone that can be meshed, head to foot; right side and midline.
const std::vector<std::string>& bone_names();

// The bone of the other side: y -> -y, bricks and quads reordered so that volumes stay positive and
// normals outward.
BoneMesh mirrored(const BoneMesh& mesh);

}  // namespace fabrica::body
