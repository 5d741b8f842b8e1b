#pragma once
// Animation states as a d3plot family: d3plot (control block and geometry), d3plot01, d3plot02, ...
// (states). Single precision, plain layout (NDIM 4). Nodes, elements and parts are written in
// ascending order of their user ids; parts keep their slots in the globals also without elements.
// Discrete elements are two-node beams whose axial force is theirs. Rigid shells have state data
// like all others.
#include <memory>
#include <string>
#include <vector>

#include "result/d3plot_layout.h"
#include "result/mesh.h"

namespace fabrica {

struct D3plotOptions {
  int shell_layers = 3;     // layers in AnimationState::shell_stress
  bool strains = false;     // write solid_strain and shell_strain
  int rigid_walls = 0;      // length of AnimationState::wall_force
  double file_bytes = 1e9;  // a state that does not fit begins a new member of the family
};
D3plotOptions d3plot_options(const Model& model);

class D3plotWriter {
 public:
  // Writes the geometry; removes the states of an earlier run. Throws std::runtime_error if it
  // cannot.
  D3plotWriter(const std::string& path, const Model& model);
  D3plotWriter(const std::string& path, const ResultMesh& mesh, const D3plotOptions& options);
  // Goes on with the family of a run that is restarted at `restart_time`: later states are dropped.
  // Begins anew if there is none; throws if the one that is there belongs to another model.
  D3plotWriter(const std::string& path, const ResultMesh& mesh, const D3plotOptions& options,
               double restart_time);

  // Appends one state and closes the file with its end marker: it can be read at once.
  void write(const AnimationState& state);
  const D3plotLayout& layout() const { return layout_; }
  int states() const { return states_; }

 private:
  void start(const std::string& path, const ResultMesh& mesh, const D3plotOptions& options);
  void write_geometry() const;

  std::string path_;
  D3plotOptions options_;
  ResultMesh mesh_;    // as given: states arrive in its order
  SortedMesh sorted_;  // as written
  D3plotLayout layout_;
  int member_ = 1;             // family member that takes the next state
  std::int64_t position_ = 0;  // word in it
  int states_ = 0;
};

// Reads geometry and states of a d3plot family, ours or another program's: 4- or 8-byte words, with
// or without material section. Particles and fluids are refused; thick shells are skipped. Throws
// std::runtime_error.
class D3plotReader {
 public:
  explicit D3plotReader(const std::string& path);
  const D3plotLayout& layout() const { return layout_; }
  // Order of the file; user ids are 1, 2, ... where the file names none. Discrete elements are
  // beams.
  const ResultMesh& mesh() const { return mesh_; }
  const std::vector<double>& times() const { return times_; }
  // State i from 0; throws std::out_of_range.
  AnimationState state(int i) const;
  // Where state i begins: member of the family and word.
  std::pair<int, std::int64_t> place(int i) const {
    return {places_.at(i).member, places_.at(i).word};
  }

 private:
  struct Words;  // a stretch of a file, read as reals or integers
  struct Place {
    int member;
    std::int64_t word;
  };
  Words read(int member, std::int64_t from, std::int64_t count) const;
  void read_control();
  void read_geometry();
  void read_numbering(std::int64_t from);
  void read_titles(std::int64_t from);
  void find_states();

  std::string path_;
  int word_bytes_ = 4;
  std::int64_t material_words_ = 0;
  std::vector<bool> part_rigid_;
  D3plotLayout layout_;
  ResultMesh mesh_;
  std::vector<double> times_;
  std::vector<Place> places_;
};

}  // namespace fabrica
