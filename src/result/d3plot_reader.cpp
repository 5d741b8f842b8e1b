#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <stdexcept>

#include "result/d3plot.h"

namespace fabrica {

// A stretch of a file; words are taken as the reader knows them: reals or integers of 4 or 8 bytes.
struct D3plotReader::Words {
  std::string data;
  int bytes;
  std::int64_t size() const { return std::int64_t(data.size()) / bytes; }
  double real(std::int64_t i) const {
    if (bytes == 8) return value<double>(i);
    return double(value<float>(i));
  }
  std::int64_t integer(std::int64_t i) const {
    if (bytes == 8) return value<std::int64_t>(i);
    return value<std::int32_t>(i);
  }
  std::vector<std::int64_t> integers(std::int64_t from, std::int64_t count) const {
    std::vector<std::int64_t> out(static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) out[i] = integer(from + i);
    return out;
  }
  std::vector<float> reals(std::int64_t from, std::int64_t count) const {
    std::vector<float> out(static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) out[i] = float(real(from + i));
    return out;
  }
  template <class T>
  T value(std::int64_t i) const {
    T v;
    std::memcpy(&v, data.data() + i * std::int64_t(sizeof v), sizeof v);
    return v;
  }
};

namespace {

std::string trimmed(std::string s) {
  s.erase(std::min(s.find('\0'), s.size()));
  s.erase(s.find_last_not_of(' ') + 1);
  s.erase(0, s.find_first_not_of(' '));
  return s;
}

// Numbers of the family members that exist, in ascending order. Members may be missing in between.
std::vector<int> members(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path base(path);
  const std::string stem = base.filename().string();
  const fs::path folder = base.has_parent_path() ? base.parent_path() : fs::path(".");
  std::vector<int> out;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.size() < stem.size() + 2 || name.size() > stem.size() + 6 ||
        name.compare(0, stem.size(), stem) != 0)
      continue;
    const std::string digits = name.substr(stem.size());
    if (std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; }))
      out.push_back(std::stoi(digits));
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

D3plotReader::D3plotReader(const std::string& path) : path_(path) {
  read_control();
  read_geometry();
  find_states();
}

D3plotReader::Words D3plotReader::read(int member, std::int64_t from, std::int64_t count) const {
  const std::string name = family_member(path_, member);
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(name.c_str(), "rb"), std::fclose);
  if (!file) throw std::runtime_error("cannot open " + name);
  std::fseek(file.get(), 0, SEEK_END);
  const std::int64_t size = std::ftell(file.get());
  if (from + count > size / word_bytes_) throw std::runtime_error(name + " ends too early");
  Words out{std::string(std::size_t(count) * word_bytes_, '\0'), word_bytes_};
  std::fseek(file.get(), long(from * word_bytes_), SEEK_SET);
  if (std::fread(out.data.data(), 1, out.data.size(), file.get()) != out.data.size())
    throw std::runtime_error("cannot read " + name);
  return out;
}

void D3plotReader::read_control() {
  // the file type is a small number in words of the right size only
  Words words = read(0, 0, 64);
  auto plausible = [](std::int64_t type) {
    return type % 1000 == 1 || type % 1000 == 5 || type % 1000 == 11;
  };
  if (!plausible(words.integer(11))) {
    word_bytes_ = 8;
    words = read(0, 0, 64);
    if (!plausible(words.integer(11))) throw std::runtime_error(path_ + " is not a d3plot");
  }
  const std::int64_t extra = words.integer(57);
  if (extra < 0 || extra > 64) throw std::runtime_error(path_ + ": damaged control block");
  mesh_.title = trimmed(words.data.substr(0, 10 * word_bytes_));
  const double version = words.real(14);
  words = read(0, 0, 64 + extra);
  layout_ = decode(words.integers(0, words.size()), float(version));
  if (layout_.nmsph != 0 || layout_.npefg != 0 || layout_.ncfdv1 != 0)
    throw std::runtime_error(path_ + ": particles and fluids in a d3plot are not supported");

  // material section: which materials are rigid
  if (layout_.ndim == 5 || layout_.ndim == 7) {
    const std::int64_t at = 64 + extra;
    const Words head = read(0, at, 2);
    layout_.rigid_shells = int(head.integer(0));
    const std::int64_t materials = head.integer(1);
    material_words_ = 2 + materials;
    const Words types = read(0, at + 2, materials);
    for (std::int64_t i = 0; i < materials; ++i) part_rigid_.push_back(types.integer(i) == 20);
  }
}

