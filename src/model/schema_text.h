#pragma once
// The grammar of .kw files, line based:
//   keyword NAME | alias NAME | options A B | category x | summary text | support
//   full|ignored|unsupported reason repeats_whole | card [optional] [repeats] [title] [width=N] [if
//   "EXPR"]
// and below a card one field a line: name type attributes "help"; a lone - leaves columns unused.
#include <string>
#include <string_view>
#include <vector>

#include "model/schema.h"

namespace fabrica {

// One keyword's lines of a .kw text, and the names that find it.
struct KeywordText {
  std::vector<std::string_view> names;  // its own, then its aliases
  std::string_view text;
  int line = 1;  // of its first line, from 1
};

// Cuts a .kw text at its keywords, without reading more of them than their names.
void split_schema(std::string_view text, std::vector<KeywordText>& keywords,
                  std::vector<std::string>& problems);

// Appends the keywords of a .kw text; breaches of the grammar go to problems and are passed over.
// `line`: number of its first line.
void parse_schema(std::string_view text, std::vector<KeywordSchema>& keywords,
                  std::vector<std::string>& problems, int line = 1);

// The .kw texts compiled into the program; made by the build.
const std::vector<std::string_view>& embedded_keyword_texts();

}  // namespace fabrica
