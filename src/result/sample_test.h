#pragma once
// What the tests of this folder share: a small model of every element shape with ids out of order,
// states whose values tell where they belong, a scratch folder, and the place of foreign files.
#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "result/mesh.h"

namespace fabrica::sample {

// A folder that is removed at the end of the test.
struct Scratch {
  std::filesystem::path path;
  Scratch() {
    static int count = 0;
    path = std::filesystem::temp_directory_path() /
           ("fabrica_result_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path);
  }
  ~Scratch() { std::filesystem::remove_all(path); }
  std::string file(const std::string& name) const { return (path / name).string(); }
};

// The folder of the reference files, or empty (the test then says that it is skipped).
inline std::string reference(const std::string& below) {
  const char* shared = std::getenv("FABRICA_SHARED");
  std::filesystem::path base = shared ? shared : FABRICA_SOURCE "/../shared";
  base /= "decks/reference-d3plot-binout/" + below;
  if (std::filesystem::exists(base)) return base.string();
  MESSAGE("skipped: no reference file " << below);
  return {};
}

inline ResultMesh mesh() {
  ResultMesh m;
  m.title = "every shape once";
  // two layers of 3 x 2 nodes, then two nodes of beam and spring
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i)
        m.position.insert(m.position.end(), {float(i), float(j), float(k)});
  m.position.insert(m.position.end(), {0, 0, 3, 0, 0, 4});
  for (int n = 0; n < 14; ++n) m.node_id.push_back(1000 - 7 * n);  // descending
  m.solid = {{0, 1, 4, 3, 6, 7, 10, 9}, {1, 2, 4, 7, 7, 7, 7, 7}, {1, 2, 5, 4, 7, 7, 10, 10}};
  m.solid_id = {30, 10, 20};
  m.solid_part = {1, 0, 1};
  m.shell = {{6, 7, 10, 9}, {7, 8, 10, 10}};
  m.shell_id = {5, 4};
  m.shell_part = {2, 2};
  m.beam = {{6, 12, 0}, {12, 13, -1}};
  m.beam_id = {8, 7};
  m.beam_part = {3, 4};
  m.discretes = 1;
  m.part_id = {50, 40, 30, 20, 10};
  m.part_title = {"tetrahedron", "brick and wedge", "shells", "beam", "spring"};
  m.part_family = {Family::solid, Family::solid, Family::shell, Family::beam, Family::discrete};
  return m;
}

// Values that no two places share: 1000 * kind + index, plus the time.
inline AnimationState state(const ResultMesh& m, double time, int layers = 3) {
  AnimationState s;
  s.time = time;
  s.shell_layers = layers;
  auto fill = [time](std::vector<float>& v, int kind, int count) {
    for (int i = 0; i < count; ++i) v.push_back(float(1000 * kind + i + time));
  };
  for (const float x : m.position) s.position.push_back(x + float(time));
  fill(s.velocity, 1, 3 * m.nodes());
  fill(s.acceleration, 2, 3 * m.nodes());
  fill(s.solid_stress, 3, 6 * m.solids());
  fill(s.solid_plastic_strain, 4, m.solids());
  fill(s.solid_strain, 5, 6 * m.solids());
  fill(s.shell_stress, 6, 6 * layers * m.shells());
  fill(s.shell_plastic_strain, 7, layers * m.shells());
  fill(s.shell_resultants, 8, 8 * m.shells());
  fill(s.shell_thickness, 9, m.shells());
  fill(s.shell_energy_density, 10, m.shells());
  fill(s.shell_strain, 11, 12 * m.shells());
  fill(s.beam_resultants, 12, 6 * (m.beams() - m.discretes));
  fill(s.discrete_force, 13, m.discretes);
  s.solid_alive.assign(m.solids(), 1);
  s.kinetic_energy = 1 + time;
  s.internal_energy = 2;
  s.total_energy = 3 + time;
  for (int p = 0; p < m.parts(); ++p) {
    s.part_internal_energy.push_back(100 + p);
    s.part_kinetic_energy.push_back(200 + p);
    s.part_mass.push_back(300 + p);
    s.part_hourglass_energy.push_back(400 + p);
    s.part_velocity.insert(s.part_velocity.end(), {500.0 + p, 600.0 + p, 700.0 + p});
  }
  s.wall_force = {77};
  return s;
}

}  // namespace fabrica::sample
