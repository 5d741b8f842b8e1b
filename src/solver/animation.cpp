#include <cmath>

#include "solver/history.h"

namespace fabrica {
namespace {

void put3(std::vector<float>& out, std::size_t i, const Vec3d& v) {
  for (int k = 0; k < 3; ++k) out[3 * i + k] = float(v[k]);
}

// which layers of a shell stand for mid, inner and outer
int layer_for(int shown, int layers) {
  if (shown == 0) return layers / 2;
  return shown == 1 ? 0 : layers - 1;
}

void fill_solids(const Simulation& s, AnimationState& a) {
  const Model& m = s.model();
  const int n = m.solids.size();
  a.solid_stress.assign(6 * n, 0), a.solid_plastic_strain.assign(n, 0), a.solid_alive.assign(n, 1);
  for (int e = 0; e < n; ++e) {
    const ElementReadout r = s.tiles().read(m, s.state(), Family::solid, e);
    for (int k = 0; k < 6; ++k) a.solid_stress[6 * e + k] = float(r.stress[0][k]);
    a.solid_plastic_strain[e] = float(r.plastic_strain[0]);
    a.solid_alive[e] = r.alive > 0;
  }
}

void fill_shells(const Simulation& s, AnimationState& a) {
  const Model& m = s.model();
  const int n = m.shells.size();
  a.shell_layers = 3;
  a.shell_stress.assign(18 * n, 0), a.shell_plastic_strain.assign(3 * n, 0),
      a.shell_resultants.assign(8 * n, 0);
  a.shell_thickness.assign(n, 0), a.shell_energy_density.assign(n, 0), a.shell_alive.assign(n, 1);
  for (int e = 0; e < n; ++e) {
    const ElementReadout r = s.tiles().read(m, s.state(), Family::shell, e);
    for (int l = 0; l < 3; ++l) {
      const int from = layer_for(l, std::max(1, r.layers));
      for (int k = 0; k < 6; ++k) a.shell_stress[(3 * e + l) * 6 + k] = float(r.stress[from][k]);
      a.shell_plastic_strain[3 * e + l] = float(r.plastic_strain[from]);
    }
    for (int k = 0; k < 8; ++k) a.shell_resultants[8 * e + k] = float(r.resultants[k]);
    a.shell_thickness[e] = float(r.thickness);
    a.shell_alive[e] = r.alive > 0;
  }
}

void fill_globals(const Simulation& s, AnimationState& a) {
  const Model& m = s.model();
  const Energies& e = s.state().energy;
  a.kinetic_energy = e.kinetic, a.internal_energy = e.internal, a.total_energy = e.total();
  a.part_internal_energy = s.part_internal();
  a.part_hourglass_energy = s.part_hourglass();
  const PartSums sums = part_sums(s);
  a.part_kinetic_energy = sums.kinetic, a.part_mass = sums.mass;
  a.part_velocity.assign(3 * m.parts.size(), 0);
  double mass = 0;
  Vec3d momentum{0, 0, 0};
  for (std::size_t p = 0; p < m.parts.size(); ++p) {
    mass += sums.mass[p];
    for (int d = 0; d < 3; ++d) {
      momentum[d] += sums.momentum[d][p];
      if (sums.mass[p] > 0) a.part_velocity[3 * p + d] = sums.momentum[d][p] / sums.mass[p];
    }
  }
  for (int d = 0; d < 3; ++d) a.momentum_velocity[d] = mass > 0 ? momentum[d] / mass : 0;
}

}  // namespace

AnimationState animation_state(const Simulation& s) {
  const Model& m = s.model();
  AnimationState a;
  a.time = s.state().time;
  const std::size_t n = m.nodes.size();
  a.position.resize(3 * n), a.velocity.resize(3 * n), a.acceleration.resize(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    put3(a.position, i, s.state().nodes[i].x);
    put3(a.velocity, i, s.velocity(int(i)));
    put3(a.acceleration, i, s.acceleration(int(i)));
  }
  fill_solids(s, a);
  fill_shells(s, a);
  a.beam_resultants.assign(6 * m.beams.size(), 0);
  for (int e = 0; e < m.beams.size(); ++e) {
    const ElementReadout r = s.tiles().read(m, s.state(), Family::beam, e);
    for (int k = 0; k < 6; ++k) a.beam_resultants[6 * e + k] = float(r.resultants[k]);
  }
  for (int i = 0; i < s.discrete_elements().beams(); ++i) {
    const auto& r = s.discrete_elements().beam_resultants(i);
    for (int k = 0; k < 6; ++k)
      a.beam_resultants[6 * s.discrete_elements().beam_index(i) + k] = float(r[k]);
  }
  a.discrete_force.resize(m.discretes.size());
  for (int e = 0; e < m.discretes.size(); ++e)
    a.discrete_force[e] = float(s.discrete_elements().force(e));
  for (const RigidWall& w : m.rigid_walls) {
    const Vec3d f = s.rigid_walls().force(int(&w - m.rigid_walls.data()));
    a.wall_force.push_back(norm(f));
  }
  fill_globals(s, a);
  return a;
}

}  // namespace fabrica
