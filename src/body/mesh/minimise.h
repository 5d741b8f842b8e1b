#pragma once
// Minimum of a function of the places of nodes by L-BFGS (Nocedal 1980) with seven pairs and
// Armijo's rule; the result depends on the input alone.
#include <functional>
#include <vector>

#include "body/mesh/bone_mesh.h"

namespace fabrica::body {

// gives the energy and fills the gradient, of the size of nodes
using NodeEnergy =
    std::function<double(const std::vector<Point>& nodes, std::vector<Point>& gradient)>;

// longest: [mm] that a node may move in one iteration
void minimise(const NodeEnergy& energy, std::vector<Point>& nodes, double longest, int iterations);

}  // namespace fabrica::body
