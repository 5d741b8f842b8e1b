#include "solver/history.h"

#include <algorithm>
#include <cmath>

namespace fabrica {
PartSums part_sums(const Simulation& s) {
  const Model& m = s.model();
  const Tiles& tiles = s.tiles();
  PartSums p;
  p.kinetic.assign(m.parts.size(), 0), p.mass.assign(m.parts.size(), 0);
  p.eroded_kinetic.assign(m.parts.size(), 0);
  for (auto& c : p.momentum) c.assign(m.parts.size(), 0);
  for (const Tile& t : tiles.tiles) {
    const int part = tiles.classes[t.tile_class].part;
    for (int k = t.node_first; k < t.node_first + t.node_count; ++k) {
      const Vec3d v = s.velocity(tiles.node[k]);
      const double mass = tiles.node_mass[k];
      p.mass[part] += mass;
      (s.erosion().eroded(tiles.node[k]) ? p.eroded_kinetic : p.kinetic)[part] +=
          0.5 * mass * dot(v, v);
      for (int d = 0; d < 3; ++d) p.momentum[d][part] += mass * v[d];
    }
  }
  for (int b = 0; b < s.rigid_bodies().size(); ++b) {
    const RigidBody& body = s.rigid_bodies()[b];
    if (body.part < 0) continue;
    const int part = body.part;
    const double mass = body.motion.mass;
    const Vec3d v = body.motion.v;
    p.mass[part] = mass;
    p.kinetic[part] = 0.5 * (mass * dot(v, v) + dot(body.motion.w, body.motion.momentum));
    for (int d = 0; d < 3; ++d) p.momentum[d][part] = mass * v[d];
  }
  return p;
}

History::History(const Simulation& simulation) : simulation_(simulation) {
  add_glstat();
  add_matsum();
  add_nodout();
  add_elout();
  add_rbdout();
  add_deforc();
  add_jntforc();
  add_rwforc();
  add_rcforc();
  add_sleout();
  add_spcforc();
  add_secforc();
}

HistorySample History::sample(int database) const {
  HistorySample out;
  out.time = simulation_.state().time;
  out.cycle = int(simulation_.state().cycle);
  const HistoryDatabase& d = databases_[database];
  out.values.resize(d.variables.size());
  for (std::size_t v = 0; v < d.variables.size(); ++v)
    out.values[v].assign(d.variables[v].length, 0);
  fills_[database](out.values);
  return out;
}

// null if the deck does not ask for it
HistoryDatabase* History::add(const std::string& path, const std::string& request) {
  const auto& intervals = simulation_.model().output.interval;
  const auto i = intervals.find(request);
  if (i == intervals.end() || i->second <= 0) return nullptr;
  databases_.push_back({});
  databases_.back().path = path;
  databases_.back().interval = i->second;
  return &databases_.back();
}

void History::add_glstat() {
  HistoryDatabase* d = add("glstat", "glstat");
  if (!d) return;
  d->text_metadata.push_back({"element_types", "solid,beam,shell,discrete"});
  for (const char* n : {"ts_eltype", "ts_element", "ts_part"}) d->variables.push_back({n, 1, true});
  declare(*d, 1,
          {"time_step",
           "kinetic_energy",
           "internal_energy",
           "stonewall_energy",
           "spring_and_damper_energy",
           "joint_internal_energy",
           "hourglass_energy",
           "system_damping_energy",
           "sliding_interface_energy",
           "external_work",
           "eroded_kinetic_energy",
           "eroded_internal_energy",
           "eroded_hourglass_energy",
           "total_energy",
           "energy_ratio",
           "energy_ratio_wo_eroded",
           "global_x_velocity",
           "global_y_velocity",
           "global_z_velocity",
           "resultant_global_velocity",
           "added_mass",
           "percent_increase"});
  fills_.push_back([this](std::vector<std::vector<double>>& v) {
    const State& state = simulation_.state();
    const Energies& e = state.energy;
    const TimeStepOwner o = simulation_.time_step_owner();
    Vec3d momentum{0, 0, 0};
    double mass = 0;
    for (int n = 0; n < int(state.nodes.size()); ++n) {
      momentum += state.nodes[n].mass * simulation_.velocity(n);
      mass += state.nodes[n].mass;
    }
    const Vec3d mean = mass > 0 ? (1 / mass) * momentum : Vec3d{0, 0, 0};
    const double eroded = e.eroded_kinetic + e.eroded_internal + e.eroded_hourglass;
    const double in = e.initial + e.external_work + e.added_mass;
    const double values[] = {o.family == "solid"   ? 1.0
                             : o.family == "beam"  ? 2.0
                             : o.family == "shell" ? 3.0
                                                   : 4.0,
                             double(o.element),
                             double(o.part),
                             state.dt,
                             e.kinetic,
                             e.internal,
                             e.rigid_wall,
                             e.discrete,
                             e.joint,
                             e.hourglass,
                             e.damping,
                             e.contact,
                             e.external_work,
                             e.eroded_kinetic,
                             e.eroded_internal,
                             e.eroded_hourglass,
                             e.total(),
                             e.ratio(),
                             in != 0 ? (e.total() - eroded) / in : 1.0,
                             mean.x,
                             mean.y,
                             mean.z,
                             norm(mean),
                             simulation_.added_mass(),
                             simulation_.physical_mass() > 0
                                 ? 100 * simulation_.added_mass() / simulation_.physical_mass()
                                 : 0};
    for (std::size_t i = 0; i < v.size(); ++i) v[i][0] = values[i];
  });
}

void History::add_matsum() {
  HistoryDatabase* d = add("matsum", "matsum");
  if (!d) return;
  const Model& m = simulation_.model();
  for (const Part& p : m.parts) d->ids.push_back(p.id), d->legend.push_back(p.title);
  declare(*d, int(m.parts.size()),
          {"internal_energy", "kinetic_energy", "x_momentum", "y_momentum", "z_momentum",
           "x_rbvelocity", "y_rbvelocity", "z_rbvelocity", "hourglass_energy", "mass",
           "eroded_internal_energy", "eroded_kinetic_energy"});
  fills_.push_back([this](std::vector<std::vector<double>>& v) {
    const PartSums p = part_sums(simulation_);
    v[0] = simulation_.part_internal();
    v[1] = p.kinetic;
    for (int k = 0; k < 3; ++k) {
      v[2 + k] = p.momentum[k];
      for (std::size_t i = 0; i < p.mass.size(); ++i)
        v[5 + k][i] = p.mass[i] > 0 ? p.momentum[k][i] / p.mass[i] : 0;
    }
    v[8] = simulation_.part_hourglass();
    v[9] = p.mass;
    v[10] = simulation_.part_eroded_internal();
    v[11] = p.eroded_kinetic;
  });
}

void History::add_nodout() {
  const auto& nodes = simulation_.model().output.nodes;
  if (nodes.empty()) return;
  HistoryDatabase* d = add("nodout", "nodout");
  if (!d) return;
  const Model& m = simulation_.model();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    d->ids.push_back(m.nodes.id[nodes[i]]);
    d->legend.push_back(i < m.output.node_names.size() ? m.output.node_names[i] : "");
  }
  declare(*d, int(nodes.size()),
          {"x_displacement", "y_displacement", "z_displacement", "x_velocity", "y_velocity",
           "z_velocity", "x_acceleration", "y_acceleration", "z_acceleration", "x_coordinate",
           "y_coordinate", "z_coordinate", "rx_velocity", "ry_velocity", "rz_velocity"});
  fills_.push_back([this](std::vector<std::vector<double>>& v) {
    const Model& m = simulation_.model();
    const State& state = simulation_.state();
    for (std::size_t i = 0; i < m.output.nodes.size(); ++i) {
      const int n = m.output.nodes[i];
      const Vec3d x = state.nodes[n].x, u = x - m.nodes.x[n], w = simulation_.velocity(n),
                  a = simulation_.acceleration(n);
      for (int k = 0; k < 3; ++k) {
        v[k][i] = u[k], v[3 + k][i] = w[k], v[6 + k][i] = a[k], v[9 + k][i] = x[k];
        v[12 + k][i] = state.spins.empty() ? 0 : state.spins[n].w[k];
      }
    }
  });
}