void D3plotReader::read_geometry() {
  const D3plotLayout& l = layout_;
  const std::int64_t start = 64 + l.extra + material_words_;
  const Words words = read(0, start, l.geometry_words());
  mesh_.position = words.reals(0, 3 * std::int64_t(l.numnp));
  std::int64_t at = 3 * std::int64_t(l.numnp);
  auto next = [&](auto& nodes, int stride, int& part) {
    for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = int(words.integer(at + k)) - 1;
    part = int(words.integer(at + stride - 1)) - 1;
    at += stride;
  };
  mesh_.solid.resize(l.solids());
  mesh_.solid_part.resize(l.solids());
  for (int e = 0; e < l.solids(); ++e) next(mesh_.solid[e], 9, mesh_.solid_part[e]);
  if (l.nel8 < 0) at += 2 * std::int64_t(l.solids());
  at += 9 * std::int64_t(l.nelt);
  mesh_.beam.resize(l.nel2);
  mesh_.beam_part.resize(l.nel2);
  for (int e = 0; e < l.nel2; ++e) next(mesh_.beam[e], 6, mesh_.beam_part[e]);
  mesh_.shell.resize(l.nel4);
  mesh_.shell_part.resize(l.nel4);
  for (int e = 0; e < l.nel4; ++e) next(mesh_.shell[e], 5, mesh_.shell_part[e]);

  read_numbering(start + at);
  read_titles(start + at + l.narbs);

  // a part is of the family of its elements
  mesh_.part_family.assign(mesh_.part_id.size(), Family::none);
  auto mark = [&](std::vector<int>& parts, Family family) {
    for (int& p : parts) {
      if (p < 0 || p >= mesh_.parts())
        throw std::runtime_error(path_ + ": an element names no part");
      mesh_.part_family[p] = family;
    }
  };
  mark(mesh_.solid_part, Family::solid);
  mark(mesh_.beam_part, Family::beam);
  mark(mesh_.shell_part, Family::shell);
}

void D3plotReader::read_numbering(std::int64_t from) {
  const D3plotLayout& l = layout_;
  auto ids = [](std::vector<std::int64_t>& out, const Words& w, std::int64_t at,
                std::int64_t count) { out = w.integers(at, count); };
  auto count_up = [](std::vector<std::int64_t>& out, std::int64_t count) {
    out.resize(std::size_t(count));
    std::iota(out.begin(), out.end(), 1);
  };
  const std::int64_t parts = std::max(l.nmmat, l.nummat8 + l.nummat2 + l.nummat4 + l.nummatt);
  count_up(mesh_.part_id, parts);
  count_up(mesh_.node_id, l.numnp);
  count_up(mesh_.solid_id, l.solids());
  count_up(mesh_.beam_id, l.nel2);
  count_up(mesh_.shell_id, l.nel4);
  mesh_.part_title.resize(std::size_t(parts));
  if (l.narbs == 0) return;

  const Words w = read(0, from, l.narbs);
  std::int64_t at = w.integer(0) < 0 ? 16 : 10;
  const std::int64_t needed = at + l.numnp + l.solids() + l.nel2 + l.nel4 + l.nelt;
  if (l.narbs < needed) throw std::runtime_error(path_ + ": the section of user ids is too short");
  ids(mesh_.node_id, w, at, l.numnp);
  ids(mesh_.solid_id, w, at += l.numnp, l.solids());
  ids(mesh_.beam_id, w, at += l.solids(), l.nel2);
  ids(mesh_.shell_id, w, at += l.nel2, l.nel4);
  // three arrays of parts close the section: in the order elements refer to, sorted, and the map
  // between
  if (l.narbs >= needed + 3 * parts) ids(mesh_.part_id, w, l.narbs - 3 * parts, parts);
}

