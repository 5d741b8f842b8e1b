#pragma once
// Rows of ids in the cards of sets.
#include <algorithm>
#include <vector>

#include "model/model.h"

namespace fabrica::body {

// Adds id(0), ..., id(count - 1) to a set in rows of eight, the last one filled with zeros.
template <class Get>
void add_ids(Card& set, std::size_t count, Get id) {
  for (std::size_t i = 0; i < count; i += 8) {
    std::vector<double> row(8, 0.0);
    for (std::size_t k = i; k < std::min(i + 8, count); ++k) row[k - i] = double(id(k));
    set.add_row(row);
  }
}

}  // namespace fabrica::body
