#pragma once
// From a distance field to fitted bricks: cells of a grid with the right topology, then all nodes
// moved at once until the boundary lies on the field and the bricks are well shaped.
#include <optional>
#include <string>

#include "body/mesh/overlay.h"
#include "body/mesh/untangle.h"

namespace fabrica::body {

struct CellOptions {
  std::string name;               // in messages
  double spacing = 4;             // [mm] of the grid
  double growth = 0;              // of the field before cells are chosen, in spacings
  std::optional<int> euler;       // that the boundary must have
  bool symmetric = false;         // the field mirrors itself, and so shall the cells
  std::optional<int> open_euler;  // or may have, where openings that most grids close are open
};

// The cells of a solid: the first grid placement and growth that give the boundary the Euler number
// asked for; where none of a growth does, the first with its openings open. Throws BodyError with
// the numbers found when none does.
BoneMesh cells_of(const DistanceField& field, const CellOptions& options);

// the problem of fitting a mesh to a field: its bricks and its surface nodes, targets still to be
// set
UntangleProblem problem_of(const BoneMesh& mesh, const DistanceField& field, double spacing);

struct FitOptions {
  double volume = 0;  // [mm3] that the bricks shall hold: chords cut convex corners, so the surface
                      // moves out for it
  double end_weight = 100;   // w of the last minimisation
  double least_size = 1;     // [mm] wish of the local stage for bricks
  double least_shell = 0;    // [mm] wish for the shells on the boundary; 0: none are there
  double shell_room = 1.6;   // shells are asked to be no larger than this many V / A
  double jacobian = 0.45;    // wish of the local stage for scaled Jacobians
  double local_weight = 50;  // w of the local stage
};

void fit(BoneMesh& mesh, DistanceField& field, const UntangleProblem& problem,
         const FitOptions& options);

// all of it: bricks of one solid, without layers
BoneMesh mesh_solid(DistanceField& field, const CellOptions& options, const FitOptions& fitting);

}  // namespace fabrica::body
