#include "solver/tiles.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <numeric>
#include <ostream>

#include "base/pack.h"
#include "solver/partition.h"

namespace fabrica {
namespace {

constexpr int tile_size(Family family, int corners) {
  return family == Family::solid && corners == 4 ? 512 : 256;
}

// one element of a class before it is put into a tile
struct Member {
  int element;
  std::array<int, 8> node;
};

Vec3d centre(const Model& model, const Member& m, int corners) {
  Vec3d c{0, 0, 0};
  for (int a = 0; a < corners; ++a) c += model.nodes.x[m.node[a]];
  return (1.0 / corners) * c;
}

// groups the deformable elements of a family by part and kind, in part order
struct Group {
  ElementKind kind;
  int corners;
  std::vector<Member> members;
};

class GroupBuilder {
 public:
  GroupBuilder(const Model& model, Diagnostics& diagnostics)
      : model_(model), diagnostics_(diagnostics) {}

  void add(Family family, int part, int element, int corners, const std::array<int, 8>& node) {
    ElementKind kind;
    try {
      kind = element_kind(model_, model_.parts[part], family, corners);
    } catch (const std::invalid_argument& e) {
      report(part, e.what());
      return;
    }
    auto& list = groups_[part];
    auto g = std::find_if(list.begin(), list.end(), [&](const Group& x) { return x.kind == kind; });
    if (g == list.end()) g = list.insert(list.end(), Group{kind, corners, {}});
    g->members.push_back({element, node});
  }
  void resize(std::size_t parts) { groups_.resize(parts), reported_.assign(parts, 0); }
  std::vector<std::vector<Group>>& groups() { return groups_; }
  void report(int part, const std::string& message) {
    if (reported_[part]++) return;
    const Part& p = model_.parts[part];
    diagnostics_.error("unsupported-formulation", p.where, "PART", "",
                       "part " + std::to_string(p.id) + ": " + message,
                       "Choose another element formulation or material");
  }