void History::add_elout() {
  const Model& m = simulation_.model();
  const Tiles& tiles = simulation_.tiles();
  const State& state = simulation_.state();
  static const char* const stress[] = {"sig_xx", "sig_yy", "sig_zz", "sig_xy", "sig_yz", "sig_zx"};
  if (!m.output.solids.empty())
    if (HistoryDatabase* d = add("elout/solid", "elout")) {
      for (int e : m.output.solids) d->ids.push_back(m.solids.id[e]);
      const int n = int(d->ids.size());
      for (const char* s : stress) d->variables.push_back({s, n, false});
      declare(*d, n, {"yield", "effsg"});
      fills_.push_back([&m, &tiles, &state](std::vector<std::vector<double>>& v) {
        for (std::size_t i = 0; i < m.output.solids.size(); ++i) {
          const ElementReadout r = tiles.read(m, state, Family::solid, m.output.solids[i]);
          for (int k = 0; k < 6; ++k) v[k][i] = r.stress[0][k];
          v[6][i] = r.plastic_strain[0];
          v[7][i] = von_mises_of_deviator(deviator(r.stress[0]));
        }
      });
    }
  if (!m.output.shells.empty())
    if (HistoryDatabase* d = add("elout/shell", "elout")) {
      std::vector<int> layers;
      int total = 0;
      std::vector<std::int64_t> nip;
      for (int e : m.output.shells) {
        d->ids.push_back(m.shells.id[e]);
        const int l = std::max(1, tiles.read(m, state, Family::shell, e).layers);
        layers.push_back(l), nip.push_back(l), total += l;
      }
      d->integer_metadata.push_back({"nip", nip});
      for (const char* s : stress) d->variables.push_back({s, total, false});
      declare(*d, total, {"plastic_strain"});
      declare(*d, int(layers.size()), {"thickness"});
      fills_.push_back([&m, &tiles, &state, layers](std::vector<std::vector<double>>& v) {
        int at = 0;
        for (std::size_t i = 0; i < m.output.shells.size(); ++i) {
          const ElementReadout r = tiles.read(m, state, Family::shell, m.output.shells[i]);
          for (int l = 0; l < layers[i]; ++l, ++at) {
            for (int k = 0; k < 6; ++k) v[k][at] = r.stress[l][k];
            v[6][at] = r.plastic_strain[l];
          }
          v[7][i] = r.thickness;
        }
      });
    }
  if (!m.output.beams.empty())
    if (HistoryDatabase* d = add("elout/beam", "elout")) {
      for (int e : m.output.beams) d->ids.push_back(m.beams.id[e]);
      declare(*d, int(d->ids.size()),
              {"axial", "shear_s", "shear_t", "moment_s", "moment_t", "torsion"});
      fills_.push_back([&m, &tiles, &state](std::vector<std::vector<double>>& v) {
        for (std::size_t i = 0; i < m.output.beams.size(); ++i) {
          const ElementReadout r = tiles.read(m, state, Family::beam, m.output.beams[i]);
          for (int k = 0; k < 6; ++k) v[k][i] = r.resultants[k];
        }
      });
    }
}

