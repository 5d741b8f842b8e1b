#include "solver/discrete_elements.h"

#include <cmath>
#include <map>

#include "element/discrete.h"

namespace fabrica {
namespace {
constexpr int chunk = 64;  // elements per unit of work

double reduced(double a, double b) { return a > 0 && b > 0 ? a * b / (a + b) : std::max(a, b); }

// axis and length of a spring between two points
SpringAxis spring_axis(const Model& model, const State& state, int orientation, const Vec3d& a,
                       const Vec3d& b) {
  if (orientation < 0) return axis_along_line(a, b);
  const SdOrientation& o = model.sd_orientations[std::size_t(orientation)];
  Vec3d n = o.direction;
  if (o.option >= 2)
    n = state.nodes[std::size_t(o.node[1])].x - state.nodes[std::size_t(o.node[0])].x;
  n = unit_or_zero(n);
  return o.option == 0 || o.option == 2 ? axis_along_direction(a, b, n) : axis_in_plane(a, b, n);
}
}  // namespace

Vec3d DiscreteElements::spin(const State& state, int node) const {
  return node < 0 || state.spins.empty() ? Vec3d{0, 0, 0} : state.spins[std::size_t(node)].w;
}

double DiscreteElements::mass_of(const State& state, int local) const {
  if (local < 0) return 0;
  const Node& n = nodes_[std::size_t(local)];
  return n.mass > 0 ? n.mass : state.nodes[std::size_t(n.node)].mass;
}

double DiscreteElements::inertia_of(const State& state, int local) const {
  if (local < 0 || state.spins.empty()) return 0;
  const Node& n = nodes_[std::size_t(local)];
  return n.inertia > 0 ? n.inertia : state.spins[std::size_t(n.node)].inertia;
}

void DiscreteElements::use_mass(int node, int body, double mass, double inertia) {
  const int local = node_to_local_[std::size_t(node)];
  if (local < 0) return;
  Node& n = nodes_[std::size_t(local)];
  n.body = body, n.mass = mass, n.inertia = inertia;
}

// A stop at the deflection limits: pushes back without ever pulling, so that the contact is nearly
// plastic. Its stiffness k = m / (2 dt)^2 and damping c = m / (2 dt) follow from the step, which
// keeps it stable.
double DiscreteElements::stop_force(const State& state, const Spring& s, double rate) const {
  if (s.longest == 0 && s.shortest == 0) return 0;
  const double high = s.longest != 0 ? std::fabs(s.longest) : INFINITY;
  const double low = s.shortest != 0 ? -std::fabs(s.shortest) : -INFINITY;
  const double over = s.elongation > high  ? s.elongation - high
                      : s.elongation < low ? s.elongation - low
                                           : 0.0;
  if (over == 0 || state.dt_previous <= 0) return 0;
  const double m = s.torsional ? reduced(inertia_of(state, s.local1), inertia_of(state, s.local2))
                               : reduced(mass_of(state, s.local1), mass_of(state, s.local2));
  const double h = 2 * state.dt_previous;
  const double push = m / (h * h) * over + m / h * rate;
  return over > 0 ? std::max(push, 0.0) : std::min(push, 0.0);
}

// The force of the law with clearance, scale, dynamic magnification and failure; sets the tangents.
double DiscreteElements::spring_law_force(const State& state, Spring& s, double rate) const {
  const bool too_long = s.failure > 0 && s.elongation >= s.failure;
  const bool too_short = s.failure < 0 && s.elongation <= s.failure;
  if (too_long || too_short) s.alive = 0;
  s.stiffness = s.damping = 0;
  if (!s.alive) return 0;
  SpringMotion m{s.elongation, rate, state.dt_previous, state.time,
                 s.torsional ? 0.0 : s.rest + s.elongation};
  // play: the law starts only behind it
  if (s.clearance > 0) m.d = std::min(m.d + s.clearance, 0.0);
  if (s.clearance < 0) m.d = std::max(m.d + s.clearance, 0.0);
  if (s.clearance != 0 && m.d == 0) m.rate = 0;
  const SpringForce f = spring_force(*spring_law_[std::size_t(s.law)], m, s.state);
  double scale = s.scale;
  if (s.dynamic_factor != 0 && s.test_velocity != 0)
    scale *= 1 + s.dynamic_factor * std::fabs(rate) / s.test_velocity;
  s.stiffness = f.stiffness * std::fabs(scale);
  s.damping = f.damping * std::fabs(scale);
  return f.force * scale;
}

void DiscreteElements::pull_spring(const Model& model, const State& state, Spring& s) const {
  s.pull = {};
  s.force = 0;
  if (!s.alive) return;
  const NodeMotion& a = state.nodes[std::size_t(s.node1)];
  const NodeMotion* b = s.node2 >= 0 ? &state.nodes[std::size_t(s.node2)] : nullptr;
  // a grounded spring runs from the ground to its node, so that motion along the axis is tension
  const Vec3d from = b ? a.x : s.ground, to = b ? b->x : a.x;
  const SpringAxis axis = spring_axis(model, state, s.orientation, from, to);
  const double sign = b ? 1.0 : -1.0;
  if (s.torsional) {
    const double rate = sign * dot(axis.e, spin(state, s.node2) - spin(state, s.node1));
    s.elongation += state.dt_previous * rate;
    s.force = spring_law_force(state, s, rate) + stop_force(state, s, rate);
    s.pull.moment1 = (sign * s.force) * axis.e;
    s.pull.moment2 = -s.pull.moment1;
    return;
  }
  const Vec3d velocity = (b ? b->v : Vec3d{0, 0, 0}) - a.v;
  const double rate = sign * dot(axis.e, velocity);
  s.elongation = axis.d - s.rest;
  s.force = spring_law_force(state, s, rate) + stop_force(state, s, rate);
  s.pull.force = (sign * s.force) * axis.e;
}

// The triad follows node 1 (SCOOR < 0), node 2 (> 0) or their mean; |SCOOR| = 2, 3 lays r along the
// nodes again.
void DiscreteElements::move_triad(const State& state, Beam& b) const {
  Vec3d w = 0.5 * (spin(state, b.node1) + spin(state, b.node2));
  if (b.tracking < 0) w = spin(state, b.node1);
  if (b.tracking > 0) w = spin(state, b.node2);
  if (b.frozen[0] || b.frozen[1] || b.frozen[2]) {
    Vec3d local = b.triad * w;
    for (int i = 0; i < 3; ++i)
      if (b.frozen[i]) local[i] = 0;
    w = transpose(b.triad) * local;
  }
  b.triad = turned_rows(b.triad, state.dt_previous * w);
  if (std::abs(b.tracking) < 2) return;
  const Vec3d line = state.nodes[std::size_t(b.node2)].x - state.nodes[std::size_t(b.node1)].x;
  if (norm(line) > 0) b.triad = orthonormal_rows(line, row_of(b.triad, 1));
}

void DiscreteElements::pull_beam(const State& state, Beam& b) const {
  b.pull = {};
  b.resultant = b.stiffness = b.damping = {};
  if (!b.alive) return;
  const NodeMotion& n1 = state.nodes[std::size_t(b.node1)];
  const NodeMotion& n2 = state.nodes[std::size_t(b.node2)];
  move_triad(state, b);

  // relative motion in the local triad; rotations by integrating the relative rate
  const Vec3d line = n2.x - n1.x;
  const Vec3d u = b.triad * line - b.rest;
  const Vec3d turn_rate = b.triad * (spin(state, b.node2) - spin(state, b.node1));
  const Vec3d triad_rate =
      (1 / std::max(state.dt_previous, 1e-300)) * (u - Vec3d{b.u[0], b.u[1], b.u[2]});
  BeamMotion m;
  m.length = b.length;
  m.mass = reduced(mass_of(state, b.local1), mass_of(state, b.local2));
  m.inertia = reduced(inertia_of(state, b.local1), inertia_of(state, b.local2));
  for (int i = 0; i < 3; ++i) {
    m.rate[i] = state.dt_previous > 0 ? triad_rate[i] : 0.0;
    m.rate[3 + i] = turn_rate[i];
    b.u[i] = u[i];
    b.u[3 + i] += state.dt_previous * turn_rate[i];
  }
  m.u = b.u;
  const BeamForce f = beam_force(*beam_law_[std::size_t(b.law)], m, b.state);
  if (f.failed) {
    b.alive = 0;
    return;
  }
  b.resultant = f.force, b.stiffness = f.stiffness, b.damping = f.damping;
  const Mat3d to_global = transpose(b.triad);
  b.pull.force = to_global * Vec3d{f.force[0], f.force[1], f.force[2]};
  b.pull.moment1 = to_global * Vec3d{f.force[3], f.force[4], f.force[5]};
  b.pull.moment2 = -b.pull.moment1;
  if (std::abs(b.tracking) < 2) return;
  // the two forces form a couple; half of its opposite goes to each node
  const Vec3d balance = 0.5 * cross(line, b.pull.force);
  b.pull.moment1 += balance;
  b.pull.moment2 += balance;
}

void DiscreteElements::forces(const Model& model, State& state, Team& team) {
  const bool spins = !state.spins.empty();
  const auto give = [&](int node1, int node2, const Pull& p) {
    state.interaction.add(std::size_t(node1), p.force);
    if (node2 >= 0) state.interaction.add(std::size_t(node2), -p.force);
    if (!spins) return;
    state.interaction_moment.add(std::size_t(node1), p.moment1);
    if (node2 >= 0) state.interaction_moment.add(std::size_t(node2), p.moment2);
  };
  const int n = springs(), m = beams();
  team.for_each((n + chunk - 1) / chunk, [&](int c, int) {
    for (int i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i) {
      Spring& s = spring_[std::size_t(i)];
      if (s.law < 0) continue;
      pull_spring(model, state, s);
      give(s.node1, s.node2, s.pull);
    }
  });
  team.for_each((m + chunk - 1) / chunk, [&](int c, int) {
    for (int i = c * chunk; i < std::min(m, (c + 1) * chunk); ++i) {
      Beam& b = beam_[std::size_t(i)];
      pull_beam(state, b);
      give(b.node1, b.node2, b.pull);
    }
  });
  state.energy.discrete -= 0.5 * state.dt_previous * power(state);
}

double DiscreteElements::power(const State& state) const {
  const auto of = [&](int node1, int node2, const Pull& p) {
    const Vec3d v1 = state.nodes[std::size_t(node1)].v;
    const Vec3d v2 = node2 >= 0 ? state.nodes[std::size_t(node2)].v : Vec3d{0, 0, 0};
    return dot(p.force, v1 - v2) + dot(p.moment1, spin(state, node1)) +
           dot(p.moment2, spin(state, node2));
  };
  double sum = 0;
  for (const Spring& s : spring_)
    if (s.law >= 0) sum += of(s.node1, s.node2, s.pull);
  for (const Beam& b : beam_) sum += of(b.node1, b.node2, b.pull);
  return sum;
}

void DiscreteElements::account(State& state) const {
  state.energy.discrete -= 0.5 * state.dt * power(state);
}

// K/m, C/m and the same for rotations at every node; nodes of one body get the sum over the body.
std::vector<DiscreteElements::Rate> DiscreteElements::rates(const State& state) const {
  std::vector<Rate> rate(nodes_.size());
  const auto add = [&](int local, double k, double c, double kr, double cr) {
    if (local < 0) return;
    Rate& r = rate[std::size_t(local)];
    r.k += k, r.c += c, r.kr += kr, r.cr += cr;
  };
  for (const Spring& s : spring_) {
    if (s.law < 0) continue;
    for (const int l : {s.local1, s.local2})
      s.torsional ? add(l, 0, 0, s.stiffness, s.damping) : add(l, s.stiffness, s.damping, 0, 0);
  }
  for (const Beam& b : beam_) {
    double k = 0, c = 0, kr = 0, cr = 0;
    for (int i = 0; i < 3; ++i) {
      k = std::max(k, b.stiffness[i]), c = std::max(c, b.damping[i]);
      kr = std::max(kr, b.stiffness[3 + i]), cr = std::max(cr, b.damping[3 + i]);
    }
    for (const int l : {b.local1, b.local2}) add(l, k, c, kr, cr);
  }
  std::map<int, Rate> body;
  for (std::size_t l = 0; l < rate.size(); ++l) {
    Rate& r = rate[l];
    const double m = mass_of(state, int(l)), j = inertia_of(state, int(l));
    r = {m > 0 ? r.k / m : 0, m > 0 ? r.c / m : 0, j > 0 ? r.kr / j : 0, j > 0 ? r.cr / j : 0};
    if (nodes_[l].body < 0) continue;
    Rate& sum = body[nodes_[l].body];
    sum.k += r.k, sum.c += r.c, sum.kr += r.kr, sum.cr += r.cr;
  }
  for (std::size_t l = 0; l < rate.size(); ++l)
    if (nodes_[l].body >= 0) rate[l] = body[nodes_[l].body];
  return rate;
}

// Bound of an element whose nodes share their mass among all elements in proportion to stiffness:
// w^2 = K1/m1 + K2/m2 with the nodes' sums K, and the same for damping and for rotations.
double DiscreteElements::time_step(const State& state) const {
  const std::vector<Rate> rate = rates(state);
  double dt = INFINITY;
  const auto bound = [&](int l1, int l2) {
    Rate sum;
    for (const int l : {l1, l2}) {
      if (l < 0) continue;
      const Rate& r = rate[std::size_t(l)];
      sum.k += r.k, sum.c += r.c, sum.kr += r.kr, sum.cr += r.cr;
    }
    dt = std::min(
        {dt, spring_time_step(sum.k, 0.5 * sum.c), spring_time_step(sum.kr, 0.5 * sum.cr)});
  };
  for (const Spring& s : spring_)
    if (s.law >= 0) bound(s.local1, s.local2);
  for (const Beam& b : beam_) bound(b.local1, b.local2);
  return dt;
}

}  // namespace fabrica
