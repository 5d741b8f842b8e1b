#include "result/binout.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace fabrica {
namespace {

constexpr int states_between_flushes = 100;

std::string padded(std::string text, std::size_t width) {
  text.resize(width, ' ');
  return text;
}

bool is_state(const std::string& name) {
  return name.size() >= 7 && name[0] == 'd' &&
         std::all_of(name.begin() + 1, name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// The path in four pieces: "/elout/solid", "d000002", "time".
struct Place {
  std::string database, folder, variable;
};
Place split(const std::string& path) {
  const std::size_t b = path.rfind('/');
  const std::size_t a = b == 0 ? std::string::npos : path.rfind('/', b - 1);
  if (a == std::string::npos) return {"", path.substr(0, b), path.substr(b + 1)};
  return {path.substr(0, a), path.substr(a + 1, b - a - 1), path.substr(b + 1)};
}

// Copies the metadata and the states up to a time; returns the number of states of each database.
std::map<std::string, int> copy_until(const LsdaReader& from, double time, LsdaWriter& to) {
  std::map<std::string, int> states;
  for (const auto& [path, symbol] : from.symbols()) {
    const Place place = split(path);
    if (is_state(place.folder)) {
      const std::string folder = place.database + "/" + place.folder;
      // time is stored in single precision: compare as such
      if (!from.has(folder + "/time") || float(from.reals(folder + "/time").at(0)) > float(time))
        continue;
      int& n = states[place.database.substr(1)];
      n = std::max(n, std::stoi(place.folder.substr(1)));
    }
    to.cd(path.substr(0, path.rfind('/')));
    to.write_raw(place.variable, symbol.type, from.raw(path).data(), symbol.count);
  }
  return states;
}

}  // namespace

std::string state_name(int number) { return fmt::format("d{:06d}", number); }

void check_shape(const HistoryDatabase& database, const HistorySample& sample) {
  if (sample.values.size() != database.variables.size())
    throw std::runtime_error(fmt::format("{}: {} variables announced, {} given", database.path,
                                         database.variables.size(), sample.values.size()));
  for (std::size_t i = 0; i < sample.values.size(); ++i)
    if (int(sample.values[i].size()) != database.variables[i].length)
      throw std::runtime_error(fmt::format("{}/{}: {} values announced, {} given", database.path,
                                           database.variables[i].name, database.variables[i].length,
                                           sample.values[i].size()));
}

BinoutWriter::BinoutWriter(const std::string& path, std::string title)
    : title_(std::move(title)), file_(std::make_unique<LsdaWriter>(path)) {}

BinoutWriter::BinoutWriter(const std::string& path, std::string title, double restart_time)
    : title_(std::move(title)) {
  if (!std::filesystem::exists(path)) {
    file_ = std::make_unique<LsdaWriter>(path);
    return;
  }
  // write the part that stays beside the old file and take its place: a crash here loses nothing
  const std::string fresh = path + ".new";
  {
    const LsdaReader old(path);
    file_ = std::make_unique<LsdaWriter>(fresh);
    earlier_ = copy_until(old, restart_time, *file_);
    file_->flush();
  }
  std::filesystem::rename(fresh, path);
}

int BinoutWriter::add(HistoryDatabase database) {
  Stream stream{std::move(database)};
  if (const auto it = earlier_.find(stream.database.path); it != earlier_.end())
    stream.states = it->second;
  else
    write_metadata(stream.database);
  streams_.push_back(std::move(stream));
  return int(streams_.size()) - 1;
}

void BinoutWriter::write_metadata(const HistoryDatabase& d) {
  file_->cd("/" + d.path + "/metadata");
  file_->write_text("title", padded(title_, 80));
  file_->write_text("version", padded("fabrica", 10));
  file_->write_text("revision", padded("0", 10));
  file_->write_text("date", padded("", 10));  // left blank: equal runs give equal files
  if (!d.ids.empty()) file_->write_integers("ids", d.ids);
  if (!d.legend.empty()) {
    std::string all;
    for (const std::string& s : d.legend) all += padded(s, 70);
    file_->write_text("legend", all);
    file_->write_integers("legend_ids", d.ids);
  }
  for (const auto& [name, text] : d.text_metadata) file_->write_text(name, text);
  for (const auto& [name, values] : d.integer_metadata) file_->write_integers(name, values);
}

void BinoutWriter::write(int database, const HistorySample& sample) {
  Stream& stream = streams_.at(database);
  check_shape(stream.database, sample);
  file_->cd("/" + stream.database.path + "/" + state_name(++stream.states));
  file_->write_reals("time", {sample.time});
  file_->write_integers("cycle", {sample.cycle});
  for (std::size_t i = 0; i < sample.values.size(); ++i) {
    const HistoryVariable& v = stream.database.variables[i];
    if (v.integer)
      file_->write_integers(v.name, {sample.values[i].begin(), sample.values[i].end()});
    else
      file_->write_reals(v.name, sample.values[i]);
  }
  if (++unflushed_ >= states_between_flushes) flush();
}

void BinoutWriter::flush() {
  file_->flush();
  unflushed_ = 0;
}

}  // namespace fabrica
