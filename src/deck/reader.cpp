#include "deck/reader.h"

#include <algorithm>
#include <cctype>

#include "deck/context.h"
#include "deck/number.h"

namespace fabrica {
namespace {

namespace fs = std::filesystem;

constexpr int deepest_include = 64;

class DeckReader {
 public:
  DeckReader(Builder& builder, Diagnostics& diagnostics, const ReadOptions& options)
      : context_(builder, diagnostics, options), paths_(options.include_paths) {}

  bool read_file(const fs::path& path, const Placement& placement) {
    std::string problem;
    const auto file = load_text(path, problem);
    if (!file) {
      context_.error("missing-file", {}, "", "", path.string() + ": " + problem, "Check the path");
      return false;
    }
    open_.push_back(identity(path));
    if (folders_.empty()) main_folder_ = path.parent_path();
    folders_.push_back(path.parent_path());
    read_text(file->text, path.string(), placement);
    folders_.pop_back();
    open_.pop_back();
    return true;
  }

  void read_text(std::string_view text, const std::string& name, const Placement& placement) {
    const int file = int(context_.diagnostics.files.size());
    context_.diagnostics.files.push_back(name);
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    Lines lines(text);
    Format format;
    bool before = true;
    while (lines.next()) {
      const std::string_view line = lines.line;
      if (line.starts_with("-----BEGIN PGP")) {
        skip_encrypted(lines, file);
      } else if (line.starts_with('*')) {
        before = false;
        if (!read_keyword(lines, file, format, placement)) {
          after_end(lines, file);
          break;
        }
      } else if (before && !line.starts_with('$') && !trimmed(line).empty()) {
        before = false;
        context_.error(
            "text-before-keyword", {file, lines.number}, "", "",
            "\"" + std::string(trimmed(line).substr(0, 40)) + "\" stands before the first keyword",
            "Start the deck with *KEYWORD; comments start with $");
      }
    }
  }

  void finish() {
    context_.curve_units.convert(context_);
    context_.summarise_rest();
    if (!context_.options.expect_complete) return;
    if (context_.keywords == 0)
      context_.error("empty-deck", {0, 1}, "", "",
                     "the deck holds no keyword besides *KEYWORD and *END",
                     "Check that this is the right file");
  }

 private:
  static std::string identity(const fs::path& path) {
    std::error_code e;
    const fs::path canonical = fs::weakly_canonical(path, e);
    return e ? path.string() : canonical.string();
  }

  void skip_encrypted(Lines& lines, int file) {
    context_.report(Severity::unsupported, "encrypted-block", {file, lines.number}, "", "",
                    "an encrypted block cannot be read", "Ask its owner for the plain text");
    while (lines.next())
      if (lines.line.starts_with("-----END PGP")) return;
  }

  void after_end(Lines& lines, int file) {
    while (lines.next()) {
      if (lines.line.starts_with('$') || trimmed(lines.line).empty()) continue;
      context_.report(Severity::warning, "text-after-end", {file, lines.number}, "END", "",
                      "what follows *END is not read", "Remove it, or remove *END");
      return;
    }
  }

  // one keyword and its block; false at *END
  bool read_keyword(Lines& lines, int file, Format& format, const Placement& placement) {
    std::string_view line = trimmed(lines.line.substr(1));
    const std::size_t end = std::min(line.find_first_of(" \t,("), line.size());
    std::string keyword(line.substr(0, end));
    for (char& c : keyword) c = char(std::toupper(static_cast<unsigned char>(c)));
    std::string rest(trimmed(line.substr(end)));
    Format own = format;
    if (keyword.size() > 1 &&
        (keyword.back() == '+' || keyword.back() == '-' || keyword.back() == '%')) {
      rest = keyword.back();
      keyword.pop_back();
    }
    if (rest == "+") own = {true, false};
    if (rest == "-") own = {false, false};
    if (rest == "%") own = {false, true};
    Block block{keyword, {file, lines.number}, own, placement, lines, false, false, {}};
    if (keyword == "END") return false;
    if (keyword == "KEYWORD") {
      format_options(rest, format);
      block.skip();
      return true;
    }
    if (keyword != "COMMENT") ++context_.keywords;
    dispatch(block);
    block.skip();
    return true;
  }

