#include "app/bench.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "app/bench_models.h"
#include "app/flops.h"
#include "app/machine.h"
#include "solver/simulation.h"

namespace fabrica {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point t) {
  return std::chrono::duration<double>(Clock::now() - t).count();
}

struct Row {
  std::string name;
  double millions = 0;  // element updates a second
  double bytes = 0;     // moved per element and cycle, estimated from the data layout
  double ratio = 1;     // of the speed to that on one thread
  int elements = 0;
  int threads = 1;
};

// state read and written, connectivity, node records, partial forces
double bytes_per_element(const Simulation& s) {
  const Tiles& t = s.tiles();
  double bytes = 2.0 * double(t.state_.size() * sizeof(Real)) + double(t.connectivity.size() * 2);
  bytes += double(t.node.size()) *
           (64 + sizeof(int) + 2 * sizeof(ForceRecord) * (t.any_rotations ? 2 : 1));
  bytes += double(s.state().nodes.size()) * (64 * 2 + 3 * 24 * (t.any_rotations ? 2 : 1));
  return bytes / std::max(1, s.elements());
}

// Cycles of one model on a number of threads, stretch by stretch.
struct Loop {
  static constexpr int cycles = 10;  // of a stretch
  Diagnostics diagnostics;
  Simulation simulation;
  double best = 1e30;  // seconds of the fastest stretch

  Loop(const Model& model, int threads)
      : simulation(model, {.threads = threads, .end_time = 1e9}, diagnostics) {
    for (int i = 0; i < 5; ++i) simulation.step();
  }
  double run() {
    const auto start = Clock::now();
    for (int i = 0; i < cycles; ++i) simulation.step();
    const double seconds = seconds_since(start);
    best = std::min(best, seconds);
    return seconds;
  }
};

// One row for each number of threads. Other programs on the machine make it slower and come and go:
// speeds are those of the best stretch, and the numbers of threads take turns.
std::vector<Row> whole_loops(const std::string& name, const Model& model,
                             const std::vector<int>& threads, double seconds) {
  std::vector<std::unique_ptr<Loop>> loops;
  for (const int t : threads) loops.push_back(std::make_unique<Loop>(model, t));
  for (double spent = 0; spent < seconds * double(threads.size());)
    for (auto& loop : loops) spent += loop->run();
  std::vector<Row> rows;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const Simulation& s = loops[k]->simulation;
    Row row;
    row.name = name, row.threads = threads[k], row.elements = s.elements();
    row.millions = Loop::cycles * double(row.elements) / loops[k]->best / 1e6;
    row.ratio = loops[0]->best / loops[k]->best;
    row.bytes = bytes_per_element(s);
    rows.push_back(row);
  }
  return rows;
}

// element forces only, on one tile's worth of elements that stay in the first-level caches
Row kernel_only(const std::string& name, const Model& model, double seconds) {
  Diagnostics d;
  RunOptions o;
  o.end_time = 1e9;
  Simulation s(model, o, d);
  for (int i = 0; i < 3; ++i) s.step();
  Tiles tiles = s.tiles();
  tiles.tiles.resize(1);
  State state = s.state();
  Team team(1);
  double best = 0, spent = 0;
  while (spent < seconds) {
    const auto start = Clock::now();
    for (int i = 0; i < 500; ++i) tiles.forces(state, team);
    const double t = seconds_since(start);
    spent += t;
    best = std::max(best, 500.0 * tiles.tiles[0].count / t);
  }
  return {name, best / 1e6, bytes_per_element(s), 1, tiles.tiles[0].count, 1};
}

}  // namespace

