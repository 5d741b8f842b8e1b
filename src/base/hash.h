#pragma once
// 64-bit hash of bytes (FNV-1a over 8-byte words, then bytes): for comparing states and files, not
// for security. Source: Fowler, Noll, Vo; constants of the 64-bit variant.
#include <cstdint>
#include <cstring>
#include <string_view>

namespace fabrica {

class Hash {
 public:
  void bytes(const void* data, std::size_t n) {
    const auto* p = static_cast<const unsigned char*>(data);
    for (; n >= 8; n -= 8, p += 8) {
      std::uint64_t w;
      std::memcpy(&w, p, 8);
      mix(w);
    }
    for (; n > 0; --n, ++p) mix(*p);
  }
  void add(double x) { bytes(&x, sizeof x); }
  void add(std::int64_t x) { bytes(&x, sizeof x); }
  void add(std::string_view s) {
    bytes(s.data(), s.size());
    mix(s.size());
  }
  std::uint64_t value() const { return h_; }

 private:
  void mix(std::uint64_t w) {
    h_ = (h_ ^ w) * 0x100000001b3ull;
    h_ ^= h_ >> 29;
  }
  std::uint64_t h_ = 0xcbf29ce484222325ull;
};

}  // namespace fabrica