 private:
  const Model& model_;
  Diagnostics& diagnostics_;
  std::vector<std::vector<Group>> groups_;
  std::vector<char> reported_;
};

bool needs_kernel(const Model& model, int part) {
  const Part& p = model.parts[part];
  if (p.rigid || p.material < 0) return false;
  // null shells carry mass and contact only
  return !(model.materials[p.material].law == "MAT_NULL" && p.family == Family::shell);
}

void collect(const Model& model, GroupBuilder& b) {
  for (int e = 0; e < model.solids.size(); ++e) {
    if (!needs_kernel(model, model.solids.part[e])) continue;
    std::array<int, 8> node;
    const int corners = solid_shape(model.solids.node[e], node);
    b.add(Family::solid, model.solids.part[e], e, corners, node);
  }
  for (int e = 0; e < model.shells.size(); ++e) {
    if (!needs_kernel(model, model.shells.part[e])) continue;
    const auto& n = model.shells.node[e];
    // membranes take triangles as quadrilaterals with a repeated corner
    const int part = model.shells.part[e];
    const int form =
        model.parts[part].section >= 0 ? model.sections[model.parts[part].section].formulation : 0;
    const bool triangle = (n[3] == n[2] || n[3] < 0) && form != 5 && form != 9;
    b.add(Family::shell, model.shells.part[e], e, triangle ? 3 : 4,
          {n[0], n[1], n[2], n[3] < 0 ? n[2] : n[3]});
  }
  for (int e = 0; e < model.beams.size(); ++e) {
    const int part = model.beams.part[e];
    if (!needs_kernel(model, part) || model.sections[model.parts[part].section].formulation == 6)
      continue;
    const auto& n = model.beams.node[e];
    b.add(Family::beam, part, e, 2, {n[0], n[1]});
  }
}

}  // namespace

Tiles::Tiles(const Model& model, Diagnostics& diagnostics) {
  GroupBuilder builder(model, diagnostics);
  builder.resize(model.parts.size());
  collect(model, builder);
  place_of_solid.resize(model.solids.size());
  place_of_shell.resize(model.shells.size());
  place_of_beam.resize(model.beams.size());

  std::vector<int> local(model.nodes.size(), -1);
  std::size_t steps_size = 0;
  for (int part = 0; part < int(model.parts.size()); ++part) {
    for (Group& group : builder.groups()[part]) {
      const Part& p = model.parts[part];
      const Material& m = model.materials[p.material];
      TileClass c{group.kind, p.family, part, {}, nullptr, 0};
      try {
        const CardParameters parameters(model, *m.card);
        std::unique_ptr<CardParameters> eos;
        if (p.eos >= 0) eos = std::make_unique<CardParameters>(model, *model.cards[p.eos]);
        c.kernel = make_kernel(group.kind, m, parameters, eos.get());
      } catch (const std::exception& e) {
        builder.report(part, e.what());
        continue;
      }
      c.parameters = element_parameters(model, p, c.kernel->elastic());
      c.fields = c.kernel->state_fields(c.parameters);
      any_rotations |= c.kernel->rotations();
      classes.push_back(c);

      // compact tiles by recursive bisection of the element centres
      std::vector<Vec3d> at(group.members.size());
      for (std::size_t i = 0; i < at.size(); ++i)
        at[i] = centre(model, group.members[i], group.corners);
      const int size = tile_size(p.family, group.corners);
      std::vector<int> order = compact_order(at, size);
      auto& places = p.family == Family::solid   ? place_of_solid
                     : p.family == Family::shell ? place_of_shell
                                                 : place_of_beam;
      for (int first = 0; first < int(order.size()); first += size) {
        Tile t{};
        t.tile_class = int(classes.size()) - 1;
        t.first = int(element.size());
        t.count = std::min(size, int(order.size()) - first);
        t.node_first = int(node.size());
        t.connectivity = connectivity.size();
        const int blocks = (t.count + block_size - 1) / block_size, N = group.corners;
        connectivity.resize(connectivity.size() + std::size_t(blocks) * N * block_size);
        // In the deck's order, so that what another thread's nodes want of this tile lies together.
        for (int i = 0; i < t.count; ++i)
          for (int a = 0; a < N; ++a) {
            const int n = group.members[order[first + i]].node[a];
            if (local[n] < 0) local[n] = 0, node.push_back(n);
          }
        std::sort(node.begin() + t.node_first, node.end());
        for (int k = t.node_first; k < int(node.size()); ++k) local[node[k]] = k - t.node_first;
        for (int i = 0; i < blocks * block_size; ++i) {
          const Member& member = group.members[order[first + std::min(i, t.count - 1)]];
          for (int a = 0; a < N; ++a)
            connectivity[t.connectivity + (std::size_t(i / block_size) * N + a) * block_size +
                         i % block_size] = std::uint16_t(local[member.node[a]]);
          if (i < t.count) {
            places[member.element] = {int(tiles.size()), i};
            element.push_back(member.element);
          }
        }
        t.node_count = int(node.size()) - t.node_first;
        // the anchor is the node nearest the middle, so that float differences stay small
        Vec3d middle{0, 0, 0};
        for (int k = 0; k < t.node_count; ++k) middle += model.nodes.x[node[t.node_first + k]];
        middle = (1.0 / t.node_count) * middle;
        double best = 1e300;
        for (int k = 0; k < t.node_count; ++k) {
          const int n = node[t.node_first + k];
          const Vec3d d = model.nodes.x[n] - middle;
          if (dot(d, d) < best) best = dot(d, d), t.anchor = n;
          local[n] = -1;
        }
        t.step = steps_size;
        steps_size += std::size_t(blocks) * block_size;
        t.state = state_.size();
        state_.resize(state_.size() + std::size_t(blocks) * c.fields * block_size, Real(0));
        tiles.push_back(t);
      }
    }
  }
  steps.resize(steps_size);
  if (std::any_of(classes.begin(), classes.end(),
                  [](const TileClass& c) { return c.kernel->can_fail(); }))
    energies.resize(steps_size);
  force.resize(node.size());
  if (any_rotations) moment.resize(node.size());

  partial_first.assign(model.nodes.size() + 1, 0);
  for (int n : node) ++partial_first[n + 1];
  std::partial_sum(partial_first.begin(), partial_first.end(), partial_first.begin());
  partial.resize(node.size());
  std::vector<int> at(partial_first.begin(), partial_first.end() - 1);
  for (int k = 0; k < int(node.size()); ++k) partial[at[node[k]]++] = k;
  for (int i = 0; i < int(tiles.size()); ++i)
    if (classes[tiles[i].tile_class].kernel->nodal_pressure()) nodal_tiles_.push_back(i);
  nodal_pressure_.build(*this);
  initialise(model);
}

void Tiles::initialise(const Model& model) {
  mass_.assign(model.nodes.size(), 0);
  inertia_.assign(model.nodes.size(), 0);
  node_mass.assign(node.size(), 0);
  std::vector<NodeRecord> nodes;
  std::vector<SpinRecord> spins;
  for (Tile& t : tiles) {
    const TileClass& c = classes[t.tile_class];
    const int N = c.kernel->corners();
    nodes.assign(t.node_count, {}), spins.assign(t.node_count, {});
    for (int k = 0; k < t.node_count; ++k)
      for (int d = 0; d < 3; ++d)
        nodes[k].value[d] =
            Real(model.nodes.x[node[t.node_first + k]][d] - model.nodes.x[t.anchor][d]);
    std::vector<float> thickness(4 * t.count, 0.f);
    std::vector<Vec3d> orientation(t.count, Vec3d{0, 0, 0});
    for (int i = 0; i < t.count; ++i) {
      const int e = element[t.first + i];
      double h[4] = {0, 0, 0, 0};
      if (c.family == Family::shell) {
        const auto given = shell_thickness(model, e);
        for (int a = 0; a < 4; ++a) thickness[4 * i + a] = float(h[a] = given[a]);
      }
      if (c.family == Family::beam) {
        const auto& n = model.beams.node[e];
        if (n[2] >= 0)
          orientation[i] = model.nodes.x[n[2]] - model.nodes.x[n[0]];
        else if (e < int(model.beams.orientation.size()))
          orientation[i] = model.beams.orientation[e];
      }
      Vec3d x[8];
      double m[8], j[8];
      const std::uint16_t* index =
          &connectivity[t.connectivity + std::size_t(i / block_size) * N * block_size];
      int global[8];
      for (int a = 0; a < N; ++a) {
        global[a] = node[t.node_first + index[a * block_size + i % block_size]];
        x[a] = model.nodes.x[global[a]];
      }
      c.kernel->lump(c.parameters, x, h, orientation[i], m, j);
      for (int a = 0; a < N; ++a) {
        mass_[global[a]] += m[a], inertia_[global[a]] += j[a];
        node_mass[t.node_first + index[a * block_size + i % block_size]] += m[a];
      }
    }
    TileView view;
    view.count = t.count;
    view.connectivity = &connectivity[t.connectivity];
    view.state = state_.data() + t.state;
    view.nodes = nodes.data(), view.spins = spins.data();
    view.thickness = thickness.data(), view.orientation = orientation.data();
    c.kernel->initialise(c.parameters, view);
  }
}

void Tiles::add_into(std::vector<double>& mass, std::vector<double>& inertia) const {
  for (std::size_t n = 0; n < mass.size(); ++n) mass[n] += mass_[n], inertia[n] += inertia_[n];
}

void Tiles::fill_nodes(const State& state, const Tile& t, NodeRecord* nodes,
                       SpinRecord* spins) const {
  const NodeMotion& anchor = state.nodes[t.anchor];
  const int* global = node.data() + t.node_first;
#if defined(__AVX512F__)
  if constexpr (sizeof(Real) == 4) {
    alignas(64) const double origin[8] = {anchor.x.x, anchor.x.y, anchor.x.z, anchor.v.x,
                                          anchor.v.y, anchor.v.z, 0,          0};
    const __m512d o = _mm512_load_pd(origin);
    for (int k = 0; k < t.node_count; ++k) {
      const __m512d line = _mm512_load_pd(&state.nodes[global[k]].x.x);
      _mm256_store_ps((float*)nodes[k].value, _mm512_cvtpd_ps(_mm512_sub_pd(line, o)));
    }
  } else
#endif
  {
    for (int k = 0; k < t.node_count; ++k) {
      const NodeMotion& n = state.nodes[global[k]];
      for (int d = 0; d < 3; ++d) {
        nodes[k].value[d] = Real(n.x[d] - anchor.x[d]);
        nodes[k].value[3 + d] = Real(n.v[d] - anchor.v[d]);
      }
      nodes[k].value[6] = Real(n.mass);
    }
  }
  if (spins)
    for (int k = 0; k < t.node_count; ++k) {
      const Vec3d& w = state.spins[global[k]].w;
      spins[k] = {{Real(w.x), Real(w.y), Real(w.z), Real(0)}};
    }
}

namespace {
// working memory of one thread
struct Scratch {
  AlignedVector<NodeRecord> nodes;
  AlignedVector<SpinRecord> spins;
};
Scratch& scratch(int count) {
  thread_local Scratch s;
  if (int(s.nodes.size()) < count) s.nodes.resize(count), s.spins.resize(count);
  return s;
}
}  // namespace

TileView Tiles::view_of(const Tile& t, const NodeRecord* nodes, const SpinRecord* spins) {
  TileView view;
  view.count = t.count;
  view.connectivity = connectivity.data() + t.connectivity;
  view.state = state_.data() + t.state;
  view.nodes = nodes, view.spins = spins;
  view.force = force.data() + t.node_first;
  std::fill_n(view.force, t.node_count, ForceRecord{});
  if (any_rotations) {
    view.moment = moment.data() + t.node_first;
    std::fill_n(view.moment, t.node_count, ForceRecord{});
  }
  return view;
}

NodesAhead Tiles::nodes_of(const State& state, int tile) const {
  const Tile& t = tiles[tile];
  const bool rotations = classes[t.tile_class].kernel->rotations();
  return {&node[t.node_first], t.node_count, state.nodes.data(),
          rotations ? state.spins.data() : nullptr};
}

// volume rates of nodal-pressure tetrahedra to their nodes
void Tiles::nodal_rates(State& state, Team& team) {
  team.for_each(int(nodal_tiles_.size()), [&](int i, int) {
    const Tile& t = tiles[nodal_tiles_[i]];
    const TileClass& c = classes[t.tile_class];
    Scratch& s = scratch(t.node_count);
    fill_nodes(state, t, s.nodes.data(), nullptr);
    TileView view = view_of(t, s.nodes.data(), nullptr);
    c.kernel->nodal_rates(c.parameters, Real(state.dt_previous), view);
  });
  nodal_pressure_.advance(*this, state.dt_previous, team);
}

// Nodes are shared out in the order of their numbers, so tiles are too: a thread finds the nodes of
// its tiles where it moved them and not in the caches of another. Within a share neighbours follow
// each other as bisection left them.
void Tiles::arrange(int shares) {
  const int n = int(tiles.size());
  std::vector<double> middle(n);  // mean node number
  for (int i = 0; i < n; ++i) {
    const auto first = node.begin() + tiles[i].node_first;
    middle[i] = std::accumulate(first, first + tiles[i].node_count, 0.0) / tiles[i].node_count;
  }
  order_.resize(n);
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(),
                   [&](int a, int b) { return middle[a] < middle[b]; });
  for (int s = 0; s < shares; ++s)
    std::sort(order_.begin() + Team::share_first(n, s, shares),
              order_.begin() + Team::share_first(n, s + 1, shares));
  shares_ = shares;
}

