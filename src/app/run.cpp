#include "app/run.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "deck/reader.h"
#include "result/binout.h"
#include "result/csv_history.h"
#include "result/d3plot.h"
#include "result/vtu.h"
#include "solver/history.h"

namespace fabrica {
namespace {

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int) { stop_requested = 1; }

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point t) {
  return std::chrono::duration<double>(Clock::now() - t).count();
}

// prints diagnostics of at least a severity; returns how many
void print(const Diagnostics& d, Severity least) {
  for (const Diagnostic& x : d.list())
    if (int(x.severity) >= int(least)) fmt::print(stderr, "{}\n", d.format(x));
}

// All output files of a run.
class Output {
 public:
  Output(const RunCommand& c, const Simulation& s, double restart_time)
      : simulation_(s),
        history_(s),
        binout_(
            restart_time > 0
                ? std::make_unique<BinoutWriter>(c.out + "/binout", s.model().title, restart_time)
                : std::make_unique<BinoutWriter>(c.out + "/binout", s.model().title)),
        csv_(restart_time > 0 ? std::make_unique<CsvHistoryWriter>(c.out + "/csv", restart_time)
                              : std::make_unique<CsvHistoryWriter>(c.out + "/csv")) {
    const Model& m = s.model();
    D3plotOptions options = d3plot_options(m);
    options.rigid_walls = int(m.rigid_walls.size());
    const ResultMesh mesh = result_mesh(m);
    d3plot_ = restart_time > 0
                  ? std::make_unique<D3plotWriter>(c.out + "/d3plot", mesh, options, restart_time)
                  : std::make_unique<D3plotWriter>(c.out + "/d3plot", mesh, options);
    if (c.vtu)
      vtu_ = restart_time > 0 ? std::make_unique<VtuWriter>(c.out + "/animation.pvd", mesh,
                                                            VtuOptions{}, restart_time)
                              : std::make_unique<VtuWriter>(c.out + "/animation.pvd", mesh);
    for (const HistoryDatabase& d : history_.databases()) {
      next_.push_back(first_after(restart_time, d.interval));
      binout_->add(d);
      csv_->add(d);
    }
    const auto i = m.output.interval.find("d3plot");
    plot_interval_ = i != m.output.interval.end() && i->second > 0 ? i->second : s.end_time() / 20;
    next_plot_ = first_after(restart_time, plot_interval_);
  }

  bool wants(double t) const {
    if (last_) return true;
    for (double n : next_)
      if (t >= n * (1 - 1e-12)) return true;
    return t >= next_plot_ * (1 - 1e-12);
  }
  void want_last() { last_ = true; }
  void sample() {
    const double t = simulation_.state().time;
    for (std::size_t i = 0; i < next_.size(); ++i)
      if (last_ || t >= next_[i] * (1 - 1e-12)) {
        const HistorySample sample = history_.sample(int(i));
        binout_->write(int(i), sample);
        csv_->write(int(i), sample);
        while (next_[i] <= t * (1 + 1e-12)) next_[i] += history_.databases()[i].interval;
      }
    if (last_ || t >= next_plot_ * (1 - 1e-12)) {
      const AnimationState a = animation_state(simulation_);
      d3plot_->write(a);
      if (vtu_) vtu_->write(a);
      while (next_plot_ <= t * (1 + 1e-12)) next_plot_ += plot_interval_;
    }
  }
  void flush_tables() { csv_->flush(); }
  void flush() {
    binout_->flush();
    flush_tables();
  }

 private:
  static double first_after(double t, double interval) {
    return t > 0 ? (std::floor(t / interval * (1 + 1e-12)) + 1) * interval : 0;
  }

  const Simulation& simulation_;
  History history_;
  std::unique_ptr<BinoutWriter> binout_;
  std::unique_ptr<CsvHistoryWriter> csv_;
  std::unique_ptr<D3plotWriter> d3plot_;
  std::unique_ptr<VtuWriter> vtu_;
  std::vector<double> next_;
  double plot_interval_ = 0, next_plot_ = 0;
  bool last_ = false;
};

void progress(const Simulation& s, double started_at, double wall) {
  const State& st = s.state();
  const double done = (st.time - started_at) / (s.end_time() - started_at);
  const double left = done > 0 ? wall * (1 - done) / done : 0;
  const TimeStepOwner o = s.time_step_owner();
  fmt::print(
      "t {:.5g} of {:.5g}  cycle {}  dt {:.4g} ({} {} part {})  energy ratio {:.5f}  hourglass "
      "{:.1f} %  "
      "added mass {:.2f} %  left {:.0f} s\n",
      st.time, s.end_time(), st.cycle, st.dt, o.family, o.element, o.part, st.energy.ratio(),
      st.energy.internal != 0 ? 100 * st.energy.hourglass / st.energy.internal : 0,
      s.physical_mass() > 0 ? 100 * s.added_mass() / s.physical_mass() : 0, left);
  std::fflush(stdout);
}

