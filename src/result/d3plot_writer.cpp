#include <fmt/format.h>

#include <bit>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "result/d3plot.h"

namespace fabrica {
namespace {

// Words to be written, integers and reals side by side.
class Buffer {
 public:
  void integer(std::int64_t v) { words_.push_back(std::uint32_t(std::int32_t(v))); }
  void real(double v) { words_.push_back(std::bit_cast<std::uint32_t>(float(v))); }
  void text(std::string t, int words) {
    t.resize(std::size_t(words) * 4, ' ');
    const std::size_t at = words_.size();
    words_.resize(at + words);
    std::memcpy(&words_[at], t.data(), t.size());
  }
  void integers(const std::vector<std::int64_t>& v) {
    for (const auto i : v) integer(i);
  }
  // the `width` values of entity i; zeros where there is no data
  template <class T>
  void reals_of(const std::vector<T>& v, int i, int width) {
    for (int k = 0; k < width; ++k) real(v.empty() ? 0.0 : v[std::size_t(i) * width + k]);
  }
  template <class T>
  void reals(const std::vector<T>& v, const std::vector<int>& order, int width) {
    for (const int i : order) reals_of(v, i, width);
  }
  void pad() { words_.resize((words_.size() + d3plot_block - 1) / d3plot_block * d3plot_block); }
  std::int64_t size() const { return std::int64_t(words_.size()); }
  const std::vector<std::uint32_t>& words() const { return words_; }
  void reserve(std::int64_t n) { words_.reserve(std::size_t(n)); }

