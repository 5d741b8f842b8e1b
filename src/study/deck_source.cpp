#include "study/deck_source.h"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <fstream>

#include "base/hash.h"
#include "deck/reader.h"
#include "deck/text.h"
#include "study/error.h"

namespace fabrica::study {
namespace {

namespace fs = std::filesystem;

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

// adds the names behind & in lines that are no comments
void collect_parameters(std::string_view text, std::set<std::string>& names) {
  Lines lines(text);
  while (lines.next()) {
    if (lines.line.empty() || lines.line[0] == '$') continue;
    for (std::size_t i = lines.line.find('&'); i != std::string_view::npos;
         i = lines.line.find('&', i + 1)) {
      std::string name;
      for (std::size_t j = i + 1; j < lines.line.size() && is_name(lines.line[j]); ++j)
        name += char(std::tolower(static_cast<unsigned char>(lines.line[j])));
      if (!name.empty()) names.insert(name);
    }
  }
}

// the declaration letter of *PARAMETER: integer, real or text
char type_of(const std::string& value) {
  if (!value.empty() && value.find_first_not_of("+-0123456789") == std::string::npos) return 'i';
  char* end = nullptr;
  std::strtod(value.c_str(), &end);
  return !value.empty() && *end == '\0' ? 'r' : 'c';
}

}  // namespace

void write_main(const std::string& path, const std::map<std::string, std::string>& parameters,
                const std::vector<std::string>& includes) {
  std::ofstream out(path);
  out << "*KEYWORD\n";
  // the first definition of a name stays
  if (!parameters.empty()) out << "*PARAMETER_DUPLICATION\n         5\n*PARAMETER\n";
  for (const auto& [name, value] : parameters)
    out << type_of(value) << name << ',' << value << '\n';
  for (const std::string& file : includes) out << "*INCLUDE\n" << file << '\n';
  out << "*END\n";
  out.close();
  if (!out) throw StudyError(path, 0, "", "cannot be written", "Check the folder and the disk");
}

DeckContent inspect_deck(const std::string& path, bool without_main) {
  Diagnostics diagnostics;
  read_deck(path, diagnostics);
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == Severity::error) throw StudyError(diagnostics.format(d));
  DeckContent content;
  content.files = diagnostics.files;
  Hash hash;
  for (std::size_t i = 0; i < content.files.size(); ++i) {
    std::string problem;
    const auto file = load_text(content.files[i], problem);
    if (!file) throw StudyError(content.files[i], 0, "", problem, "Check the file");
    if (i > 0 || !without_main) hash.add(file->text);
    collect_parameters(file->text, content.parameters);
  }
  content.hash = hash.value();
  return content;
}

void need_parameter(const DeckContent& content, const std::string& name, const std::string& file,
                    int line) {
  std::string lower;
  for (const char c : name) lower += char(std::tolower(static_cast<unsigned char>(c)));
  if (content.parameters.count(lower)) return;
  std::string list;
  for (const std::string& p : content.parameters) list += (list.empty() ? "" : ", ") + p;
  throw StudyError(file, line, name, "is no parameter that the deck refers to",
                   list.empty() ? "The deck refers to none" : "Take one of: " + list);
}

std::string program_version() {
  return fmt::format("{} (engine {:.8})", FABRICA_VERSION, engine_version);
}

std::string fingerprint(std::uint64_t deck, const std::vector<std::string>& settings) {
  Hash hash;
  hash.add(std::int64_t(deck));
  hash.add(std::string_view(engine_version));
  hash.add(std::string_view(FABRICA_VERSION));
  for (const std::string& s : settings) hash.add(std::string_view(s));
  return fmt::format("{:016x}", hash.value());
}

}  // namespace fabrica::study
