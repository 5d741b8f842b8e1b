#pragma once
// Reads decks in LS-DYNA keyword format. Every problem goes to the diagnostics with file, line,
// keyword, field, what was expected and a remedy; reading goes on behind it, so that one run lists
// all of them.
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "model/model.h"

namespace fabrica {

struct ReadOptions {
  bool follow_includes =
      true;  // false: *INCLUDE is an error (decks from memory that nobody vouches for)
  bool expect_complete = true;                       // report an empty deck
  std::vector<std::filesystem::path> include_paths;  // searched after those of the deck
};

// The model of a deck file (plain, gzip or zstd) and all it includes; usable only if no diagnostic
// is an error.
std::unique_ptr<Model> read_deck(const std::filesystem::path& path, Diagnostics& diagnostics,
                                 const ReadOptions& options = {});

// The model of a deck held in memory; `name` stands for the file in diagnostics.
std::unique_ptr<Model> read_deck_text(std::string_view text, std::string_view name,
                                      Diagnostics& diagnostics, const ReadOptions& options = {});

// Adds the content of a deck file to a model under construction; false if the file cannot be read.
bool read_into(Builder& builder, const std::filesystem::path& path, Diagnostics& diagnostics,
               const ReadOptions& options = {});

// Adds the content of a deck held in memory to a model under construction.
void read_text_into(Builder& builder, std::string_view text, std::string_view name,
                    Diagnostics& diagnostics, const ReadOptions& options = {});

}  // namespace fabrica
