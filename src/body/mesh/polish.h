#pragma once
// The local stage: nodes of the worst bricks try small random moves and keep those that lower
//   sum exp(-14 (s - s_w)) + sum exp(-14 (L / L_w - 1))
//   + sum exp(-14 (a / a_w - 1)) + w (phi / h)^2 (1)
// over the bricks and shells around the node; s scaled Jacobian, L size of a brick, a of a shell,
// each with a wish. Planes add W (d / h)^2, d [mm] the distance to them (one-sided: from behind).
// Nodes of a mesh with an image move in pairs. The random numbers are seeded by the mesh, so that
// the result depends on the input alone.
#include "body/mesh/untangle.h"

namespace fabrica::body {

struct PolishOptions {
  double jacobian = 0.45;  // s_w
  double size = 1;         // [mm] L_w
  double shell_size = 0;   // [mm] a_w; 0: shells do not count
  double weight = 60;      // w
  int sweeps = 30;
};

void polish(const UntangleProblem& problem, std::vector<Point>& nodes,
            const PolishOptions& options);

}  // namespace fabrica::body
