#include "signal/iso_mme.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "signal/units.h"

namespace fabrica {
namespace {

namespace fs = std::filesystem;

std::string trimmed(const std::string& s) {
  const std::size_t a = s.find_first_not_of(" \t\r"), b = s.find_last_not_of(" \t\r");
  return a == std::string::npos ? "" : s.substr(a, b - a + 1);
}

[[noreturn]] void broken(const std::string& path, int line, const std::string& what) {
  throw SignalError(
      "bad-channel-file", fmt::format("{}:{}: {}", path, line, what),
      "An ISO-MME channel file has lines 'key :value' up to 'Number of samples', then the samples");
}

double to_number(const std::string& text, const std::string& path, int line) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0')
    throw SignalError("not-a-number", fmt::format("{}:{}: '{}'", path, line, text),
                      "Write a number");
  return value;
}

Signal read_channel_file(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw SignalError("no-such-file", "cannot open " + path, "Check the path");
  std::map<std::string, std::pair<std::string, int>> header;  // value and line
  std::string line;
  int number = 0;
  while (header.count("Number of samples") == 0 && std::getline(in, line)) {
    ++number;
    const std::size_t colon = line.find(':');
    if (trimmed(line).empty()) continue;
    if (colon == std::string::npos) broken(path, number, "'" + trimmed(line) + "' has no colon");
    header[trimmed(line.substr(0, colon))] = {trimmed(line.substr(colon + 1)), number};
  }
  auto value = [&](const char* key) {
    const auto found = header.find(key);
    if (found == header.end()) broken(path, number, fmt::format("'{}' is missing", key));
    return to_number(found->second.first, path, found->second.second);
  };
  if (const auto kind = header.find("Reference channel");
      kind != header.end() && kind->second.first == "explicit")
    broken(path, kind->second.second, "a channel with times in another file is not supported");
  const double start = value("Time of first sample"), step = value("Sampling interval");
  const double count = value("Number of samples");
  Signal s{header["Channel code"].first, plain_unit(header["Unit"].first), "s", {}, {}};
  while (std::getline(in, line)) {
    ++number;
    if (trimmed(line).empty()) continue;
    s.x.push_back(start + double(s.x.size()) * step);
    s.y.push_back(to_number(trimmed(line), path, number));
  }
  if (double(s.size()) != count)
    broken(path, number, fmt::format("{} samples, 'Number of samples' says {}", s.size(), count));
  return s;
}

// .001, .002, ...
bool is_channel_file(const fs::path& p) {
  const std::string e = p.extension().string();
  return e.size() >= 4 &&
         std::all_of(e.begin() + 1, e.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::vector<std::string> channel_files(const fs::path& path) {
  if (is_channel_file(path)) return {path.string()};
  fs::path folder = fs::is_directory(path) ? path : path.parent_path();
  if (folder.empty()) folder = ".";
  for (const char* name : {"Channel", "channel", "CHANNEL"})
    if (fs::is_directory(folder / name)) folder /= name;
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_channel_file(entry.path()))
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  if (files.empty())
    throw SignalError("no-such-channel", folder.string() + " holds no ISO-MME channel file",
                      "Name a .csv table, or an ISO-MME test with files .001, .002, ...");
  return files;
}

std::string entry(const std::string& key, const std::string& value) {
  return fmt::format("{:<28}:{}\n", key, value);
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream out(path);
  out << text;
  out.flush();
  if (!out)
    throw SignalError("cannot-write", "cannot write " + path.string(),
                      "Check the folder and the space left");
}

}  // namespace

std::string plain_unit(std::string unit) {
  auto replace = [&](const std::string& from, const std::string& to) {
    if (const std::size_t at = unit.find(from); at != std::string::npos)
      unit.replace(at, from.size(), to);
  };
  replace("\xC2\xB2", "2");    // superscript two, UTF-8
  replace("\xB2", "2");        // superscript two, Latin-1
  replace("\xC2\xB0", "deg");  // degree sign, UTF-8
  replace("\xB0", "deg");      // degree sign, Latin-1
  replace("\xC2\xB7", "");     // middle dot
  replace("(s*s)", "s2");
  replace("N*m", "Nm");
  return unit;
}

std::vector<Signal> read_mme_test(const std::string& path) {
  std::vector<Signal> out;
  for (const std::string& file : channel_files(path)) out.push_back(read_channel_file(file));
  return out;
}

Signal read_mme_channel(const std::string& path, const std::string& code) {
  std::vector<Signal> all = read_mme_test(path), found;
  std::vector<std::string> names;
  for (Signal& s : all) {
    names.push_back(s.name);
    if (s.name == code) return std::move(s);
  }
  for (Signal& s : all)
    if (s.name.rfind(code, 0) == 0) found.push_back(std::move(s));
  if (found.size() != 1)
    throw SignalError("no-such-channel",
                      fmt::format("{}: {} channels begin with '{}'", path, found.size(), code),
                      "There are: " + listed(names));
  return std::move(found[0]);
}

void write_mme_test(const std::string& folder, const std::string& test,
                    const std::vector<Signal>& signals) {
  const fs::path root(folder), channels = root / "Channel";
  fs::create_directories(channels);
  std::string list = entry("Instrumentation standard", "ISO 6487") +
                     entry("Number of channels", fmt::format("{}", signals.size()));
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const Signal& s = signals[i];
    const double to_seconds = unit_factor(s.x_unit, "s"), step = sample_interval(s) * to_seconds;
    list += entry(fmt::format("Name of channel {:03}", i + 1), s.name + " / " + s.name);
    std::string text =
        entry("Test object number", "1") + entry("Name of the channel", s.name) +
        entry("Channel code", s.name) + entry("Unit", s.unit.empty() ? "NOVALUE" : s.unit) +
        entry("Reference channel", "implicit") +
        entry("Time of first sample", fmt::format("{:.12g}", s.x.front() * to_seconds)) +
        entry("Sampling interval", fmt::format("{:.12g}", step)) +
        entry("Number of samples", fmt::format("{}", s.size()));
    for (const double y : s.y) text += fmt::format("{:.12g}\n", y);
    write_text(channels / fmt::format("{}.{:03}", test, i + 1), text);
  }
  write_text(channels / (test + ".chn"), list);
  write_text(root / (test + ".mme"),
             entry("Data format edition number", "1.6") + entry("Name of the test", test));
}

}  // namespace fabrica
