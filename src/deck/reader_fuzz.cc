// Fuzz target: any bytes are a deck. Reading, checking and writing it back must neither crash, hang
// nor leak. Includes are not followed.
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string_view>

#include "deck/reader.h"
#include "deck/writer.h"
#include "model/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fabrica::Diagnostics diagnostics;
  fabrica::ReadOptions options;
  options.follow_includes = false;
  const auto model = fabrica::read_deck_text({reinterpret_cast<const char*>(data), size}, "fuzz",
                                             diagnostics, options);
  if (!model) return 0;
  fabrica::format_check(fabrica::check_model(*model, diagnostics), diagnostics);
  std::ostringstream out;
  fabrica::write_deck(*model, out);
  return 0;
}
