#include "study/assets.h"

#include <filesystem>
#include <string_view>

#include "study/outcome.h"

// Places a file's bytes between two symbols (GNU assembler; FABRICA_WEB is the folder web/).
#define EMBED(symbol, path)                                                           \
  asm(".section .rodata\n.global " #symbol "\n.global " #symbol "_end\n" #symbol      \
      ":\n.incbin \"" FABRICA_WEB "/" path "\"\n" #symbol "_end:\n.byte 0\n.text\n"); \
  extern "C" const char symbol[];                                                     \
  extern "C" const char symbol##_end[];

EMBED(fabrica_web_plotly, "plotly/plotly-basic.min.js")
EMBED(fabrica_web_plotly_licence, "plotly/LICENSE")
EMBED(fabrica_web_script, "page.js")
EMBED(fabrica_web_style, "page.css")

namespace fabrica::study {

void write_assets(const std::string& folder) {
  const std::filesystem::path to = std::filesystem::path(folder) / "assets";
  std::filesystem::create_directories(to);
  const auto write = [&](const char* name, const char* begin, const char* end) {
    const std::string path = (to / name).string();
    const std::string text(begin, std::size_t(end - begin));
    if (read_file(path) != text) write_file(path, text);
  };
  write("plotly-basic.min.js", fabrica_web_plotly, fabrica_web_plotly_end);
  write("plotly-LICENSE.txt", fabrica_web_plotly_licence, fabrica_web_plotly_licence_end);
  write("page.js", fabrica_web_script, fabrica_web_script_end);
  write("page.css", fabrica_web_style, fabrica_web_style_end);
}

}  // namespace fabrica::study
