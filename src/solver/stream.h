#pragma once
// Raw bytes of plain values and vectors, for restarts that continue with the same bits.
#include <cstdint>
#include <istream>
#include <ostream>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace fabrica {

template <class T>
void write_value(std::ostream& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}
template <class T>
void read_value(std::istream& in, T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (!in.read(reinterpret_cast<char*>(&value), sizeof value))
    throw std::runtime_error("restart data ends early");
}
template <class T>
void write_vector(std::ostream& out, const std::vector<T>& v) {
  write_value(out, std::int64_t(v.size()));
  out.write(reinterpret_cast<const char*>(v.data()), std::streamsize(v.size() * sizeof(T)));
}
template <class T>
void read_vector(std::istream& in, std::vector<T>& v) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::int64_t n = 0;
  read_value(in, n);
  if (n != std::int64_t(v.size())) throw std::runtime_error("restart data is of another model");
  if (!in.read(reinterpret_cast<char*>(v.data()), std::streamsize(v.size() * sizeof(T))))
    throw std::runtime_error("restart data ends early");
}

}  // namespace fabrica
