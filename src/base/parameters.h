#pragma once
// How a law (material, spring, joint) reads its parameters, without knowing about decks.
#include <string_view>

#include "base/curve.h"

namespace fabrica {

class Parameters {
 public:
  virtual ~Parameters() = default;
  // the value of a field, or the schema's default when it is blank
  virtual double real(std::string_view field) const = 0;
  virtual bool given(std::string_view field) const = 0;
  // the curve or table whose id stands in the field; empty view when the field is 0 or blank.
  // Views stay valid for the life of the model.
  virtual CurveView curve(std::string_view field) const = 0;
  virtual TableView table(std::string_view field) const = 0;
  // rows of the repeating card (Prony terms, ...): count, and the value in a column
  virtual int rows() const = 0;
  virtual double row(int i, std::string_view field) const = 0;
  int integer(std::string_view field) const { return int(real(field)); }
};

}  // namespace fabrica