void Tiles::forces(State& state, Team& team) {
  if (!nodal_tiles_.empty()) nodal_rates(state, team);
  if (shares_ != team.size() || order_.size() != tiles.size()) arrange(team.size());
  team.for_each(int(tiles.size()), [&](int i, int) {
    Tile& t = tiles[order_[i]];
    const TileClass& c = classes[t.tile_class];
    Scratch& s = scratch(t.node_count);
    fetch_history(state_.data() + t.state, c.fields);
    fill_nodes(state, t, s.nodes.data(), c.kernel->rotations() ? s.spins.data() : nullptr);
    TileView view = view_of(t, s.nodes.data(), s.spins.data());
    if (i + 1 < int(order_.size())) view.ahead = nodes_of(state, order_[i + 1]);
    if (c.kernel->nodal_pressure()) {
      view.node_rate = nodal_pressure_.rate(t.node_first);
      view.node_pressure = nodal_pressure_.pressure(t.node_first);
    }
    if (record_steps) view.element_time_step = steps.data() + t.step;
    if (c.kernel->can_fail()) view.element_energy = energies.data() + t.step;
    c.kernel->forces(c.parameters, Real(state.dt_previous), view);
    t.internal = view.internal, t.hourglass = view.hourglass, t.damping = view.damping;
    t.eroded_internal = view.eroded_internal, t.eroded_hourglass = view.eroded_hourglass,
    t.failed = view.failed;
    t.time_step = view.time_step, t.smallest_volume = view.smallest_volume;
  });
}

