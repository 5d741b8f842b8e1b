#pragma once
// Random bodies: does the maker hold over postures and sizes?
#include <string>

namespace fabrica {

// Makes `count` bodies of 1550 to 1900 mm and 50 to 110 kg with every joint angle in the middle 80
// % of its range, from a fixed seed, prints each and lists the failures. 0 if all have positive
// Jacobians, else 1.
int draw_bodies(int count, const std::string& resolution, bool joints);

}  // namespace fabrica
