#pragma once
// One meniscus as meshed: columns over the plan, i along the sweep, j from the inner edge to the
// rim, k upwards.
#include "body/joints/bone_surface.h"
#include "body/joints/meniscus.h"
#include "body/joints/meniscus_plan.h"
#include "body/joints/piece_builder.h"

namespace fabrica::body {

// a knee: bones by index, its frame, and which of its faces menisci meet
struct Knee {
  int femur, tibia;
  Side side;
  // outer faces of a bone with its cartilage, as patches and as plain lists
  struct Faces {
    std::vector<std::array<PieceNode, 4>> patch;
    std::vector<Point> nodes;
    std::vector<std::array<int, 4>> quads;
    // [mm] that contact keeps before a face and around its corners: half of the cortex's shell
    std::vector<double> shell;
    std::vector<std::array<double, 4>> corner_shell;
  };
  Faces above, below;
};

// Faces of a bone: the free faces of its cartilage in the knee (a piece of that name), and its own
// where it is bare.
Knee::Faces knee_faces(const std::vector<PlacedBone>& bones, int index, const BetweenBones& between,
                       const std::string& cartilage);

// Does no corner of a face, with what contact keeps around it, stand behind one of the others, nor
// a corner of those behind the face?
bool clear_of(const std::array<PieceNode, 4>& face, double shell,
              const std::array<double, 4>& corner_shell,
              const std::vector<std::array<PieceNode, 4>>& others);

struct MeniscusMesh {
  int piece = -1;  // index into the list of pieces
  int along = 0, across = 0, layers = 0;
  std::string name;       // "leg.right.medial_meniscus"
  double ds = 0;          // of s, between columns
  std::vector<int> node;  // of the piece, by (i, j, k); -1 where no brick is
  int at(int i, int j, int k) const {
    return node[std::size_t((i * (across + 1) + j) * (layers + 1) + k)];
  }
};

// Strands of the rows of meniscus_ligaments.csv of the menisci of one knee.
void add_meniscus_ligaments(const std::vector<PlacedBone>& bones, const Knee& knee,
                            const std::vector<std::pair<MeniscusPlan, MeniscusMesh>>& menisci,
                            BetweenBones& between);

}  // namespace fabrica::body
