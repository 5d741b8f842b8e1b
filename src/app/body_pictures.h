#pragma once
// Pictures of a body: whole, and region by region.
#include <string>

#include "body/body.h"

namespace fabrica {

// Writes <folder>/<name>.png for the whole from three sides, and regions and cuts; returns their
// names. Throws std::runtime_error when the drawing fails.
std::vector<std::string> draw_body(const body::Body& body, const std::string& folder);

}  // namespace fabrica