// penetration at the start and the deepest since, over all contacts
void add_penetrations(const Contacts& contacts, nlohmann::ordered_json& j) {
  int initial = 0;
  double initial_depth = 0, depth = 0, share = 0;
  std::int64_t released = 0;
  for (const ContactCheck& c : contacts.checks()) {
    initial += c.initial_nodes, released += c.deepest.released;
    initial_depth = std::max(initial_depth, c.initial_depth);
    depth = std::max(depth, c.deepest.depth);
    if (c.deepest.allowed > 0) share = std::max(share, c.deepest.depth / c.deepest.allowed);
  }
  j["contact_initial_penetrations"] = initial;
  j["contact_initial_depth"] = initial_depth;
  j["contact_largest_penetration"] = depth;
  j["contact_largest_penetration_percent"] = 100 * share;  // of the depth at which a node is let go
  j["contact_nodes_let_go"] = released;
}

nlohmann::ordered_json summary(const Simulation& s, double wall, std::int64_t first_cycle) {
  const State& st = s.state();
  const Energies& e = st.energy;
  const double updates = double(st.cycle - first_cycle) * s.elements();
  nlohmann::ordered_json j;
  j["ending"] = s.ending_text();
  j["time"] = st.time;
  j["cycles"] = st.cycle;
  j["elements"] = s.elements();
  j["element_updates"] = updates;
  j["wall_time"] = wall;
  j["updates_per_second"] = wall > 0 ? updates / wall : 0;
  j["kinetic_energy"] = e.kinetic;
  j["internal_energy"] = e.internal;
  j["hourglass_energy"] = e.hourglass;
  j["contact_energy"] = e.contact;
  j["contact_friction_energy"] = e.contact_friction;
  j["rigid_wall_energy"] = e.rigid_wall;
  j["damping_energy"] = e.damping;
  j["discrete_energy"] = e.discrete;
  j["joint_energy"] = e.joint;
  if (!s.model().contacts.empty()) add_penetrations(s.contacts(), j);
  if (s.joints().size() > 0) j["joint_gap"] = s.joints().largest_gap(s.rigid_bodies());
  j["external_work"] = e.external_work;
  j["total_energy"] = e.total();
  j["energy_ratio"] = e.ratio();
  j["energy_error"] = e.ratio() - 1;
  j["added_mass"] = s.added_mass();
  j["added_mass_percent"] = s.physical_mass() > 0 ? 100 * s.added_mass() / s.physical_mass() : 0;
  if (const SelectiveMass& m = s.mass_scaling().selective(); m.active()) {
    j["selective_added_mass"] = s.mass_scaling().selective_added_mass();
    j["selective_mass_elements"] = m.elements();
    j["selective_mass_iterations"] = m.mean_iterations();
    j["selective_mass_steps_not_converged"] = m.unconverged();
  }
  if (s.rigid_walls().size() > 0)
    j["rigid_wall_method"] = wall_method_names()[std::size_t(s.rigid_walls().method())];
  j["hash"] = fmt::format("{:016x}", s.state_hash());
  return j;
}

// what a run checks about itself; each line is a finding
std::vector<std::string> findings(const Simulation& s) {
  std::vector<std::string> list;
  const Energies& e = s.state().energy;
  const double scale = std::max({std::abs(e.internal), std::abs(e.kinetic), std::abs(e.initial)});
  if (std::abs(e.ratio() - 1) > 0.02)
    list.push_back(fmt::format("energy ratio {:.4f} is off by more than 2 %", e.ratio()));
  if (e.hourglass > 0.05 * std::max(e.internal, 0.01 * scale))
    list.push_back(fmt::format("hourglass energy is {:.1f} % of internal energy (bound 5 %)",
                               100 * e.hourglass / std::max(e.internal, 1e-300)));
  for (const ContactCheck& c : s.contacts().checks()) {
    const Model& m = s.model();
    const PenetrationCheck& p = c.deepest;
    if (m.contacts[c.contact].ignore == 0 && c.initial_nodes > 0)
      list.push_back(fmt::format(
          "contact {}: {} nodes penetrate at the start, by up to {:.4g}; with IGNORE = 0 too this "
          "is not pushed back",
          m.contacts[c.contact].id, c.initial_nodes, c.initial_depth));
    if (p.released > 0)
      list.push_back(fmt::format("contact {}: {} times a node went so deep that it was let go",
                                 m.contacts[c.contact].id, p.released));
    if (p.allowed > 0 && p.depth > 0.5 * p.allowed)
      list.push_back(fmt::format(
          "contact {}: node {} was {:.4g} deep{} at t = {:.4g}, {:.0f} % of what it may be",
          m.contacts[c.contact].id, m.nodes.id[p.node], p.depth,
          p.part >= 0 ? fmt::format(" in part {}", m.parts[p.part].id) : "", p.time,
          100 * p.depth / p.allowed));
  }
  if (e.contact < -0.01 * scale) list.push_back("sliding energy is negative by more than 1 %");
  // selective mass leaves translation alone
  const double heavier = s.added_mass() - s.mass_scaling().selective_added_mass();
  if (s.physical_mass() > 0 && heavier > 0.01 * s.physical_mass())
    list.push_back(
        fmt::format("added mass is {:.1f} % (bound 1 %)", 100 * heavier / s.physical_mass()));
  if (const std::int64_t n = s.mass_scaling().selective().unconverged(); n > 0)
    list.push_back(fmt::format("selective mass scaling did not converge in {} steps", n));
  return list;
}

