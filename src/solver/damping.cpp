#include "solver/damping.h"

#include <algorithm>

#include "load/time_curve.h"
#include "solver/stream.h"

namespace fabrica {

namespace {

constexpr int chunk_nodes = 1024;

// damping force over one step for momentum p, force f: -D (p + dt f/2) / (1 + D dt/2)
double semi_implicit(double rate, double dt, double p, double f) {
  return -rate * (p + 0.5 * dt * f) / (1 + 0.5 * rate * dt);
}

}  // namespace

MassDamping::MassDamping(const Model& model, const RigidBodies& bodies) : model_(model) {
  const int n = model.nodes.size();
  for (int i = 0; i < int(model.part_damping.size()); ++i) {
    const PartDamping& d = model.part_damping[i];
    if (d.mass_curve < 0) continue;
    std::vector<unsigned char> in(model.parts.size(), 0);
    for (int p : d.parts) in[p] = 1;
    std::vector<double> all(n, 0);
    PartRate rate{i, std::vector<double>(n, 0), {}};
    auto count = [&](const auto& family, int corners) {
      for (int e = 0; e < family.size(); ++e)
        for (int k = 0; k < corners; ++k) {
          const int node = family.node[e][k];
          if (node < 0) continue;
          all[node] += 1;
          if (in[family.part[e]]) rate.weight[node] += 1;
        }
    };
    count(model.solids, 8), count(model.shells, 4), count(model.beams, 2);
    for (int k = 0; k < n; ++k)
      if (all[k] > 0) rate.weight[k] /= all[k];
    for (int b = 0; b < bodies.size(); ++b)
      if (bodies[b].part >= 0 && in[bodies[b].part]) rate.bodies.push_back(b);
    parts_.push_back(std::move(rate));
  }
  active_ = !parts_.empty() || !model.global_damping.empty();
  if (!active_) return;
  last_force_.assign(n, {}), last_moment_.assign(n, {});
  last_body_force_.assign(bodies.size(), {}), last_body_moment_.assign(bodies.size(), {});
}

void MassDamping::global_rates(double time, double (&rate)[6]) const {
  for (double& r : rate) r = 0;
  for (const Damping& d : model_.global_damping) {
    const double value = d.curve >= 0
                             ? curve_value(model_.curves[d.curve].x, model_.curves[d.curve].y, time)
                             : d.value;
    const bool blank = std::all_of(d.scale.begin(), d.scale.end(), [](double s) { return s == 0; });
    for (int k = 0; k < 6; ++k) rate[k] += value * (blank ? 1 : d.scale[k]);
  }
}

void MassDamping::apply(State& state, RigidBodies& bodies, Team& team) {
  if (!active_) return;
  double rate[6];
  global_rates(state.time, rate);
  std::vector<double> part_rate;
  for (const PartRate& p : parts_) {
    const PartDamping& d = model_.part_damping[p.index];
    const Curve& c = model_.curves[d.mass_curve];
    part_rate.push_back((d.mass_scale != 0 ? d.mass_scale : 1) * curve_value(c.x, c.y, state.time));
  }
  const std::size_t n = state.nodes.size();
  const double dt = state.mean_dt();
  partial_.assign(Team::ranges(n, chunk_nodes), 0);
  team.for_ranges(n, chunk_nodes, [&](int chunk, int first, int end) {
    double work = 0;
    // v holds v- + dt f/m: damps it and returns twice the mean work rate with the last force
    auto damp = [&](Vec3d& v, const Vec3d& f, double mass, double extra, const double* d,
                    Vec3d& last) {
      Vec3d force;
      double power = 0;
      const double inverse = 1 / mass;
      for (int k = 0; k < 3; ++k) {
        const double before = mass * v[k] - dt * f[k];
        force[k] = semi_implicit(d[k] + extra, dt, before, f[k]);
        power += (last[k] + force[k]) * before * inverse;
        v[k] += dt * force[k] * inverse;
      }
      last = force;
      return power;
    };
    for (int i = first; i < end; ++i) {
      if (state.owner[i] != NodeOwner::free) continue;
      double extra = 0;
      for (std::size_t p = 0; p < parts_.size(); ++p) extra += part_rate[p] * parts_[p].weight[i];
      work +=
          damp(state.nodes[i].v, state.force[i], state.nodes[i].mass, extra, rate, last_force_[i]);
      if (!state.spins.empty() && state.spins[i].inertia > 0)
        work += damp(state.spins[i].w, state.moment[i], state.spins[i].inertia, extra, rate + 3,
                     last_moment_[i]);
    }
    partial_[chunk] = work;
  });
  double work = 0;
  for (double w : partial_) work += w;
  for (int b = 0; b < bodies.size(); ++b) {
    const RigidBody& body = bodies[b];
    if (!body.active) continue;
    double extra = 0;
    for (std::size_t p = 0; p < parts_.size(); ++p)
      if (std::binary_search(parts_[p].bodies.begin(), parts_[p].bodies.end(), b))
        extra += part_rate[p];
    Vec3d force, moment;
    for (int k = 0; k < 3; ++k) {
      force[k] =
          semi_implicit(rate[k] + extra, dt, body.motion.mass * body.motion.v[k], body.force[k]);
      moment[k] = semi_implicit(rate[k + 3] + extra, dt, body.motion.momentum[k], body.moment[k]);
    }
    work += dot(last_body_force_[b] + force, body.motion.v) +
            dot(last_body_moment_[b] + moment, body.motion.w);
    last_body_force_[b] = force, last_body_moment_[b] = moment;
    bodies.add_force(b, force, moment);
  }
  state.energy.damping -= 0.5 * state.dt_previous * work;
}

void MassDamping::save(std::ostream& out) const {
  for (const auto* v : {&last_force_, &last_moment_, &last_body_force_, &last_body_moment_})
    write_vector(out, *v);
}

void MassDamping::load(std::istream& in) {
  for (auto* v : {&last_force_, &last_moment_, &last_body_force_, &last_body_moment_})
    read_vector(in, *v);
}

}  // namespace fabrica