 private:
  std::vector<std::uint32_t> words_;
};

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

void store(const std::string& path, const char* mode, std::int64_t word, const Buffer& buffer) {
  File file(std::fopen(path.c_str(), mode), std::fclose);
  if (!file) throw std::runtime_error("cannot write " + path);
  std::fseek(file.get(), long(word * 4), SEEK_SET);
  const auto& w = buffer.words();
  if (std::fwrite(w.data(), 4, w.size(), file.get()) != w.size() || std::fflush(file.get()) != 0)
    throw std::runtime_error("cannot write " + path + ": disk full?");
}

int parts_of(const ResultMesh& mesh, Family family) {
  int count = 0;
  for (const Family f : mesh.part_family)
    count += f == family || (family == Family::beam && f == Family::discrete);
  return count;
}

D3plotLayout make_layout(const ResultMesh& mesh, const D3plotOptions& options) {
  D3plotLayout l;
  l.numnp = mesh.nodes();
  l.nmmat = mesh.parts();
  l.nglbv = 6 + 7 * l.nmmat + options.rigid_walls;
  l.nel8 = mesh.solids();
  l.nel2 = mesh.beams();
  l.nel4 = mesh.shells();
  l.nummat2 = parts_of(mesh, Family::beam);
  l.nummat4 = parts_of(mesh, Family::shell);
  l.nummat8 = l.nmmat - l.nummat2 - l.nummat4;  // parts without elements count here
  l.maxint = -10000 - options.shell_layers;
  l.neiph = options.strains ? 6 : 0;
  l.nv3d = 7 + l.neiph;
  l.nv1d = 6;
  l.nv2d = l.shell_values() + (options.strains ? 12 : 0);
  l.idtdt = options.strains ? 10000 : 0;
  l.narbs = numbering_words(l);
  return l;
}

// pointers, counts, ids and the three arrays of parts; ids are ascending, so the cross reference is
// the identity
void add_numbering(Buffer& out, const ResultMesh& m) {
  const std::int64_t nodes = m.nodes(), solids = m.solids(), beams = m.beams(), shells = m.shells(),
                     parts = m.parts();
  const std::int64_t first = 16 + 1, solid = first + nodes, beam = solid + solids,
                     shell = beam + beams, thick = shell + shells, part = thick;
  for (const std::int64_t v :
       {-first, solid, beam, shell, thick, nodes, solids, beams, shells, std::int64_t(0)})
    out.integer(v);
  for (const std::int64_t v : {part + parts, part, part + 2 * parts, parts, std::int64_t(0), parts})
    out.integer(v);
  out.integers(m.node_id);
  out.integers(m.solid_id);
  out.integers(m.beam_id);
  out.integers(m.shell_id);
  out.integers(m.part_id);
  out.integers(m.part_id);
  for (std::int64_t i = 1; i <= parts; ++i) out.integer(i);
}

void add_titles(Buffer& out, const ResultMesh& m) {
  out.integer(90001);
  out.integer(m.parts());
  for (int p = 0; p < m.parts(); ++p) {
    out.integer(m.part_id[p]);
    out.text(m.part_title[p], 18);
  }
  out.integer(90000);
  out.text(m.title, 18);
}

void add_globals(Buffer& out, const AnimationState& s, const std::vector<int>& part, int walls) {
  out.real(s.time);
  for (const double v : {s.kinetic_energy, s.internal_energy, s.total_energy}) out.real(v);
  for (const double v : s.momentum_velocity) out.real(v);
  out.reals(s.part_internal_energy, part, 1);
  out.reals(s.part_kinetic_energy, part, 1);
  out.reals(s.part_velocity, part, 3);
  out.reals(s.part_mass, part, 1);
  out.reals(s.part_hourglass_energy, part, 1);
  for (int w = 0; w < walls; ++w) out.real(w < int(s.wall_force.size()) ? s.wall_force[w] : 0.0);
}

void add_solids(Buffer& out, const AnimationState& s, const std::vector<int>& solid, bool strains) {
  for (const int e : solid) {
    out.reals_of(s.solid_stress, e, 6);
    out.reals_of(s.solid_plastic_strain, e, 1);
    if (strains) out.reals_of(s.solid_strain, e, 6);
  }
}

void add_beams(Buffer& out, const AnimationState& s, const std::vector<int>& beam, int discretes) {
  const int beams = int(beam.size()) - discretes;
  for (const int e : beam) {
    const bool discrete = e >= beams;
    for (int k = 0; k < 6; ++k) {
      double v = 0;
      if (!discrete && !s.beam_resultants.empty()) v = s.beam_resultants[6 * std::size_t(e) + k];
      if (discrete && k == 0 && !s.discrete_force.empty()) v = s.discrete_force[e - beams];
      out.real(v);
    }
  }
}

// per layer stress and plastic strain; then resultants, thickness, two element values, energy; then
// strains
void add_shells(Buffer& out, const AnimationState& s, const std::vector<int>& shell, int layers,
                bool strains) {
  for (const int e : shell) {
    for (int k = 0; k < layers; ++k) {
      out.reals_of(s.shell_stress, e * layers + k, 6);
      out.reals_of(s.shell_plastic_strain, e * layers + k, 1);
    }
    out.reals_of(s.shell_resultants, e, 8);
    out.reals_of(s.shell_thickness, e, 1);
    out.real(0);
    out.real(0);
    out.reals_of(s.shell_energy_density, e, 1);
    if (strains) out.reals_of(s.shell_strain, e, 12);
  }
}

void add_alive(Buffer& out, const std::vector<std::uint8_t>& alive, const std::vector<int>& order,
               const std::vector<int>& part) {
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool lives = std::size_t(order[i]) >= alive.size() || alive[order[i]];
    out.real(lives ? part[i] + 1 : 0);  // like the reference: the part of a living element
  }
}

}  // namespace

D3plotOptions d3plot_options(const Model& model) {
  D3plotOptions o;
  o.shell_layers = model.output.shell_layers;
  o.strains = model.output.write_strains;
  o.rigid_walls = int(model.rigid_walls.size());
  return o;
}

D3plotWriter::D3plotWriter(const std::string& path, const Model& model)
    : D3plotWriter(path, result_mesh(model), d3plot_options(model)) {}

D3plotWriter::D3plotWriter(const std::string& path, const ResultMesh& mesh,
                           const D3plotOptions& options) {
  start(path, mesh, options);
  for (int n = 1; std::filesystem::remove(family_member(path, n)); ++n) {
  }
  write_geometry();
}

