#pragma once
// What a body is tried in: rigid seat, plane to fall on, ball that hits the breastbone.
#include <string>

#include "body/assembly.h"
#include "body/body.h"

namespace fabrica::body {

// "none"; "seat": rigid pan, back, floor, headrest and arm supports, 1 g, light damping; "drop":
// the body reaches a rigid plane after a fall of 0.5 m, 1 g; "sternum": a rigid ball of 5 kg, 75 mm
// radius, at 3 m/s. Gives the time that the trial runs [ms] and the title of its case. Throws
// BodyError that lists them.
double trial_time(const std::string& trial);
// Adds walls, ball, loads and velocities to the model of an assembled body.
void surround(const std::string& trial, const Body& body, AssembledBody& assembled,
              Builder& builder);

}  // namespace fabrica::body
