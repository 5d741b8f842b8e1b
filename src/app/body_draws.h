#pragma once
// Random bodies, of 1550 to 1900 mm and 50 to 110 kg with every joint angle in the middle 80 % of
// its range: does the maker hold over postures and sizes?
#include <string>
#include <vector>

#include "body/body.h"

namespace fabrica {

// Subject and posture of one of the random bodies, counted from 1; the same on every machine.
body::BodyOptions drawn_body(int number);

// Makes the first `count` of them, or only `bones` of them, and prints each: its worst brick and
// what nothing connects. 0 if all have positive Jacobians, else 1.
int draw_bodies(int count, const std::string& resolution, bool joints,
                const std::vector<std::string>& bones);

}  // namespace fabrica
