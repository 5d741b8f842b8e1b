#include "base/diagnostics.h"

namespace fabrica {

int Diagnostics::count(Severity s) const {
  int cases = 0;
  for (const Diagnostic& d : list_)
    if (d.severity == s) cases += d.cases;
  return cases;
}

std::string Diagnostics::format(const Diagnostic& d) const {
  static const char* const names[] = {"note", "warning", "ignored", "unsupported", "error"};
  std::string text;
  if (d.where.file >= 0 && d.where.file < int(files.size()))
    text += files[d.where.file] + ":" + std::to_string(d.where.line) + ": ";
  text += names[int(d.severity)];
  text += " [" + d.name + "]";
  if (!d.keyword.empty()) text += " *" + d.keyword;
  if (!d.field.empty()) text += ", field " + d.field;
  text += ": " + d.message;
  if (!d.remedy.empty()) text += ". " + d.remedy;
  return text;
}

}  // namespace fabrica