int bench_command(const BenchCommand& c) {
  std::vector<int> threads;
  for (int t = 1; t <= c.threads; t *= 2) threads.push_back(t);
  const Machine machine = measure_machine(threads);
  std::string triads;
  for (const auto& [n, speed] : machine.triad)
    triads += fmt::format("{} {:.1f} on {}", triads.empty() ? "" : ",", speed, n);
  fmt::print(
      "machine: {} {}, triad{} GB/s, one core {:.0f} Gflop/s peak {} "
      "(fused multiply-add)\n",
      machine.name, machine.instruction_set, triads, machine.peak,
      sizeof(Real) == 4 ? "float" : "double");
  using Make = std::function<std::unique_ptr<Model>(int, Diagnostics&)>;
  struct Case {
    std::string name;
    Make make;
    double flops;
  };
  const Case cases[] = {{"bricks on a rigid wall", bench_bricks, flops_of_brick()},
                        {"tetrahedra on a rigid wall", bench_tets, flops_of_tet()},
                        {"shells, 5 points, J2", bench_shells, flops_of_shell()},
                        {"two brick blocks in contact", bench_contact, flops_of_brick()}};
  nlohmann::ordered_json out = nlohmann::json::array();
  fmt::print("{:<34} {:>8} {:>7} {:>10} {:>6} {:>7} {:>8} {:>7} {:>7} {:>7}\n", "case", "elements",
             "threads", "million/s", "ratio", "ns", "Gflop/s", "of peak", "GB/s", "of triad");
  auto show = [&](const Row& r, double flops) {
    const double gflops = r.millions * flops * 1e-3, gbytes = r.millions * r.bytes * 1e-3;
    fmt::print(
        "{:<34} {:>8} {:>7} {:>10.2f} {:>6.2f} {:>7.1f} {:>8.1f} {:>6.0f}% {:>7.1f} {:>6.0f}%\n",
        r.name, r.elements, r.threads, r.millions, r.ratio, 1e3 / r.millions, gflops,
        100 * gflops / (machine.peak * r.threads), gbytes,
        100 * gbytes / machine.triad.at(r.threads));
    std::fflush(stdout);
    out.push_back({{"case", r.name},
                   {"elements", r.elements},
                   {"threads", r.threads},
                   {"million_updates_per_second", r.millions},
                   {"speed_ratio_to_one_thread", r.ratio},
                   {"bytes_per_element", r.bytes},
                   {"flops_per_element", flops},
                   {"gflops", gflops},
                   {"gbytes_per_second", gbytes}});
  };
  for (const auto& [name, make, flops] : cases) {
    if (name.find(c.only) == std::string::npos) continue;
    Diagnostics d;
    const auto model = make(c.elements, d);
    if (!model || d.has_errors()) {
      for (const auto& x : d.list()) fmt::print(stderr, "{}\n", d.format(x));
      return 1;
    }
    if (name.find("contact") == std::string::npos)
      show(kernel_only("  kernel: " + name, *model, 0.3 * c.seconds), flops);
    for (const Row& row : whole_loops(name, *model, threads, c.seconds)) show(row, flops);
  }
  fmt::print(
      "flops are counted per element (kernel only); bytes are what the data layout moves once per "
      "cycle. Kernels are\n"
      "bound by dependent arithmetic and shuffles, whole loops of large models by memory: node "
      "lines, partial forces\n"
      "and history pass through the caches once per cycle.\n");
  if (!c.json.empty()) std::ofstream(c.json) << out.dump(2) << "\n";
  return 0;
}

void add_bench(CLI::App& app, BenchCommand& c) {
  auto* bench = app.add_subcommand("bench", "Time this program on this machine");
  c.threads = int(std::thread::hardware_concurrency());
  bench->add_option("--threads", c.threads, "largest number of threads to time")
      ->capture_default_str();
  bench->add_option("--elements", c.elements, "elements per case")->capture_default_str();
  bench->add_option("--seconds", c.seconds, "time per case")->capture_default_str();
  bench->add_option("--only", c.only, "only cases whose name contains this");
  bench->add_option("--json", c.json, "write the table to this file");
  bench->callback([&c] { throw CLI::RuntimeError(bench_command(c)); });
}

}  // namespace fabrica