  static void format_options(std::string text, Format& format) {
    for (char& c : text) c = char(std::toupper(static_cast<unsigned char>(c)));
    const auto set = [&](const char* name, bool& flag) {
      const std::size_t at = text.find(name);
      if (at == std::string::npos) return;
      const std::size_t equals = text.find_first_not_of(" \t", at + std::string_view(name).size());
      if (equals == std::string::npos || text[equals] != '=') return;
      const std::size_t value = text.find_first_not_of(" \t", equals + 1);
      // LONG=S keeps standard input with long output; only Y changes the reader
      if (value != std::string::npos) flag = text[value] == 'Y';
    };
    set("LONG", format.long_fields);
    set("I10", format.wide_ids);
  }

  void dispatch(Block& block) {
    const std::string& k = block.keyword;
    if (k == "TITLE") {
      if (block.next()) context_.builder.set_title(std::string(trimmed(block.line())));
    } else if (k == "COMMENT") {
      return;
    } else if (k.starts_with("INCLUDE") && include(block)) {
      return;
    } else if (!read_parameters(context_, block) && !read_bulk(context_, block)) {
      regular(block);
    }
  }

  void regular(Block& block) {
    std::vector<std::string> options;
    const Vocabulary& vocabulary = Vocabulary::get();
    const KeywordSchema* const schema = vocabulary.find(block.keyword, options);
    if (schema) return read_cards(context_, block, *schema, options);
    const auto near = vocabulary.suggest(block.keyword);
    std::string remedy = near.empty()
                             ? "Remove the keyword, or see the manual for what is supported"
                             : "Did you mean ";
    for (std::size_t i = 0; i < near.size(); ++i) remedy += (i ? ", *" : "*") + near[i];
    context_.error("unknown-keyword", block.where, block.keyword, "", "the keyword is not known",
                   remedy);
  }

  // a file name, continued on the next line where it ends in " +"
  std::string name_line(Block& block) {
    std::string name;
    do {
      std::string_view part = trimmed(block.lines.line);
      const bool more = part == "+" || part.ends_with(" +");
      if (more) part = trimmed(part.substr(0, part.size() - 1));
      name += part;
      if (!more) break;
    } while (block.next());
    std::replace(name.begin(), name.end(), '\\', '/');
    if (name.size() > 1 && (name[0] == '"' || name[0] == '\'') && name.back() == name[0])
      name = name.substr(1, name.size() - 2);
    return name;
  }

  // false if this member of the *INCLUDE family is not handled here
  bool include(Block& block) {
    const std::string& k = block.keyword;
    if (k == "INCLUDE_PATH" || k == "INCLUDE_PATH_RELATIVE") {
      while (block.next())
        if (const std::string name = name_line(block); !name.empty()) {
          paths_.push_back(k == "INCLUDE_PATH" ? fs::path(name) : main_folder_ / name);
          if (k != "INCLUDE_PATH") relative_paths_.push_back(name);
        }
      return true;
    }
    if (k == "INCLUDE") {
      while (block.next()) {
        const Location where = block.here();
        if (const std::string name = name_line(block); !name.empty())
          follow(block, name, where, block.placement);
      }
      return true;
    }
    if (k != "INCLUDE_TRANSFORM") return false;
    if (!block.next()) {
      context_.error("truncated-card", block.where, k, "filename", "the file name is missing",
                     "Name the file");
      return true;
    }
    const Location where = block.here();
    const std::string name = name_line(block);
    Placement inner;
    if (transform_cards(block, inner)) follow(block, name, where, nest(block.placement, inner));
    return true;
  }

