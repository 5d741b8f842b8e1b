#pragma once
// What the body refuses to do: the message names the bone, table or angle, the figure found and the
// nearest possible one.
#include <stdexcept>
#include <string>

namespace fabrica::body {

class BodyError : public std::runtime_error {
 public:
  explicit BodyError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace fabrica::body
