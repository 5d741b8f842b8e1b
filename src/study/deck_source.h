#pragma once
// The deck of a run: a small main file where parameters are set, what all its files hold, and the
// fingerprint by which a result is known to be up to date.
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace fabrica::study {

// Writes a main deck that gives parameters their values (these win over values in the included
// decks) and includes decks.
void write_main(const std::string& path, const std::map<std::string, std::string>& parameters,
                const std::vector<std::string>& includes);

struct DeckContent {
  std::uint64_t hash = 0;            // of the bytes of all files
  std::vector<std::string> files;    // all that were read, the main file first
  std::set<std::string> parameters;  // names that fields refer to (&name), in lower case
};

// Reads a deck with its includes. Throws StudyError with the first error found, in the reader's
// words. `without_main` leaves the main file out of the hash.
DeckContent inspect_deck(const std::string& path, bool without_main = false);

// Throws StudyError if a parameter is used nowhere in the deck, naming those that are.
void need_parameter(const DeckContent& content, const std::string& name, const std::string& file,
                    int line);

// A hash of the sources of everything a run computes with, made when the program was built.
extern const char* const engine_version;

// "0.1.0 (engine 1a2b3c4d)"
std::string program_version();

// Sixteen hexadecimal digits that change with the deck, the program or any of `settings`.
std::string fingerprint(std::uint64_t deck, const std::vector<std::string>& settings);

}  // namespace fabrica::study