  // the four lines of numbers below the file name
  bool transform_cards(Block& block, Placement& p) {
    static constexpr const char* names[4][8] = {
        {"idnoff", "ideoff", "idpoff", "idmoff", "idsoff", "idfoff", "iddoff", ""},
        {"idroff", "", "", "", "", "", "", ""},
        {"fctmas", "fcttim", "fctlen", "", "incout1", "", "", ""},
        {"tranid", "", "", "", "", "", "", ""}};
    double v[4][8] = {};
    const int width = block.format.long_fields ? 20 : 10;
    std::vector<FieldPlace> places;
    for (int i = 0; i < 8; ++i) places.push_back({i * width, width});
    FieldTexts texts;
    bool good = true;
    for (int line = 0; line < 4 && block.next(); ++line) {
      cut_fields(block.line(), places, 1 << 30, texts);
      for (int i = 0; i < 8; ++i) {
        bool given = false;
        if (*names[line][i])
          good = context_.number(block, block.here(), names[line][i], texts.text[std::size_t(i)],
                                 line != 2, v[line][i], given) &&
                 good;
      }
    }
    for (const auto& row : {v[0], v[1]})
      for (int i = 0; i < 7; ++i)
        if (std::abs(row[i]) > 1e12) return too_large(block);
    std::int64_t* const ids[7] = {&p.node, &p.element,  &p.part,  &p.material,
                                  &p.set,  &p.function, &p.define};
    for (int i = 0; i < 7; ++i) *ids[i] = std::int64_t(v[0][i]);
    p.other = std::int64_t(v[1][0]);
    if (v[2][0] != 0) p.mass = v[2][0];
    if (v[2][1] != 0) p.time = v[2][1];
    if (v[2][2] != 0) p.length = v[2][2];
    const auto id = std::int64_t(std::clamp(v[3][0], -1e15, 1e15));
    if (id != 0) {
      // one of the including file's own ids, which are shifted where it is placed itself, or one
      // from outside
      auto found = context_.transformations.find(id + block.placement.offset("transformation"));
      if (found == context_.transformations.end()) found = context_.transformations.find(id);
      if (found == context_.transformations.end()) {
        context_.error("missing-transformation", block.here(), block.keyword, "tranid",
                       "*DEFINE_TRANSFORMATION " + std::to_string(id) + " is not defined above",
                       "Define it before it is used");
        return false;
      }
      p.map = found->second;
    }
    return good;
  }

  bool too_large(const Block& block) {
    context_.error("value-out-of-range", block.here(), block.keyword, "", "an offset is too large",
                   "Use less than 1e12");
    return false;
  }

  void follow(const Block& block, const std::string& name, Location where,
              const Placement& placement) {
    if (!context_.options.follow_includes) {
      context_.error("include-not-followed", where, block.keyword, "filename",
                     name + " is not read here", "Read the deck from a file");
      return;
    }
    fs::path found;
    if (!locate(name, found)) {
      context_.error("missing-file", where, block.keyword, "filename",
                     name + " is in none of the search paths",
                     "Check the name, or add its folder with *INCLUDE_PATH");
      return;
    }
    if (std::find(open_.begin(), open_.end(), identity(found)) != open_.end() ||
        int(open_.size()) > deepest_include) {
      context_.error("cyclic-include", where, block.keyword, "filename",
                     name + " includes itself, directly or not", "Remove one of the includes");
      return;
    }
    context_.parameters.open_scope();
    read_file(found, placement);
    context_.parameters.close_scope();
  }

  // beside the including files from the innermost outwards, then in the search paths; those of
  // *INCLUDE_PATH_RELATIVE start at the main file, then at each file on the way to here
  bool locate(const std::string& name, fs::path& found) const {
    std::error_code e;
    const auto is_file = [&](const fs::path& p) { return fs::is_regular_file(p, e); };
    for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder)
      if (is_file(found = *folder / name)) return true;
    for (const fs::path& path : paths_)
      for (const fs::path& base : {main_folder_ / path, path})
        if (is_file(found = base / name)) return true;
    for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder)
      for (const fs::path& path : paths_)
        if (is_file(found = *folder / path / name)) return true;
    // a deck may itself be included, as by the main file of a case: then what it calls the main
    // folder is its own
    for (const fs::path& folder : folders_)
      for (const fs::path& path : relative_paths_)
        if (is_file(found = folder / path / name)) return true;
    return false;
  }

  Context context_;
  std::vector<fs::path> paths_, folders_, relative_paths_;
  std::vector<std::string> open_;  // files being read, outermost first
  fs::path main_folder_;
};

}  // namespace

bool read_into(Builder& builder, const fs::path& path, Diagnostics& diagnostics,
               const ReadOptions& options) {
  DeckReader reader(builder, diagnostics, options);
  if (!reader.read_file(path, Placement())) return false;
  reader.finish();
  return true;
}

void read_text_into(Builder& builder, std::string_view text, std::string_view name,
                    Diagnostics& diagnostics, const ReadOptions& options) {
  DeckReader reader(builder, diagnostics, options);
  reader.read_text(text, std::string(name), Placement());
  reader.finish();
}

std::unique_ptr<Model> read_deck(const fs::path& path, Diagnostics& diagnostics,
                                 const ReadOptions& options) {
  Builder builder(diagnostics);
  read_into(builder, path, diagnostics, options);
  return builder.finish();
}

std::unique_ptr<Model> read_deck_text(std::string_view text, std::string_view name,
                                      Diagnostics& diagnostics, const ReadOptions& options) {
  Builder builder(diagnostics);
  read_text_into(builder, text, name, diagnostics, options);
  return builder.finish();
}

}  // namespace fabrica
