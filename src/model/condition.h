#pragma once
// Conditions of .kw cards: numbers, field names, == != < > <= >= && || ! + - * ( ), option(NAME),
// given(field).
#include <string_view>

#include "model/card.h"

namespace fabrica {

// The value of an expression over the fields of a card read so far (true is 1). Throws
// std::invalid_argument when the expression is not well formed or names a field that the schema
// lacks.
double evaluate_condition(std::string_view expression, const Card& card);

}  // namespace fabrica
