// fabrica_gpu_check: the same model on the CPU and on the GPU for 1000 steps; every bit of partial
// forces, element history and motion is compared, and element updates per second are printed for
// both. Without a GPU it says so and succeeds. Exit code 1: the two differ, or the GPU refused.
#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

#include "app/bench_models.h"
#include "solver/cuda/gpu_forces.h"
#include "solver/simulation.h"

namespace fabrica {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point t) {
  return std::chrono::duration<double>(Clock::now() - t).count();
}

// A velocity field that shears and squeezes with the given wavelength; the model flies free.
void throw_nodes(State& state, double wavelength) {
  const double q = 2 * std::acos(-1.0) / wavelength, speed = 10;
  for (NodeMotion& n : state.nodes)
    n.v = {speed * std::sin(q * n.x.y), speed * std::sin(q * n.x.z + 1),
           speed * std::sin(q * n.x.x + 2)};
}

// the passes of Simulation::step for a model that nothing acts on, with the step rule of
// GpuStepping
void step_on_cpu(Tiles& tiles, State& s, Team& team, const GpuStepping& stepping) {
  tiles.forces(s, team);
  double step = 1e30;
  for (const Tile& t : tiles.tiles) {
    step = std::min(step, double(t.time_step));
    s.energy.internal += t.internal, s.energy.hourglass += t.hourglass;
  }
  step *= stepping.scale;
  if (s.dt_previous > 0) step = std::min(step, 1.05 * s.dt_previous);
  s.dt = step;
  const int count = int(s.nodes.size()), chunk = 1024;
  team.for_each((count + chunk - 1) / chunk, [&](int c, int) {
    const int first = c * chunk, last = std::min(count, first + chunk);
    tiles.sum_partials(s, first, last);
    for (int n = first; n < last; ++n) {
      s.nodes[n].v += (s.mean_dt() * s.nodes[n].inverse_mass) * s.force[n];
      if (!s.spins.empty() && s.spins[n].inertia > 0)
        s.spins[n].w += (s.mean_dt() / s.spins[n].inertia) * s.moment[n];
      s.nodes[n].x += s.dt * s.nodes[n].v;
    }
  });
  s.time_sum.add(s.dt), s.time = s.time_sum.value();
  s.dt_previous = s.dt;
  ++s.cycle;
}

// places where two arrays of numbers differ by a bit
template <class Number, class Array>
std::size_t differences(const Array& a, const Array& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  const std::size_t n = a.size() * sizeof(a[0]) / sizeof(Number);
  const auto* p = reinterpret_cast<const unsigned char*>(a.data());
  const auto* q = reinterpret_cast<const unsigned char*>(b.data());
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i)
    count += std::memcmp(p + i * sizeof(Number), q + i * sizeof(Number), sizeof(Number)) != 0;
  return count;
}

bool report(const char* what, std::size_t count, std::size_t of) {
  if (count == 0)
    fmt::print("  {:<28} equal to the bit\n", what);
  else
    fmt::print("  {:<28} {} of {} numbers differ\n", what, count, of);
  return count == 0;
}

bool compare(const Tiles& a, const Tiles& b, const State& s, const State& t) {
  bool same = report("partial forces", differences<Real>(a.force, b.force), 4 * a.force.size());
  same &= report("partial moments", differences<Real>(a.moment, b.moment), 4 * a.moment.size());
  same &= report("element history", differences<Real>(a.state_, b.state_), a.state_.size());
  same &=
      report("positions and velocities", differences<double>(s.nodes, t.nodes), 8 * s.nodes.size());
  if (a.any_rotations)
    same &= report("spins", differences<double>(s.spins, t.spins), 8 * s.spins.size());
  const std::size_t clock = (s.time != t.time) + (s.dt != t.dt) + (s.cycle != t.cycle);
  return report("time, step, cycle", clock, 3) && same;
}

bool check_model(const char* name, const Model& model, double wavelength, int steps) {
  Diagnostics diagnostics;
  RunOptions options;
  options.end_time = 1e9;
  Simulation start(model, options, diagnostics);
  Tiles cpu = start.tiles(), gpu = start.tiles();
  State at_cpu = start.state();
  throw_nodes(at_cpu, wavelength);
  State at_gpu = at_cpu;
  fmt::print("{}: {} elements, {} steps\n", name, cpu.elements(), steps);

  GpuForces device(model, gpu);
  device.upload(gpu, at_gpu);
  const GpuStepping stepping;
  device.step(1, stepping);  // loads the kernels
  auto from = Clock::now();
  device.step(steps - 1, stepping);
  const double gpu_seconds = seconds_since(from);
  device.download(gpu, at_gpu);

  const int threads = std::max(1, int(std::thread::hardware_concurrency()));
  Team team(threads);
  from = Clock::now();
  for (int i = 0; i < steps; ++i) step_on_cpu(cpu, at_cpu, team, stepping);
  const double cpu_seconds = seconds_since(from);

  const double updates = double(cpu.elements()) / 1e6;
  fmt::print("  CPU, {:3} threads {:10.2f} million element updates a second\n", threads,
             updates * steps / cpu_seconds);
  fmt::print("  GPU              {:10.2f} million element updates a second, {:.1f} us a step\n",
             updates * (steps - 1) / gpu_seconds, 1e6 * gpu_seconds / (steps - 1));
  fmt::print("  internal energy  {:.9g} on the CPU, {:.9g} on the GPU\n", at_cpu.energy.internal,
             at_gpu.energy.internal);
  if (device.ending() != GpuEnding::running) {
    fmt::print("  the GPU ended the run early\n");
    return false;
  }
  return compare(cpu, gpu, at_cpu, at_gpu);
}

int check_all(int elements, int steps) {
  if (!cuda_available()) {
    fmt::print("no GPU: skipped\n");
    return 0;
  }
  fmt::print("device: {}\n", cuda_device_name());
  Diagnostics diagnostics;
  const auto bricks = bench_bricks(elements, diagnostics);
  const auto tets = bench_tets(elements, diagnostics);
  const auto shells = bench_shells(elements, diagnostics);
  if (!bricks || !tets || !shells || diagnostics.has_errors()) {
    for (const auto& d : diagnostics.list()) fmt::print(stderr, "{}\n", diagnostics.format(d));
    return 1;
  }
  bool same = check_model("bricks", *bricks, 60, steps);
  same &= check_model("tetrahedra", *tets, 60, steps);
  same &= check_model("shells", *shells, 200, steps);
  return same ? 0 : 1;
}

}  // namespace
}  // namespace fabrica

// fabrica_gpu_check [elements [steps]]
int main(int argc, char** argv) {
  try {
    const int elements = argc > 1 ? std::stoi(argv[1]) : 64000,
              steps = argc > 2 ? std::stoi(argv[2]) : 1000;
    if (elements < 8 || steps < 2)
      throw std::invalid_argument("usage: fabrica_gpu_check [elements [steps]]");
    return fabrica::check_all(elements, steps);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
