#include "result/d3plot.h"

#include <doctest/doctest.h>

#include <cstring>
#include <fstream>

#include "result/sample_test.h"

using namespace fabrica;

namespace {

std::string contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
float word(const std::string& bytes, std::int64_t i) {
  float v;
  std::memcpy(&v, bytes.data() + 4 * i, 4);
  return v;
}

// the state in the order of the sorted mesh
template <class T>
std::vector<T> reordered(const std::vector<T>& v, const std::vector<int>& order, int width) {
  std::vector<T> out;
  for (const int i : order)
    out.insert(out.end(), v.begin() + i * width, v.begin() + (i + 1) * width);
  return out;
}

}  // namespace

TEST_CASE("d3plot: word counts of a real file, 4915 nodes and 4696 shells") {
  D3plotLayout l;
  l.numnp = 4915;
  l.nel4 = 4696;
  l.nmmat = 1;
  l.nglbv = 13;
  l.neips = 19;
  l.maxint = -10003;
  l.nv2d = l.shell_values() + 12;
  CHECK(l.nv2d == 102);
  CHECK(l.strains());
  CHECK(numbering_words(l) == 9624 + 6);  // that file has the short header of 10 words
  CHECK(64 + l.geometry_words() + 9624 == 47913);
  CHECK(l.state_words() == 527937);
}

TEST_CASE("d3plot: names of the family") {
  CHECK(family_member("a/d3plot", 0) == "a/d3plot");
  CHECK(family_member("a/d3plot", 7) == "a/d3plot07");
  CHECK(family_member("a/d3plot", 100) == "a/d3plot100");
}

TEST_CASE("d3plot: what is written is read, sorted by user id") {
  for (const bool strains : {false, true}) {
    const sample::Scratch scratch;
    const std::string path = scratch.file("d3plot");
    const ResultMesh mesh = sample::mesh();
    D3plotOptions options;
    options.strains = strains;
    options.rigid_walls = 1;
    D3plotWriter out(path, mesh, options);
    AnimationState s = sample::state(mesh, 0.5);
    s.solid_alive = {1, 0, 1};
    out.write(sample::state(mesh, 0));
    out.write(s);

    // sizes: whole blocks, end markers where the identities put them
    const std::string geometry = contents(path), states = contents(path + "01");
    const D3plotLayout& l = out.layout();
    CHECK(geometry.size() % (4 * d3plot_block) == 0);
    CHECK(states.size() % (4 * d3plot_block) == 0);
    CHECK(l.narbs == 16 + 14 + 3 + 2 + 2 + 3 * 5);
    CHECK(word(geometry, 64 + l.geometry_words() + l.narbs) == d3plot_end);
    CHECK(word(geometry, 64 + l.geometry_words() + l.narbs + 1 + 2 + 5 * 19 + 19) == d3plot_end);
    CHECK(word(states, 2 * l.state_words()) == d3plot_end);

    const D3plotReader in(path);
    const SortedMesh sorted = sorted_by_id(mesh);
    CHECK(in.mesh().title == "every shape once");
    CHECK(in.mesh().node_id == sorted.mesh.node_id);
    CHECK(in.mesh().part_id == std::vector<std::int64_t>{10, 20, 30, 40, 50});
    CHECK(in.mesh().part_title[3] == "brick and wedge");
    CHECK(in.mesh().solid == sorted.mesh.solid);
    CHECK(in.mesh().shell == sorted.mesh.shell);
    CHECK(in.mesh().beam == sorted.mesh.beam);
    CHECK(in.mesh().position == sorted.mesh.position);
    CHECK(in.mesh().solid_part == std::vector<int>{4, 3, 3});
    CHECK(in.times() == std::vector<double>{0, 0.5});

    const AnimationState r = in.state(1);
    CHECK(r.position == reordered(s.position, sorted.node, 3));
    CHECK(r.velocity == reordered(s.velocity, sorted.node, 3));
    CHECK(r.acceleration == reordered(s.acceleration, sorted.node, 3));
    CHECK(r.solid_stress == reordered(s.solid_stress, sorted.solid, 6));
    CHECK(r.solid_plastic_strain == reordered(s.solid_plastic_strain, sorted.solid, 1));
    CHECK(r.shell_stress == reordered(s.shell_stress, sorted.shell, 18));
    CHECK(r.shell_resultants == reordered(s.shell_resultants, sorted.shell, 8));
    CHECK(r.shell_thickness == reordered(s.shell_thickness, sorted.shell, 1));
    CHECK(r.shell_energy_density == reordered(s.shell_energy_density, sorted.shell, 1));
    if (strains) {
      CHECK(r.solid_strain == reordered(s.solid_strain, sorted.solid, 6));
      CHECK(r.shell_strain == reordered(s.shell_strain, sorted.shell, 12));
    } else {
      CHECK(r.solid_strain.empty());
    }
    // the spring has the lower id and comes first; its force is axial
    CHECK(r.beam_resultants[0] == s.discrete_force[0]);
    CHECK(r.beam_resultants[6] == s.beam_resultants[0]);
    CHECK(r.solid_alive == std::vector<std::uint8_t>{0, 1, 1});
    CHECK(r.part_mass == std::vector<double>{304, 303, 302, 301, 300});
    CHECK(r.part_velocity[1] == 604);
    CHECK(r.wall_force == std::vector<double>{77});
    CHECK(r.kinetic_energy == 1.5);
  }
}