void Tiles::sum_partials(State& state, int a, int b) const {
  const bool rotations = any_rotations && !state.spins.empty();
  for (int n = a; n < b; ++n) {
    Vec3d f{0, 0, 0}, m{0, 0, 0};
    for (int k = partial_first[n]; k < partial_first[n + 1]; ++k) {
      const Real* r = force[partial[k]].value;
      f += Vec3d{double(r[0]), double(r[1]), double(r[2])};
      if (rotations) {
        const Real* q = moment[partial[k]].value;
        m += Vec3d{double(q[0]), double(q[1]), double(q[2])};
      }
    }
    state.force[n] = f;
    if (!state.spins.empty()) state.moment[n] = m;
  }
}

void Tiles::save(std::ostream& out) const {
  const std::uint64_t n = state_.size();
  out.write(reinterpret_cast<const char*>(&n), sizeof n);
  out.write(reinterpret_cast<const char*>(state_.data()), std::streamsize(n * sizeof(Real)));
  out.write(reinterpret_cast<const char*>(energies.data()),
            std::streamsize(energies.size() * sizeof(ElementEnergy)));
  nodal_pressure_.save(out);
}

void Tiles::load(std::istream& in) {
  std::uint64_t n = 0;
  in.read(reinterpret_cast<char*>(&n), sizeof n);
  if (n != state_.size())
    throw std::runtime_error("restart file does not belong to this deck: element history differs");
  in.read(reinterpret_cast<char*>(state_.data()), std::streamsize(n * sizeof(Real)));
  in.read(reinterpret_cast<char*>(energies.data()),
          std::streamsize(energies.size() * sizeof(ElementEnergy)));
  nodal_pressure_.load(in);
}

}  // namespace fabrica
