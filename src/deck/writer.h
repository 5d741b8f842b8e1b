#pragma once
// Writes a model as a deck that reads back to the same bits.
#include <ostream>

#include "model/model.h"

namespace fabrica {

// Writes nodes, elements and all cards of a resolved model. Fields are fixed; the whole deck is in
// long format where one value does not fit its field without loss. Texts of the fields are written
// as they were read.
void write_deck(const Model& model, std::ostream& out);

}  // namespace fabrica
