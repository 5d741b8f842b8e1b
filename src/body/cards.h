#pragma once
// Cards that the makers of the body's model share: titles, rows of ids, curves, shapes.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "body/assembly.h"
#include "body/shapes.h"

namespace fabrica::body {

// a new card with a title
Card& titled(Builder& builder, const char* keyword, const std::string& title);

// Adds id(0), ..., id(count - 1) to a set in rows of eight, the last one filled with zeros.
template <class Get>
void add_ids(Card& set, std::size_t count, Get id) {
  for (std::size_t i = 0; i < count; i += 8) {
    std::vector<double> row(8, 0.0);
    for (std::size_t k = i; k < std::min(i + 8, count); ++k) row[k - i] = double(id(k));
    set.add_row(row);
  }
}

// Places to a nanometre and thicknesses to 1/1024 mm: they fit the fields of a deck without loss.
Point to_field(const Point& p);
double to_field(double thickness);

void add_curve(Builder& builder, std::int64_t id, const std::string& title,
               const std::vector<std::pair<double, double>>& points);

// Nodes and bricks of a shape, those of its pad as another part.
void add_shape(const ShapeMesh& mesh, std::int64_t part, std::int64_t pad,
               const Placement& placement, AssembledBody& assembled, Builder& builder);

}  // namespace fabrica::body