// Title records follow the first end marker: 90000 title, 90001 parts. Their text is of 4-byte
// characters.
void D3plotReader::read_titles(std::int64_t from) {
  const std::int64_t size = std::int64_t(std::filesystem::file_size(path_)) / word_bytes_;
  if (from >= size) return;
  const Words w = read(0, from, size - from);
  std::int64_t i = 0;
  while (i < w.size() && float(w.real(i)) != d3plot_end) ++i;
  std::int64_t byte = (i + 1) * word_bytes_;
  const std::int64_t text = 72;
  auto integer = [&](std::int64_t at) {
    std::int64_t v = 0;
    std::memcpy(&v, w.data.data() + at, word_bytes_);
    return v;
  };
  while (byte + word_bytes_ <= std::int64_t(w.data.size())) {
    const std::int64_t kind = integer(byte);
    byte += word_bytes_;
    if (kind == 90000 && byte + text <= std::int64_t(w.data.size())) {
      mesh_.title = trimmed(w.data.substr(byte, text));
      byte += text;
    } else if (kind == 90001 || kind == 90002) {
      const std::int64_t count = integer(byte);
      byte += word_bytes_;
      for (std::int64_t k = 0;
           k < count && byte + word_bytes_ + text <= std::int64_t(w.data.size()); ++k) {
        const std::int64_t id = integer(byte);
        const auto it = std::find(mesh_.part_id.begin(), mesh_.part_id.end(), id);
        if (kind == 90001 && it != mesh_.part_id.end())
          mesh_.part_title[it - mesh_.part_id.begin()] =
              trimmed(w.data.substr(byte + word_bytes_, text));
        byte += word_bytes_ + text;
      }
    } else {
      return;
    }
  }
}

void D3plotReader::find_states() {
  const std::int64_t words = layout_.state_words();
  for (const int member : members(path_)) {
    const std::int64_t size =
        std::int64_t(std::filesystem::file_size(family_member(path_, member))) / word_bytes_;
    for (std::int64_t at = 0; at + words <= size; at += words) {
      const double time = read(member, at, 1).real(0);
      if (float(time) == d3plot_end) break;
      times_.push_back(time);
      places_.push_back({member, at});
    }
  }
}

namespace {

// Takes values from a state one after the other.
template <class Words>
class Cursor {
 public:
  explicit Cursor(const Words& words) : words_(words) {}
  double next() { return words_.real(at_++); }
  void skip(std::int64_t count) { at_ += count; }
  template <class T>
  void append(std::vector<T>& out, std::int64_t count) {
    for (std::int64_t k = 0; k < count; ++k) out.push_back(T(next()));
  }

