// Force databases: rigid walls, contacts, supports, cross sections.
#include <cmath>

#include "solver/history.h"

namespace fabrica {

void History::add_rwforc() {
  const RigidWalls& walls = simulation_.rigid_walls();
  const Model& m = simulation_.model();
  if (walls.size() == 0) return;
  HistoryDatabase* d = add("rwforc/forces", "rwforc");
  if (!d) return;
  for (int w = 0; w < walls.size(); ++w) {
    d->ids.push_back(m.rigid_walls[w].id != 0 ? m.rigid_walls[w].id : w + 1);
    d->legend.push_back(m.rigid_walls[w].title);
  }
  declare(*d, walls.size(), {"normal_force", "x_force", "y_force", "z_force"});
  fills_.push_back([&walls, &m](std::vector<std::vector<double>>& v) {
    for (int w = 0; w < walls.size(); ++w) {
      const Vec3d f = walls.force(w);
      v[0][w] = m.rigid_walls[w].shape == RigidWall::Shape::plane ? walls.normal_force(w) : norm(f);
      for (int k = 0; k < 3; ++k) v[1 + k][w] = f[k];
    }
  });
}

void History::add_rcforc() {
  const Model& m = simulation_.model();
  const auto resultants = simulation_.contacts().resultants();
  if (resultants.empty()) return;
  HistoryDatabase* d = add("rcforc", "rcforc");
  if (!d) return;
  std::vector<std::int64_t> side;
  for (const auto& r : resultants)
    for (int s = 0; s < 2; ++s) {
      d->ids.push_back(m.contacts[r.contact].id != 0 ? m.contacts[r.contact].id : r.contact + 1);
      d->legend.push_back(m.contacts[r.contact].title);
      side.push_back(s);
    }
  d->integer_metadata.push_back({"side", side});
  declare(*d, int(side.size()), {"x_force", "y_force", "z_force", "mass"});
  fills_.push_back([this](std::vector<std::vector<double>>& v) {
    const auto now = simulation_.contacts().resultants();
    for (std::size_t i = 0; i < now.size(); ++i) {
      for (int k = 0; k < 3; ++k)
        v[k][2 * i] = now[i].side_a[k], v[k][2 * i + 1] = now[i].side_b[k];
      v[3][2 * i] = now[i].mass_a, v[3][2 * i + 1] = now[i].mass_b;
    }
  });
}

void History::add_sleout() {
  const Model& m = simulation_.model();
  const auto resultants = simulation_.contacts().resultants();
  if (resultants.empty()) return;
  HistoryDatabase* d = add("sleout", "sleout");
  if (!d) return;
  for (const auto& r : resultants) {
    d->ids.push_back(m.contacts[r.contact].id != 0 ? m.contacts[r.contact].id : r.contact + 1);
    d->legend.push_back(m.contacts[r.contact].title);
  }
  const int n = int(resultants.size());
  declare(*d, n, {"slave", "master", "friction_energy"});
  declare(*d, 1, {"total_slave", "total_master", "total_energy"});
  fills_.push_back([this](std::vector<std::vector<double>>& v) {
    const auto now = simulation_.contacts().resultants();
    for (std::size_t i = 0; i < now.size(); ++i) {
      v[0][i] = now[i].energy_a, v[1][i] = now[i].energy_b, v[2][i] = now[i].friction_energy;
      v[3][0] += now[i].energy_a, v[4][0] += now[i].energy_b;
    }
    v[5][0] = v[3][0] + v[4][0];
  });
}

void History::add_spcforc() {
  const NodeConstraints& constraints = simulation_.node_constraints();
  const Model& m = simulation_.model();
  if (constraints.size() == 0) return;
  HistoryDatabase* d = add("spcforc", "spcforc");
  if (!d) return;
  std::vector<std::int64_t> ids;
  for (const auto& r : constraints.reactions()) ids.push_back(m.nodes.id[r.node]);
  d->ids = ids;
  d->integer_metadata.push_back({"force_ids", ids});
  d->integer_metadata.push_back({"moment_ids", ids});
  declare(*d, int(ids.size()),
          {"x_force", "y_force", "z_force", "x_moment", "y_moment", "z_moment"});
  declare(*d, 1, {"x_resultant", "y_resultant", "z_resultant"});
  fills_.push_back([&constraints](std::vector<std::vector<double>>& v) {
    const auto& reactions = constraints.reactions();
    for (std::size_t i = 0; i < reactions.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        v[k][i] = reactions[i].force[k], v[3 + k][i] = reactions[i].moment[k];
        v[6 + k][0] += reactions[i].force[k];
      }
  });
}

// Force of the listed elements on the nodes of the section, and its moment about the nodes' mean.
void History::add_secforc() {
  const Model& m = simulation_.model();
  if (m.cross_sections.empty()) return;
  HistoryDatabase* d = add("secforc", "secforc");
  if (!d) return;
  for (std::size_t i = 0; i < m.cross_sections.size(); ++i) {
    d->ids.push_back(m.cross_sections[i].id != 0 ? m.cross_sections[i].id : std::int64_t(i) + 1);
    d->legend.push_back(m.cross_sections[i].title);
  }
  declare(*d, int(m.cross_sections.size()),
          {"x_force", "y_force", "z_force", "total_force", "x_moment", "y_moment", "z_moment",
           "total_moment", "x_centroid", "y_centroid", "z_centroid"});
  fills_.push_back([this](std::vector<std::vector<double>>& v) {
    const Model& m = simulation_.model();
    for (std::size_t i = 0; i < m.cross_sections.size(); ++i) {
      const SectionForce f = section_force(simulation_, m.cross_sections[i]);
      for (int k = 0; k < 3; ++k)
        v[k][i] = f.force[k], v[4 + k][i] = f.moment[k], v[8 + k][i] = f.centroid[k];
      v[3][i] = norm(f.force), v[7][i] = norm(f.moment);
    }
  });
}

SectionForce section_force(const Simulation& simulation, const CrossSection& section) {
  const Model& m = simulation.model();
  const State& state = simulation.state();
  SectionForce out;
  std::vector<char> inside(m.nodes.size(), 0);
  for (int n : section.nodes) inside[n] = 1, out.centroid += state.nodes[n].x;
  if (!section.nodes.empty()) out.centroid = (1.0 / double(section.nodes.size())) * out.centroid;
  auto add = [&](Family family, int e) {
    int node[8];
    Vec3d f[8], moment[8];
    const int corners = simulation.tiles().corner_forces(state, family, e, node, f, moment);
    for (int a = 0; a < corners; ++a)
      if (inside[node[a]]) {
        out.force += f[a];
        out.moment += moment[a] + cross(state.nodes[node[a]].x - out.centroid, f[a]);
      }
  };
  for (int e : section.solids) add(Family::solid, e);
  for (int e : section.shells) add(Family::shell, e);
  for (int e : section.beams) add(Family::beam, e);
  for (int e : section.discretes)
    for (int side = 0; side < 2; ++side) {
      const int n = m.discretes.node[e][side];
      if (n >= 0 && inside[n])
        out.force += (side == 0 ? 1.0 : -1.0) * simulation.discrete_elements().force_vector(e);
    }
  return out;
}

}  // namespace fabrica
