#include "model/schema.h"

#include <algorithm>
#include <mutex>
#include <unordered_map>

#include "model/schema_text.h"

namespace fabrica {
namespace {

// Is `rest` a run of "_OPTION" suffixes of the keyword, in any order?
bool take_options(std::string_view rest, const KeywordSchema& k, std::vector<std::string>& found) {
  if (rest.empty()) return true;
  if (rest[0] != '_') return false;
  rest.remove_prefix(1);
  for (const std::string& option : k.options) {
    if (!rest.starts_with(option)) continue;
    const std::string_view next = rest.substr(option.size());
    if (!next.empty() && next[0] != '_') continue;
    if (std::find(found.begin(), found.end(), option) != found.end()) continue;
    found.push_back(option);
    if (take_options(next, k, found)) return true;
    found.pop_back();
  }
  return false;
}

// Levenshtein distance, at most `limit` + 1
int edit_distance(std::string_view a, std::string_view b, int limit) {
  if (std::abs(int(a.size()) - int(b.size())) > limit) return limit + 1;
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = int(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = int(i);
    int best = row[0];
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int keep = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({keep, row[j] + 1, row[j - 1] + 1});
      best = std::min(best, row[j]);
    }
    if (best > limit) return limit + 1;
  }
  return row[b.size()];
}

}  // namespace

struct Vocabulary::Content {
  std::vector<KeywordText> texts;
  std::unordered_map<std::string_view, int> names;
  std::vector<KeywordSchema> keywords;  // one a text; those not read yet are empty
  std::vector<std::uint8_t> read;
  std::vector<std::string> problems;
  std::mutex reading;
};

Vocabulary::Vocabulary() : content_(std::make_unique<Content>()) {
  for (const std::string_view text : embedded_keyword_texts())
    split_schema(text, content_->texts, content_->problems);
  index();
}

Vocabulary::Vocabulary(std::string_view text) : content_(std::make_unique<Content>()) {
  split_schema(text, content_->texts, content_->problems);
  index();
}

Vocabulary::~Vocabulary() = default;

const Vocabulary& Vocabulary::get() {
  static const Vocabulary vocabulary;
  return vocabulary;
}

void Vocabulary::index() {
  Content& c = *content_;
  c.keywords.resize(c.texts.size());
  c.read.resize(c.texts.size());
  for (int i = 0; i < int(c.texts.size()); ++i)
    for (const std::string_view name : c.texts[i].names)
      if (!c.names.emplace(name, i).second) c.problems.push_back("twice: " + std::string(name));
}

const KeywordSchema& Vocabulary::schema(int i) const {
  Content& c = *content_;
  const std::lock_guard lock(c.reading);
  if (!c.read[i]) {
    std::vector<KeywordSchema> one;
    parse_schema(c.texts[i].text, one, c.problems, c.texts[i].line);
    if (!one.empty()) c.keywords[i] = std::move(one.front());
    c.read[i] = 1;
  }
  return c.keywords[i];
}

const std::vector<KeywordSchema>& Vocabulary::all() const {
  for (int i = 0; i < int(content_->texts.size()); ++i) schema(i);
  return content_->keywords;
}

const std::vector<std::string>& Vocabulary::problems() const {
  all();
  return content_->problems;
}

int Vocabulary::canonical(std::string_view name) const {
  const auto it = content_->names.find(name);
  return it == content_->names.end() ? -1 : it->second;
}

const KeywordSchema* Vocabulary::find(std::string_view name) const {
  const int i = canonical(name);
  return i < 0 ? nullptr : &schema(i);
}

const KeywordSchema* Vocabulary::find(std::string_view keyword,
                                      std::vector<std::string>& options) const {
  // the longest known name whose remainder consists of its options
  for (std::size_t length = keyword.size(); length != keyword.npos && length > 0;
       length = keyword.rfind('_', length - 1)) {
    const int i = canonical(keyword.substr(0, length));
    options.clear();
    if (i >= 0 && take_options(keyword.substr(length), schema(i), options)) return &schema(i);
  }
  options.clear();
  return nullptr;
}

std::vector<std::string> Vocabulary::suggest(std::string_view keyword, int count) const {
  const int limit = std::max(2, int(keyword.size()) / 4);
  std::vector<std::pair<int, std::string>> near;
  for (const auto& [name, i] : content_->names) {
    const int d = edit_distance(keyword.substr(0, 80), name, limit);
    if (d <= limit) near.emplace_back(d, std::string(name));
  }
  std::sort(near.begin(), near.end());
  std::vector<std::string> names;
  for (const auto& [d, name] : near)
    if (int(names.size()) < count) names.push_back(name);
  return names;
}

}  // namespace fabrica