 private:
  const Words& words_;
  std::int64_t at_ = 0;
};

template <class C>
void take_globals(C& in, const D3plotLayout& l, AnimationState& s) {
  const int parts = l.nmmat, walls = l.nglbv - 6 - 7 * parts;
  if (walls < 0) return in.skip(l.nglbv);
  s.kinetic_energy = in.next();
  s.internal_energy = in.next();
  s.total_energy = in.next();
  for (double& v : s.momentum_velocity) v = in.next();
  in.append(s.part_internal_energy, parts);
  in.append(s.part_kinetic_energy, parts);
  in.append(s.part_velocity, 3 * parts);
  in.append(s.part_mass, parts);
  in.append(s.part_hourglass_energy, parts);
  in.append(s.wall_force, walls);
}

template <class C>
void take_nodes(C& in, const D3plotLayout& l, AnimationState& s) {
  const std::int64_t n = l.numnp, vectors = (l.iu != 0) + (l.iv != 0) + (l.ia != 0);
  if (l.iu) in.append(s.position, 3 * n);
  in.skip(n * (l.node_words() - 3 * vectors));  // temperatures, added mass
  if (l.iv) in.append(s.velocity, 3 * n);
  if (l.ia) in.append(s.acceleration, 3 * n);
}

template <class C>
void take_solids(C& in, const D3plotLayout& l, AnimationState& s) {
  in.skip(std::int64_t(l.nt3d) * l.solids());
  if (l.nv3d < 7) return in.skip(std::int64_t(l.solids()) * l.nv3d);
  const int strain = l.strains() && l.neiph >= 6 ? 6 : 0;
  for (int e = 0; e < l.solids(); ++e) {
    in.append(s.solid_stress, 6);
    in.append(s.solid_plastic_strain, 1);
    in.skip(l.nv3d - 7 - strain);
    in.append(s.solid_strain, strain);
  }
}

template <class C>
void take_shell(C& in, const D3plotLayout& l, AnimationState& s) {
  for (int k = 0; k < l.layers(); ++k) {
    in.append(s.shell_stress, l.has(0) ? 6 : 0);
    in.append(s.shell_plastic_strain, l.has(1));
    in.skip(l.neips);
  }
  in.append(s.shell_resultants, l.has(2) ? 8 : 0);
  if (l.has(3)) {
    in.append(s.shell_thickness, 1);
    in.skip(2);
    in.append(s.shell_energy_density, 1);
  }
  const int strain = l.nv2d - l.shell_values() >= 12 ? 12 : 0;
  in.skip(l.nv2d - l.shell_values() - strain);
  in.append(s.shell_strain, strain);
}

// a shell without data: zeros of the same number
void add_absent_shell(const D3plotLayout& l, AnimationState& s) {
  auto zeros = [](std::vector<float>& v, int count) { v.resize(v.size() + std::size_t(count)); };
  zeros(s.shell_stress, l.has(0) ? 6 * l.layers() : 0);
  zeros(s.shell_plastic_strain, l.has(1) ? l.layers() : 0);
  zeros(s.shell_resultants, l.has(2) ? 8 : 0);
  zeros(s.shell_thickness, l.has(3));
  zeros(s.shell_energy_density, l.has(3));
  zeros(s.shell_strain, l.nv2d - l.shell_values() >= 12 ? 12 : 0);
}

// the table of deleted elements: zero means deleted
template <class C>
void take_alive(C& in, const D3plotLayout& l, AnimationState& s) {
  auto alive = [&](std::vector<std::uint8_t>& out, int count) {
    for (int e = 0; e < count; ++e) out.push_back(in.next() != 0);
  };
  if (!l.element_deletion()) return;
  alive(s.solid_alive, l.solids());
  in.skip(l.nelt);
  alive(s.shell_alive, l.nel4);
  alive(s.beam_alive, l.nel2);
}

}  // namespace

AnimationState D3plotReader::state(int i) const {
  const D3plotLayout& l = layout_;
  const Place place = places_.at(std::size_t(i));
  const Words words = read(place.member, place.word, l.state_words());
  Cursor in(words);
  AnimationState s;
  s.time = in.next();
  s.shell_layers = l.layers();
  take_globals(in, l, s);
  take_nodes(in, l, s);
  take_solids(in, l, s);
  in.skip(std::int64_t(l.nelt) * l.nv3dt);
  for (int e = 0; e < l.nel2; ++e) {
    in.append(s.beam_resultants, l.nv1d >= 6 ? 6 : 0);
    in.skip(l.nv1d >= 6 ? l.nv1d - 6 : l.nv1d);
  }
  for (int e = 0; e < l.nel4; ++e) {
    // where there is a material section, shells of rigid parts have no data
    const int p = mesh_.shell_part[e];
    const bool absent = l.rigid_shells > 0 && p < int(part_rigid_.size()) && part_rigid_[p];
    absent ? add_absent_shell(l, s) : take_shell(in, l, s);
  }
  take_alive(in, l, s);
  return s;
}

}  // namespace fabrica
