#pragma once
// The grammar of .kw files, line based:
//   keyword NAME | alias NAME | options A B | category x | summary text | support full|ignored|unsupported reason
//   repeats_whole | card [optional] [repeats] [title] [width=N] [if "EXPR"]
// and below a card one field a line: name type attributes "help"; a lone - leaves columns unused.
#include <string>
#include <string_view>
#include <vector>

#include "model/schema.h"

namespace fabrica {

// Appends the keywords of a .kw text; breaches of the grammar go to problems and are passed over.
void parse_schema(std::string_view text, std::vector<KeywordSchema>& keywords, std::vector<std::string>& problems);

// The .kw texts compiled into the program; made by the build.
const std::vector<std::string_view>& embedded_keyword_texts();

}  // namespace fabrica
