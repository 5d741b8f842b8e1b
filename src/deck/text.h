#pragma once
// The text of a deck file: mapped or inflated into memory, and cut into lines.
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace fabrica {

// A file's bytes, for the life of this object.
class FileText {
 public:
  virtual ~FileText() = default;
  std::string_view text;
};

// Maps a file into memory, or inflates it when its first bytes say gzip or zstd. Null, and what
// went wrong in `problem`, if it cannot be read.
std::unique_ptr<FileText> load_text(const std::filesystem::path& path, std::string& problem);

// Cuts a text into lines, counting from 1; handles LF and CRLF and a missing final newline.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  std::string_view line;
  int number = 0;

  // moves to the next line; false at the end
  bool next() {
    if (rest_.empty()) return false;
    const void* const found = std::char_traits<char>::find(rest_.data(), rest_.size(), '\n');
    const std::size_t end =
        found ? std::size_t(static_cast<const char*>(found) - rest_.data()) : rest_.size();
    line = rest_.substr(0, end);
    rest_.remove_prefix(found ? end + 1 : end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++number;
    return true;
  }
  // moves to the next data line of a block: passes over comments, stops before a keyword or an
  // encrypted block
  bool next_data() {
    while (!rest_.empty()) {
      if (rest_[0] == '*' || rest_.starts_with("-----BEGIN PGP")) return false;
      if (!next()) return false;
      if (line.empty() || line[0] != '$') return true;
    }
    return false;
  }
  // rest of the text after the current line
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

// a line in which each tab reaches to the next column divisible by 8
std::string without_tabs(std::string_view line);

}  // namespace fabrica
