#include "result/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace fabrica {
namespace {

// Eight corners of a solid that names 4, 6, 8 or 10 nodes.
std::array<int, 8> eight_corners(const std::array<int, 10>& n) {
  const int count = int(std::find(n.begin(), n.end(), -1) - n.begin());
  if (count == 4 || count == 10) return {n[0], n[1], n[2], n[3], n[3], n[3], n[3], n[3]};
  if (count == 5) return {n[0], n[1], n[2], n[3], n[4], n[4], n[4], n[4]};
  if (count == 6) return {n[0], n[1], n[2], n[3], n[4], n[4], n[5], n[5]};
  return {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]};
}

std::vector<int> ascending(const std::vector<std::int64_t>& ids) {
  std::vector<int> order(ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return ids[a] < ids[b]; });
  return order;
}

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> out(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) out[order[i]] = int(i);
  return out;
}

template <class T>
std::vector<T> picked(const std::vector<T>& values, const std::vector<int>& order) {
  std::vector<T> out;
  out.reserve(order.size());
  if (!values.empty())
    for (const int i : order) out.push_back(values[i]);
  return out;
}

template <std::size_t N>
void renumber(std::vector<std::array<int, N>>& elements, const std::vector<int>& rank) {
  for (auto& nodes : elements)
    for (int& n : nodes) n = n < 0 ? n : rank[n];
}

}  // namespace

ResultMesh result_mesh(const Model& model) {
  ResultMesh m;
  m.title = model.title;
  m.node_id = model.nodes.id;
  m.position.reserve(3 * model.nodes.x.size());
  for (const Vec3d& x : model.nodes.x)
    for (int i = 0; i < 3; ++i) m.position.push_back(float(x[i]));

  m.solid_id = model.solids.id;
  m.solid_part = model.solids.part;
  for (const auto& n : model.solids.node) m.solid.push_back(eight_corners(n));
  m.shell_id = model.shells.id;
  m.shell_part = model.shells.part;
  for (const auto& n : model.shells.node)
    m.shell.push_back({n[0], n[1], n[2], n[3] < 0 ? n[2] : n[3]});

  m.beam_id = model.beams.id;
  m.beam_part = model.beams.part;
  m.beam = model.beams.node;
  const Discretes& d = model.discretes;
  m.discretes = d.size();
  m.beam_id.insert(m.beam_id.end(), d.id.begin(), d.id.end());
  m.beam_part.insert(m.beam_part.end(), d.part.begin(), d.part.end());
  for (const auto& n : d.node) m.beam.push_back({n[0], n[1] < 0 ? n[0] : n[1], -1});

  for (const Part& p : model.parts) {
    m.part_id.push_back(p.id);
    m.part_title.push_back(p.title);
    m.part_family.push_back(p.family);
  }
  return m;
}

SortedMesh sorted_by_id(const ResultMesh& m) {
  SortedMesh out{{},
                 ascending(m.node_id),
                 ascending(m.solid_id),
                 ascending(m.shell_id),
                 ascending(m.beam_id),
                 ascending(m.part_id)};
  ResultMesh& s = out.mesh;
  s.title = m.title;
  s.node_id = picked(m.node_id, out.node);
  s.solid_id = picked(m.solid_id, out.solid);
  s.shell_id = picked(m.shell_id, out.shell);
  s.beam_id = picked(m.beam_id, out.beam);
  s.part_id = picked(m.part_id, out.part);
  s.part_title = picked(m.part_title, out.part);
  s.part_family = picked(m.part_family, out.part);
  for (const int i : out.node)
    s.position.insert(s.position.end(), &m.position[3 * i], &m.position[3 * i] + 3);

  s.solid = picked(m.solid, out.solid);
  s.shell = picked(m.shell, out.shell);
  s.beam = picked(m.beam, out.beam);
  const std::vector<int> node_rank = inverse(out.node), part_rank = inverse(out.part);
  renumber(s.solid, node_rank);
  renumber(s.shell, node_rank);
  renumber(s.beam, node_rank);
  s.solid_part = picked(m.solid_part, out.solid);
  s.shell_part = picked(m.shell_part, out.shell);
  s.beam_part = picked(m.beam_part, out.beam);
  for (auto* parts : {&s.solid_part, &s.shell_part, &s.beam_part})
    for (int& p : *parts) p = part_rank[p];
  return out;
}

SolidCorners solid_corners(const std::array<int, 8>& n) {
  const bool bottom_edge = n[2] == n[3], top_edge = n[6] == n[7];
  if (n[3] == n[4] && n[4] == n[5] && n[5] == n[6] && top_edge)
    return {4, {n[0], n[1], n[2], n[3]}};
  if (n[4] == n[5] && n[5] == n[6] && top_edge) return {5, {n[0], n[1], n[2], n[3], n[4]}};
  if (n[4] == n[5] && top_edge) return {6, {n[0], n[1], n[4], n[3], n[2], n[6]}};
  if (bottom_edge && top_edge) return {6, {n[0], n[1], n[2], n[4], n[5], n[6]}};
  return {8, n};
}

void check_state(const ResultMesh& mesh, const AnimationState& s) {
  auto expect = [](const char* name, std::size_t have, std::size_t want, bool required = false) {
    if (have != want && (required || have != 0))
      throw std::runtime_error(
          fmt::format("animation state: {} has {} values, the model needs {}", name, have, want));
  };
  const std::size_t nodes = mesh.nodes(), solids = mesh.solids(), shells = mesh.shells(),
                    layers = std::size_t(s.shell_layers), parts = mesh.parts();
  expect("position", s.position.size(), 3 * nodes, true);
  expect("velocity", s.velocity.size(), 3 * nodes);
  expect("acceleration", s.acceleration.size(), 3 * nodes);
  expect("solid_stress", s.solid_stress.size(), 6 * solids);
  expect("solid_plastic_strain", s.solid_plastic_strain.size(), solids);
  expect("solid_strain", s.solid_strain.size(), 6 * solids);
  expect("shell_stress", s.shell_stress.size(), 6 * layers * shells);
  expect("shell_plastic_strain", s.shell_plastic_strain.size(), layers * shells);
  expect("shell_resultants", s.shell_resultants.size(), 8 * shells);
  expect("shell_thickness", s.shell_thickness.size(), shells);
  expect("shell_energy_density", s.shell_energy_density.size(), shells);
  expect("shell_strain", s.shell_strain.size(), 12 * shells);
  expect("solid_alive", s.solid_alive.size(), solids);
  expect("shell_alive", s.shell_alive.size(), shells);
  const std::size_t discretes = std::size_t(mesh.discretes), beams = mesh.beams() - discretes;
  expect("beam_resultants", s.beam_resultants.size(), 6 * beams);
  expect("discrete_force", s.discrete_force.size(), discretes);
  expect("beam_alive", s.beam_alive.size(), beams);
  expect("part_internal_energy", s.part_internal_energy.size(), parts);
  expect("part_kinetic_energy", s.part_kinetic_energy.size(), parts);
  expect("part_mass", s.part_mass.size(), parts);
  expect("part_hourglass_energy", s.part_hourglass_energy.size(), parts);
  expect("part_velocity", s.part_velocity.size(), 3 * parts);
}

float von_mises(const float* s) {
  const float a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  const float shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
  return std::sqrt(0.5f * (a * a + b * b + c * c) + 3 * shear);
}

}  // namespace fabrica