void print_summary(const nlohmann::ordered_json& j) {
  fmt::print("summary\n");
  for (const auto& [key, value] : j.items())
    fmt::print("{}: {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
}

// what is not supported must be allowed by the user
bool refused(const Diagnostics& diagnostics, bool allowed) {
  const int unsupported = diagnostics.count(Severity::unsupported);
  if (unsupported > 0 && !allowed)
    fmt::print(stderr,
               "fabrica: {} unsupported keywords or fields would change the physics. `fabrica "
               "check` lists them; "
               "--allow-unsupported runs without them\n",
               unsupported);
  return unsupported > 0 && !allowed;
}

// Functions of time became curves that end with the deck's run: a longer one would hold their last
// value.
bool outlasts_functions(const Model& m, double until) {
  const bool any = std::any_of(m.cards.begin(), m.cards.end(), [](const auto& card) {
    return card->schema && card->schema->name == "DEFINE_CURVE_FUNCTION";
  });
  if (!any || until <= m.controls.end_time) return false;
  fmt::print(stderr,
             "fabrica: [functions-end-early] the run is to last to {:g}, but the deck's "
             "*DEFINE_CURVE_FUNCTIONs are known to ENDTIM, {:g}. Raise ENDTIM in the deck\n",
             until, m.controls.end_time);
  return true;
}

}  // namespace

int run_command(const RunCommand& c) {
  Diagnostics diagnostics;
  const auto read_start = Clock::now();
  std::unique_ptr<Model> model = read_deck(c.deck, diagnostics);
  print(diagnostics, Severity::warning);
  if (!model || diagnostics.has_errors()) return 1;
  if (refused(diagnostics, c.allow_unsupported)) return 2;
  if (outlasts_functions(*model, c.until)) return 1;
  std::filesystem::create_directories(c.out);
  const std::size_t printed = diagnostics.list().size();
  RunOptions options;
  options.threads = c.threads > 0 ? c.threads : int(std::thread::hardware_concurrency());
  options.end_time = c.until;
  options.walls = wall_method(c.walls);
  Simulation simulation(*model, options, diagnostics);
  for (std::size_t i = printed; i < diagnostics.list().size(); ++i)
    fmt::print(stderr, "{}\n", diagnostics.format(diagnostics.list()[i]));
  if (diagnostics.has_errors()) return 1;
  if (refused(diagnostics, c.allow_unsupported)) return 2;
  if (!c.restart.empty()) simulation.load(c.restart);
  const double started_at = simulation.state().time;
  const std::int64_t first_cycle = simulation.state().cycle;
  if (!c.quiet)
    fmt::print("{}: {} nodes, {} elements, {} threads, ready in {:.2f} s\n", c.deck,
               model->nodes.size(), simulation.elements(), options.threads,
               seconds_since(read_start));

  Output output(c, simulation, started_at);
  const auto start = Clock::now();
  auto last_line = start;
  bool line_due =
      false;  // a line is printed from a sample, where all energies are those of one time
  const Sampler sampler{[&](double t) { return line_due || output.wants(t); },
                        [&] {
                          output.sample();
                          if (line_due) {
                            progress(simulation, started_at, seconds_since(start));
                            output.flush_tables();  // who looks on reads what is there by now
                          }
                          line_due = false;
                        }};
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  double next_restart = c.restart_interval > 0 ? started_at + c.restart_interval : 1e300;
  while (simulation.ending() == Ending::running && !stop_requested) {
    simulation.step(sampler);
    if (simulation.state().time >= next_restart) {
      simulation.save(fmt::format("{}/restart_{:.6g}", c.out, simulation.state().time));
      next_restart += c.restart_interval;
    }
    if (!c.quiet && simulation.state().cycle % 20 == 0 && seconds_since(last_line) > 5) {
      last_line = Clock::now();
      line_due = true;
    }
  }
  if (stop_requested) simulation.stop("stopped by a signal");
  const double wall = seconds_since(start);
  const bool sound =
      simulation.ending() != Ending::negative_volume && simulation.ending() != Ending::not_a_number;
  if (sound) simulation.save(c.out + "/restart");
  output.want_last();
  simulation.sample_now(sampler);
  output.flush();

  const auto list = findings(simulation);
  auto j = summary(simulation, wall, first_cycle);
  j["threads"] = options.threads;
  j["version"] = FABRICA_VERSION;
  j["findings"] = list;
  std::ofstream(c.out + "/summary.json") << j.dump(2) << "\n";
  for (const auto& f : list) fmt::print("check: {}\n", f);
  j.erase("findings");
  print_summary(j);
  if (stop_requested) return 130;
  return sound && simulation.ending() != Ending::time_step_too_small ? 0 : 3;
}

}  // namespace fabrica
