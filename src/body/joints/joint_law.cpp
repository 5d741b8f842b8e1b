#include "body/joints/joint_law.h"

#include <charconv>
#include <sstream>

#include "body/tables.h"

namespace fabrica::body {

Law joint_law(const std::string& name) {
  const Table table("anatomy/joints/materials.csv");
  for (int row = 0; row < table.rows(); ++row) {
    if (table.text(row, "name") != name) continue;
    Law law{table.text(row, "keyword"), {}, "", {}, table.text(row, "source"),
            table.text(row, "flag")};
    std::istringstream fields(table.text(row, "fields"));
    for (std::string field; fields >> field;) {
      const std::size_t equals = field.find('=');
      double value = 0;
      const char* end = field.data() + field.size();
      if (equals == std::string::npos ||
          std::from_chars(field.data() + equals + 1, end, value).ptr != end)
        table.fail(row, "\"" + field + "\" is not name=number");
      law.fields.emplace_back(field.substr(0, equals), value);
    }
    return law;
  }
  throw BodyError("anatomy/joints/materials.csv: no law named " + name);
}

}  // namespace fabrica::body
