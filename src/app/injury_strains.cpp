#include "app/injury_strains.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "result/element_strain.h"

namespace fabrica {
namespace {

namespace fs = std::filesystem;
using Parts = std::vector<int>;  // indices into the mesh

const std::vector<std::string> tissues{"brain", "liver", "spleen", "kidney",
                                       "heart", "lung",  "ribs"};

std::vector<std::string> split(const std::string& text, const std::string& at) {
  std::vector<std::string> out(1);
  for (const char c : text)
    if (at.find(c) != std::string::npos)
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

std::vector<std::string> words_of(std::string title) {
  for (char& c : title) c = char(std::tolower(static_cast<unsigned char>(c)));
  return split(title, "._- ,:/");
}

bool is_rib(const std::string& word) {
  return word.size() > 3 && word.starts_with("rib") &&
         std::all_of(word.begin() + 3, word.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

// "thorax.left.rib05.cortical" -> "thorax left rib05"; "" where it is no cortical bone of a rib
std::string rib_of(const std::string& title) {
  const std::vector<std::string> words = words_of(title);
  std::string name;
  bool rib = false, cortical = false;
  for (const std::string& w : words) {
    rib = rib || is_rib(w);
    cortical = cortical || w.starts_with("cortical");
    if (!cortical) name += (name.empty() ? "" : " ") + w;
  }
  return rib && cortical ? name : "";
}

// items of a tissue that nobody asked for: by the words of the titles
std::vector<Parts> titled(const std::string& tissue, const ResultMesh& mesh) {
  std::map<std::string, Parts> ribs;
  Parts organ;
  for (int p = 0; p < mesh.parts(); ++p) {
    const std::string& title = mesh.part_title[std::size_t(p)];
    if (tissue == "ribs") {
      if (const std::string rib = rib_of(title); !rib.empty()) ribs[rib].push_back(p);
      continue;
    }
    for (const std::string& w : words_of(title))
      if (w == tissue || w == tissue + "s") {
        organ.push_back(p);
        break;
      }
  }
  std::vector<Parts> items;
  for (auto& [name, parts] : ribs) items.push_back(std::move(parts));
  if (!organ.empty()) items.push_back(std::move(organ));
  return items;
}

int part_named(const std::string& name, const ResultMesh& mesh) {
  const bool number = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isdigit(c) != 0;
  });
  for (int p = 0; p < mesh.parts(); ++p)
    if (number ? std::to_string(mesh.part_id[std::size_t(p)]) == name
               : mesh.part_title[std::size_t(p)] == name)
      return p;
  std::vector<std::string> some;
  for (int p = 0; p < std::min(mesh.parts(), 12); ++p)
    some.push_back(
        fmt::format("{} {}", mesh.part_id[std::size_t(p)], mesh.part_title[std::size_t(p)]));
  throw SignalError("no-such-part", "the d3plot has no part '" + name + "'",
                    fmt::format("Among its {} parts: {}", mesh.parts(), fmt::join(some, ", ")));
}

std::vector<Parts> asked(const std::vector<std::string>& items, const ResultMesh& mesh) {
  std::vector<Parts> out;
  for (const std::string& item : items) {
    out.emplace_back();
    for (const std::string& part : split(item, "+")) out.back().push_back(part_named(part, mesh));
  }
  return out;
}

// strain over volume of every solid of an organ
Signal organ(const Parts& parts, const ResultMesh& mesh, const PeakStrains& peak) {
  Signal s;
  for (std::size_t e = 0; e < mesh.solid.size(); ++e)
    if (std::find(parts.begin(), parts.end(), mesh.solid_part[e]) != parts.end())
      s.x.push_back(peak.solid_volume[e]), s.y.push_back(peak.solid[e]);
  return s;
}

// the largest strain of each rib over its number
Signal ribs(const std::vector<Parts>& items, const ResultMesh& mesh, const PeakStrains& peak) {
  Signal s;
  for (const Parts& parts : items) {
    double largest = -1;
    const auto look = [&](const std::vector<int>& part_of, const std::vector<double>& strain) {
      for (std::size_t e = 0; e < part_of.size(); ++e)
        if (std::find(parts.begin(), parts.end(), part_of[e]) != parts.end())
          largest = std::max(largest, strain[e]);
    };
    look(mesh.solid_part, peak.solid), look(mesh.shell_part, peak.shell);
    if (largest < 0) return {};
    s.x.push_back(double(s.x.size() + 1)), s.y.push_back(largest);
  }
  return s;
}

std::string titles(const std::vector<Parts>& items, const ResultMesh& mesh) {
  std::vector<std::string> names;
  for (const Parts& parts : items)
    for (const int p : parts)
      names.push_back(mesh.part_title[std::size_t(p)].empty()
                          ? std::to_string(mesh.part_id[std::size_t(p)])
                          : mesh.part_title[std::size_t(p)]);
  const std::size_t shown = std::min<std::size_t>(names.size(), 4);
  return fmt::format("{}{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(shown), ", "),
                     names.size() > shown ? fmt::format(", ... ({} parts)", names.size()) : "");
}

RunStrains read_strains(const std::string& file, const StrainRequest& request) {
  const D3plotReader reader(file);
  const ResultMesh& mesh = reader.mesh();
  std::map<std::string, std::vector<Parts>> chosen;
  std::vector<bool> wanted(std::size_t(mesh.parts()), false);
  for (const std::string& tissue : tissues) {
    const auto given = request.parts.find(tissue);
    auto items = given == request.parts.end() ? titled(tissue, mesh) : asked(given->second, mesh);
    if (items.empty()) continue;
    for (const Parts& parts : items)
      for (const int p : parts) wanted[std::size_t(p)] = true;
    chosen[tissue] = std::move(items);
  }
  RunStrains out;
  if (chosen.empty()) return out;
  const PeakStrains peak =
      peak_strains(reader, wanted,
                   request.measure == "green" ? StrainMeasure::green : StrainMeasure::logarithmic);
  for (const auto& [tissue, items] : chosen) {
    Parts all;
    for (const Parts& parts : items) all.insert(all.end(), parts.begin(), parts.end());
    Signal s = tissue == "ribs" ? ribs(items, mesh, peak) : organ(all, mesh, peak);
    if (s.y.empty()) {
      if (!request.parts.count(tissue)) continue;  // only titles that sound like it
      throw SignalError("no-elements",
                        "the parts of '" + tissue + "' (" + titles(items, mesh) + ") have no " +
                            (tissue == "ribs" ? "solids or shells" : "solids"),
                        "Name others by --part " + tissue + "=...");
    }
    out.notes.push_back(fmt::format(
        "{}.strain: {}, {} {}, {} states of {}, {} strain", tissue, titles(items, mesh), s.y.size(),
        tissue == "ribs" ? "ribs" : "solids", reader.times().size(), file, request.measure));
    s.name = tissue + ".strain", s.unit = "1";
    out.channels[s.name] = std::move(s);
  }
  return out;
}

}  // namespace

StrainRequest strain_request(const std::vector<std::string>& parts, const std::string& measure) {
  StrainRequest out;
  out.measure = measure;
  for (const std::string& text : parts) {
    const std::size_t equal = text.find('=');
    const std::string tissue = text.substr(0, equal);
    if (equal == std::string::npos || equal + 1 == text.size() ||
        std::find(tissues.begin(), tissues.end(), tissue) == tissues.end())
      throw SignalError("bad-setting", "'" + text + "' is not TISSUE=PARTS",
                        fmt::format("Write brain=12,13; tissues are {}", fmt::join(tissues, ", ")));
    for (const std::string& item : split(text.substr(equal + 1), ","))
      out.parts[tissue].push_back(item);
  }
  return out;
}

RunStrains strains_of_run(const std::string& folder, const StrainRequest& request) {
  const fs::path file = fs::path(folder) / "d3plot";
  if (!fs::exists(file)) return {};
  try {
    return read_strains(file.string(), request);
  } catch (const std::runtime_error& e) {
    if (dynamic_cast<const SignalError*>(&e)) throw;
    throw SignalError("cannot-read", e.what(), "Give a complete d3plot family");
  }
}

}  // namespace fabrica