void History::add_rbdout() {
  const RigidBodies& bodies = simulation_.rigid_bodies();
  if (bodies.size() == 0) return;
  HistoryDatabase* d = add("rbdout", "rbdout");
  if (!d) return;
  std::vector<int> order;
  for (int nodal = 0; nodal < 2; ++nodal)
    for (int b = 0; b < bodies.size(); ++b)
      if ((bodies[b].part < 0) == (nodal == 1)) order.push_back(b);
  std::int64_t nodal = 0;
  for (int b : order) d->ids.push_back(bodies[b].id), nodal += bodies[b].part < 0;
  d->integer_metadata.push_back({"num_nodal", {nodal}});
  declare(*d, int(order.size()),
          {"global_x",   "global_y",   "global_z",   "global_dx", "global_dy", "global_dz",
           "global_rdx", "global_rdy", "global_rdz", "global_vx", "global_vy", "global_vz",
           "global_rvx", "global_rvy", "global_rvz", "global_ax", "global_ay", "global_az",
           "global_rax", "global_ray", "global_raz", "dircos_11", "dircos_12", "dircos_13",
           "dircos_21",  "dircos_22",  "dircos_23",  "dircos_31", "dircos_32", "dircos_33"});
  fills_.push_back([&bodies, order](std::vector<std::vector<double>>& v) {
    for (std::size_t i = 0; i < order.size(); ++i) {
      const RigidBody& b = bodies[order[i]];
      const Vec3d u = b.displacement();
      const Mat3d turn = b.turn();
      for (int k = 0; k < 3; ++k) {
        v[k][i] = b.motion.x[k], v[3 + k][i] = u[k], v[6 + k][i] = b.rotation[k];
        v[9 + k][i] = b.motion.v[k], v[12 + k][i] = b.motion.w[k];
        v[15 + k][i] = b.acceleration[k], v[18 + k][i] = b.angular_acceleration[k];
        for (int j = 0; j < 3; ++j) v[21 + 3 * k + j][i] = turn(k, j);
      }
    }
  });
}