TEST_CASE("d3plot: many states spread over members; a restart leaves the uninterrupted family") {
  const sample::Scratch scratch;
  const ResultMesh mesh = sample::mesh();
  D3plotOptions options;
  options.rigid_walls = 1;
  options.file_bytes = 8000;  // room for three states
  const std::string whole = scratch.file("whole"), parts = scratch.file("parts");
  {
    D3plotWriter out(whole, mesh, options);
    for (int i = 0; i < 9; ++i) out.write(sample::state(mesh, i));
  }
  {
    D3plotWriter out(parts, mesh, options);
    for (int i = 0; i < 8; ++i) out.write(sample::state(mesh, i));
  }
  for (const int last : {6, 4, 2}) {
    D3plotWriter out(parts, mesh, options, last);
    CHECK(out.states() == last + 1);
    CHECK(D3plotReader(parts).times().size() == std::size_t(last + 1));
    for (int i = last + 1; i < 9; ++i) out.write(sample::state(mesh, i));
    int members = 0;
    for (; std::filesystem::exists(family_member(whole, members)); ++members)
      CHECK(contents(family_member(whole, members)) == contents(family_member(parts, members)));
    CHECK(members >= 3);
    CHECK_FALSE(std::filesystem::exists(family_member(parts, members)));
  }
  ResultMesh other = mesh;
  other.node_id[0] = 99999;
  CHECK_THROWS_WITH(D3plotWriter(parts, other, options, 1.0).states(),
                    doctest::Contains("belongs to another model"));
}

TEST_CASE("d3plot: a state that does not fit the model is refused") {
  const sample::Scratch scratch;
  const ResultMesh mesh = sample::mesh();
  D3plotWriter out(scratch.file("d3plot"), mesh, {});
  AnimationState s = sample::state(mesh, 0);
  s.velocity.pop_back();
  CHECK_THROWS_WITH(out.write(s), "animation state: velocity has 41 values, the model needs 42");
}

TEST_CASE("d3plot: the reference files") {
  struct Expect {
    const char* path;
    int nodes, solids, beams, shells;
  };
  for (const Expect& e : {Expect{"ansys_d3plot/d3plot", 1065, 548, 0, 0},
                          Expect{"ansys_d3plot_beam/d3plot", 1940, 1512, 544, 0},
                          Expect{"lasso/simple_d3plot/d3plot", 4915, 0, 0, 4696},
                          Expect{"lasso/order_d3plot/d3plot", 106, 16, 0, 16},
                          Expect{"lasso/d3plot_solid_int/d3plot", 106, 16, 0, 16},
                          Expect{"lasso/d3plot_beamip/d3plot", 2, 0, 1, 0}}) {
    const std::string path = sample::reference(e.path);
    if (path.empty()) continue;
    CAPTURE(e.path);
    const D3plotReader in(path);
    CHECK(in.mesh().nodes() == e.nodes);
    CHECK(in.mesh().solids() == e.solids);
    CHECK(in.mesh().beams() == e.beams);
    CHECK(in.mesh().shells() == e.shells);
    CHECK(in.times().size() >= 1);
    // times rise; the first state of a run is the undeformed mesh
    for (std::size_t i = 1; i < in.times().size(); ++i) CHECK(in.times()[i] > in.times()[i - 1]);
    const AnimationState s = in.state(0);
    check_state(in.mesh(), s);
    if (s.time == 0) CHECK(s.position == in.mesh().position);
    for (const std::uint8_t alive : s.solid_alive) CHECK(alive == 1);
  }
}
