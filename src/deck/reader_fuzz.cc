// Fuzz target: any bytes are a deck; reading them must neither crash nor hang. Includes are not followed.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "deck/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fabrica::Diagnostics diagnostics;
  fabrica::ReadOptions options;
  options.follow_includes = false;
  fabrica::read_deck_text({reinterpret_cast<const char*>(data), size}, "fuzz", diagnostics, options);
  return 0;
}