void History::add_deforc() {
  const DiscreteElements& elements = simulation_.discrete_elements();
  const Model& m = simulation_.model();
  if (m.discretes.size() == 0) return;
  HistoryDatabase* d = add("deforc", "deforc");
  if (!d) return;
  std::vector<std::int64_t> torsional;
  for (int e = 0; e < m.discretes.size(); ++e) {
    d->ids.push_back(m.discretes.id[e]);
    torsional.push_back(elements.torsional(e) ? 1 : 0);
  }
  d->integer_metadata.push_back({"irot", torsional});
  declare(*d, m.discretes.size(),
          {"x_force", "y_force", "z_force", "resultant_force", "displacement"});
  fills_.push_back([&m, &elements](std::vector<std::vector<double>>& v) {
    for (int e = 0; e < m.discretes.size(); ++e) {
      const Vec3d f = elements.force_vector(e);
      for (int k = 0; k < 3; ++k) v[k][e] = f[k];
      v[3][e] = elements.force(e);
      v[4][e] = elements.elongation(e);
    }
  });
}

void History::add_jntforc() {
  const Joints& joints = simulation_.joints();
  const Model& m = simulation_.model();
  if (joints.size() == 0) return;
  HistoryDatabase* d = add("jntforc/joints", "jntforc");
  if (!d) return;
  for (int j = 0; j < joints.size(); ++j) {
    d->ids.push_back(m.joints[j].id != 0 ? m.joints[j].id : j + 1);
    d->legend.push_back(m.joints[j].title);
  }
  declare(*d, joints.size(),
          {"x_force", "y_force", "z_force", "x_moment", "y_moment", "z_moment", "resultant_force",
           "resultant_moment"});
  fills_.push_back([&joints](std::vector<std::vector<double>>& v) {
    for (int j = 0; j < joints.size(); ++j) {
      for (int k = 0; k < 3; ++k) v[k][j] = joints.force(j)[k], v[3 + k][j] = joints.moment(j)[k];
      v[6][j] = norm(joints.force(j));
      v[7][j] = norm(joints.moment(j));
    }
  });
}

}  // namespace fabrica
