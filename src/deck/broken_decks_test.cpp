// Broken decks: each names in its first line the diagnostic that it must raise, and the line it
// must point at.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "deck/reader.h"
#include "model/check.h"

using namespace fabrica;

TEST_CASE("broken decks: each problem is named at its line") {
  std::vector<std::filesystem::path> decks;
  for (const auto& entry : std::filesystem::directory_iterator(FABRICA_BROKEN_DECKS))
    if (entry.path().extension() == ".k") decks.push_back(entry.path());
  std::sort(decks.begin(), decks.end());
  REQUIRE(decks.size() >= 30);
  for (const auto& path : decks) {
    std::ifstream in(path);
    std::string dollar, expect, name, word;
    int line = 0;
    in >> dollar >> expect >> name >> word >> line;
    REQUIRE(expect == "expect:");
    Diagnostics diagnostics;
    // what could be read is checked too, as the command does
    if (const auto model = read_deck(path, diagnostics))
      format_check(check_model(*model, diagnostics), diagnostics);
    bool found = false;
    std::string all;
    for (const Diagnostic& d : diagnostics.list()) {
      found = found || (d.name == name && d.where.line == line);
      all += diagnostics.format(d) + "\n";
    }
    CHECK_MESSAGE(found, path.filename().string()
                             << ": expected " << name << " at line " << line << ", got\n"
                             << all);
  }
}
