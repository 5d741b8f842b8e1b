#include "model/schema_text.h"

#include <charconv>

namespace fabrica {
namespace {

// words of a line; a quoted text is one word without its quotes
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t i = 0;
  while (i < line.size()) {
    if (line[i] == ' ' || line[i] == '\t' || line[i] == '\r') {
      ++i;
    } else if (line[i] == '"') {
      const std::size_t end = std::min(line.find('"', i + 1), line.size());
      words.push_back(line.substr(i + 1, end - i - 1));
      i = end + 1;
    } else {
      const std::size_t end = std::min(line.find_first_of(" \t\r", i), line.size());
      words.push_back(line.substr(i, end - i));
      i = end;
    }
  }
  return words;
}

bool to_number(std::string_view text, double& value) {
  const auto [p, e] = std::from_chars(text.data(), text.data() + text.size(), value);
  return e == std::errc() && p == text.data() + text.size();
}

class SchemaParser {
 public:
  SchemaParser(std::vector<KeywordSchema>& keywords, std::vector<std::string>& problems)
      : keywords_(keywords), problems_(problems) {}

  void line(std::string_view text, int number) {
    number_ = number;
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || text[first] == '#') return;
    const auto words = words_of(text);
    if (words[0] == "keyword" && words.size() == 2) {
      keywords_.emplace_back().name = words[1];
      in_card_ = false;
    } else if (keywords_.empty()) {
      problem("text before the first keyword");
    } else if (first > 0 && in_card_) {
      field(words);
    } else {
      heading(words, text.substr(first));
    }
  }

 private:
  void problem(const std::string& what) {
    problems_.push_back((keywords_.empty() ? "" : keywords_.back().name + ", ") + "line " +
                        std::to_string(number_) + ": " + what);
  }

  // the rest of a line after its first n words
  static std::string rest(std::string_view text, int n) {
    for (; n > 0; --n) {
      text.remove_prefix(std::min(text.find_first_of(" \t"), text.size()));
      text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    }
    while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
    return std::string(text);
  }

  void heading(const std::vector<std::string_view>& words, std::string_view text) {
    KeywordSchema& k = keywords_.back();
    if (words[0] == "alias") {
      for (std::size_t i = 1; i < words.size(); ++i) k.aliases.emplace_back(words[i]);
    } else if (words[0] == "options") {
      for (std::size_t i = 1; i < words.size(); ++i) k.options.emplace_back(words[i]);
    } else if (words[0] == "category") {
      k.category = rest(text, 1);
    } else if (words[0] == "summary") {
      k.summary = rest(text, 1);
    } else if (words[0] == "support" && words.size() > 1) {
      if (words[1] == "ignored") k.support = Support::ignored;
      if (words[1] == "unsupported") k.support = Support::unsupported;
      k.reason = rest(text, 2);
    } else if (words[0] == "repeats_whole") {
      k.repeats_whole = true;
    } else if (words[0] == "card") {
      card(words);
    } else {
      problem("unknown word " + std::string(words[0]));
    }
  }

  void card(const std::vector<std::string_view>& words) {
    CardSchema& c = keywords_.back().cards.emplace_back();
    in_card_ = true, column_ = 0, width_ = 10;
    for (std::size_t i = 1; i < words.size(); ++i) {
      double number = 0;
      if (words[i] == "optional")
        c.optional = true;
      else if (words[i] == "repeats")
        c.repeats = true;
      else if (words[i] == "title")
        c.title = true;
      else if (words[i] == "if" && i + 1 < words.size())
        c.condition = words[++i];
      else if (words[i].starts_with("width=") && to_number(words[i].substr(6), number))
        width_ = int(number);
      else
        problem("unknown word on a card: " + std::string(words[i]));
    }
  }

  void field(const std::vector<std::string_view>& words) {
    FieldSchema f;
    f.width = width_;
    const bool unused = words[0] == "-";
    std::size_t i = 1;
    if (!unused) {
      f.name = words[0];
      if (words.size() < 2) return problem("a field without a type");
      if (words[1] == "int")
        f.type = FieldType::integer;
      else if (words[1] == "text")
        f.type = FieldType::text;
      else if (words[1] != "real")
        return problem("unknown type " + std::string(words[1]));
      i = 2;
    }
    for (; i < words.size(); ++i)
      if (!attribute(f, words[i])) {
        if (i + 1 != words.size()) problem("unknown attribute " + std::string(words[i]));
        f.help = words[i];
      }
    f.column = column_;
    column_ += f.width;
    if (!unused) keywords_.back().cards.back().fields.push_back(std::move(f));
  }

  bool attribute(FieldSchema& f, std::string_view word) {
    const std::size_t equals = word.find('=');
    const std::string_view name = word.substr(0, equals);
    const std::string_view value =
        equals == word.npos ? std::string_view{} : word.substr(equals + 1);
    double number = 0;
    const bool numeric = to_number(value, number);
    if (name == "required" && value.empty()) return f.required = true;
    if (name == "ignored" && value.empty()) return f.support = Support::ignored, true;
    if (name == "unsupported" && value.empty()) return f.support = Support::unsupported, true;
    if (name == "width" && numeric) return f.width = int(number), true;
    if (name == "default" && numeric) return f.default_value = number, true;
    if (name == "min" && numeric) return f.minimum = number, true;
    if (name == "max" && numeric) return f.maximum = number, true;
    if (name == "above" && numeric) return f.minimum = number, f.exclusive_minimum = true;
    if (name == "ref" && !value.empty()) return f.reference = value, true;
    if (name == "unit" && !value.empty()) return f.unit = value, true;
    if (name == "supported" && !value.empty()) {
      f.supported_values = value;
      for (char& c : f.supported_values)
        if (c == ',') c = ' ';
      return true;
    }
    return false;
  }

  std::vector<KeywordSchema>& keywords_;
  std::vector<std::string>& problems_;
  int number_ = 0, column_ = 0, width_ = 10;
  bool in_card_ = false;
};

}  // namespace

void split_schema(std::string_view text, std::vector<KeywordText>& keywords,
                  std::vector<std::string>& problems) {
  const std::size_t before = keywords.size();
  const char* begin = text.data();  // of the keyword that is being cut
  const char* const end = text.data() + text.size();
  const auto close = [&](const char* here) {
    if (keywords.size() > before) keywords.back().text = {begin, std::size_t(here - begin)};
  };
  int number = 0;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    ++number;
    if (line.starts_with("keyword ")) {
      close(line.data());
      begin = line.data();
      KeywordText& k = keywords.emplace_back();
      k.names = words_of(line.substr(8));
      k.line = number;
      if (k.names.size() != 1)
        problems.push_back("line " + std::to_string(number) + ": a keyword has one name");
      k.names.resize(1);
    } else if (line.starts_with("alias ") && keywords.size() > before) {
      for (const std::string_view name : words_of(line.substr(6)))
        keywords.back().names.push_back(name);
    } else if (keywords.size() == before && line.find_first_not_of(" \t\r") != line.npos &&
               line[0] != '#') {
      problems.push_back("line " + std::to_string(number) + ": text before the first keyword");
    }
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  close(end);
}

void parse_schema(std::string_view text, std::vector<KeywordSchema>& keywords,
                  std::vector<std::string>& problems, int line) {
  SchemaParser parser(keywords, problems);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    parser.line(text.substr(0, end), line++);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace fabrica
