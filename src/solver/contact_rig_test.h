#pragma once
// For tests of contacts: a model of plates and bricks without stiffness, driven by a small explicit
// integrator of its own: point masses, and groups of nodes that translate together.
#include <memory>
#include <vector>

#include "solver/contact.h"

namespace fabrica {

struct Rig {
  Model model;
  State state;
  ContactInput input;
  Diagnostics diagnostics;
  std::unique_ptr<Contacts> contacts;
  std::vector<Vec3d> load;  // constant force by node; empty: none

  int add_part() {
    Part p;
    p.id = int(model.parts.size()) + 1;
    model.parts.push_back(p);
    input.part_bulk.push_back(1), input.part_youngs.push_back(1), input.part_poisson.push_back(0.3);
    return int(model.parts.size()) - 1;
  }
  int add_node(Vec3d x) {
    model.nodes.id.push_back(model.nodes.size() + 1);
    model.nodes.x.push_back(x);
    return model.nodes.size() - 1;
  }
  // n x m flat shells from origin along a and b
  std::vector<int> add_plate(int part, Vec3d origin, Vec3d a, Vec3d b, int n, int m,
                             double thickness) {
    std::vector<int> nodes;
    for (int j = 0; j <= m; ++j)
      for (int i = 0; i <= n; ++i)
        nodes.push_back(add_node(origin + (double(i) / n) * a + (double(j) / m) * b));
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < n; ++i) {
        const int k = j * (n + 1) + i;
        model.shells.id.push_back(model.shells.size() + 1);
        model.shells.part.push_back(part);
        model.shells.node.push_back({nodes[k], nodes[k + 1], nodes[k + n + 2], nodes[k + n + 1]});
        input.shell_thickness.push_back(thickness);
      }
    return nodes;
  }
  std::vector<int> add_brick(int part, Vec3d low, Vec3d size, int n) {
    std::vector<int> nodes;
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
          nodes.push_back(add_node(low + Vec3d{size.x * i / n, size.y * j / n, size.z * k / n}));
    auto at = [&](int i, int j, int k) { return nodes[(k * (n + 1) + j) * (n + 1) + i]; };
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          model.solids.id.push_back(model.solids.size() + 1);
          model.solids.part.push_back(part);
          model.solids.node.push_back({at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k),
                                       at(i, j + 1, k), at(i, j, k + 1), at(i + 1, j, k + 1),
                                       at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1), -1, -1});
        }
    return nodes;
  }
  Contact& add_contact(ContactKind kind, std::vector<int> a, std::vector<int> b = {}) {
    Contact c;
    c.id = int(model.contacts.size()) + 1;
    c.kind = kind;
    c.ignore = 1;
    c.a.kind = ContactSide::Kind::parts, c.a.parts = a;
    if (!b.empty()) c.b.kind = ContactSide::Kind::parts, c.b.parts = b;
    model.contacts.push_back(c);
    return model.contacts.back();
  }
  void start(double dt, double force_scale = 1) {
    const int n = model.nodes.size();
    state.nodes.resize(n);
    for (int i = 0; i < n; ++i) state.nodes[i] = {model.nodes.x[i], {0, 0, 0}, 1, 1};
    state.force.assign(n, Vec3d{0, 0, 0});
    state.owner.assign(n, NodeOwner::free);
    state.physical_mass.assign(n, 1.0);
    state.interaction.resize(n, FixedScale::of(force_scale));
    input.initial_dt = dt;
    contacts = std::make_unique<Contacts>(model, state, input, diagnostics);
  }
  // groups: nodes that translate together; nodes in no group stand still
  void step(Team& team, double dt, const std::vector<std::vector<int>>& groups) {
    contacts->forces(model, state, team);
    state.dt = dt;
    for (int i = 0; i < model.nodes.size(); ++i) state.force[i] = state.interaction.take(i);
    for (const auto& group : groups) {
      Vec3d f{0, 0, 0};
      double m = 0;
      for (int n : group) {
        f += state.force[n], m += state.nodes[n].mass;
        if (!load.empty()) f += load[n];
      }
      for (int n : group)
        state.nodes[n].v += (dt / m) * f, state.nodes[n].x += dt * state.nodes[n].v;
    }
    contacts->account(state);
    state.time += dt, state.dt_previous = dt;
  }
};

inline Vec3d total(const std::vector<Vec3d>& list) {
  Vec3d sum{0, 0, 0};
  for (const Vec3d& f : list) sum += f;
  return sum;
}

}  // namespace fabrica