D3plotWriter::D3plotWriter(const std::string& path, const ResultMesh& mesh,
                           const D3plotOptions& options, double restart_time) {
  start(path, mesh, options);
  if (!std::filesystem::exists(path)) {
    write_geometry();
    return;
  }

  const D3plotReader old(path);
  if (encode(old.layout(), "") != encode(layout_, "") || old.mesh().node_id != sorted_.mesh.node_id)
    throw std::runtime_error(path + " belongs to another model; remove it or write elsewhere");
  const auto& times = old.times();
  while (states_ < int(times.size()) && float(times[states_]) <= float(restart_time)) ++states_;
  if (states_ > 0) {
    const auto [member, word] = old.place(states_ - 1);
    member_ = member;
    position_ = word + layout_.state_words();
    Buffer end;
    end.real(d3plot_end);
    const std::string name = family_member(path, member);
    store(name, "r+b", position_, end);
    const std::int64_t words = (position_ + d3plot_block) / d3plot_block * d3plot_block;
    std::filesystem::resize_file(name, std::uintmax_t(words) * 4);
  }
  for (int n = member_ + (states_ > 0); std::filesystem::remove(family_member(path, n)); ++n) {
  }
}

void D3plotWriter::start(const std::string& path, const ResultMesh& mesh,
                         const D3plotOptions& options) {
  path_ = path;
  options_ = options;
  mesh_ = mesh;
  sorted_ = sorted_by_id(mesh);
  layout_ = make_layout(sorted_.mesh, options);
}

void D3plotWriter::write_geometry() const {
  const ResultMesh& m = sorted_.mesh;
  Buffer out;
  for (const std::uint32_t w : encode(layout_, m.title)) out.integer(std::int32_t(w));
  for (const float x : m.position) out.real(x);

  // nodes and parts count from 1; a beam has two spare words
  auto element = [&](const auto& nodes, int spare, int part) {
    for (const int n : nodes) out.integer(n + 1);
    for (int i = 0; i < spare; ++i) out.integer(0);
    out.integer(part + 1);
  };
  for (int e = 0; e < m.solids(); ++e) element(m.solid[e], 0, m.solid_part[e]);
  for (int e = 0; e < m.beams(); ++e) element(m.beam[e], 2, m.beam_part[e]);
  for (int e = 0; e < m.shells(); ++e) element(m.shell[e], 0, m.shell_part[e]);
  add_numbering(out, m);
  out.real(d3plot_end);
  add_titles(out, m);
  out.real(d3plot_end);
  out.pad();
  store(path_, "wb", 0, out);
}

void D3plotWriter::write(const AnimationState& state) {
  check_state(mesh_, state);
  if (state.shell_layers != options_.shell_layers && mesh_.shells() > 0)
    throw std::runtime_error(fmt::format("d3plot: {} shell layers announced, {} given",
                                         options_.shell_layers, state.shell_layers));
  Buffer out;
  out.reserve(layout_.state_words() + d3plot_block);
  add_globals(out, state, sorted_.part, options_.rigid_walls);
  out.reals(state.position, sorted_.node, 3);
  out.reals(state.velocity, sorted_.node, 3);
  out.reals(state.acceleration, sorted_.node, 3);
  add_solids(out, state, sorted_.solid, options_.strains);
  add_beams(out, state, sorted_.beam, mesh_.discretes);
  add_shells(out, state, sorted_.shell, options_.shell_layers, options_.strains);
  add_alive(out, state.solid_alive, sorted_.solid, sorted_.mesh.solid_part);
  add_alive(out, state.shell_alive, sorted_.shell, sorted_.mesh.shell_part);
  add_alive(out, state.beam_alive, sorted_.beam, sorted_.mesh.beam_part);
  if (out.size() != layout_.state_words())
    throw std::logic_error("d3plot: a state has the wrong length");
  out.real(d3plot_end);

  // a state is never split; each member holds at least one
  if (position_ > 0 && 4.0 * double(position_ + out.size()) > options_.file_bytes) {
    ++member_;
    position_ = 0;
  }
  const std::int64_t end = position_ + out.size();
  for (std::int64_t i = end; i % d3plot_block != 0; ++i) out.integer(0);
  store(family_member(path_, member_), position_ == 0 ? "wb" : "r+b", position_, out);
  position_ = end - 1;  // the next state takes the place of the end marker
  ++states_;
}

}  // namespace fabrica
